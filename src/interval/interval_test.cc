// Every operation against MPFR: enclosures hold for every back end, are not wider than stated, and inverses
// keep every preimage. RONDO_CASES sets the number of cases for each operation and back end.
#include "interval/interval.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

#include "interval/batch.h"

namespace rondo::interval {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// A number with 300 bits.
class Big {
 public:
  Big() { mpfr_init2(v_, 300); }
  explicit Big(double d) : Big() { mpfr_set_d(v_, d, MPFR_RNDN); }
  Big(const Big& o) : Big() { mpfr_set(v_, o.v_, MPFR_RNDN); }
  Big& operator=(const Big&) = delete;
  ~Big() { mpfr_clear(v_); }
  mpfr_ptr get() { return v_; }
  mpfr_srcptr get() const { return v_; }

 private:
  mpfr_t v_;
};

using Exact = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr);

struct Operation {
  std::string name;
  int arity;
  Exact exact;  // the exact value; a NaN where the function is undefined
  std::function<void(const Kernels&, const Batch&, const Batch&, Batch&)> forward;
  std::function<void(const Kernels&, const Batch&, Batch&, Batch&)> inverse;
  double relative = 0;  // stated error of a bound at a point
  double absolute = 0;
};

#define UNARY(NAME, FN)                                                                        \
  Operation {                                                                                  \
    #NAME, 1, [](mpfr_ptr r, mpfr_srcptr a, mpfr_srcptr) { return FN(r, a, MPFR_RNDN); },      \
        [](const Kernels& k, const Batch& a, const Batch&, Batch& out) { k.NAME(a, out); }, {} \
  }
#define BINARY(NAME, FN)                                                                         \
  Operation {                                                                                    \
    #NAME, 2, [](mpfr_ptr r, mpfr_srcptr a, mpfr_srcptr b) { return FN(r, a, b, MPFR_RNDN); },   \
        [](const Kernels& k, const Batch& a, const Batch& b, Batch& out) { k.NAME(a, b, out); }, \
        [](const Kernels& k, const Batch& z, Batch& x, Batch& y) { k.NAME##_inverse(z, x, y); }  \
  }

template <int N>
Operation PowerOf() {
  return {"pow" + std::to_string(N), 1,
          [](mpfr_ptr r, mpfr_srcptr a, mpfr_srcptr) { return mpfr_pow_si(r, a, N, MPFR_RNDN); },
          [](const Kernels& k, const Batch& a, const Batch&, Batch& out) { k.pow(a, N, out); },
          [](const Kernels& k, const Batch& z, Batch& x, Batch&) { k.pow_inverse(z, x, N); }};
}

std::vector<Operation> All() {
  std::vector<Operation> all;
  const auto add = [&](Operation op, double relative, double absolute,
                       Kernels::UnaryInverse Kernels::*inverse = nullptr) {
    op.relative = relative;
    op.absolute = absolute;
    if (inverse != nullptr)
      op.inverse = [inverse](const Kernels& k, const Batch& z, Batch& x, Batch&) { (k.*inverse)(z, x); };
    all.push_back(std::move(op));
  };
  const double two_ulps = 0x1p-51;
  const double elementary = 0x1p-47;
  add(UNARY(neg, mpfr_neg), 0, 0, &Kernels::neg_inverse);
  add(UNARY(sqr, mpfr_sqr), two_ulps, 0, &Kernels::sqr_inverse);
  add(UNARY(sqrt, mpfr_sqrt), two_ulps, 0, &Kernels::sqrt_inverse);
  add(UNARY(abs, mpfr_abs), 0, 0, &Kernels::abs_inverse);
  add(UNARY(sin, mpfr_sin), elementary, elementary, &Kernels::sin_inverse);
  add(UNARY(cos, mpfr_cos), elementary, elementary, &Kernels::cos_inverse);
  add(UNARY(tan, mpfr_tan), kInf, 0);
  add(UNARY(asin, mpfr_asin), elementary, 0, &Kernels::asin_inverse);
  add(UNARY(acos, mpfr_acos), elementary, elementary, &Kernels::acos_inverse);
  add(UNARY(atan, mpfr_atan), elementary, 0, &Kernels::atan_inverse);
  add(UNARY(exp, mpfr_exp), elementary, 0, &Kernels::exp_inverse);
  add(UNARY(log, mpfr_log), elementary, 0, &Kernels::log_inverse);
  add(BINARY(add, mpfr_add), two_ulps, 0);
  add(BINARY(sub, mpfr_sub), two_ulps, 0);
  add(BINARY(mul, mpfr_mul), two_ulps, 0);
  add(BINARY(div, mpfr_div), two_ulps, 0);
  add(BINARY(min, mpfr_min), 0, 0);
  add(BINARY(max, mpfr_max), 0, 0);
  Operation atan2{"atan2",
                  2,
                  [](mpfr_ptr r, mpfr_srcptr a, mpfr_srcptr b) { return mpfr_atan2(r, a, b, MPFR_RNDN); },
                  [](const Kernels& k, const Batch& a, const Batch& b, Batch& out) { k.atan2(a, b, out); },
                  {}};
  add(std::move(atan2), kInf, 0);
  add(PowerOf<3>(), 3 * two_ulps, 0);
  add(PowerOf<4>(), 4 * two_ulps, 0);
  add(PowerOf<5>(), 5 * two_ulps, 0);
  add(PowerOf<8>(), 8 * two_ulps, 0);
  return all;
}

size_t Cases() {
  const char* text = std::getenv("RONDO_CASES");
  return text == nullptr ? 10'000 : std::strtoull(text, nullptr, 10);
}

// Numbers at which floating point goes wrong, and all others.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : rng_(seed) {}

  double Any() {
    switch (rng_() % 8) {
      case 0: {
        static constexpr double kSpecial[] = {
            0.0,  -0.0, 1.0,     0.5,    2.0,   0x1p-1074, 0x1p-1022, 0x1.fffffffffffffp1023,
            kInf, 1e5,  65536.0, 0x1p53, 1e300, 1e-300,    709.78,    745.13};
        const double d = kSpecial[rng_() % std::size(kSpecial)];
        return Nudge(rng_() % 2 == 0 ? d : -d);
      }
      case 1:  // near multiples of pi/2
        return Nudge(static_cast<double>(static_cast<int64_t>(rng_() % 80001) - 40000) * 1.5707963267948966);
      case 2: {  // any bits
        const auto d = std::bit_cast<double>(static_cast<uint64_t>(rng_()));
        return std::isnan(d) ? 1.0 : d;
      }
      case 3:  // small integers and their halves
        return static_cast<double>(static_cast<int>(rng_() % 41) - 20) * 0.5;
      case 4:
        return Nudge(Uniform(-1, 1));
      default:
        return Uniform(-10, 10);
    }
  }
  Interval Range() {
    const double a = Any();
    const double b = rng_() % 4 == 0 ? a : rng_() % 2 == 0 ? a + Uniform(-1, 1) : Any();
    Interval r{std::min(a, b), std::max(a, b)};
    if (r.lo == kInf) r.lo = 0x1.fffffffffffffp1023;
    if (r.hi == -kInf) r.hi = -0x1.fffffffffffffp1023;
    return r;
  }
  double Member(Interval r) {
    switch (rng_() % 4) {
      case 0:
        return std::max(r.lo, -0x1.fffffffffffffp1023);
      case 1:
        return std::min(r.hi, 0x1.fffffffffffffp1023);
      case 2:
        return r.Middle();
      default: {
        const double a = std::max(r.lo, -1e300);
        const double b = std::min(r.hi, 1e300);
        return a <= b ? std::clamp(Uniform(a, b), a, b) : r.Middle();
      }
    }
  }

 private:
  double Uniform(double a, double b) { return a + (b - a) * (static_cast<double>(rng_() >> 11) * 0x1p-53); }
  double Nudge(double d) {
    for (unsigned i = rng_() % 4; i > 0 && std::isfinite(d); --i)
      d = std::nextafter(d, rng_() % 2 == 0 ? kInf : -kInf);
    return d;
  }
  std::mt19937_64 rng_;
};

