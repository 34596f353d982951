#include "robot/separation/set.h"

#include <cmath>
#include <map>
#include <numbers>

#include "expr/defined.h"
#include "robot/values/value.h"

namespace rondo::robot {
namespace {

using expr::Op;
using expr::Rational;

/// A polynomial in the coordinates of the point, of degree at most two: coefficients by exponents.
using Monomial = std::array<uint8_t, 3>;
using Polynomial = std::map<Monomial, TermId>;

class Reader {
 public:
  Reader(Arena& arena, const Vector& point) : arena_(arena), point_(point) {}

  // low <= high, or low < high
  std::optional<Set> Comparison(TermId low, TermId high, bool open) {
    const auto p = Read(arena_.Sub(low, high));
    if (!p) return std::nullopt;
    const auto at = [&](const Monomial& m) {
      const auto it = p->find(m);
      return it == p->end() ? Zero() : it->second;
    };
    Set set;
    set.open = open;
    std::array<TermId, 3> squares{at({2, 0, 0}), at({0, 2, 0}), at({0, 0, 2})};
    for (const auto& [m, c] : *p) {
      if (m[0] + m[1] + m[2] == 2 && m[0] != 2 && m[1] != 2 && m[2] != 2) return std::nullopt;
    }
    const std::array<TermId, 3> linear{at({1, 0, 0}), at({0, 1, 0}), at({0, 0, 1})};
    const TermId constant = at({0, 0, 0});
    std::optional<Rational> factor;
    for (size_t i = 0; i < 3; ++i) {
      set.axes[i] = squares[i] != Zero();
      if (!set.axes[i]) continue;
      if (!arena_.IsNumber(squares[i])) return std::nullopt;
      if (factor && !(arena_.number(squares[i]) == *factor)) return std::nullopt;
      factor = arena_.number(squares[i]);
    }
    if (!factor) {
      set.kind = SetKind::kBelow;
      set.normal = linear;
      set.bound = arena_.Neg(constant);
      return set;
    }
    // factor * |p - centre|^2 <= factor * bound
    const Rational half = Rational(-1) / (Rational(2) * *factor);
    std::vector<TermId> bound{Scaled(Rational(-1) / *factor, constant)};
    for (size_t i = 0; i < 3; ++i) {
      set.centre[i] = set.axes[i] ? Scaled(half, linear[i]) : Zero();
      if (set.axes[i]) {
        bound.push_back(Square(arena_, set.centre[i]));
      } else if (linear[i] != Zero()) {
        return std::nullopt;
      }
    }
    set.kind = Rational(0) < *factor ? SetKind::kBall : SetKind::kOutside;
    set.bound = arena_.Add(bound);
    return set;
  }

 private:
  TermId Zero() { return arena_.Number(arena_.Real(), Rational(0)); }
  TermId Scaled(const Rational& r, TermId t) { return arena_.Mul(arena_.Number(arena_.Real(), r), t); }

  bool IsFree(TermId t) {
    const auto [it, fresh] = free_.emplace(t, true);
    if (!fresh) return it->second;
    bool free = t != point_[0] && t != point_[1] && t != point_[2];
    const auto args = arena_.args(t);
    for (size_t i = 0; free && i < args.size(); ++i) free = IsFree(arena_.arg(t, i));
    return free_[t] = free;
  }

  std::optional<Polynomial> Read(TermId t) {
    if (IsFree(t)) return Polynomial{{{0, 0, 0}, t}};
    for (size_t i = 0; i < 3; ++i) {
      if (t != point_[i]) continue;
      Monomial m{0, 0, 0};
      m[i] = 1;
      return Polynomial{{m, arena_.Number(arena_.Real(), Rational(1))}};
    }
    if (arena_.op(t) == Op::kAdd) {
      Polynomial sum;
      for (size_t i = 0; i < arena_.args(t).size(); ++i) {
        const auto part = Read(arena_.arg(t, i));
        if (!part) return std::nullopt;
        for (const auto& [m, c] : *part) Accumulate(sum, m, c);
      }
      return sum;
    }
    if (arena_.op(t) != Op::kMul) return std::nullopt;
    const auto a = Read(arena_.arg(t, 0));
    const auto b = a ? Read(arena_.arg(t, 1)) : std::nullopt;
    if (!b) return std::nullopt;
    Polynomial product;
    for (const auto& [m, c] : *a) {
      for (const auto& [n, d] : *b) {
        Monomial both;
        for (size_t i = 0; i < 3; ++i) both[i] = static_cast<uint8_t>(m[i] + n[i]);
        if (both[0] + both[1] + both[2] > 2) return std::nullopt;
        Accumulate(product, both, arena_.Mul(c, d));
      }
    }
    return product;
  }

