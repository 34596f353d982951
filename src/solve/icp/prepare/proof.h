#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "expr/smtlib/smtlib.h"
#include "solve/icp/prepare/lower.h"

/// How the interval solver writes certificates.
namespace rondo::solve::icp {

/// Writes down a refutation while it is found, in the language of `solve/certify` (`proof_reader.h` says what
/// each step means): formulas of the lowered arena become text, each step as it happens.
class Proof {
 public:
  explicit Proof(const Lowered& lowered);

  void Substitute(TermId variable, TermId value);
  void Squares(TermId formula);
  void Period(TermId variable, const Rational& lo, const Rational& hi);
  void Fact(TermId formula);
  /// Adds constant + the sum of coefficient * term = 0, which holds whatever the variables are.
  void Identity(const std::vector<std::pair<Rational, TermId>>& parts, const Rational& constant);
  void Cases(TermId disjunction);
  void Case(TermId alternative);
  void End() { text_ += "(end)\n"; }
  void Contradiction() { text_ += "(contradiction)\n"; }
  void Search(const std::vector<TermId>& variables, const std::string& tree);

  /// Returns the steps so far.
  const std::string& text() const { return text_; }

 private:
  void Step(const char* head, TermId formula);
  std::string Say(TermId term);
  static std::string Say(const Rational& value);

  const expr::Arena& arena_;
  expr::SmtPrinter printer_;
  std::unordered_set<TermId> seen_;
  std::string text_;
  size_t names_ = 0;
};

}  // namespace rondo::solve::icp
