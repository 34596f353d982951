#include <fmt/format.h>

#include <algorithm>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/statements.h"

namespace rondo::choreo {

using expr::TermId;

namespace {

// The part of a precondition about states that a motion does not modify.
TermId Unchanged(Statements& s, const Instance& i) {
  std::set<TermId> changing;
  const robot::Body& body = s.graph().BodyOf(i.robot);
  for (size_t k = 0; k < body.states.size(); ++k) {
    if (i.contract.modifies[k]) changing.insert(body.states[k].term);
  }
  for (const auto& v : body.inputs) changing.insert(v.term);
  for (const auto& v : s.graph().world->environment) changing.insert(v.term);
  std::vector<TermId> kept;
  for (const TermId part : Conjuncts(s.arena(), i.contract.pre)) {
    const auto& variables = s.VariablesOf(part);
    if (std::ranges::none_of(variables, [&](TermId v) { return changing.contains(v); })) kept.push_back(part);
  }
  return s.arena().And(kept);
}

}  // namespace

// A contract that nothing can keep would prove everything.
void StateContract(Statements& s, const Instance& i) {
  expr::Arena& arena = s.arena();
  const diag::Span span = i.motion->name.span;
  const std::string who = fmt::format("`{}: {}`", s.graph().NameOf(i.robot), i.text);
  const robot::Contract& c = i.contract;
  s.Sat(span, State("in which " + who + " may begin"), {c.pre, c.assume, s.AtClock(c.during, 0)});
  // What the motion leaves as it is stays as it was required to be.
  const TermId during = arena.And({c.during, c.assume, Unchanged(s, i)});
  s.Sat(span, State("during " + who), {during, s.Elapsed(i.duration)});
  if (i.duration.interruptible && c.post != arena.True()) {
    s.Unsat(ObligationKind::kInterrupted, span,
            {"what " + who + " promises whenever it may be interrupted",
             "what " + who + " promises may not hold when a message ends it"},
            {c.during, c.assume, s.Ended(i.duration), s.Fails(c.post)});
  }
  // At the latest, if that can be; or some time before.
  const TermId ends = arena.And({c.post, during, s.Ended(i.duration)});
  s.Sat(span, State("in which " + who + " ends"),
        {arena.Or(s.AtClock(ends, i.duration.most.value_or(i.duration.least)), ends)});
  if (c.footprint) {
    s.Unsat(ObligationKind::kBody, span,
            {"the footprint of " + who + " has a value", "the footprint of " + who + " may have no value"},
            {c.during, c.assume, s.Elapsed(i.duration), robot::Undefined(arena, *c.footprint)});
  }
}

}  // namespace rondo::choreo