  void Accumulate(Polynomial& sum, const Monomial& m, TermId c) {
    const auto [it, fresh] = sum.emplace(m, c);
    if (!fresh) it->second = arena_.Add(it->second, c);
  }

  Arena& arena_;
  const Vector& point_;
  std::map<TermId, bool> free_;
};

class Cutter {
 public:
  Cutter(Arena& arena, const Vector& point, size_t most)
      : arena_(arena), reader_(arena, point), most_(most) {}

  bool Intersect(const Shape& shape) {
    std::vector<Piece> parts;
    return PartsOf(shape, parts) && Distribute(parts);
  }

  // A formula about the point: in disjunctive normal form, as far as it goes.
  bool Intersect(TermId formula, bool positive) {
    std::vector<Piece> parts;
    return PartsOf(formula, positive, parts) && Distribute(parts);
  }

  std::vector<Piece> Take() { return std::move(pieces_); }

 private:
  bool Distribute(const std::vector<Piece>& parts) {
    if (pieces_.size() * parts.size() > most_) return false;
    std::vector<Piece> all;
    for (const Piece& a : pieces_) {
      for (const Piece& b : parts) {
        Piece both = a;
        both.insert(both.end(), b.begin(), b.end());
        all.push_back(std::move(both));
      }
    }
    pieces_ = std::move(all);
    return true;
  }

  // Every list of alternatives, one after the other.
  bool Product(const std::vector<std::vector<Piece>>& factors, std::vector<Piece>& result) {
    Cutter inner = *this;
    inner.pieces_ = {{}};
    for (const auto& f : factors) {
      if (!inner.Distribute(f)) return false;
    }
    result = inner.Take();
    return true;
  }

  bool PartsOf(const Shape& shape, std::vector<Piece>& result) {
    switch (shape.kind) {
      case ShapeKind::kUnion:
        for (const Shape& part : shape.parts) {
          std::vector<Piece> own;
          if (!PartsOf(part, own)) return false;
          result.insert(result.end(), own.begin(), own.end());
        }
        return result.size() <= most_;
      case ShapeKind::kIntersection: {
        std::vector<std::vector<Piece>> factors;
        for (const Shape& part : shape.parts) {
          if (!PartsOf(part, factors.emplace_back())) return false;
        }
        return Product(factors, result);
      }
      case ShapeKind::kHalfSpace:
        result = {FacesOf(shape)};
        return true;
      case ShapeKind::kHalfSphere: {
        Piece piece = FacesOf(shape);
        Shape ball = shape;
        ball.kind = ShapeKind::kSphere;
        piece.push_back(Solid(std::move(ball)));
        result = {std::move(piece)};
        return true;
      }
      case ShapeKind::kPrism:
        if (!Corners(arena_, shape)) {
          result = {SidesOf(shape)};
          return true;
        }
        [[fallthrough]];
      default:
        result = {{Solid(shape)}};
        return true;
    }
  }

  // A prism by its faces alone, bottom and top among them.
  Piece SidesOf(Shape shape) {
    const TermId zero = arena_.Number(arena_.Real(), Rational(0)),
                 one = arena_.Number(arena_.Real(), Rational(1));
    shape.faces.push_back({{zero, zero, arena_.Neg(one)}, arena_.Neg(shape.sizes[0]), one});
    shape.faces.push_back({{zero, zero, one}, shape.sizes[1], one});
    return FacesOf(shape);
  }

  static Set Solid(Shape shape) {
    Set set;
    set.solid = std::move(shape);
    return set;
  }

  Piece FacesOf(const Shape& shape) {
    Piece piece;
    for (const Face& f : shape.faces) {
      Set set;
      set.kind = SetKind::kBelow;
      for (size_t i = 0; i < 3; ++i) set.normal[i] = Dot(arena_, shape.frame.rotation[i], f.normal);
      set.bound = arena_.Add(f.offset, Dot(arena_, set.normal, shape.frame.origin));
      piece.push_back(std::move(set));
    }
    return piece;
  }

