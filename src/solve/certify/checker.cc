#include "solve/certify/checker.h"

#include <fmt/format.h>
#include <mpfr.h>

#include <algorithm>
#include <set>

#include "solve/certify/facts.h"
#include "solve/certify/propagator.h"

namespace rondo::solve::certify {
namespace {

using expr::Op;
using lang::smtlib::Command;

constexpr int kSweeps = 3;       // for a box that is split
constexpr int kLeafSweeps = 60;  // for a box that must turn out empty
constexpr int kLeafParts = 64;  // into which it may be split to that end: enclosures differ from the search's

constexpr size_t kDeepest = 1000;            // nested cases
constexpr size_t kMostNumbers = 20'000'000;  // in boxes that wait

struct Stopped {};

/// The words of a tree.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::string_view Next() {
    at_ = std::min(text_.find_first_not_of(" \n\t\r", at_), text_.size());
    const size_t end = std::min(text_.find_first_of(" \n\t\r", at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
  }

 private:
  std::string_view text_;
  size_t at_ = 0;
};

class Checker {
 public:
  Checker(const Certificate& certificate, const base::StopToken& stop)
      : certificate_(certificate), arena_(certificate.script.arena), stop_(stop), normal_(arena_) {}

  void Run(Tally& tally) {
    Branch root{Facts(normal_), {}, {}, FormulaId()};
    for (const expr::TermId v : certificate_.script.variables) {
      if (arena_.sort_of(v) != arena_.Bool()) continue;
      const Poly x{{Monomial{normal_.Variable(v)}, Rational(1)}};
      root.facts.Add(normal_.Literal(x, kAbove | kEven));
      root.facts.Add(normal_.Literal(Normal::Minus(x, Normal::ConstantPoly(Rational(1))), kBelow | kEven));
    }
    for (const Command& c : certificate_.script.commands) {
      if (c.kind == Command::Kind::kCheckSat || c.kind == Command::Kind::kDeclare) continue;
      at = c.span;
      if (c.kind != Command::Kind::kAssert) throw Rejection("a certificate has no such command");
      root.facts.Add(normal_.Of(c.terms[0]));
      ++tally.assertions;
    }
    open_.push_back(std::move(root));
    for (const Step& step : certificate_.steps) {
      at = step.span;
      if (stop_.StopRequested()) throw Stopped{};
      if (open_.empty()) throw Rejection("the proof has ended before this step");
      Take(step, tally);
    }
    if (!open_.empty()) throw Rejection("the proof ends here, with a case that is not closed");
  }

  diag::Span at;

 private:
  /// A case: what is known in it, and, once it is split, the alternatives that are still open.
  struct Branch {
    Facts facts;
    std::vector<const Step*> required;  // facts and identities, for searches
    std::optional<std::set<FormulaId>> open;
    FormulaId assumed;
  };

  void Take(const Step& step, Tally& tally) {
    Branch& branch = open_.back();
    if (branch.open.has_value() != (step.kind == Step::Kind::kCase || step.kind == Step::Kind::kEnd))
      throw Rejection(branch.open ? "`case` or `end` should stand here" : "no cases are open here");
    switch (step.kind) {
      case Step::Kind::kCase: {
        Branch next{branch.facts, branch.required, std::nullopt, normal_.Of(step.terms[0])};
        next.facts.Add(next.assumed);
        if (open_.size() == kDeepest) throw Rejection("cases are nested too deeply");
        open_.push_back(std::move(next));
        return;
      }
      case Step::Kind::kEnd:
        if (!branch.open->empty()) throw Rejection("an alternative is missing");
        break;
      case Step::Kind::kSubstitute: {
        if (arena_.op(step.terms[0]) != Op::kVariable || arena_.sort_of(step.terms[1]) == arena_.Bool())
          throw Rejection("only variables are substituted, by numbers");
        const AtomId variable = normal_.Variable(step.terms[0]);
        branch.facts.Substitute(variable, normal_.Number(step.terms[1]));
        // The variable is free from now on: what was said of it holds no longer.
        branch.required.clear();
        return;
      }
      case Step::Kind::kSquares:
        Require(branch, step.terms[0]);
        return Squares(branch.facts, step.terms[0]);
      case Step::Kind::kPeriod: {
        if (arena_.op(step.terms[0]) != Op::kVariable || !arena_.IsNumber(step.terms[1]) ||
            !arena_.IsNumber(step.terms[2]))
          throw Rejection("a variable and two numbers should stand here");
        return branch.facts.AddWindow(normal_.Variable(step.terms[0]), arena_.number(step.terms[1]),
                                      arena_.number(step.terms[2]));
      }
      case Step::Kind::kFact:
        Require(branch, step.terms[0]);
        branch.required.push_back(&step);
        return;
      case Step::Kind::kIdentity:
        Identity(step.terms);
        branch.required.push_back(&step);
        return;
      case Step::Kind::kCases:
        return Cases(branch, step.terms[0]);
      case Step::Kind::kContradiction:
        if (!branch.facts.contradiction()) throw Rejection("no contradiction is known here");
        break;
      case Step::Kind::kSearch:
        Search(branch, step, tally);
        break;
    }
    if (step.kind != Step::Kind::kEnd) ++tally.cases;
    const FormulaId closed = branch.assumed;
    open_.pop_back();
    if (!open_.empty()) open_.back().open->erase(closed);
  }

