#include "koord/prove/confirm.h"

#include <algorithm>
#include <functional>

#include "expr/substitute.h"

namespace rondo::koord {

// Satisfiable with everything taken into account, or as far as the instances go, or nothing.
std::optional<Candidate> Confirm(const Problem& problem, std::vector<TermId> wanted,
                                 const std::vector<solve::Assertion>& small, bool complete,
                                 const solve::Solver& solver, solve::Budget budget,
                                 const base::StopToken& stop) {
  budget.core = false;
  budget.time /= 4;  // of several questions
  solve::Query query = problem.query;
  query.wanted = std::move(wanted);
  // Small numbers, if there are any, are easier to read.
  const size_t without = query.assertions.size();
  query.assertions.insert(query.assertions.end(), small.begin(), small.end());
  solve::Answer answer = solver.Check(query, budget, stop);
  if (!std::holds_alternative<solve::Sat>(answer)) {
    query.assertions.resize(without);
    answer = solver.Check(query, budget, stop);
  }
  if (!std::holds_alternative<solve::Sat>(answer)) return std::nullopt;
  if (complete) return Candidate{std::get<solve::Sat>(std::move(answer)), true};
  // Some quantifiers were only instantiated: ask again with all of them, for numbers as small.
  solve::Query complete_query = problem.Whole();
  complete_query.wanted = query.wanted;
  complete_query.assertions.insert(complete_query.assertions.end(), query.assertions.begin() + without,
                                   query.assertions.end());
  solve::Answer whole = solver.Check(complete_query, budget, stop);
  if (std::holds_alternative<solve::Unsat>(whole)) return std::nullopt;
  const bool confirmed = std::holds_alternative<solve::Sat>(whole);
  return Candidate{std::get<solve::Sat>(std::move(confirmed ? whole : answer)), confirmed};
}

// Every number among the terms, and every member of a record, lies between -10 and 10.
std::vector<solve::Assertion> Small(expr::Arena& arena, const std::vector<TermId>& terms) {
  std::vector<solve::Assertion> result;
  const std::function<void(TermId)> bound = [&](TermId t) {
    const expr::SortId sort = arena.sort_of(t);
    if (sort == arena.Int() || sort == arena.Real()) {
      const TermId low = arena.Number(sort, expr::Rational(-10));
      const TermId high = arena.Number(sort, expr::Rational(10));
      result.push_back({arena.And(arena.Le(low, t), arena.Le(t, high)), ""});
    } else if (arena.sort(sort).kind == expr::SortKind::kRecord) {
      const size_t fields = arena.sort(sort).parts.size();
      for (uint32_t f = 0; f < fields; ++f) bound(arena.Field(t, f));
    }
  };
  for (const TermId t : terms) bound(t);
  return result;
}

// Is every quantified assertion of the form "for each robot r, p", where r occurs in p only to pick robot r's
// values? Then robots that the problem does not mention can be copies of one that it does: they satisfy p
// because that one does, and skip. (Not if they owe something to a controller assumption: nothing says that
// they can keep it by standing still.)
bool OthersCanBeCopies(const expr::Arena& arena, const Problem& problem, Problems& problems) {
  if (problem.participants.empty() || !problems.promises().empty()) return false;
  return std::all_of(problem.assertions.begin(), problem.assertions.end(), [&](const solve::Assertion& a) {
    if (!arena.HasQuantifier(a.formula)) return true;
    if (arena.op(a.formula) != expr::Op::kForall || arena.args(a.formula).size() != 2) return false;
    const TermId robot = arena.arg(a.formula, 0);
    const TermId body = arena.arg(a.formula, 1);
    if (arena.HasQuantifier(body) || arena.sort_of(robot) != arena.Int()) return false;
    // Its range is the only other place in which the robot may occur.
    const TermId range = problems.vocabulary().IsRobot(robot);
    std::unordered_set<TermId> seen;
    for (const TermId part : arena.args(range)) seen.insert(part);
    bool local = arena.op(range) == expr::Op::kAnd;
    expr::VisitPostorder(arena, body, seen, [&](TermId t) {
      const auto args = arena.args(t);
      for (size_t i = 0; i < args.size(); ++i)
        local = local && (args[i] != robot || (arena.op(t) == expr::Op::kSelect && i == 1));
    });
    return local;
  });
}

}  // namespace rondo::koord
