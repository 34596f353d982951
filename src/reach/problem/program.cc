#include "reach/problem/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "base/check.h"

namespace rondo::reach {

using expr::Elementary;
using expr::Op;

Interval Enclose(const Rational& value) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const double d = value.ToDouble();
  if (!std::isfinite(d)) {
    const double most = std::numeric_limits<double>::max();
    return value > Rational(0) ? Interval{most, kInf} : Interval{-kInf, -most};
  }
  const Rational exact = Rational::FromDouble(d);
  if (exact == value) return {d, d};
  return exact < value ? Interval{d, std::nextafter(d, kInf)} : Interval{std::nextafter(d, -kInf), d};
}

LinearPart NearestConstant(const Rational& value) {
  const Interval i = Enclose(value);
  // The end that is nearer to zero, so that -c and c are opposite: sums that are opposite terms are opposite
  // numbers.
  const double d = std::fabs(i.lo) < std::fabs(i.hi) ? i.lo : i.hi;
  return {d, i.IsPoint() ? 0 : std::nextafter(i.hi - i.lo, std::numeric_limits<double>::infinity()), 0};
}

namespace {

class Compiler {
 public:
  Compiler(const expr::Arena& arena, Program& program) : arena_(arena), program_(program) {}

  void Variables() {
    for (uint32_t v = 0; v < program_.variables.size(); ++v) {
      const uint32_t node = Push({CodeOp::kVariable, v});
      program_.variable_nodes.push_back(node);
      nodes_.emplace(program_.variables[v], node);
    }
  }

  uint32_t Number(TermId t) {
    if (const auto it = nodes_.find(t); it != nodes_.end()) return it->second;
    const uint32_t node = Make(t);
    nodes_.emplace(t, node);
    return node;
  }

  std::string problem;

 private:
  struct Part {
    Rational factor;
    uint32_t node;
  };

  uint32_t Push(Code code) {
    const std::array<uint32_t, 4> key{static_cast<uint32_t>(code.op), code.a, code.b, code.c};
    const bool shared = code.op != CodeOp::kLinear && code.op != CodeOp::kVariable;
    if (shared) {
      if (const auto it = known_.find(key); it != known_.end()) return it->second;
    }
    const auto node = static_cast<uint32_t>(program_.code.size());
    program_.code.push_back(code);
    program_.constants.push_back({0, 0, 0});
    if (shared) known_.emplace(key, node);
    return node;
  }

  uint32_t Linear(std::vector<Part> parts, const Rational& constant) {
    std::erase_if(parts, [](const Part& p) { return p.factor.IsZero(); });
    if (parts.size() == 1 && parts[0].factor == Rational(1) && constant.IsZero()) return parts[0].node;
    std::string key = constant.ToString();
    for (const Part& p : parts) key += fmt::format(" {}*{}", p.factor.ToString(), p.node);
    if (const auto it = sums_.find(key); it != sums_.end()) return it->second;
    const auto first = static_cast<uint32_t>(program_.parts.size());
    for (const Part& p : parts) {
      LinearPart part = NearestConstant(p.factor);
      part.node = p.node;
      program_.parts.push_back(part);
    }
    const uint32_t node = Push({CodeOp::kLinear, first, static_cast<uint32_t>(parts.size())});
    program_.constants[node] = NearestConstant(constant);
    sums_.emplace(std::move(key), node);
    return node;
  }
  uint32_t Constant(const Rational& value) { return Linear({}, value); }
  uint32_t Product(uint32_t a, uint32_t b) {
    return Push({CodeOp::kProduct, std::min(a, b), std::max(a, b)});
  }
  uint32_t Max(uint32_t a, uint32_t b) { return Push({CodeOp::kMax, std::min(a, b), std::max(a, b)}); }
  uint32_t Sine(uint32_t a) {
    const uint32_t sine = Push({CodeOp::kSine, a});
    Push({CodeOp::kCosine, a});
    return sine;
  }
  uint32_t Atan(uint32_t a) {
    const uint32_t w = Linear({{Rational(1), Product(a, a)}}, Rational(1));
    return Push({CodeOp::kAtan, a, w});
  }
  uint32_t Unknown(std::string what) {
    if (problem.empty()) problem = std::move(what);
    return Constant(Rational(0));
  }

