#include "solve/icp/prepare/rotation.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "expr/substitute.h"

namespace rondo::solve::icp {

using expr::Elementary;
using expr::Monomial;
using expr::Op;
using expr::Polynomial;

namespace {

using Rational = expr::Rational;
using Complex = std::pair<Rational, Rational>;

Complex Divide(const Complex& a, const Complex& b) {
  const Rational norm = b.first * b.first + b.second * b.second;
  return {(a.first * b.first + a.second * b.second) / norm, (a.second * b.first - a.first * b.second) / norm};
}

bool IsCall(const expr::Arena& arena, expr::TermId t, Elementary f) {
  return arena.op(t) == Op::kElementary && arena.elementary_of(t) == f;
}

// The sum as a polynomial in its factors, which may be sums.
Polynomial Shallow(expr::Arena& arena, expr::TermId sum) {
  Polynomial result;
  const auto args = arena.args(sum);
  const std::vector<expr::TermId> summands(args.begin(), args.end());
  for (const expr::TermId summand : summands) {
    Rational coefficient(1);
    Monomial factors;
    std::vector<expr::TermId> todo{summand};
    while (!todo.empty()) {
      const expr::TermId t = todo.back();
      todo.pop_back();
      if (arena.op(t) == Op::kMul) {
        todo.insert(todo.end(), {arena.arg(t, 0), arena.arg(t, 1)});
      } else if (arena.IsNumber(t)) {
        coefficient = coefficient * arena.number(t);
      } else {
        const auto [lead, monic] = Monic(arena, t);
        coefficient = coefficient * lead;
        factors.push_back(monic);
      }
    }
    std::sort(factors.begin(), factors.end());
    const auto [it, fresh] = result.emplace(std::move(factors), coefficient);
    if (!fresh) it->second = it->second + coefficient;
    if (it->second.IsZero()) result.erase(it);
  }
  return result;
}

}  // namespace

expr::TermId Rotations::Rewrite(TermId formula) {
  rewritten_.push_back(expr::Transform(arena_, formula, [this](TermId t) {
    if (arena_.op(t) == Op::kAdd) return RewriteSum(t);
    // The square of a sum is the square of its negative, too.
    const bool square = arena_.op(t) == Op::kMul && arena_.arg(t, 0) == arena_.arg(t, 1);
    return square && arena_.op(arena_.arg(t, 0)) == Op::kAdd ? Square(arena_.arg(t, 0)) : t;
  }));
  return rewritten_.back();
}

// A lemma must hold even where a partial function has no value: there are none in it.
bool Rotations::IsTotal(TermId term) const {
  std::unordered_set<TermId> seen;
  bool total = true;
  expr::VisitPostorder(arena_, term, seen, [&](TermId t) {
    for (const Elementary f :
         {Elementary::kSqrt, Elementary::kLog, Elementary::kAsin, Elementary::kAcos, Elementary::kTan})
      total = total && !IsCall(arena_, t, f);
    total = total && arena_.op(t) != Op::kIte && arena_.op(t) != Op::kDivide;
  });
  return total;
}

bool Rotations::IsWave(TermId t) const {
  return IsCall(arena_, t, Elementary::kSin) || IsCall(arena_, t, Elementary::kCos);
}

std::set<expr::TermId> Rotations::AnglesOf(const Polynomial& polynomial) const {
  std::set<TermId> angles;
  for (const auto& [m, c] : polynomial) {
    for (const TermId t : m) {
      if (IsWave(t)) angles.insert(arena_.arg(t, 0));
    }
  }
  return angles;
}

expr::TermId Rotations::RewriteSum(TermId sum) {
  if (stop_.StopRequested() || !IsTotal(sum)) return sum;
  // As it is written, with sums as factors, which keeps chains of frames apart; else multiplied out.
  for (const auto& polynomial : {std::optional(Shallow(arena_, sum)), Expand(arena_, sum, kMostMonomials)}) {
    if (!polynomial) continue;
    for (const TermId angle : AnglesOf(*polynomial)) {
      const TermId result = RewriteAngle(*polynomial, angle);
      if (result.valid()) return result;
    }
  }
  return sum;
}

// sum = A cos u + B sin u + rest, with neither cos u nor sin u in A, B and the rest.
expr::TermId Rotations::RewriteAngle(const Polynomial& polynomial, TermId angle) {
  const TermId cosine = arena_.Apply(Elementary::kCos, {angle});
  const TermId sine = arena_.Apply(Elementary::kSin, {angle});
  Vector vector;
  Polynomial rest;
  bool has_cosine = false;
  bool has_sine = false;
  for (const auto& [m, c] : polynomial) {
    const auto cosines = std::count(m.begin(), m.end(), cosine);
    const auto sines = std::count(m.begin(), m.end(), sine);
    if (cosines + sines > 1) return {};
    if (cosines + sines == 0) {
      rest.emplace(m, c);
      continue;
    }
    Monomial other = m;
    other.erase(std::find(other.begin(), other.end(), cosines == 1 ? cosine : sine));
    Complex& entry = vector[other];
    (cosines == 1 ? entry.first : entry.second) = c;
    has_cosine = has_cosine || cosines == 1;
    has_sine = has_sine || sines == 1;
  }
  if (!has_cosine || !has_sine || vector.size() < 2) return {};
  Complex ratio;
  Frame& frame = FrameOf(angle, vector, ratio);
  if (!ratio.second.IsZero()) frame.both = true;
  // A + i B = ratio * (the frame's): the first coordinate is Re(ratio) p - Im(ratio) q.
  std::vector<TermId> parts{arena_.Mul(arena_.Number(arena_.Real(), ratio.first), frame.p),
                            arena_.Mul(arena_.Number(arena_.Real(), Rational(0) - ratio.second), frame.q)};
  for (const auto& [m, c] : rest) {
    TermId product = arena_.Number(arena_.Real(), c);
    for (const TermId t : m) product = arena_.Mul(product, t);
    parts.push_back(product);
  }
  return arena_.Add(std::move(parts));
}

// Scaled and turned so that the first coefficient is 1, equal vectors are recognised however they are
// written.
Rotations::Frame& Rotations::FrameOf(TermId angle, const Vector& vector, Complex& ratio) {
  ratio = vector.begin()->second;
  Vector canonical;
  for (const auto& [m, z] : vector) canonical.emplace(m, Divide(z, ratio));
  for (Frame& frame : frames_[angle]) {
    if (frame.vector == canonical) return frame;
  }
  Frame frame;
  frame.a = Part(canonical, false);
  frame.b = Part(canonical, true);
  frame.vector = std::move(canonical);
  const TermId cosine = arena_.Apply(Elementary::kCos, {angle});
  const TermId sine = arena_.Apply(Elementary::kSin, {angle});
  // Numbers stay outside, so that a sum and its negative do not become two terms.
  const auto times = [this](TermId part, TermId wave) {
    const auto [lead, monic] = Monic(arena_, part);
    return arena_.Mul(arena_.Number(arena_.Real(), lead), arena_.Mul(monic, wave));
  };
  frame.p = arena_.Add(times(frame.a, cosine), times(frame.b, sine));
  frame.q = arena_.Sub(times(frame.b, cosine), times(frame.a, sine));
  frames_[angle].push_back(std::move(frame));
  return frames_[angle].back();
}

expr::TermId Rotations::Part(const Vector& vector, bool imaginary) {
  Polynomial p;
  for (const auto& [m, z] : vector) {
    const Rational& c = imaginary ? z.second : z.first;
    if (!c.IsZero()) p.emplace(m, c);
  }
  const TermId plain = ToTerm(arena_, p);
  return arena_.op(plain) == Op::kAdd ? RewriteSum(plain) : plain;
}

// Its square, by the one term that stands for it wherever it occurs.
expr::TermId Rotations::Square(TermId term) {
  const auto [lead, monic] = Monic(arena_, term);
  return arena_.Mul(arena_.Number(arena_.Real(), lead * lead), arena_.Mul(monic, monic));
}

Rotations::Norm Rotations::NormOf(TermId a, TermId b) {
  Norm norm;
  for (size_t i = 0; i < 2; ++i) {
    const auto [lead, monic] = Monic(arena_, i == 0 ? a : b);
    norm.squares[i] = {lead * lead, monic};
  }
  norm.sum = arena_.Add(Square(a), Square(b));
  return norm;
}

std::vector<Lemma> Rotations::Lemmas() {
  std::vector<Lemma> result;
  std::vector<Norm> norms;
  for (const auto& [angle, frames] : frames_) {
    for (const Frame& f : frames) {
      if (!f.both) continue;
      norms.push_back(NormOf(f.a, f.b));
      norms.push_back(NormOf(f.p, f.q));
      result.push_back(
          {{{Rational(1), norms[norms.size() - 2].sum}, {Rational(-1), norms.back().sum}}, Rational(0)});
    }
  }
  Translations(norms, result);
  return result;
}

// k (r + d)^2 + l s^2 = (k r^2 + l s^2) + 2 k d r + k d^2, for norms that have s in common, up to a factor.
void Rotations::Translations(const std::vector<Norm>& norms, std::vector<Lemma>& lemmas) {
  for (size_t i = 0; i < norms.size(); ++i) {
    for (size_t j = 0; j < norms.size(); ++j) {
      for (const auto& [m, n] :
           {std::pair(0u, 0u), std::pair(0u, 1u), std::pair(1u, 0u), std::pair(1u, 1u)}) {
        const auto& [k, r] = norms[i].squares[m];
        const auto& [l, s] = norms[i].squares[1 - m];
        const auto& [moved_k, moved_r] = norms[j].squares[n];
        const auto& [moved_l, moved_s] = norms[j].squares[1 - n];
        if (s != moved_s || r == moved_r || k * moved_l != l * moved_k) continue;
        const TermId distance = arena_.Sub(moved_r, r);
        if (!arena_.IsNumber(distance)) continue;
        const Rational d = arena_.number(distance);
        if (i > j) continue;  // the same, seen from the other side
        lemmas.push_back(
            {{{k / moved_k, norms[j].sum}, {Rational(-1), norms[i].sum}, {Rational(-2) * k * d, r}},
             Rational(-1) * k * d * d});
      }
    }
  }
}

}  // namespace rondo::solve::icp
