#include "solve/icp/rotation.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "expr/substitute.h"

namespace rondo::solve::icp {

using expr::Elementary;
using expr::Op;

namespace {

constexpr size_t kMostMonomials = 64;

using Rational = expr::Rational;
using Complex = std::pair<Rational, Rational>;

Complex Divide(const Complex& a, const Complex& b) {
  const Rational norm = b.first * b.first + b.second * b.second;
  return {(a.first * b.first + a.second * b.second) / norm, (a.second * b.first - a.first * b.second) / norm};
}

Complex Times(const Complex& a, const Complex& b) {
  return {a.first * b.first - a.second * b.second, a.first * b.second + a.second * b.first};
}

bool IsCall(const expr::Arena& arena, expr::TermId t, Elementary f) {
  return arena.op(t) == Op::kElementary && arena.elementary_of(t) == f;
}

// The sum as a polynomial in its factors, which may be sums.
Polynomial Shallow(const expr::Arena& arena, expr::TermId sum) {
  Polynomial result;
  for (const expr::TermId summand : arena.args(sum)) {
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
        factors.push_back(t);
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
  return expr::Transform(arena_, formula,
                         [this](TermId t) { return arena_.op(t) == Op::kAdd ? RewriteSum(t) : t; });
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

expr::TermId Rotations::RewriteSum(TermId sum) {
  if (!IsTotal(sum)) return sum;
  // As it is written, with sums as factors, which keeps chains of frames apart; else multiplied out.
  for (const auto& polynomial : {std::optional(Shallow(arena_, sum)), Expand(arena_, sum, kMostMonomials)}) {
    if (!polynomial) continue;
    std::set<TermId> angles;
    for (const auto& [m, c] : *polynomial) {
      for (const TermId t : m) {
        if (IsCall(arena_, t, Elementary::kSin) || IsCall(arena_, t, Elementary::kCos))
          angles.insert(arena_.arg(t, 0));
      }
    }
    for (const TermId angle : angles) {
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

Rotations::Frame& Rotations::FrameOf(TermId angle, const Vector& vector, Complex& ratio) {
  for (Frame& frame : frames_[angle]) {
    if (frame.vector.size() != vector.size()) continue;
    const Complex k = Divide(vector.begin()->second, frame.vector.begin()->second);
    bool multiple = true;
    for (auto i = vector.begin(), j = std::as_const(frame.vector).begin(); multiple && i != vector.end();
         ++i, ++j)
      multiple = i->first == j->first && i->second == Times(k, j->second);
    if (!multiple) continue;
    ratio = k;
    if (Size(vector) < Size(frame.vector)) {
      frame = MakeFrame(angle, vector);
      ratio = {Rational(1), Rational(0)};
    }
    return frame;
  }
  ratio = {Rational(1), Rational(0)};
  frames_[angle].push_back(MakeFrame(angle, vector));
  return frames_[angle].back();
}

// How many products its coordinates take.
size_t Rotations::Size(const Vector& vector) {
  size_t size = 0;
  for (const auto& [m, z] : vector) size += (z.first.IsZero() ? 0u : 1u) + (z.second.IsZero() ? 0u : 1u);
  return size;
}

Rotations::Frame Rotations::MakeFrame(TermId angle, const Vector& vector) {
  Frame frame;
  frame.vector = vector;
  frame.a = Part(vector, false);
  frame.b = Part(vector, true);
  const TermId cosine = arena_.Apply(Elementary::kCos, {angle});
  const TermId sine = arena_.Apply(Elementary::kSin, {angle});
  frame.p = arena_.Add(arena_.Mul(frame.a, cosine), arena_.Mul(frame.b, sine));
  frame.q = arena_.Sub(arena_.Mul(frame.b, cosine), arena_.Mul(frame.a, sine));
  return frame;
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

void Rotations::Restart() {
  for (auto& [angle, frames] : frames_) {
    for (Frame& f : frames) f.both = false;
  }
}

std::vector<expr::TermId> Rotations::Lemmas() {
  std::vector<TermId> result;
  for (const auto& [angle, frames] : frames_) {
    for (const Frame& f : frames) {
      if (!f.both) continue;
      const TermId before = Condense(arena_, arena_.Add(arena_.Mul(f.a, f.a), arena_.Mul(f.b, f.b)));
      const TermId after = arena_.Add(arena_.Mul(f.p, f.p), arena_.Mul(f.q, f.q));
      result.push_back(arena_.Eq(before, after));
    }
  }
  return result;
}

}  // namespace rondo::solve::icp