  void Require(const Branch& branch, expr::TermId formula) {
    if (!branch.facts.Known(normal_.Of(formula))) throw Rejection("this does not follow from what is known");
    if (!normal_.Faithful(formula))
      throw Rejection("this says that something is defined, which does not follow from what is known");
  }

  std::vector<std::pair<Rational, expr::TermId>> Parts(const std::vector<expr::TermId>& terms) const {
    std::vector<std::pair<Rational, expr::TermId>> parts;
    for (size_t i = 0; i + 1 < terms.size(); i += 2)
      parts.emplace_back(arena_.number(terms[i]), terms[i + 1]);
    return parts;
  }

  // The sum is 0 as a polynomial, and defined everywhere.
  void Identity(const std::vector<expr::TermId>& terms) {
    for (size_t i = 0; i < terms.size(); ++i) {
      const bool number = i % 2 == 0;
      if (arena_.sort_of(terms[i]) == arena_.Bool() || (number && !arena_.IsNumber(terms[i])))
        throw Rejection("numbers and terms should alternate here");
      if (!number && normal_.HasPartial(terms[i]))
        throw Rejection("a term of the identity is not defined everywhere");
    }
    Poly sum = Normal::ConstantPoly(arena_.number(terms.back()));
    for (const auto& [c, term] : Parts(terms)) {
      const Poly p = normal_.poly(normal_.Number(term));
      for (const auto& [m, d] : p) AddTo(sum, m, c * d);
    }
    if (!sum.empty()) throw Rejection("this is no identity");
  }

  void Cases(Branch& branch, expr::TermId formula) {
    const FormulaId id = normal_.Of(formula);
    if (!branch.facts.Known(id)) throw Rejection("this disjunction is not known");
    if (arena_.op(formula) != Op::kOr) throw Rejection("only disjunctions have cases");
    branch.open.emplace();
    for (const expr::TermId a : arena_.args(formula)) {
      const FormulaId alternative = normal_.Of(a);
      if (normal_.formula(alternative).kind != Formula::Kind::kFalse) branch.open->insert(alternative);
    }
  }

  // c1 r1 r1 + ... <= b with b <= 0 < ci.
  void Squares(Facts& facts, expr::TermId formula) {
    const Op op = arena_.op(formula);
    if (op != Op::kLe && op != Op::kLt && op != Op::kEq)
      throw Rejection("a sum of squares should be at most 0");
    const bool swapped = op == Op::kEq && arena_.IsNumber(arena_.arg(formula, 0));
    const expr::TermId sum = arena_.arg(formula, swapped ? 1 : 0);
    const expr::TermId bound = arena_.arg(formula, swapped ? 0 : 1);
    if (!arena_.IsNumber(bound) || arena_.number(bound) > Rational(0))
      throw Rejection("a sum of squares should be at most 0");
    std::vector<expr::TermId> summands{sum};
    if (arena_.op(sum) == Op::kAdd) summands.assign(arena_.args(sum).begin(), arena_.args(sum).end());
    const bool none = arena_.number(bound) < Rational(0) || op == Op::kLt;
    for (expr::TermId t : summands) {
      if (arena_.op(t) == Op::kMul && arena_.IsNumber(arena_.arg(t, 0))) {
        if (arena_.number(arena_.arg(t, 0)) < Rational(0)) throw Rejection("a square is subtracted");
        t = arena_.arg(t, 1);
      }
      if (arena_.op(t) == Op::kToReal) t = arena_.arg(t, 0);
      if (arena_.op(t) != Op::kMul || arena_.arg(t, 0) != arena_.arg(t, 1))
        throw Rejection("a summand is no square");
      facts.Add(normal_.Literal(normal_.poly(normal_.Number(arena_.arg(t, 0))), kEven));
    }
    if (none) facts.Add(normal_.Literal({}, kBelow));
  }