  // (a factor, a term): 3 * x is one part of a sum, not a product.
  std::pair<Rational, TermId> Scaled(TermId t) const {
    if (arena_.op(t) == Op::kMul) {
      const auto args = arena_.args(t);
      if (args.size() == 2 && arena_.IsNumber(args[0])) return {arena_.number(args[0]), args[1]};
    }
    return {Rational(1), t};
  }

  uint32_t Make(TermId t) {
    const auto args = arena_.args(t);
    switch (arena_.op(t)) {
      case Op::kNumber:
        return Constant(arena_.number(t));
      case Op::kToReal:
        return Number(args[0]);
      case Op::kAdd: {
        std::vector<Part> parts;
        Rational constant(0);
        for (const TermId a : args) {
          if (arena_.IsNumber(a)) {
            constant = constant + arena_.number(a);
            continue;
          }
          const auto [factor, rest] = Scaled(a);
          parts.push_back({factor, Number(rest)});
        }
        return Linear(std::move(parts), constant);
      }
      case Op::kMul: {
        const auto [factor, rest] = Scaled(t);
        if (rest != t) return Linear({{factor, Number(rest)}}, Rational(0));
        uint32_t product = Number(args[0]);
        for (size_t i = 1; i < args.size(); ++i) product = Product(product, Number(args[i]));
        return product;
      }
      case Op::kDivide:
        return Product(Number(args[0]), Push({CodeOp::kReciprocal, Number(args[1])}));
      case Op::kElementary:
        return Function(t);
      case Op::kIte: {
        const uint32_t then = Number(args[1]);
        return Choose(args[0], then, Number(args[2]));
      }
      case Op::kVariable:
        return Unknown(
            fmt::format("`{}` is neither a state nor an input", arena_.symbol(arena_.symbol_of(t)).name));
      default:
        return Unknown(fmt::format("`{}` has no derivative", expr::Name(arena_.op(t))));
    }
  }

  uint32_t Function(TermId t) {
    const auto args = arena_.args(t);
    const uint32_t a = Number(args[0]);
    switch (arena_.elementary_of(t)) {
      case Elementary::kSqrt:
        return Push({CodeOp::kRoot, a});
      case Elementary::kAbs:
        return Push({CodeOp::kAbs, a});
      case Elementary::kMin:
      case Elementary::kMax: {
        const uint32_t b = Number(args[1]);
        if (arena_.elementary_of(t) == Elementary::kMax) return Max(a, b);
        // min(a, b) = -max(-a, -b)
        const uint32_t max =
            Max(Linear({{Rational(-1), a}}, Rational(0)), Linear({{Rational(-1), b}}, Rational(0)));
        return Linear({{Rational(-1), max}}, Rational(0));
      }
      case Elementary::kSin:
        return Sine(a);
      case Elementary::kCos:
        return Sine(a) + 1;
      case Elementary::kTan: {
        const uint32_t sine = Sine(a);
        return Product(sine, Push({CodeOp::kReciprocal, sine + 1}));
      }
      case Elementary::kAsin:
      case Elementary::kAcos: {
        // asin x = atan(x / sqrt(1 - x^2))
        const uint32_t root = Push({CodeOp::kRoot, Linear({{Rational(-1), Product(a, a)}}, Rational(1))});
        const uint32_t asin = Atan(Product(a, Push({CodeOp::kReciprocal, root})));
        if (arena_.elementary_of(t) == Elementary::kAsin) return asin;
        return Linear({{Rational(2), Atan(Constant(Rational(1)))}, {Rational(-1), asin}}, Rational(0));
      }
      case Elementary::kAtan:
        return Atan(a);
      case Elementary::kAtan2: {
        const uint32_t b = Number(args[1]);
        const uint32_t w = Linear({{Rational(1), Product(a, a)}, {Rational(1), Product(b, b)}}, Rational(0));
        return Push({CodeOp::kAtan2, a, b, w});
      }
      case Elementary::kExp:
        return Push({CodeOp::kExp, a});
      case Elementary::kLog:
        return Push({CodeOp::kLog, a});
      case Elementary::kPower:  // no language of robots makes one
      case Elementary::kCount_:
        break;
    }
    CHECK(false);
    return 0;
  }

