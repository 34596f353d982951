// Small worlds with a planted fault, and the same worlds without it. Whatever hides the fault, nothing may be
// proved of a world that has it, and nothing refuted of its safe twin. The positions are computed here, from
// the geometry of spheres on straight lines, and not by the tool.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

#include "checked.h"
#include "choreo/prove/prove.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

enum class Plant : uint8_t {
  kOnTheWay,    ///< an obstacle on the path, which is met in between
  kGap,         ///< the same, where `during` allows no state
  kClockGap,    ///< the same, at moments when `during` allows no state
  kRange,       ///< the same, beyond a range that cuts the motion off
  kJump,        ///< the same, between two sets of states that `during` allows
  kSwitch,      ///< the same, jumped over by a choice of the clock
  kTouch,       ///< an obstacle that the path only touches
  kOtherRobot,  ///< another robot that crosses the path at that moment
  kMounted,     ///< an arm that stands on the robot meets it, not the robot
  kInput,       ///< a motion that follows an input jumps with it: the obstacle is where the input leads
  kCount_,
};

constexpr std::array<std::string_view, static_cast<size_t>(Plant::kCount_)> kNames{
    "on the way", "gap",   "gap of the clock", "range",   "jump",
    "switch",     "touch", "other robot",      "mounted", "input"};

/// One world, as text: with the fault, or without.
class World {
 public:
  World(Plant plant, bool faulty, uint64_t seed) : plant_(plant), faulty_(faulty), random_(seed) {}

  std::string Text() {
    const double length = Draw(2, 6), time = Draw(1, 5), angle = Draw(-180, 180);
    const double radius = Millimetres(Draw(0.1, 0.3)), other = Millimetres(Draw(0.05, 0.2)),
                 at = Draw(0.35, 0.65) * length;
    const bool turned = random_() % 2 == 0;
    const std::string base = turned ? fmt::format("self * rotate_z({:.3f} deg)", angle) : "self";
    // Where the obstacle is beside the path.
    double beside = faulty_ ? Draw(0, 0.8) * (radius + other) : radius + other + Draw(0.01, 0.2);
    if (plant_ == Plant::kTouch) beside = radius + other + (faulty_ ? 0 : 0.001);
    const bool hidden = plant_ != Plant::kOnTheWay && plant_ != Plant::kTouch &&
                        plant_ != Plant::kOtherRobot && plant_ != Plant::kMounted && plant_ != Plant::kInput;
    std::string during = fmt::format("x == linear(clock, 0, {:.6f} m, {:.6f} s)", length, time);
    std::string range = "[-20 m, 20 m]";
    const double near = (radius + other) * 1.05;
    const double low = at - near, high = at + near;
    std::string post = fmt::format("post x == {:.6f} m", length);
    // Safe twins have the same form, without the hole.
    const double gap = faulty_ ? 1 : -1;
    switch (plant_) {
      case Plant::kGap:
        during += fmt::format(" and (x <= {:.6f} m or x >= {:.6f} m)", at - gap * near, at + gap * near);
        break;
      case Plant::kClockGap:
        during += fmt::format(" and (clock <= {:.6f} s or clock >= {:.6f} s)",
                              (at - gap * near) * time / length, (at + gap * near) * time / length);
        break;
      case Plant::kRange:
        range = fmt::format("[-20 m, {:.6f} m]", faulty_ ? low : length + 0.5);
        if (faulty_) post = "";
        break;
      case Plant::kJump:
        during = fmt::format("(x >= -1 m and x <= {:.6f} m or x >= {:.6f} m and x <= {:.6f} m)",
                             at - gap * near, at + gap * near, length);
        break;
      case Plant::kSwitch:
        during = fmt::format(
            "x == select(clock < {0:.6f} s, linear(clock, 0, {1:.6f} m, {0:.6f} s), {2:.6f} m + linear(clock "
            "- "
            "{0:.6f} s, 0, 1 m, 1 s))",
            time / 2, faulty_ ? low : high, high);
        post = "";
        break;
      default:
        break;
    }
    if (hidden && !faulty_ && plant_ == Plant::kRange) beside = radius + other + 0.1;
    std::string robot = fmt::format(R"(robot Bot {{
  state x: length in {}
  frame base = {} * translate(x, 0, 0)
  mount top = base * translate(0, 0, {:.6f} m)
  body sphere(base, {:.6f} m)
  input lead: length in [-1 m, {:.6f} m]
  motion Idle() interruptible [0.1 s, inf) {{}}
  motion Go() noninterruptible [{:.6f} s, {:.6f} s] {{
    modifies x
    pre x == 0
    during {}
    {}
  }}
  motion Follow() interruptible [0.1 s, inf) {{
    modifies x
    pre x == lead
    during x == lead
  }}
  motion Back() noninterruptible [0.5 s, 2 s] {{ modifies x during x >= {:.6f} m and x <= {:.6f} m }}
}}
robot Arm {{
  state a: angle in [-170 deg, 170 deg]
  body sphere(self * translate(0, 0, 0.5 m), {:.6f} m)
  motion Idle() interruptible [0.1 s, inf) {{}}
}}
)",
                                    range, base, radius, radius, length, time, time, during, post, length,
                                    length + 0.1, radius);
    std::string world = "world W {\n  a: Bot at (0, 0, 0)\n";
    std::string step = "a: Go()";
    const std::string place = turned ? fmt::format("rotate_z({:.3f} deg) * ", angle) : std::string();
    double height = 0;
    if (plant_ == Plant::kMounted) {
      // Only the sphere above the robot may meet it.
      height = radius + 0.5;
      world += "  arm: Arm on a.top\n";
      step = "{ a: Go(), arm: Idle() }";
    }
    if (plant_ == Plant::kMounted) beside = faulty_ ? beside : radius + other + 0.05;
    if (plant_ == Plant::kOtherRobot) {
      robot += fmt::format(R"(robot Crosser {{
  state q: length in [-20 m, 20 m]
  body sphere({}self * translate({:.6f} m, q, 0), {:.6f} m)
  motion Idle() interruptible [0.1 s, inf) {{}}
  motion Cross() interruptible [0.1 s, inf) {{
    modifies q
    pre q == -2 m
    during q == -2 m + linear(clock, 0, {:.6f} m, {:.6f} s)
  }}
}}
)",
                           place.empty() ? "" : place, at, other, faulty_ ? 2.0 : -1.0, at * time / length);
      world += "  b: Crosser\n";
      step = "{ a: Go(), b: Cross() }";
    } else {
      world += fmt::format("  obstacle o: sphere({}translate({:.6f} m, {:.6f} m, {:.6f} m), {:.6f} m)\n",
                           place, at, beside, height, other);
    }
    if (plant_ == Plant::kInput) step = "a: Follow()";
    world += "}\n";
    return robot + world + Choreography(step);
  }

 private:
  static double Millimetres(double x) { return std::round(x * 1000) / 1000; }
  double Draw(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }

  // Plainly, in a branch, or behind another step.
  std::string Choreography(const std::string& step) {
    std::string begins = "a.x == 0";
    if (plant_ == Plant::kOtherRobot) begins += " and b.q == -2 m";
    if (plant_ == Plant::kInput) begins += " and a.lead == 0";
    const bool alone = plant_ != Plant::kOtherRobot && plant_ != Plant::kMounted && plant_ != Plant::kInput;
    switch (alone ? random_() % 3 : 0) {
      case 1:
        return fmt::format("choreography C in W {{\n  initially {}\n  a: Idle()\n  {}\n}}\n", begins, step);
      case 2:
        return fmt::format(
            "choreography C in W {{\n  initially {}\n  choose at a {{\n    when a.lead > 0 {{ {} }}\n    "
            "when a.lead "
            "<= 0 {{ a: Idle() }}\n  }}\n}}\n",
            begins, step);
      default:
        return fmt::format("choreography C in W {{\n  initially {}\n  {}\n}}\n", begins, step);
    }
  }

  Plant plant_;
  bool faulty_;
  std::mt19937_64 random_;
};

