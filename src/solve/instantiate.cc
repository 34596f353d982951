#include "solve/instantiate.h"

#include <algorithm>
#include <functional>
#include <set>

#include "expr/substitute.h"
#include "solve/places.h"
#include "solve/triggers.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::Op;
using expr::TermId;

struct Universal {
  std::vector<TermId> variables;
  TermId body;
  std::string group;
  std::map<TermId, std::vector<VariablePlace>> places;
  std::map<TermId, std::vector<TermId>> equal;
  /// Variables whose values come from triggers, and those triggers.
  std::vector<TermId> matched;
  std::vector<std::vector<TermId>> triggers;
  std::set<std::vector<TermId>> done;
};

class Engine {
 public:
  Engine(Arena& arena, const std::map<expr::SortId, std::vector<TermId>>& fallback,
         const InstantiationLimits& limits, Witnesses& witnesses)
      : arena_(arena), fallback_(fallback), limits_(limits), witnesses_(witnesses), index_(arena) {}

  Ground Run(const std::vector<Assertion>& assertions) {
    for (const Assertion& assertion : assertions) Assert(assertion.formula, assertion.group);
    for (int round = 0; round < limits_.rounds; ++round) {
      for (; indexed_ < result_.assertions.size(); ++indexed_)
        index_.Add(result_.assertions[indexed_].formula);
      bool progress = false;
      // Instances may add universals; those wait for the next round.
      const size_t count = universals_.size();
      for (size_t u = 0; u < count; ++u) progress = InstantiateOne(u) || progress;
      if (!progress) break;
    }
    result_.complete = universals_.empty();
    return std::move(result_);
  }

 private:
  enum class Polarity : uint8_t { kPositive, kNegative, kBoth };

  void Assert(TermId formula, const std::string& group) {
    if (arena_.op(formula) == Op::kAnd) {
      const std::vector<TermId> parts(arena_.args(formula).begin(), arena_.args(formula).end());
      for (const TermId part : parts) Assert(part, group);
      return;
    }
    if (arena_.op(formula) == Op::kForall) {
      AddUniversal(formula, group);
      return;
    }
    const TermId ground = Strip(formula, Polarity::kPositive, group);
    if (ground == arena_.True() || !asserted_.insert({ground, group}).second) return;
    result_.assertions.push_back({ground, group});
  }

  void AddUniversal(TermId forall, const std::string& group) {
    const auto args = arena_.args(forall);
    Universal u{{args.begin(), args.end() - 1}, args.back(), group, {}, {}, {}, {}, {}};
    u.places = PlacesOf(arena_, u.body, u.variables);
    u.equal = EqualTerms(arena_, u.body, u.variables);
    if (limits_.mode == InstantiationMode::kTriggers) {
      for (const TermId v : u.variables) {
        if (arena_.sort_of(v) != arena_.Int()) u.matched.push_back(v);
      }
      if (u.matched.size() > 1) u.triggers = FindTriggers(arena_, u.body, u.matched);
      if (u.triggers.empty()) u.matched.clear();
    }
    universals_.push_back(std::move(u));
  }

  // `formula` without quantifiers, equisatisfiable as an assertion together with what is asserted on the
  // side.
  TermId Strip(TermId formula, Polarity polarity, const std::string& group) {
    if (!arena_.HasQuantifier(formula)) return formula;
    const std::vector<TermId> args(arena_.args(formula).begin(), arena_.args(formula).end());
    switch (arena_.op(formula)) {
      case Op::kNot: {
        const Polarity flipped = polarity == Polarity::kPositive   ? Polarity::kNegative
                                 : polarity == Polarity::kNegative ? Polarity::kPositive
                                                                   : Polarity::kBoth;
        return arena_.Not(Strip(args[0], flipped, group));
      }
      case Op::kAnd:
      case Op::kOr: {
        std::vector<TermId> parts;
        for (const TermId arg : args) parts.push_back(Strip(arg, polarity, group));
        return arena_.op(formula) == Op::kAnd ? arena_.And(parts) : arena_.Or(parts);
      }
      case Op::kForall:
      case Op::kExists: {
        const bool existential = (arena_.op(formula) == Op::kExists) == (polarity == Polarity::kPositive);
        if (polarity == Polarity::kBoth) return Name(formula, Polarity::kBoth, group);
        if (!existential) return Name(formula, polarity, group);
        return Strip(Skolemize(formula), polarity, group);
      }
      default: {
        // Under equality or if-then-else both polarities count: name every quantifier below.
        std::vector<TermId> parts;
        for (const TermId arg : args) parts.push_back(Strip(arg, Polarity::kBoth, group));
        const expr::Term shape = arena_.term(formula);
        return arena_.Rebuild(shape, std::move(parts));
      }
    }
  }

  // One body for each quantifier, whichever polarity asks first: `exists x. p` holds of the Skolem constants
  // if it holds of anything, and `not forall x. p` is `exists x. not p`.
  TermId Skolemize(TermId quantifier) {
    if (const auto it = witnesses_.find(quantifier); it != witnesses_.end()) return it->second;
    const std::vector<TermId> args(arena_.args(quantifier).begin(), arena_.args(quantifier).end());
    expr::Substitution map;
    for (size_t i = 0; i + 1 < args.size(); ++i) {
      const std::string name = arena_.symbol(arena_.symbol_of(args[i])).name;
      map[args[i]] = arena_.FreshConstant(name, arena_.sort_of(args[i]));
    }
    return witnesses_[quantifier] = Substitute(arena_, args.back(), map);
  }