  void Search(const Branch& branch, const Step& step, Tally& tally) {
    Propagator propagator(arena_);
    for (const Step* fact : branch.required) {
      if (fact->kind == Step::Kind::kFact) {
        propagator.Require(fact->terms[0]);
      } else {
        propagator.RequireSum(Parts(fact->terms), arena_.number(fact->terms.back()));
      }
    }
    std::vector<size_t> places;
    for (const expr::TermId v : step.terms) {
      const auto& all = propagator.variables();
      const auto it = std::ranges::find(all, v);
      if (it == all.end()) throw Rejection("a variable of the search occurs in no fact");
      places.push_back(static_cast<size_t>(it - all.begin()));
    }
    Words words(step.text);
    std::vector<Box> open(1, Box(propagator.variables().size()));
    uint64_t number = 0;
    while (!open.empty()) {
      if (stop_.StopRequested()) throw Stopped{};
      Box box = std::move(open.back());
      open.pop_back();
      ++number;
      ++tally.boxes;
      const std::string_view word = words.Next();
      if (word == ".") {
        if (!IsEmpty(propagator, box))
          throw Rejection(fmt::format("box {} of the search is not empty", number));
        continue;
      }
      const auto which = expr::Rational::Parse(word);
      const auto value = expr::Rational::Parse(words.Next());
      if (!which || !value || !which->IsInteger() || *which < Rational(0) ||
          *which >= Rational(static_cast<int64_t>(places.size())))
        throw Rejection(fmt::format("the tree of the search is malformed at box {}", number));
      const size_t place = places[static_cast<size_t>(which->ToDouble())];
      // The parts of an empty box are empty.
      if (!IsEmptyNow(box)) {
        if (!propagator.Contract(box, kSweeps)) std::ranges::for_each(box, &Enclosure::Clear);
      }
      Box upper = box;
      const Enclosure middle(*value);
      if (arena_.sort_of(propagator.variables()[place]) == arena_.Real()) {
        upper[place].AtLeast(middle);
        box[place].AtMost(middle);
      } else {
        upper[place].AtLeast(Enclosure(value->Floor() + Rational(1)));
        box[place].AtMost(Enclosure(value->Floor()));
      }
      if (open.size() * (box.size() + 1) > kMostNumbers)
        throw Rejection("the tree of the search is too deep");
      open.push_back(std::move(upper));
      open.push_back(std::move(box));
    }
    if (!words.Next().empty()) throw Rejection("the tree of the search goes on behind its end");
  }

  static bool IsEmptyNow(const Box& box) {
    return std::ranges::any_of(box, [](const Enclosure& e) { return e.IsEmpty(); });
  }

  bool IsEmpty(Propagator& propagator, Box& box) const {
    if (IsEmptyNow(box) || !propagator.Contract(box, kLeafSweeps)) return true;
    std::vector<std::pair<Box, size_t>> open{{box, 0}};  // with the variable to split next
    for (int parts = 0; !open.empty(); ++parts) {
      if (parts == kLeafParts) return false;
      auto [part, next] = std::move(open.back());
      open.pop_back();
      if (parts > 0 && !propagator.Contract(part, kLeafSweeps)) continue;
      const auto splits = [&](size_t v) {
        return arena_.sort_of(propagator.variables()[v]) == arena_.Real() && part[v].IsBounded();
      };
      if (part.empty()) return false;
      size_t v = next % part.size();
      for (size_t tried = 0; !splits(v); v = (v + 1) % part.size()) {
        if (++tried == part.size()) return false;
      }
      auto [low, high] = part[v].Halves();
      Box other = part;
      part[v] = low;
      other[v] = high;
      open.emplace_back(std::move(part), v + 1);
      open.emplace_back(std::move(other), v + 1);
    }
    return true;
  }

  const Certificate& certificate_;
  const expr::Arena& arena_;
  const base::StopToken& stop_;
  Normal normal_;
  std::vector<Branch> open_;
};

/// MPFR keeps constants and memory for each thread, and leaves it to the thread to give them back.
class ThreadCache {
 public:
  ThreadCache() = default;
  ThreadCache(const ThreadCache&) = delete;
  ThreadCache& operator=(const ThreadCache&) = delete;
  ~ThreadCache() { mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); }
};

}  // namespace

Tally Check(const Certificate& certificate, diag::Diagnostics& diagnostics, const base::StopToken& stop) {
  thread_local const ThreadCache cache;
  static_cast<void>(&cache);  // made at the first use in a thread
  Tally tally;
  Checker checker(certificate, stop);
  try {
    checker.Run(tally);
  } catch (const Rejection& why) {
    diagnostics.Report(diag::Kind::kCertificateRejected, checker.at, why.what());
  } catch (const Stopped&) {
    tally.stopped = true;
  }
  return tally;
}

}  // namespace rondo::solve::certify
