// Random questions for solvers, and what several tests ask of answers.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "solve/certify/checker.h"
#include "solve/solver.h"

namespace rondo::testing_support {

using expr::Arena;
using expr::Elementary;
using expr::Rational;
using expr::TermId;
using solve::Query;

inline std::string Say(const solve::Answer& a) {
  if (std::holds_alternative<solve::Unsat>(a)) return "unsat";
  if (std::holds_alternative<solve::Sat>(a)) return "sat";
  return std::holds_alternative<solve::DeltaSat>(a) ? "delta-sat" : "unknown";
}

/// Why the checker does not accept a certificate; empty if it does.
inline std::string Rejected(const std::string& text) {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  solve::certify::Certificate certificate;
  solve::certify::ReadCertificate(sources, sources.Add("certificate", text), certificate, diagnostics);
  if (!diagnostics.has_errors()) solve::certify::Check(certificate, diagnostics, {});
  return diagnostics.has_errors() ? diagnostics.Sorted()[0].message : "";
}

/// The same of an `unsat` answer that was asked for a certificate; empty for other answers.
inline std::string CertificateProblem(const solve::Answer& answer) {
  const auto* unsat = std::get_if<solve::Unsat>(&answer);
  if (unsat == nullptr) return "";
  const std::string why = Rejected(unsat->certificate);
  return why.empty() ? "" : why + "\n" + unsat->certificate;
}

// Random formulas over a few bounded reals.
class Formulas {
 public:
  Formulas(uint64_t seed, bool polynomial) : rng_(seed), polynomial_(polynomial) {
    for (const char* name : {"x", "y", "z"})
      variables_.push_back(arena_.Variable(arena_.Declare(name, {}, arena_.Real())));
    for (const TermId v : variables_) {
      query_.assertions.push_back({arena_.And(arena_.Le(Number(-2), v), arena_.Le(v, Number(2))), ""});
    }
    const int count = 1 + Pick(3);
    for (int i = 0; i < count; ++i) query_.assertions.push_back({Formula(2), ""});
    query_.arena = &arena_;
    query_.wanted = variables_;
  }

  const Query& query() const { return query_; }
  const std::vector<TermId>& variables() const { return variables_; }
  Arena& arena() { return arena_; }

 private:
  int Pick(int n) { return static_cast<int>(rng_() % static_cast<uint64_t>(n)); }
  TermId Number(int n) { return arena_.Number(arena_.Real(), Rational(n)); }
  TermId Constant() {
    static constexpr const char* kNumbers[] = {"0", "1", "-1", "0.5", "2", "0.1", "-0.3", "1.7", "3"};
    return arena_.Number(arena_.Real(), *Rational::Parse(kNumbers[Pick(9)]));
  }

  TermId Formula(int depth) {
    switch (depth == 0 ? 3 : Pick(6)) {
      case 0:
        return arena_.And(Formula(depth - 1), Formula(depth - 1));
      case 1:
        return arena_.Or(Formula(depth - 1), Formula(depth - 1));
      case 2:
        return arena_.Not(Formula(depth - 1));
      default: {
        const TermId a = Term(3);
        const TermId b = Pick(2) == 0 ? Constant() : Term(2);
        const int relation = Pick(7);
        return relation < 3 ? arena_.Le(a, b) : relation < 6 ? arena_.Lt(b, a) : arena_.Eq(a, b);
      }
    }
  }

  TermId Term(int depth) {
    if (depth == 0) return Pick(4) == 0 ? Constant() : variables_[static_cast<size_t>(Pick(3))];
    const int choice = Pick(polynomial_ ? 8 : 14);
    if (choice < 2) return Term(0);
    const TermId a = Term(depth - 1);
    if (choice < 4) return arena_.Add(a, Term(depth - 1));
    if (choice < 5) return arena_.Sub(a, Term(depth - 1));
    if (choice < 7) return arena_.Mul(a, Term(depth - 1));
    if (choice < 8) return arena_.Ite(arena_.Le(a, Term(0)), Term(depth - 1), Term(0));
    static constexpr Elementary kUnary[] = {
        Elementary::kSin, Elementary::kCos, Elementary::kSqrt, Elementary::kAbs,  Elementary::kAtan,
        Elementary::kExp, Elementary::kTan, Elementary::kLog,  Elementary::kAsin, Elementary::kAcos};
    if (choice < 12) return arena_.Apply(kUnary[Pick(choice == 8 ? 2 : 10)], {a});
    static constexpr Elementary kBinary[] = {Elementary::kMin, Elementary::kMax, Elementary::kPower};
    if (choice < 13) return arena_.Apply(kBinary[Pick(3)], {a, Term(depth - 1)});
    return arena_.Divide(a, Term(depth - 1));
  }

  std::mt19937_64 rng_;
  bool polynomial_;
  Arena arena_;
  Query query_;
  std::vector<TermId> variables_;
};

}  // namespace rondo::testing_support