Interval Lane(const Batch& b, int i) { return {-b.nl[i], b.hi[i]}; }
void SetLane(Batch& b, int i, Interval v) {
  b.nl[i] = -v.lo;
  b.hi[i] = v.hi;
}

bool Encloses(Interval r, const Big& exact) {
  return mpfr_cmp_d(exact.get(), r.lo) >= 0 && mpfr_cmp_d(exact.get(), r.hi) <= 0;
}

// Is a bound at most this far from the exact value, give or take what is subnormal?
bool Near(double bound, const Big& exact, double relative, double absolute) {
  if (std::isinf(relative) || std::isinf(bound)) return true;
  Big distance;
  mpfr_sub_d(distance.get(), exact.get(), bound, MPFR_RNDA);
  const double d = std::fabs(mpfr_get_d(distance.get(), MPFR_RNDA));
  const double size = std::fabs(mpfr_get_d(exact.get(), MPFR_RNDN));
  return d <= size * relative + absolute + 0x1p-1020;
}

class EveryOperation : public testing::TestWithParam<Backend> {};

TEST_P(EveryOperation, EnclosesWhatMpfrComputes) {
  const Kernels& kernels = KernelsOf(GetParam());
  for (const Operation& op : All()) {
    Numbers numbers(std::hash<std::string>{}(op.name));
    for (size_t n = 0; n < Cases(); n += kLanes) {
      Batch a, b, out;
      for (int i = 0; i < kLanes; ++i) {
        SetLane(a, i, numbers.Range());
        SetLane(b, i, numbers.Range());
      }
      op.forward(kernels, a, b, out);
      for (int i = 0; i < kLanes; ++i) {
        const Interval x = Lane(a, i);
        const Interval y = Lane(b, i);
        for (int k = 0; k < 3; ++k) {
          const double px = numbers.Member(x);
          const double py = numbers.Member(y);
          if (op.name == "div" && py == 0) continue;
          if (op.name == "atan2" && px == 0 && py == 0) continue;
          Big value;
          const bool rounded = op.exact(value.get(), Big(px + 0.0).get(), Big(py + 0.0).get()) != 0;
          if (mpfr_nan_p(value.get()) != 0 || (op.name == "log" && px == 0)) continue;
          const Interval z = Lane(out, i);
          ASSERT_TRUE(Encloses(z, value)) << op.name << " " << kernels.name << " of " << ToString(x) << " "
                                          << ToString(y) << " at " << px << " " << py << ": " << ToString(z);
          if (x.IsPoint() && (op.arity == 1 || y.IsPoint()) &&
              std::fabs(px) < (op.name == "exp" ? 709 : 65536)) {
            ASSERT_TRUE(Near(z.lo, value, op.relative, op.absolute) &&
                        Near(z.hi, value, op.relative, op.absolute))
                << op.name << " " << kernels.name << " at " << px << " " << py
                << " is too wide: " << ToString(z);
          }
          if (!op.inverse || (op.name == "div" && y.Contains(0))) continue;
          // An interval around the value: contraction must keep the point.
          Interval target{mpfr_get_d(value.get(), MPFR_RNDD), mpfr_get_d(value.get(), MPFR_RNDU)};
          if (rounded) target = {std::nextafter(target.lo, -kInf), std::nextafter(target.hi, kInf)};
          if (k == 1) target = Interval{target.lo - 0.1, target.hi + 0.25};
          Batch bz = out, bx = a, by = b;
          SetLane(bz, i, target);
          op.inverse(kernels, bz, bx, by);
          ASSERT_TRUE(Lane(bx, i).Contains(px))
              << op.name << "^-1 " << kernels.name << " " << ToString(target) << " of " << ToString(x) << " "
              << ToString(y) << " loses " << px;
          if (op.arity == 2) {
            ASSERT_TRUE(Lane(by, i).Contains(py))
                << op.name << "^-1 " << kernels.name << " " << ToString(target) << " of " << ToString(x)
                << " " << ToString(y) << " loses " << py;
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, EveryOperation,
                         testing::ValuesIn(AvailableBackends().begin(), AvailableBackends().end()),
                         [](const auto& chosen) {
                           std::string name = KernelsOf(chosen.param).name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Inverses, Contract) {
  const Kernels& k = BestKernels();
  const auto contract = [&](auto inverse, Interval z, Interval x) {
    Batch bz, bx;
    for (int i = 0; i < kLanes; ++i) {
      SetLane(bz, i, z);
      SetLane(bx, i, x);
    }
    inverse(bz, bx);
    return Lane(bx, 3);
  };
  const Interval sine = contract(k.sin_inverse, {0.5, 1}, {-1, 1});
  EXPECT_NEAR(sine.lo, 0.5235987755982989, 1e-12);
  EXPECT_EQ(sine.hi, 1);
  EXPECT_TRUE(contract(k.sin_inverse, {0.5, 1}, {-3, -0.1}).IsEmpty());
  const Interval cosine = contract(k.cos_inverse, {-1, 0}, {-0.5, 4});
  EXPECT_NEAR(cosine.lo, 1.5707963267948966, 1e-12);
  const Interval square = contract(k.sqr_inverse, {4, 9}, {-10, 2.5});
  EXPECT_NEAR(square.lo, -3, 1e-12);
  EXPECT_EQ(square.hi, 2.5);
  EXPECT_TRUE(contract(k.sqrt_inverse, {-3, -1}, {0, 5}).IsEmpty());
}

TEST(Arithmetic, KeepsExactResultsExact) {
  for (const Backend backend : AvailableBackends()) {
    const Kernels& k = KernelsOf(backend);
    Batch zero, x, out;
    for (int i = 0; i < kLanes; ++i) {
      SetLane(zero, i, {0, 0});
      SetLane(x, i, {-kInf, 7});
    }
    k.mul(zero, x, out);
    EXPECT_EQ(Lane(out, 0), (Interval{0, 0})) << k.name;
    SetLane(x, 0, {2, 2});
    k.sub(x, x, out);
    EXPECT_EQ(Lane(out, 0), (Interval{0, 0})) << k.name;
  }
}

TEST(Middle, IsAFiniteMember) {
  for (const Interval r : {Interval{},
                           {0, kInf},
                           {-kInf, -5},
                           {-3, kInf},
                           {1, 2},
                           {-0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023}}) {
    EXPECT_TRUE(r.Contains(r.Middle())) << ToString(r);
    EXPECT_TRUE(std::isfinite(r.Middle()));
  }
}

}  // namespace
}  // namespace rondo::interval