  // A Boolean constant that implies the quantifier (positive), is implied by it (negative), or both.
  TermId Name(TermId quantifier, Polarity polarity, const std::string& group) {
    const auto [it, fresh] = names_.try_emplace({quantifier, polarity});
    if (!fresh) return it->second;
    const TermId name = arena_.FreshConstant("named", arena_.Bool());
    it->second = name;
    const bool forall = arena_.op(quantifier) == Op::kForall;
    const std::vector<TermId> args(arena_.args(quantifier).begin(), arena_.args(quantifier).end());
    const std::vector<TermId> variables(args.begin(), args.end() - 1);
    // A universal statement under the condition that the name has the value `when`.
    const auto universal = [&](bool when, TermId body) {
      const TermId condition = when ? arena_.Not(name) : name;
      AddUniversal(arena_.Forall(variables, arena_.Or(condition, body)), group);
    };
    const auto existential = [&](bool when, bool holds) {
      const TermId body = Skolemize(quantifier);
      Assert(arena_.Or(when ? arena_.Not(name) : name, holds ? body : arena_.Not(body)), group);
    };
    if (polarity != Polarity::kNegative) {
      if (forall)
        universal(true, args.back());
      else
        existential(true, true);
    }
    if (polarity != Polarity::kPositive) {
      if (forall)
        existential(false, false);
      else
        universal(false, arena_.Not(args.back()));
    }
    return name;
  }

  std::vector<TermId> Candidates(const Universal& u, TermId variable) {
    std::vector<TermId> result;
    std::unordered_set<TermId> seen;
    const auto it = u.places.find(variable);
    if (it != u.places.end()) {
      for (const VariablePlace& where : it->second) {
        const std::vector<TermId> terms = index_.At(where.place);
        for (const TermId t : terms) {
          const TermId candidate =
              where.offset.IsZero() ? t : arena_.Sub(t, arena_.Number(arena_.sort_of(t), where.offset));
          if (seen.insert(candidate).second) result.push_back(candidate);
        }
      }
    }
    if (const auto equal = u.equal.find(variable); equal != u.equal.end()) {
      for (const TermId t : equal->second) {
        if (seen.insert(t).second) result.push_back(t);
      }
    }
    if (result.empty()) {
      if (const auto f = fallback_.find(arena_.sort_of(variable)); f != fallback_.end()) return f->second;
    }
    return result;
  }

  bool InstantiateOne(size_t which) {
    const std::vector<TermId> variables = universals_[which].variables;
    const std::vector<TermId> matched = universals_[which].matched;
    std::map<TermId, std::vector<TermId>> candidates;
    for (const TermId v : variables) {
      if (std::find(matched.begin(), matched.end(), v) == matched.end())
        candidates[v] = Candidates(universals_[which], v);
    }
    std::vector<std::vector<TermId>> matches;
    for (const std::vector<TermId>& trigger : std::vector(universals_[which].triggers)) {
      const auto found = MatchTrigger(arena_, index_, trigger, matched, limits_.per_quantifier);
      matches.insert(matches.end(), found.begin(), found.end());
    }
    if (matched.empty()) matches.emplace_back();
    bool progress = false;
    expr::Substitution map;
    const std::function<void(size_t)> choose = [&](size_t i) {
      if (universals_[which].done.size() >= limits_.per_quantifier || made_ >= limits_.total) return;
      if (i < variables.size()) {
        const auto it = candidates.find(variables[i]);
        if (it == candidates.end()) return choose(i + 1);  // bound by the match
        for (const TermId t : it->second) {
          map[variables[i]] = t;
          choose(i + 1);
        }
        return;
      }
      std::vector<TermId> tuple;
      for (const TermId v : variables) tuple.push_back(map.at(v));
      if (!universals_[which].done.insert(tuple).second) return;
      progress = true;
      ++made_;
      const std::string group = universals_[which].group;
      Assert(Substitute(arena_, universals_[which].body, map), group);
    };
    for (const std::vector<TermId>& match : matches) {
      for (size_t k = 0; k < matched.size(); ++k) map[matched[k]] = match[k];
      choose(0);
    }
    return progress;
  }

  Arena& arena_;
  const std::map<expr::SortId, std::vector<TermId>>& fallback_;
  const InstantiationLimits& limits_;
  Witnesses& witnesses_;
  PlaceIndex index_;
  size_t indexed_ = 0;
  size_t made_ = 0;
  std::vector<Universal> universals_;
  std::map<std::pair<TermId, Polarity>, TermId> names_;
  std::set<std::pair<TermId, std::string>> asserted_;
  Ground result_;
};

}  // namespace

Ground Instantiate(Arena& arena, const std::vector<Assertion>& assertions,
                   const std::map<expr::SortId, std::vector<TermId>>& fallback,
                   const InstantiationLimits& limits, Witnesses& witnesses) {
  return Engine(arena, fallback, limits, witnesses).Run(assertions);
}

Ground Instantiate(Arena& arena, const std::vector<Assertion>& assertions,
                   const std::map<expr::SortId, std::vector<TermId>>& fallback,
                   const InstantiationLimits& limits) {
  Witnesses witnesses;
  return Instantiate(arena, assertions, fallback, limits, witnesses);
}

}  // namespace rondo::solve
