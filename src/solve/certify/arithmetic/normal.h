#pragma once

#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "expr/arena.h"

/// The checker of certificates. It shares no code with the search that writes them: it has normal forms,
/// interval arithmetic (MPFR) and propagation of its own.
namespace rondo::solve::certify {

using expr::Rational;
using expr::TermId;

/// Name atoms, polynomials and formulas of one Normal.
using AtomId = base::Id<struct AtomTag>;
using PolyId = base::Id<struct PolyTag>;
using FormulaId = base::Id<struct FormulaTag>;

/// Says why a step cannot be accepted. Thrown inside the checker only: `Check` turns it into a diagnostic.
struct Rejection : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Is a product of atoms, sorted; empty: 1.
using Monomial = std::vector<AtomId>;
/// Is a sum of monomials with coefficients.
using Poly = std::map<Monomial, Rational>;

/// Adds a summand. Throws a Rejection if the polynomial grows too large.
void AddTo(Poly& p, Monomial monomial, const Rational& coefficient);
/// Returns the number that the polynomial is, if it is one.
std::optional<Rational> ConstantOf(const Poly& p);

/// Is what polynomials are made of: a variable, a function or quotient of polynomials, or a choice between
/// two.
struct Atom {
  enum class Kind : uint8_t { kVariable, kFunction, kQuotient, kChoice };
  Kind kind = Kind::kVariable;
  expr::Elementary function = expr::Elementary::kCount_;
  TermId variable;
  std::vector<PolyId> args;
  FormulaId condition;    ///< of kChoice
  bool integral = false;  ///< a variable that is an integer, or a truth value (0 or 1)
  friend auto operator<=>(const Atom&, const Atom&) = default;
};

/// Says which of <, = and > satisfy a comparison: a set of bits.
enum Relation : uint8_t { kBelow = 1, kEven = 2, kAbove = 4 };

/// Returns the relation with its sides exchanged.
uint8_t Mirrored(uint8_t relation);

/// Is a formula in negation normal form. A literal is `poly relation bound`: no constant in the polynomial,
/// first coefficient 1; comparisons of one integral variable have integers for bounds and are not strict.
struct Formula {
  enum class Kind : uint8_t { kTrue, kFalse, kLiteral, kAnd, kOr };
  Kind kind = Kind::kTrue;
  PolyId poly;
  uint8_t relation = 0;
  Rational bound;
  std::vector<FormulaId> parts;
  friend auto operator<=>(const Formula&, const Formula&) = default;
};

/// Puts terms into a normal form, so that whatever differs by arithmetic only is equal: polynomials
/// multiplied out, modulo sin^2 + cos^2 = 1 and sqrt(c) sqrt(e) = sqrt(c e) for numbers c >= 0.
///
/// A literal counts as true only where all partial functions in it (sqrt, log, asin, acos) are defined.
/// Throws Rejection for what it does not know and for polynomials that grow too large.
class Normal {
 public:
  explicit Normal(const expr::Arena& arena) : arena_(arena) {}
  Normal(const Normal&) = delete;
  Normal& operator=(const Normal&) = delete;

  /// Returns the normal form of a number.
  PolyId Number(TermId term);
  /// Returns the normal form of a formula, or of its negation if not `positive`.
  FormulaId Of(TermId formula, bool positive = true);
  /// Reports whether all partial functions of each literal, as written, occur in its normal form. Else the
  /// normal form says less than what is written.
  bool Faithful(TermId formula);
  /// Reports whether a function occurs in it that is not defined everywhere.
  bool HasPartial(TermId term);

  /// Returns the normal form of `difference relation 0`.
  FormulaId Literal(const Poly& difference, uint8_t relation);
  FormulaId And(std::vector<FormulaId> parts) { return Junction(Formula::Kind::kAnd, std::move(parts)); }
  FormulaId Or(std::vector<FormulaId> parts) { return Junction(Formula::Kind::kOr, std::move(parts)); }

  const Poly& poly(PolyId id) const { return polys_[id.index()]; }
  const Atom& atom(AtomId id) const { return atoms_[id.index()]; }
  const Formula& formula(FormulaId id) const { return formulas_[id.index()]; }
  AtomId Variable(TermId variable);
  /// Returns the atom, if the polynomial is one; else an invalid id.
  AtomId Single(const Poly& p) const;
  static Poly Minus(const Poly& a, const Poly& b);
  static Poly ConstantPoly(const Rational& value);

  /// Replaces one variable by a polynomial.
  class Substitution {
   public:
    Substitution(Normal& normal, AtomId variable, PolyId value)
        : normal_(normal), variable_(variable), value_(value) {}
    FormulaId Apply(FormulaId formula);

   private:
    PolyId ApplyTo(PolyId poly);
    PolyId Atom(AtomId atom);
    Normal& normal_;
    AtomId variable_;
    PolyId value_;
    std::map<PolyId, PolyId> polys_;
    std::map<AtomId, PolyId> atoms_;
    std::map<FormulaId, FormulaId> formulas_;
  };

 private:
  // What must be defined: a function and its argument, or a choice (kCount_).
  using Key = std::pair<expr::Elementary, PolyId>;

  PolyId NewNumber(TermId term);
  FormulaId NewFormula(TermId formula, bool positive);
  FormulaId Compare(TermId a, TermId b, uint8_t relation);
  FormulaId Junction(Formula::Kind kind, std::vector<FormulaId> parts);
  PolyId Function(expr::Elementary function, std::vector<PolyId> args);
  PolyId Quotient(std::vector<PolyId> args);
  std::optional<PolyId> WholePower(PolyId base, const Rational& exponent);
  PolyId Choice(FormulaId condition, PolyId then, PolyId otherwise);
  Poly Times(const Poly& a, const Poly& b);
  void AddProduct(Poly& out, Monomial monomial, const Rational& coefficient);
  PolyId AtomPoly(Atom atom);
  PolyId Intern(Poly poly);
  FormulaId Intern(Formula formula);
  std::optional<Key> KeyOf(expr::Elementary function, PolyId argument);
  void KeysOf(PolyId poly, std::set<Key>& keys, std::set<PolyId>& seen);
  bool Written(TermId term, std::set<Key>& keys, std::unordered_set<TermId>& seen);
  bool Keeps(const std::vector<TermId>& terms, PolyId normal);
  bool FaithfulNumber(TermId term);
  bool FaithfulLiteral(TermId literal);

  const expr::Arena& arena_;
  std::vector<Poly> polys_;
  std::vector<Atom> atoms_;
  std::vector<Formula> formulas_;
  std::map<Poly, PolyId> poly_ids_;
  std::map<Atom, AtomId> atom_ids_;
  std::map<Formula, FormulaId> formula_ids_;
  std::map<TermId, PolyId> numbers_;
  std::map<std::pair<TermId, bool>, FormulaId> forms_;
  std::map<TermId, bool> faithful_;
  std::vector<uint32_t> depths_;  // of atoms
  std::vector<uint64_t> sizes_;   // of formulas, as trees
};

}  // namespace rondo::solve::certify