  // `then` where the condition holds, else `otherwise`: nodes.
  uint32_t Choose(TermId condition, uint32_t then, uint32_t otherwise) {
    const auto args = arena_.args(condition);
    const auto gap = [&](size_t less, size_t more) {
      return Linear({{Rational(1), Number(args[less])}, {Rational(-1), Number(args[more])}}, Rational(0));
    };
    switch (arena_.op(condition)) {
      case Op::kBool:
        return condition == arena_.True() ? then : otherwise;
      case Op::kNot:
        return Choose(args[0], otherwise, then);
      case Op::kLe:
        return Push({CodeOp::kChoose, gap(0, 1), then, otherwise});
      case Op::kLt:
        return Push({CodeOp::kChoose, gap(1, 0), otherwise, then});
      case Op::kEq: {
        if (arena_.sort_of(args[0]) != arena_.Real()) break;
        const uint32_t below = Push({CodeOp::kChoose, gap(1, 0), then, otherwise});
        return Push({CodeOp::kChoose, gap(0, 1), below, otherwise});
      }
      case Op::kAnd: {
        uint32_t result = then;
        for (size_t i = args.size(); i-- > 0;) result = Choose(args[i], result, otherwise);
        return result;
      }
      case Op::kOr: {
        uint32_t result = otherwise;
        for (size_t i = args.size(); i-- > 0;) result = Choose(args[i], then, result);
        return result;
      }
      default:
        break;
    }
    return Unknown("a condition that is no combination of comparisons");
  }

  const expr::Arena& arena_;
  Program& program_;
  std::unordered_map<TermId, uint32_t> nodes_;
  std::map<std::array<uint32_t, 4>, uint32_t> known_;
  std::map<std::string, uint32_t> sums_;
};

// What each node depends on; sines and cosines on the same.
void FindDependencies(Program& program) {
  program.depends.resize(program.code.size());
  for (uint32_t n = 0; n < program.code.size(); ++n) {
    std::vector<uint32_t>& own = program.depends[n];
    const auto join = [&](uint32_t other) {
      const std::vector<uint32_t>& more = program.depends[other];
      std::vector<uint32_t> all;
      std::set_union(own.begin(), own.end(), more.begin(), more.end(), std::back_inserter(all));
      own = std::move(all);
    };
    const Code& c = program.code[n];
    switch (c.op) {
      case CodeOp::kVariable:
        own.push_back(c.a);
        break;
      case CodeOp::kLinear:
        for (uint32_t p = c.a; p < c.a + c.b; ++p) join(program.parts[p].node);
        break;
      case CodeOp::kChoose:
        join(c.a);
        join(c.b);
        join(c.c);
        program.kinks.push_back(n);
        break;
      case CodeOp::kProduct:
      case CodeOp::kAtan2:
        join(c.a);
        join(c.b);
        break;
      case CodeOp::kMax:
        join(c.b);
        [[fallthrough]];
      case CodeOp::kAbs:
        program.kinks.push_back(n);
        join(c.a);
        break;
      case CodeOp::kReciprocal:
      case CodeOp::kRoot:
      case CodeOp::kSine:
      case CodeOp::kCosine:
      case CodeOp::kExp:
      case CodeOp::kLog:
      case CodeOp::kAtan:
        join(c.a);
        break;
    }
  }
}

}  // namespace

base::Result<Program> Compile(const expr::Arena& arena, std::vector<TermId> variables,
                              const std::vector<TermId>& functions, size_t core) {
  Program program;
  program.variables = std::move(variables);
  Compiler compiler(arena, program);
  compiler.Variables();
  program.core_end = static_cast<uint32_t>(program.code.size());
  for (size_t i = 0; i < functions.size(); ++i) {
    program.outputs.push_back(compiler.Number(functions[i]));
    if (i < core) program.core_end = static_cast<uint32_t>(program.code.size());
  }
  if (!compiler.problem.empty()) return base::Error{compiler.problem};
  FindDependencies(program);
  return program;
}

}  // namespace rondo::reach
