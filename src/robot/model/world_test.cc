#include "robot/model/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "lang/lexer.h"
#include "robot/syntax/parser.h"
#include "robot/values/shape.h"

namespace rondo::robot {
namespace {

using Point = std::array<double, 3>;

// The value of a term, in doubles.
class Numeric {
 public:
  Numeric(const Arena& arena, std::map<std::string, double> values)
      : arena_(arena), values_(std::move(values)) {}

  double operator()(TermId id) const {
    const auto args = arena_.args(id);
    const auto a = [&](size_t i) { return (*this)(args[i]); };
    switch (arena_.op(id)) {
      case expr::Op::kNumber:
        return arena_.number(id).ToDouble();
      case expr::Op::kVariable:
        return values_.at(arena_.symbol(arena_.symbol_of(id)).name);
      case expr::Op::kAdd: {
        double sum = 0;
        for (size_t i = 0; i < args.size(); ++i) sum += a(i);
        return sum;
      }
      case expr::Op::kMul: {
        double product = 1;
        for (size_t i = 0; i < args.size(); ++i) product *= a(i);
        return product;
      }
      case expr::Op::kDivide:
        return a(0) / a(1);
      case expr::Op::kElementary:
        return Elementary(id, a);
      default:
        ADD_FAILURE() << "no number: " << expr::Name(arena_.op(id));
        return 0;
    }
  }

  bool Holds(TermId id) const {
    const auto args = arena_.args(id);
    switch (arena_.op(id)) {
      case expr::Op::kBool:
        return id == arena_.True();
      case expr::Op::kNot:
        return !Holds(args[0]);
      case expr::Op::kAnd:
        return std::ranges::all_of(args, [&](TermId t) { return Holds(t); });
      case expr::Op::kOr:
        return std::ranges::any_of(args, [&](TermId t) { return Holds(t); });
      case expr::Op::kLe:
        return (*this)(args[0]) <= (*this)(args[1]);
      case expr::Op::kLt:
        return (*this)(args[0]) < (*this)(args[1]);
      case expr::Op::kEq:
        return std::abs((*this)(args[0]) - (*this)(args[1])) < 1e-9;
      default:
        ADD_FAILURE() << "no formula: " << expr::Name(arena_.op(id));
        return false;
    }
  }

 private:
  template <typename Argument>
  double Elementary(TermId id, const Argument& a) const {
    switch (arena_.elementary_of(id)) {
      case expr::Elementary::kSin:
        return std::sin(a(0));
      case expr::Elementary::kCos:
        return std::cos(a(0));
      case expr::Elementary::kAtan:
        return std::atan(a(0));
      case expr::Elementary::kAtan2:
        return std::atan2(a(0), a(1));
      case expr::Elementary::kSqrt:
        return std::sqrt(a(0));
      case expr::Elementary::kMin:
        return std::min(a(0), a(1));
      case expr::Elementary::kMax:
        return std::max(a(0), a(1));
      default:
        ADD_FAILURE() << "not needed here";
        return 0;
    }
  }

  const Arena& arena_;
  std::map<std::string, double> values_;
};

class WordsParser : public Parser {
 public:
  using Parser::Parser;
  std::optional<RobotDef> Robot() {
    Take();
    return ParseRobot({});
  }
  std::optional<WorldDef> World() {
    Take();
    return ParseWorld({});
  }

 protected:
  bool IsReserved(std::string_view word) const override { return IsRobotWord(word); }
};

// A robot type `R` and a world, from text.
struct Model {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  lang::ExprPool pool;
  Arena arena;
  RobotDef type;
  WorldDef source;
  Evaluator evaluator{arena, pool, diagnostics};
  std::unique_ptr<World> world;

