#include "reach/system/text.h"

#include <fmt/format.h>

#include <unordered_map>
#include <unordered_set>

#include "expr/substitute.h"

namespace rondo::reach {

namespace {

class Writer {
 public:
  explicit Writer(const Problem& problem) : p_(problem), arena_(*problem.arena) {}

  std::string Run() {
    for (size_t i = 0; i < p_.states.size(); ++i) Name(p_.states[i], fmt::format("x{}", i));
    for (size_t i = 0; i < p_.inputs.size(); ++i) Name(p_.inputs[i].term, fmt::format("w{}", i));
    for (size_t i = 0; i < p_.states.size(); ++i) {
      const std::string rate = Term(p_.rates[i]);
      text_ += fmt::format("state x{} in [{}, {}] rate {}", i, p_.initial[i].lo, p_.initial[i].hi, rate);
      if (i < p_.copy_of.size() && p_.copy_of[i]) text_ += fmt::format(" copy x{}", *p_.copy_of[i]);
      text_ += '\n';
    }
    for (size_t i = 0; i < p_.inputs.size(); ++i)
      text_ += fmt::format("input w{} in [{}, {}]\n", i, p_.inputs[i].bounds.lo, p_.inputs[i].bounds.hi);
    if (p_.controller) {
      text_ += fmt::format("every {}\n", p_.controller->period.ToString());
      for (size_t i = 0; i < p_.states.size(); ++i) {
        if (!p_.controller->updates[i]) continue;
        const std::string value = Term(*p_.controller->updates[i]);
        text_ += fmt::format("set x{} {}\n", i, value);
      }
    }
    for (const Event& e : p_.events) {
      const std::string condition = Term(e.condition);
      text_ += fmt::format("when {}\n", condition);
      for (size_t i = 0; i < p_.states.size(); ++i) {
        if (!e.updates[i]) continue;
        const std::string value = Term(*e.updates[i]);
        text_ += fmt::format("set x{} {}\n", i, value);
      }
    }
    const std::string assumed = Term(p_.assume);
    text_ += fmt::format("assume {}\nhorizon {}\n", assumed, p_.horizon.ToString());
    for (const Claim& c : p_.claims) {
      const std::string formula = Term(c.formula);
      text_ += fmt::format("claim {} from {} to {}\n", formula, c.from.ToString(), c.to.ToString());
    }
    return std::move(text_);
  }

 private:
  void Name(TermId t, std::string name) {
    names_[t] = std::move(name);
    seen_.insert(t);
  }

  std::string Term(TermId term) {
    expr::VisitPostorder(arena_, term, seen_, [&](TermId t) {
      if (names_.contains(t)) return;
      std::string line;
      switch (arena_.op(t)) {
        case expr::Op::kBool:
          line = t == arena_.True() ? "true" : "false";
          break;
        case expr::Op::kNumber:
          line = arena_.number(t).Numerator() + "/" + arena_.number(t).Denominator();
          break;
        case expr::Op::kVariable:
          line = "variable " + arena_.symbol(arena_.symbol_of(t)).name;
          break;
        default:
          line = std::string(expr::Name(arena_.op(t)));
          if (arena_.op(t) == expr::Op::kElementary) line = std::string(expr::Name(arena_.elementary_of(t)));
          if (arena_.op(t) == expr::Op::kApply) line += fmt::format(" {}", arena_.term(t).payload);
          for (const TermId a : arena_.args(t)) line += " " + names_.at(a);
      }
      names_[t] = fmt::format("t{}", next_++);
      text_ += fmt::format("{} {}\n", names_[t], line);
    });
    return names_.at(term);
  }

  const Problem& p_;
  const expr::Arena& arena_;
  std::string text_;
  std::unordered_map<TermId, std::string> names_;
  std::unordered_set<TermId> seen_;
  size_t next_ = 0;
};

}  // namespace

std::string ToText(const Problem& problem) { return Writer(problem).Run(); }

}  // namespace rondo::reach
