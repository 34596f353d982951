#include "reach/problem/symmetry.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_set>

#include "expr/polynomial.h"
#include "expr/substitute.h"

namespace rondo::reach {

using expr::Elementary;
using expr::Monomial;
using expr::Op;
using expr::Polynomial;
using expr::Rational;

namespace {

constexpr size_t kMostMonomials = 2000;

/// Linear equations over the rationals, in echelon form. Unknown 0 is the constant 1.
class Equations {
 public:
  using Row = std::map<size_t, Rational>;  ///< by unknown: the sum is zero

  static void AddTo(Row& row, size_t unknown, const Rational& c) {
    const auto [it, fresh] = row.emplace(unknown, c);
    if (!fresh) it->second = it->second + c;
    if (it->second.IsZero()) row.erase(it);
  }

  /// False if the equations have no solution any more.
  bool Insert(Row row) {
    for (const auto& [pivot, known] : rows_) {
      const auto it = row.find(pivot);
      if (it != row.end()) Subtract(row, known, Rational(it->second));
    }
    if (row.empty()) return true;
    if (row.rbegin()->first == 0) return false;  // 1 = 0
    const size_t pivot = row.rbegin()->first;
    const Rational lead = row.rbegin()->second;
    for (auto& [unknown, c] : row) c = c / lead;
    for (auto& [other, known] : rows_) {
      const auto it = known.find(pivot);
      if (it != known.end()) Subtract(known, row, Rational(it->second));
    }
    rows_.emplace(pivot, std::move(row));
    return true;
  }

  /// Of the solution in which whatever is free is zero: the unknowns that are not.
  std::set<size_t> NonZero() const {
    std::set<size_t> all;
    for (const auto& [pivot, row] : rows_) {
      if (row.contains(0)) all.insert(pivot);
    }
    return all;
  }

 private:
  // `factor`: of no row, which may change.
  static void Subtract(Row& row, const Row& other, const Rational& factor) {
    for (const auto& [unknown, c] : other) AddTo(row, unknown, Rational(0) - factor * c);
  }

  std::map<size_t, Row> rows_;  ///< by their pivot, the largest unknown, which no other row has
};

class Finder {
 public:
  explicit Finder(const Structure& s) : s_(s), arena_(*s.arena) {
    const size_t n = s_.coordinates.size();
    for (size_t v = 0; v < n; ++v) index_.emplace(s_.coordinates[v].term, v);
    mixed_.resize(n);
    for (size_t v = 0; v < n; ++v) {
      for (size_t w = 0; w < n; ++w) {
        const auto& a = s_.coordinates[v];
        const auto& b = s_.coordinates[w];
        if (a.kind == b.kind && (!a.parameter || b.parameter)) mixed_[v].emplace(w, unknowns_++);
      }
    }
  }

  Removable Run() {
    for (const auto& [variable, rate] : s_.rates) Equivariant(variable, rate, false);
    for (const auto& [variable, after] : s_.jumps) Equivariant(variable, after, true);
    for (const TermId t : s_.invariant) Invariant(t);
    Removable result;
    if (!possible_) return result;
    std::set<size_t> removed, moved;
    for (bool again = true; again;) {
      again = false;
      for (size_t p = 0; p < s_.coordinates.size(); ++p) {
        if (!s_.coordinates[p].parameter || s_.coordinates[p].stays || removed.contains(p)) continue;
        const auto along = SymmetryOf(p, removed);
        if (!along) continue;
        moved.insert(along->begin(), along->end());
        removed.insert(p);
        again = true;
      }
    }
    result.parameters.assign(removed.begin(), removed.end());
    result.moved.assign(moved.begin(), moved.end());
    return result;
  }

 private:
  // g_v = Shift(v) + the sum of mixed_[v][w] * w.
  static size_t Shift(size_t v) { return 1 + v; }

  void Insert(Equations::Row row) { possible_ = possible_ && equations_.Insert(std::move(row)); }

  // The coordinates that are moved by a symmetry which moves `p` evenly, and no other parameter but those
  // that are removed afterwards.
  std::optional<std::vector<size_t>> SymmetryOf(size_t p, const std::set<size_t>& removed) const {
    Equations own = equations_;
    bool possible = own.Insert({{Shift(p), Rational(1)}, {0, Rational(-1)}});
    for (size_t q = 0; q < s_.coordinates.size(); ++q) {
      if (!s_.coordinates[q].parameter || removed.contains(q)) continue;
      if (q != p) possible = possible && own.Insert({{Shift(q), Rational(1)}});
      for (const auto& [w, unknown] : mixed_[q]) possible = possible && own.Insert({{unknown, Rational(1)}});
    }
    if (!possible) return std::nullopt;
    const std::set<size_t> used = own.NonZero();
    std::vector<size_t> moved;
    for (size_t v = 0; v < s_.coordinates.size(); ++v) {
      const bool moves = used.contains(Shift(v)) || std::ranges::any_of(mixed_[v], [&](const auto& m) {
                           return used.contains(m.second);
                         });
      if (moves) moved.push_back(v);
    }
    return moved;
  }

  using Rows = std::map<Monomial, Equations::Row>;

  // Adds c m times the unknown, with squares of sines as 1 - squares of cosines.
  void AddTo(Rows& rows, Monomial m, size_t unknown, const Rational& c) {
    for (size_t i = 0; i + 1 < m.size(); ++i) {
      if (m[i] != m[i + 1] || arena_.op(m[i]) != Op::kElementary ||
          arena_.elementary_of(m[i]) != Elementary::kSin)
        continue;
      const TermId cosine = arena_.Apply(Elementary::kCos, {arena_.arg(m[i], 0)});
      m.erase(m.begin() + static_cast<std::ptrdiff_t>(i), m.begin() + static_cast<std::ptrdiff_t>(i) + 2);
      AddTo(rows, expr::Product(m, {cosine, cosine}), unknown, Rational(0) - c);
      AddTo(rows, std::move(m), unknown, c);
      return;
    }
    Equations::AddTo(rows[std::move(m)], unknown, c);
  }