  bool PartsOf(TermId formula, bool positive, std::vector<Piece>& result) {
    const Op op = arena_.op(formula);
    const std::vector<TermId> args(arena_.args(formula).begin(), arena_.args(formula).end());
    switch (op) {
      case Op::kBool:
        result.clear();
        if ((formula == arena_.True()) == positive) result.push_back({});
        return true;
      case Op::kNot:
        return PartsOf(args[0], !positive, result);
      case Op::kAnd:
      case Op::kOr: {
        std::vector<std::vector<Piece>> parts;
        for (const TermId a : args) {
          if (!PartsOf(a, positive, parts.emplace_back())) return false;
        }
        if ((op == Op::kAnd) == positive) return Product(parts, result);
        for (const auto& p : parts) result.insert(result.end(), p.begin(), p.end());
        return result.size() <= most_;
      }
      case Op::kLe:
      case Op::kLt: {
        const bool strict = (op == Op::kLt) == positive;
        auto set = positive ? reader_.Comparison(args[0], args[1], strict)
                            : reader_.Comparison(args[1], args[0], strict);
        result = {Piece()};
        if (set) result[0].push_back(std::move(*set));
        return true;
      }
      default:
        result = {Piece()};  // nothing is known of it
        return true;
    }
  }

  Arena& arena_;
  Reader reader_;
  size_t most_;
  std::vector<Piece> pieces_{{}};
};

}  // namespace

std::optional<std::vector<Piece>> PiecesOf(Arena& arena, const Vector& point, const Meeting& meeting,
                                           size_t most) {
  Cutter cutter(arena, point, most);
  for (const Shape& s : meeting.shapes) {
    if (!cutter.Intersect(s)) return std::nullopt;
  }
  if (!cutter.Intersect(meeting.where, true)) return std::nullopt;
  if (meeting.beyond) {
    const TermId outside = expr::Complement(arena, Contains(arena, *meeting.beyond, point));
    if (!cutter.Intersect(outside, true)) return std::nullopt;
  }
  return cutter.Take();
}

std::optional<std::vector<std::array<TermId, 2>>> Corners(Arena& arena, const Shape& prism) {
  const size_t n = prism.faces.size();
  if (n < 3) return std::nullopt;
  // Consecutive normals turn to the left, by less than half a turn each and by one turn in all.
  std::vector<std::array<double, 2>> normals;
  expr::Numeric numeric(arena, {});
  for (const Face& f : prism.faces) {
    for (const TermId t : {f.normal[0], f.normal[1]}) {
      if (!VariablesOf(arena, {t}).empty()) return std::nullopt;
    }
    normals.push_back({numeric(f.normal[0]), numeric(f.normal[1])});
  }
  double turned = 0;
  for (size_t i = 0; i < n; ++i) {
    const auto& a = normals[i];
    const auto& b = normals[(i + 1) % n];
    const double cross = a[0] * b[1] - a[1] * b[0];
    const double scale = std::hypot(a[0], a[1]) * std::hypot(b[0], b[1]);
    if (!(cross > 1e-6 * scale)) return std::nullopt;
    turned += std::atan2(cross, a[0] * b[0] + a[1] * b[1]);
  }
  if (!(std::abs(turned - 2 * std::numbers::pi) < 1e-3)) return std::nullopt;
  std::vector<std::array<TermId, 2>> corners;
  const auto cross = [&](TermId ax, TermId ay, TermId bx, TermId by) {
    return arena.Sub(arena.Mul(ax, by), arena.Mul(ay, bx));
  };
  for (size_t i = 0; i < n; ++i) {
    const Face& a = prism.faces[i];
    const Face& b = prism.faces[(i + 1) % n];
    const TermId determinant = cross(a.normal[0], a.normal[1], b.normal[0], b.normal[1]);
    corners.push_back({arena.Divide(cross(a.offset, a.normal[1], b.offset, b.normal[1]), determinant),
                       arena.Divide(cross(a.normal[0], a.offset, b.normal[0], b.offset), determinant)});
  }
  return corners;
}

}  // namespace rondo::robot