  explicit Model(const std::string& robot, const std::string& world_text = "world W { r: R }") {
    lang::LexerOptions options;
    options.indentation = false;
    options.prime = true;
    options.half_open = true;
    const auto tokens = lang::Lex(sources, sources.Add("robot", robot), options, diagnostics);
    const auto more = lang::Lex(sources, sources.Add("world", world_text), options, diagnostics);
    type = *WordsParser(tokens, pool, diagnostics).Robot();
    source = *WordsParser(more, pool, diagnostics).World();
    world = BuildWorld(source, {{type.name.text, &type}}, evaluator);
    for (const auto& d : diagnostics.all()) ADD_FAILURE() << d.message;
  }
  Vector Fixed(const Point& p) {
    Vector v;
    for (size_t i = 0; i < 3; ++i) v[i] = arena.Number(arena.Real(), expr::Rational::FromDouble(p[i]));
    return v;
  }
};

double Uniform(std::mt19937_64& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

TEST(Frames, ChainsOfFramesArePoses) {
  Model m(R"(robot R {
    state x, y: length  state a, b, c: angle
    frame one = self * translate(x, y, 0) * rotate_z(c)
    frame two = one * rotate_x(a) * translate(0, 0, 2 m)
    mount tip = two * rotate_y(b) * rotate_z(90 deg)
  })",
          "world W { r: R at translate(1 m, 2 m, 3 m) * rotate_z(90 deg) }");
  std::mt19937_64 rng(3);
  const Pose& tip = m.world->bodies[0].mounts.at("tip");
  for (int i = 0; i < 50; ++i) {
    const double x = Uniform(rng, -5, 5), y = Uniform(rng, -5, 5);
    const double a = Uniform(rng, -3, 3), b = Uniform(rng, -3, 3), c = Uniform(rng, -3, 3);
    const Numeric value(m.arena, {{"r.x", x}, {"r.y", y}, {"r.a", a}, {"r.b", b}, {"r.c", c}});
    const Point v{Uniform(rng, -1, 1), Uniform(rng, -1, 1), Uniform(rng, -1, 1)};
    // By hand, from the tip outwards.
    Point p{-v[1], v[0], v[2]};
    p = {std::cos(b) * p[0] + std::sin(b) * p[2], p[1], -std::sin(b) * p[0] + std::cos(b) * p[2]};
    p[2] += 2;
    p = {p[0], std::cos(a) * p[1] - std::sin(a) * p[2], std::sin(a) * p[1] + std::cos(a) * p[2]};
    p = {std::cos(c) * p[0] - std::sin(c) * p[1] + x, std::sin(c) * p[0] + std::cos(c) * p[1] + y, p[2]};
    p = {1 - p[1], 2 + p[0], 3 + p[2]};
    const Vector world = ToWorld(m.arena, tip, m.Fixed(v));
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(value(world[k]), p[k], 1e-9);
    const Vector back = FromWorld(m.arena, tip, world);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(value(back[k]), v[k], 1e-9);
  }
}

TEST(Frames, OneSineForEachAngle) {
  Model m(R"(robot R { state a: angle
    mount tip = self * rotate_z(a) * translate(1 m, 0, 0) * rotate_z(a + 180 deg) * rotate_z(90 deg - a) * rotate_z(a) })");
  const Pose& tip = m.world->bodies[0].mounts.at("tip");
  std::unordered_set<TermId> seen;
  size_t functions = 0;
  for (const Vector& row : tip.rotation) {
    for (const TermId t : row) {
      std::vector<TermId> todo{t};
      while (!todo.empty()) {
        const TermId at = todo.back();
        todo.pop_back();
        if (!seen.insert(at).second) continue;
        functions += m.arena.op(at) == expr::Op::kElementary ? 1 : 0;
        const auto args = m.arena.args(at);
        todo.insert(todo.end(), args.begin(), args.end());
      }
    }
  }
  EXPECT_LE(functions, 4u);  // of a and of -a
}

TEST(Frames, RightAnglesAreExact) {
  Arena arena;
  const auto number = [&](int64_t n) { return arena.Number(arena.Real(), expr::Rational(n)); };
  const TermId quarter =
      arena.Mul(arena.Number(arena.Real(), expr::Rational(1) / expr::Rational(2)), Pi(arena));
  const std::array<int64_t, 4> sines{0, 1, 0, -1};
  for (int k = -9; k < 9; ++k) {
    const auto turn = static_cast<size_t>(((k % 4) + 4) % 4);
    EXPECT_EQ(Sin(arena, arena.Mul(number(k), quarter)), number(sines[turn]));
    EXPECT_EQ(Cos(arena, arena.Mul(number(k), quarter)), number(sines[(turn + 1) % 4]));
  }
}

// The formula of a shape, at points.
class Inside {
 public:
  Inside(Arena& arena, const Shape& shape) : arena_(arena) {
    Vector p;
    for (size_t i = 0; i < 3; ++i)
      p[i] = arena.Variable(arena.Declare(std::string(1, "xyz"[i]), {}, arena.Real()));
    formula_ = Contains(arena, shape, p);
  }
  bool operator()(const Point& p) const {
    return Numeric(arena_, {{"x", p[0]}, {"y", p[1]}, {"z", p[2]}}).Holds(formula_);
  }

 private:
  const Arena& arena_;
  TermId formula_;
};