  void InsertAll(Rows&& rows) {
    for (auto& [monomial, row] : rows) {
      if (!row.empty()) Insert(std::move(row));
    }
  }

  // What the derivative of `term` along g contributes.
  void AddDerivative(TermId term, Rows& rows) {
    for (const auto& [v, slope] : Gradient(term)) {
      for (const auto& [m, c] : slope) {
        AddTo(rows, m, Shift(v), c);
        for (const auto& [w, unknown] : mixed_[v])
          AddTo(rows, expr::Product(m, {s_.coordinates[w].term}), unknown, c);
      }
    }
  }

  void Invariant(TermId term) {
    if (!demanded_.insert(term).second) return;
    Rows rows;
    AddDerivative(term, rows);
    InsertAll(std::move(rows));
  }

  // Dh g = g_v(h'), where h' are the rates, or the values after an update.
  void Equivariant(TermId variable, TermId h, bool update) {
    const auto it = index_.find(variable);
    if (it == index_.end()) return Invariant(h);
    Rows rows;
    AddDerivative(h, rows);
    if (update) AddTo(rows, {}, Shift(it->second), Rational(-1));
    for (const auto& [w, unknown] : mixed_[it->second]) {
      const TermId image = ImageOf(s_.coordinates[w].term, update);
      const auto polynomial = expr::Expand(arena_, Quotients(image), kMostMonomials);
      if (!polynomial) return Fail();
      for (const auto& [m, c] : *polynomial) AddTo(rows, m, unknown, Rational(0) - c);
    }
    InsertAll(std::move(rows));
  }

  TermId ImageOf(TermId variable, bool update) {
    for (const auto& [v, image] : update ? s_.jumps : s_.rates) {
      if (v == variable) return image;
    }
    return update ? variable : arena_.Number(arena_.Real(), Rational(0));
  }

  void Fail() { possible_ = false; }

  // a / b as a * (1 / b): the derivative of that is known as long as b is invariant.
  TermId Quotients(TermId term) {
    return expr::Transform(arena_, term, [&](TermId t) {
      const TermId one = arena_.Number(arena_.Real(), Rational(1));
      if (arena_.op(t) != Op::kDivide || arena_.arg(t, 0) == one) return t;
      return arena_.Mul(arena_.arg(t, 0), arena_.Divide(one, arena_.arg(t, 1)));
    });
  }

  using Slopes = std::map<size_t, Polynomial>;

  // The derivatives by the coordinates. Demands what must be invariant.
  const Slopes& Gradient(TermId term) {
    if (const auto it = gradients_.find(term); it != gradients_.end()) return it->second;
    Slopes slopes;
    const auto polynomial = expr::Expand(arena_, Quotients(term), kMostMonomials);
    if (!polynomial) Fail();
    for (const auto& [m, c] : polynomial.value_or(Polynomial())) {
      for (size_t i = 0; i < m.size(); ++i) {
        Monomial rest = m;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
        for (const auto& [v, slope] : OfAtom(m[i])) {
          for (const auto& [n, d] : slope) expr::AddTo(slopes[v], expr::Product(rest, n), c * d);
        }
      }
    }
    return gradients_.emplace(term, std::move(slopes)).first->second;
  }

  Slopes OfAtom(TermId atom) {
    if (const auto it = index_.find(atom); it != index_.end()) return {{it->second, {{{}, Rational(1)}}}};
    const bool wave = arena_.op(atom) == Op::kElementary && (arena_.elementary_of(atom) == Elementary::kSin ||
                                                             arena_.elementary_of(atom) == Elementary::kCos);
    if (!wave) {
      const std::vector<TermId> args(arena_.args(atom).begin(), arena_.args(atom).end());
      for (const TermId a : args) Demand(a);
      return {};
    }
    const bool sine = arena_.elementary_of(atom) == Elementary::kSin;
    const TermId angle = arena_.arg(atom, 0);
    const TermId outer = arena_.Apply(sine ? Elementary::kCos : Elementary::kSin, {angle});
    Slopes slopes;
    for (const auto& [v, slope] : Slopes(Gradient(angle))) {
      for (const auto& [m, c] : slope)
        expr::AddTo(slopes[v], expr::Product(m, {outer}), sine ? c : Rational(0) - c);
    }
    return slopes;
  }

  // Numbers must be invariant, and so must what formulas compare.
  void Demand(TermId term) {
    if (arena_.sort_of(term) == arena_.Real()) return Invariant(term);
    const std::vector<TermId> args(arena_.args(term).begin(), arena_.args(term).end());
    const bool compares = args.size() == 2 && arena_.sort_of(args[0]) == arena_.Real();
    if (compares) return Invariant(arena_.Sub(args[0], args[1]));
    for (const TermId a : args) Demand(a);
  }

  const Structure& s_;
  expr::Arena& arena_;
  std::map<TermId, size_t> index_;
  std::vector<std::map<size_t, size_t>> mixed_;  ///< by coordinate: its factor in g, for each that may mix
  size_t unknowns_ = 1 + s_.coordinates.size();
  Equations equations_;
  bool possible_ = true;
  std::unordered_set<TermId> demanded_;
  std::map<TermId, Slopes> gradients_;
};

}  // namespace

Removable RemovableParameters(const Structure& structure) { return Finder(structure).Run(); }

}  // namespace rondo::reach
