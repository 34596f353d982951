#include "reach/problem/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
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
    names_[t] = name;
    shapes_[t] = std::move(name);
  }

  // What the term is, without its arguments.
  std::string Head(TermId t) const {
    switch (arena_.op(t)) {
      case expr::Op::kBool:
        return t == arena_.True() ? "true" : "false";
      case expr::Op::kNumber:
        return arena_.number(t).Numerator() + "/" + arena_.number(t).Denominator();
      case expr::Op::kVariable:
        return "variable " + arena_.symbol(arena_.symbol_of(t)).name;
      case expr::Op::kElementary:
        return std::string(expr::Name(arena_.elementary_of(t)));
      case expr::Op::kApply:
        return fmt::format("{} {}", expr::Name(arena_.op(t)), arena_.term(t).payload);
      default:
        return std::string(expr::Name(arena_.op(t)));
    }
  }

  bool Commutes(TermId t) const {
    switch (arena_.op(t)) {
      case expr::Op::kAnd:
      case expr::Op::kOr:
      case expr::Op::kAdd:
      case expr::Op::kMul:
      case expr::Op::kEq:
        return true;
      default:
        return false;
    }
  }

  // The arguments in an order that depends on what they are, not on when they were made.
  std::vector<TermId> Arguments(TermId t) const {
    std::vector<TermId> args(arena_.args(t).begin(), arena_.args(t).end());
    if (Commutes(t)) {
      std::ranges::stable_sort(args, {}, [&](TermId a) { return shapes_.at(a); });
    }
    return args;
  }

  // A digest of each subterm.
  void Shape(TermId term) {
    std::unordered_set<TermId> seen;
    expr::VisitPostorder(arena_, term, seen, [&](TermId t) {
      if (shapes_.contains(t)) return;
      std::string text = Head(t);
      for (const TermId a : Arguments(t)) text += " " + shapes_.at(a);
      shapes_[t] =
          text.size() <= 32 ? "(" + text + ")" : fmt::format("#{:016x}", std::hash<std::string>()(text));
    });
  }

  std::string Term(TermId term) {
    Shape(term);
    std::vector<std::pair<TermId, bool>> stack{{term, false}};
    while (!stack.empty()) {
      const auto [t, expanded] = stack.back();
      stack.pop_back();
      if (names_.contains(t)) continue;
      const std::vector<TermId> args = Arguments(t);
      if (!expanded) {
        stack.emplace_back(t, true);
        for (size_t i = args.size(); i-- > 0;) stack.emplace_back(args[i], false);
        continue;
      }
      std::string line = Head(t);
      for (const TermId a : args) line += " " + names_.at(a);
      names_[t] = fmt::format("t{}", next_++);
      text_ += fmt::format("{} {}\n", names_[t], line);
    }
    return names_.at(term);
  }

  const Problem& p_;
  const expr::Arena& arena_;
  std::string text_;
  std::unordered_map<TermId, std::string> names_;
  std::unordered_map<TermId, std::string> shapes_;
  size_t next_ = 0;
};

}  // namespace

std::string ToText(const Problem& problem) { return Writer(problem).Run(); }

}  // namespace rondo::reach
