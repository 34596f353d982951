#include "solve/triggers.h"

#include <algorithm>
#include <functional>
#include <set>

#include "expr/substitute.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::TermId;

bool Contains(const std::vector<TermId>& list, TermId t) {
  return std::find(list.begin(), list.end(), t) != list.end();
}

}  // namespace

std::vector<std::vector<TermId>> FindTriggers(const Arena& arena, TermId body,
                                              const std::vector<TermId>& variables) {
  std::vector<TermId> patterns;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, body, seen, [&](TermId t) {
    if (arena.op(t) != expr::Op::kApply || !arena.IsOpen(t)) return;
    const bool flat = std::all_of(arena.args(t).begin(), arena.args(t).end(),
                                  [&](TermId a) { return !arena.IsOpen(a) || Contains(variables, a); });
    if (flat) patterns.push_back(t);
  });
  const auto covers = [&](const std::vector<TermId>& set) {
    return std::all_of(variables.begin(), variables.end(), [&](TermId v) {
      return std::any_of(set.begin(), set.end(), [&](TermId p) {
        return std::find(arena.args(p).begin(), arena.args(p).end(), v) != arena.args(p).end();
      });
    });
  };
  std::vector<std::vector<TermId>> result;
  for (size_t size = 1; size <= 3 && result.empty(); ++size) {
    std::vector<TermId> chosen;
    const std::function<void(size_t)> choose = [&](size_t from) {
      if (chosen.size() == size) {
        if (covers(chosen)) result.push_back(chosen);
        return;
      }
      for (size_t i = from; i < patterns.size(); ++i) {
        chosen.push_back(patterns[i]);
        choose(i + 1);
        chosen.pop_back();
      }
    };
    choose(0);
  }
  return result;
}

std::vector<std::vector<TermId>> MatchTrigger(const Arena& arena, const PlaceIndex& index,
                                              const std::vector<TermId>& trigger,
                                              const std::vector<TermId>& variables, size_t limit) {
  std::vector<std::vector<TermId>> result;
  std::map<TermId, TermId> bound;
  const std::function<void(size_t)> match = [&](size_t i) {
    if (result.size() >= limit) return;
    if (i == trigger.size()) {
      std::vector<TermId> tuple;
      for (const TermId v : variables) tuple.push_back(bound.at(v));
      result.push_back(std::move(tuple));
      return;
    }
    const auto pattern = arena.args(trigger[i]);
    for (const TermId candidate : index.Applications(arena.symbol_of(trigger[i]))) {
      const auto args = arena.args(candidate);
      std::vector<TermId> fresh;
      bool fits = true;
      for (size_t k = 0; fits && k < args.size(); ++k) {
        if (!arena.IsOpen(pattern[k])) {
          fits = pattern[k] == args[k];
        } else if (const auto it = bound.find(pattern[k]); it != bound.end()) {
          fits = it->second == args[k];
        } else {
          bound.emplace(pattern[k], args[k]);
          fresh.push_back(pattern[k]);
        }
      }
      if (fits) match(i + 1);
      for (const TermId v : fresh) bound.erase(v);
    }
  };
  match(0);
  return result;
}

}  // namespace rondo::solve