enum class Outcome : uint8_t { kProved, kRefuted, kUnknown, kRejected };

Outcome OutcomeOf(const std::string& text) {
  Checked checked(text);
  if (!checked.good()) return Outcome::kRejected;
  const Obligations obligations = ObligationsOf(checked.graphs[0], checked.arena);
  if (!obligations.missing.empty()) return Outcome::kRejected;
  ProveOptions options;
  options.limits.time = std::chrono::seconds(20);
  options.limits.certificates = false;
  options.jobs = 1;
  const Proofs proofs = Prove(obligations, checked.graphs[0], checked.arena, options);
  Outcome result = Outcome::kProved;
  for (size_t i = 0; i < obligations.all.size(); ++i) {
    if (!IsRequired(obligations.all[i].kind)) continue;
    if (proofs.all[i].decision.verdict == verdict::Verdict::kRefuted) return Outcome::kRefuted;
    if (proofs.all[i].decision.verdict == verdict::Verdict::kUnknown) result = Outcome::kUnknown;
  }
  return result;
}

TEST(Planted, FaultsAreFoundAndTheirTwinsAreNot) {
  const char* wanted = std::getenv("RONDO_CASES");
  const uint64_t each =
      wanted == nullptr ? 4 : std::max<uint64_t>(4, std::strtoull(wanted, nullptr, 10) / 2000);
  int faults = 0, seen = 0, unknown = 0, twins = 0, proved = 0;
  std::map<std::string_view, int> missed, open;
  for (size_t p = 0; p < kNames.size(); ++p) {
    for (uint64_t seed = 1; seed <= each; ++seed) {
      const std::string faulty = World(static_cast<Plant>(p), true, seed * 31 + p).Text();
      const Outcome outcome = OutcomeOf(faulty);
      EXPECT_NE(outcome, Outcome::kProved) << kNames[p] << ", seed " << seed << "\n" << faulty;
      ++faults;
      seen += outcome == Outcome::kRefuted || outcome == Outcome::kRejected ? 1 : 0;
      const std::string safe = World(static_cast<Plant>(p), false, seed * 31 + p).Text();
      const Outcome twin = OutcomeOf(safe);
      EXPECT_TRUE(twin == Outcome::kProved || twin == Outcome::kUnknown)
          << kNames[p] << " (safe), seed " << seed << "\n"
          << safe;
      ++twins;
      if (outcome == Outcome::kUnknown) ++missed[kNames[p]];
      if (twin == Outcome::kUnknown) ++open[kNames[p]];
      proved += twin == Outcome::kProved ? 1 : 0;
      unknown += twin == Outcome::kUnknown ? 1 : 0;
    }
  }
  for (const auto& [name, count] : missed)
    std::printf("faults that are not decided: %s %d\n", name.data(), count);
  for (const auto& [name, count] : open)
    std::printf("twins that are not decided: %s %d\n", name.data(), count);
  std::printf("%d of %d faults refuted or rejected, %d of %d twins proved, %d unknown\n", seen, faults,
              proved, twins, unknown);
  EXPECT_GE(seen * 20, faults * 19);
}

}  // namespace
}  // namespace rondo::choreo
