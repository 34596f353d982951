#include "expr/substitute.h"

namespace rondo::expr {
namespace {

class Rebuilder {
 public:
  // `replaced`: what original subterms become, without a look inside. `change`: what rebuilt ones do.
  Rebuilder(Arena& arena, const Substitution& replaced, const std::function<TermId(TermId)>& change)
      : arena_(arena), change_(change), done_(replaced) {}

  TermId operator()(TermId root) {
    std::vector<TermId> stack{root};
    while (!stack.empty()) {
      const TermId t = stack.back();
      if (done_.contains(t)) {
        stack.pop_back();
        continue;
      }
      bool ready = true;
      for (const TermId arg : arena_.args(t)) {
        if (!done_.contains(arg)) {
          if (ready) ready = false;
          stack.push_back(arg);
        }
      }
      if (!ready) continue;
      stack.pop_back();
      const Term shape = arena_.term(t);
      std::vector<TermId> args;
      bool same = true;
      for (const TermId arg : arena_.args(t)) {
        args.push_back(done_.at(arg));
        same = same && args.back() == arg;
      }
      const TermId rebuilt = same ? t : arena_.Rebuild(shape, std::move(args));
      done_.emplace(t, change_ ? change_(rebuilt) : rebuilt);
    }
    return done_.at(root);
  }

 private:
  Arena& arena_;
  const std::function<TermId(TermId)>& change_;
  Substitution done_;
};

}  // namespace

TermId Transform(Arena& arena, TermId term, const std::function<TermId(TermId)>& change) {
  return Rebuilder(arena, {}, change)(term);
}

TermId Substitute(Arena& arena, TermId term, const Substitution& map) {
  return Rebuilder(arena, map, nullptr)(term);
}

void VisitPostorder(const Arena& arena, TermId term, std::unordered_set<TermId>& seen,
                    const std::function<void(TermId)>& visit) {
  std::vector<std::pair<TermId, bool>> stack{{term, false}};
  while (!stack.empty()) {
    const auto [t, expanded] = stack.back();
    stack.pop_back();
    if (expanded) {
      visit(t);
      continue;
    }
    if (!seen.insert(t).second) continue;
    stack.emplace_back(t, true);
    for (const TermId arg : arena.args(t)) {
      if (!seen.contains(arg)) stack.emplace_back(arg, false);
    }
  }
}

}  // namespace rondo::expr