// What contains a point, inflated by d, contains all points up to d from there.
TEST(Shapes, InflatingKeepsTheNeighbourhood) {
  Model m(R"(robot R {
    frame f = self * translate(1 m, 2 m, 0) * rotate_x(30 deg) * rotate_z(20 deg)
    body union(sphere(f, 1 m), cylinder(f, 0.5 m, -1 m, 2 m), capsule(f, 0.6 m, 2 m), box(f, (-1 m, 0, 0), (1 m, 2 m, 0.5 m)),
      prism(f, 0, 1 m, (0, 0), (2 m, 0), (2 m, 1 m), (1 m, 2 m)), hexagon(f, 0.5 m, 0.8 m, 1 m), half_sphere(f, 1.5 m),
      half_space(f, (1, 2, 0), 5 m))
  })");
  std::mt19937_64 rng(5);
  const TermId margin = m.arena.Number(m.arena.Real(), expr::Rational(1) / expr::Rational(10));
  for (const Shape& shape : m.world->bodies[0].body->parts) {
    const Inside in(m.arena, shape), wide(m.arena, Inflate(m.arena, shape, margin));
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const Point p{Uniform(rng, -2, 6), Uniform(rng, -1, 6), Uniform(rng, -2, 3)};
      if (!in(p)) continue;
      ++inside;
      Point d{Uniform(rng, -1, 1), Uniform(rng, -1, 1), Uniform(rng, -1, 1)};
      const double length = std::hypot(d[0], d[1], d[2]);
      for (double& x : d) x *= 0.0999 / length;
      EXPECT_TRUE(wide({p[0] + d[0], p[1] + d[1], p[2] + d[2]})) << static_cast<int>(shape.kind);
    }
    EXPECT_GT(inside, 10) << static_cast<int>(shape.kind);
  }
}

TEST(Shapes, ContainWhatTheySay) {
  Model m("robot R { body hexagon(self, 0.15 m, 0.25 m, 80 mm) hull cylinder(self, 0.3 m, 80 mm) }");
  const Inside body(m.arena, *m.world->bodies[0].body), hull(m.arena, *m.world->bodies[0].hull);
  EXPECT_TRUE(body({0.2499, 0, 0}));
  EXPECT_FALSE(body({0.2501, 0, 0}));
  EXPECT_TRUE(body({-0.1499, 0, 0.0799}));
  EXPECT_FALSE(body({-0.1501, 0, 0}));
  EXPECT_FALSE(body({0, 0, 0.0801}));
  // The hull is a hull.
  std::mt19937_64 rng(9);
  for (int i = 0; i < 5000; ++i) {
    const Point p{Uniform(rng, -0.4, 0.4), Uniform(rng, -0.4, 0.4), Uniform(rng, -0.1, 0.2)};
    EXPECT_TRUE(!body(p) || hull(p));
  }
}

TEST(Contracts, SegmentsAndArguments) {
  Model m(R"(robot R {
    state x, y: length
    motion Move(x0: length, y0: length, heading: angle, d: length) noninterruptible [1 s, 2 s] {
      modifies x
      during on_segment((x, y), (x0, y0), (x0, y0) + d * dir(heading), 10 cm)
      post near((x, y), (x0, y0), 1 m) and dist((x, y), (0, 0)) < 3 m
    }
  })");
  const Body& body = m.world->bodies[0];
  const auto& motion = std::get<MotionDef>(m.type.items[1]);
  const auto length = [&](int64_t v) {
    return Quantity(m.arena.Number(m.arena.Real(), expr::Rational(v)), kLength);
  };
  const auto contract = [&](int64_t d) {
    const std::vector<Value> args{
        length(1), length(0),
        Quantity(
            m.arena.Mul(m.arena.Number(m.arena.Real(), expr::Rational(1) / expr::Rational(2)), Pi(m.arena)),
            kAngle),
        length(d)};
    return ContractOf(body, motion, MotionScope(body, motion, args, std::vector<diag::Span>(4), m.evaluator),
                      m.evaluator);
  };
  const Contract c = contract(2);
  EXPECT_TRUE(c.modifies[0]);
  EXPECT_FALSE(c.modifies[1]);
  const auto at = [&](double x, double y) { return Numeric(m.arena, {{"r.x", x}, {"r.y", y}}); };
  EXPECT_TRUE(at(1.05, 1).Holds(c.during));
  EXPECT_FALSE(at(1.2, 1).Holds(c.during));
  EXPECT_FALSE(at(1, 2.05).Holds(c.during));  // beyond the end
  EXPECT_TRUE(at(1, 0.5).Holds(c.post));
  EXPECT_FALSE(at(1, 1.5).Holds(c.post));
  // A segment without length is a ball.
  EXPECT_TRUE(at(1.05, 0).Holds(contract(0).during));
  EXPECT_FALSE(at(1, 0.5).Holds(contract(0).during));
}

}  // namespace
}  // namespace rondo::robot
