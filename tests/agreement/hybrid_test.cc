// Small controlled systems with a bound that samples break, and the same systems with a bound that is well beyond
// what samples reach. Nothing may be proved of the first, and nothing refuted of the second that a run here does
// not confirm. Runs are computed here, by the midpoint rule on equations written down here, and not by the tool.
// RONDO_CASES: how many, in nightly runs of a million: 625 of each kind and as many twins.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>

#include "contracts/decide.h"
#include "contracts/load.h"
#include "contracts/tube_certificate.h"
#include "fixtures/temporary_folder.h"

namespace rondo {
namespace {

using State = std::vector<double>;

enum class Shape : uint8_t {
  kThermostat,     ///< thresholds, by events
  kUnknownLevels,  ///< thresholds that are unknown constants, and a disturbance
  kThreeLevels,    ///< three modes in a row
  kTank,           ///< two states, a valve that is switched by events
  kStop,           ///< runs to a guard and stays there
  kSampledLevel,   ///< a thermostat that looks now and then
  kBangBang,       ///< a double integrator whose acceleration has two values, at instants
  kSaturated,      ///< a double integrator whose acceleration is limited, at instants, with a disturbance
  kCount_,
};
constexpr std::array<std::string_view, static_cast<size_t>(Shape::kCount_)> kNames{
    "thermostat", "unknown levels", "three levels", "tank",
    "stop",       "sampled level",  "bang-bang",    "saturated"};

// A system: as text for the tool, and as functions for the runs here. The first state is what bounds are about.
struct System {
  std::string text;  ///< with {0} in the place of the claim
  double horizon = 0;
  std::vector<std::pair<double, double>> starts;  ///< states, then unknown constants
  double disturbance = 0;                         ///< its largest magnitude
  double period = 0;                              ///< of a controller at instants; 0: none
  std::function<void(const State&, int mode, double input, double disturbance, State&)> rates;
  std::function<int(const State&, int mode)> next = [](const State&, int mode) { return mode; };
  std::function<double(const State&)> law = [](const State&) { return 0.0; };
};

class Drawing {
 public:
  explicit Drawing(uint64_t seed) : random_(seed) {}
  // Numbers that texts show exactly.
  double operator()(double least, double most) {
    const double share = static_cast<double>(random_() >> 11) * 0x1p-53;
    return std::round((least + share * (most - least)) * 1000) / 1000;
  }

 private:
  std::mt19937_64 random_;
};

constexpr std::string_view kHead = "robot P {{\n  state x: number in [-1000, 1000]\n";

System Thermostat(Drawing& draw, bool unknown) {
  System s;
  const double low = draw(17, 19), high = low + draw(1.5, 4), heat = draw(3, 8), loss = draw(0.05, 0.2),
               leak = unknown ? draw(0, 0.3) : 0, spread = unknown ? draw(0.1, 0.6) : 0;
  s.horizon = draw(5, 15);
  s.starts = {{low + 0.5, low + 1}, {low, low + spread}, {high, high + spread}};
  s.disturbance = leak;
  s.text = fmt::format(
      "{}  input leak: number in [-{}, {}]\n  memory on: number in [0, 0]\n"
      "  dynamics {{ x' = (select(on == 1, {}, 0) - {} * (x - 10) + leak) / 1 s }}\n"
      "  motion Go(low: number in [{}, {}], high: number in [{}, {}]) noninterruptible [{} s, {} s] {{\n"
      "    modifies x\n    pre x >= {} and x <= {}\n    during CLAIM\n"
      "    control {{\n      when on == 0 and x <= low {{ on = 1 }}\n      when on == 1 and x >= high {{ on = 0 }}\n"
      "    }}\n  }}\n}}\n",
      fmt::format(kHead), leak, leak, heat, loss, low, low + spread, high, high + spread, s.horizon,
      s.horizon, s.starts[0].first, s.starts[0].second);
  s.rates = [=](const State& x, int mode, double, double w, State& rate) {
    rate[0] = (mode == 1 ? heat : 0) - loss * (x[0] - 10) + w;
  };
  s.next = [](const State& x, int mode) { return x[0] <= x[1] ? 1 : x[0] >= x[2] ? 0 : mode; };
  return s;
}

System ThreeLevels(Drawing& draw) {
  System s;
  const double up = draw(0.5, 2), down = draw(0.2, 1), first = draw(1, 2), second = first + draw(0.5, 1),
               bottom = draw(-1, 0);
  s.horizon = draw(4, 12);
  s.starts = {{0, draw(0.1, 0.4)}};
  s.text = fmt::format(
      "{}  memory phase: number in [0, 0]\n"
      "  dynamics {{ x' = select(phase == 0, {}, select(phase == 1, {}, -{})) / 1 s }}\n"
      "  motion Go() noninterruptible [{} s, {} s] {{\n    modifies x\n    pre x >= 0 and x <= {}\n    during CLAIM\n"
      "    control {{\n      when phase == 0 and x >= {} {{ phase = 1 }}\n      when phase == 1 and x >= {} {{ phase = 2 }}\n"
      "      when phase == 2 and x <= {} {{ phase = 0 }}\n    }}\n  }}\n}}\n",
      fmt::format(kHead), up, up / 2, down, s.horizon, s.horizon, s.starts[0].second, first, second, bottom);
  s.rates = [=](const State&, int mode, double, double, State& rate) {
    rate[0] = mode == 0 ? up : mode == 1 ? up / 2 : -down;
  };
  s.next = [=](const State& x, int mode) {
    if (mode == 0 && x[0] >= first) return 1;
    if (mode == 1 && x[0] >= second) return 2;
    return mode == 2 && x[0] <= bottom ? 0 : mode;
  };
  return s;
}

System Tank(Drawing& draw) {
  System s;
  const double in = draw(0.5, 1), out = draw(0.2, 0.4), lag = draw(0.5, 2), low = draw(1, 1.5),
               high = low + draw(0.5, 1.5), noise = draw(0, 0.05);
  s.horizon = draw(5, 12);
  s.starts = {{low + 0.1, low + 0.3}, {0, 0.1}};
  s.disturbance = noise;
  s.text = fmt::format(
      "{}  state flow: number in [-100, 100]\n  input w: number in [-{}, {}]\n  memory open: number in [0, 0]\n"
      "  dynamics {{ x' = (flow - {} * x + w) / 1 s; flow' = {} * (select(open == 1, {}, 0) - flow) / 1 s }}\n"
      "  motion Go() noninterruptible [{} s, {} s] {{\n    modifies x, flow\n"
      "    pre x >= {} and x <= {} and flow >= 0 and flow <= 0.1\n    during CLAIM\n"
      "    control {{\n      when open == 0 and x <= {} {{ open = 1 }}\n      when open == 1 and x >= {} {{ open = 0 }}\n"
      "    }}\n  }}\n}}\n",
      fmt::format(kHead), noise, noise, out, lag, in * high, s.horizon, s.horizon, s.starts[0].first,
      s.starts[0].second, low, high);
  s.rates = [=](const State& x, int mode, double, double w, State& rate) {
    rate[0] = x[1] - out * x[0] + w;
    rate[1] = lag * ((mode == 1 ? in * high : 0) - x[1]);
  };
  s.next = [=](const State& x, int mode) {
    return mode == 0 && x[0] <= low ? 1 : mode == 1 && x[0] >= high ? 0 : mode;
  };
  return s;
}

System Stop(Drawing& draw) {
  System s;
  const double speed = draw(0.3, 2), wall = draw(1, 2), drift = draw(0, 0.2) * speed;
  s.horizon = draw(2, 6);
  s.starts = {{0, draw(0.05, 0.3)}};
  s.disturbance = drift;
  s.text = fmt::format(
      "{}  input w: number in [-{}, {}]\n  memory phase: number in [0, 0]\n"
      "  dynamics {{ x' = select(phase == 0, {} + w, 0) / 1 s }}\n"
      "  motion Go() noninterruptible [{} s, {} s] {{\n    modifies x\n    pre x >= 0 and x <= {}\n    during CLAIM\n"
      "    control {{ when phase == 0 and x >= {} {{ phase = 1 }} }}\n  }}\n}}\n",
      fmt::format(kHead), drift, drift, speed, s.horizon, s.horizon, s.starts[0].second, wall);
  s.rates = [=](const State&, int mode, double, double w, State& rate) {
    rate[0] = mode == 0 ? speed + w : 0;
  };
  s.next = [=](const State& x, int mode) { return x[0] >= wall ? 1 : mode; };
  return s;
}

System SampledLevel(Drawing& draw) {
  System s;
  const double level = draw(18, 21), heat = draw(2, 6), loss = draw(0.05, 0.2), leak = draw(0, 0.3);
  s.period = draw(0.1, 0.4);
  s.horizon = draw(4, 10);
  s.starts = {{level - 0.5, level + 0.5}};
  s.disturbance = leak;
  s.text = fmt::format(
      "{}  input u: number\n  input leak: number in [-{}, {}]\n"
      "  dynamics {{ x' = (u - {} * (x - 10) + leak) / 1 s }}\n"
      "  motion Go() noninterruptible [{} s, {} s] {{\n    modifies x\n    pre x >= {} and x <= {}\n    during CLAIM\n"
      "    control every {} s {{ u = select(x < {}, {}, 0) }}\n  }}\n}}\n",
      fmt::format(kHead), leak, leak, loss, s.horizon, s.horizon, s.starts[0].first, s.starts[0].second,
      s.period, level, heat);
  s.rates = [=](const State& x, int, double u, double w, State& rate) {
    rate[0] = u - loss * (x[0] - 10) + w;
  };
  s.law = [=](const State& x) { return x[0] < level ? heat : 0; };
  return s;
}

System BangBang(Drawing& draw) {
  System s;
  const double push = draw(0.5, 2), slope = draw(0.6, 1.5), width = draw(0.05, 0.2);
  s.period = draw(0.05, 0.15);
  s.horizon = draw(2, 5);
  s.starts = {{1 - width, 1 + width}, {0, 0}};
  s.text = fmt::format(
      "{}  state v: number in [-1000, 1000]\n  input u: number\n  dynamics {{ x' = v / 1 s; v' = u / 1 s }}\n"
      "  motion Go() noninterruptible [{} s, {} s] {{\n    modifies x, v\n"
      "    pre x >= {} and x <= {} and v == 0\n    during CLAIM\n"
      "    control every {} s {{ u = select(x + {} * v > 0, -{}, {}) }}\n  }}\n}}\n",
      fmt::format(kHead), s.horizon, s.horizon, s.starts[0].first, s.starts[0].second, s.period, slope, push,
      push);
  s.rates = [](const State& x, int, double u, double, State& rate) {
    rate[0] = x[1];
    rate[1] = u;
  };
  s.law = [=](const State& x) { return x[0] + slope * x[1] > 0 ? -push : push; };
  return s;
}

System Saturated(Drawing& draw) {
  System s;
  const double most = draw(0.3, 1), gain = draw(1, 3), damping = 2 * std::sqrt(gain) * draw(0.7, 1.2),
               width = draw(0.05, 0.3), noise = draw(0, 0.05);
  s.period = draw(0.05, 0.1);
  s.horizon = draw(3, 6);
  s.starts = {{1 - width, 1 + width}, {-0.1, 0.1}};
  s.disturbance = noise;
  s.text = fmt::format(
      "{}  state v: number in [-1000, 1000]\n  input u: number\n  input w: number in [-{}, {}]\n"
      "  dynamics {{ x' = v / 1 s; v' = (u + w) / 1 s }}\n"
      "  motion Go() noninterruptible [{} s, {} s] {{\n    modifies x, v\n"
      "    pre x >= {} and x <= {} and v >= -0.1 and v <= 0.1\n    during CLAIM\n"
      "    control every {} s {{ u = clamp(-{} * x - {} * v, -{}, {}) }}\n  }}\n}}\n",
      fmt::format(kHead), noise, noise, s.horizon, s.horizon, s.starts[0].first, s.starts[0].second, s.period,
      gain, damping, most, most);
  s.rates = [](const State& x, int, double u, double w, State& rate) {
    rate[0] = x[1];
    rate[1] = u + w;
  };
  s.law = [=](const State& x) { return std::clamp(-gain * x[0] - damping * x[1], -most, most); };
  return s;
}

System Draw(Shape shape, uint64_t seed) {
  Drawing draw(seed);
  switch (shape) {
    case Shape::kThermostat:
      return Thermostat(draw, false);
    case Shape::kUnknownLevels:
      return Thermostat(draw, true);
    case Shape::kThreeLevels:
      return ThreeLevels(draw);
    case Shape::kTank:
      return Tank(draw);
    case Shape::kStop:
      return Stop(draw);
    case Shape::kSampledLevel:
      return SampledLevel(draw);
    case Shape::kBangBang:
      return BangBang(draw);
    default:
      return Saturated(draw);
  }
}

struct Extent {
  double least = HUGE_VAL, most = -HUGE_VAL;
};

// What the first state is during some runs.
Extent Sample(const System& s, uint64_t seed) {
  std::mt19937_64 random(seed);
  Extent extent;
  for (int run = 0; run < 120; ++run) {
    State x;
    for (const auto& [low, high] : s.starts) {
      const double share = static_cast<double>(random() >> 11) * 0x1p-53;
      x.push_back(low + (run < 60 ? std::round(share) : share) * (high - low));
    }
    State rate(x.size(), 0.0), middle(x.size()), first(x.size(), 0.0);
    int mode = 0;
    double input = 0, w = run % 3 == 0 ? s.disturbance : -s.disturbance, next_sample = 0;
    const double step = s.horizon / 4000;
    for (int k = 0; k <= 4000; ++k) {
      const double now = k * step;
      if (s.period > 0 && now >= next_sample) {
        input = s.law(x);
        next_sample += s.period;
      }
      mode = s.next(x, mode);
      if (run % 3 == 2 && k % 200 == 0) w = random() % 2 == 0 ? s.disturbance : -s.disturbance;
      extent.least = std::min(extent.least, x[0]);
      extent.most = std::max(extent.most, x[0]);
      s.rates(x, mode, input, w, first);
      for (size_t i = 0; i < x.size(); ++i) middle[i] = x[i] + step / 2 * first[i];
      s.rates(middle, mode, input, w, rate);
      for (size_t i = 0; i < x.size(); ++i) x[i] += step * rate[i];
    }
  }
  return extent;
}

enum class Answer : uint8_t { kProved, kRefuted, kUnknown, kRejected };
struct Decided {
  Answer answer = Answer::kRejected;
  bool certified = false;
};

Decided Decide(const System& s, bool upper, double bound) {
  std::string text = s.text;
  const std::string_view place = "CLAIM";
  text.replace(text.find(place), place.size(), fmt::format("x {} {:.6f}", upper ? "<=" : ">=", bound));
  fixtures::TemporaryFolder folder;
  workspace::Session session;
  contracts::LoadedContracts loaded;
  const std::string file = folder.Write("p.rondo", text);
  if (!contracts::LoadContracts({file}, "", nullptr, true, session, loaded) || loaded.results.empty()) {
    ADD_FAILURE() << text;
    return {};
  }
  contracts::ContractResult& result = loaded.results[0];
  const bool wanted = std::getenv("RONDO_CASES") != nullptr;
  contracts::DecideOptions options;
  options.jobs = 1;
  options.timeout = wanted ? 20 : 3;
  contracts::DecideContract(result, options, base::StopToken());
  if (!result.outcome) return {};
  const verdict::Verdict verdict = reach::VerdictOf(*result.outcome);
  if (verdict == verdict::Verdict::kRefuted) return {Answer::kRefuted, false};
  if (verdict != verdict::Verdict::kProved) return {Answer::kUnknown, false};
  contracts::CertifyContract(result, contracts::CertificateOf(std::get<reach::Proved>(*result.outcome)), 1,
                             base::StopToken());
  return {Answer::kProved, result.IsCertified()};
}

TEST(Hybrid, WhatSamplesBreakIsNeverProved) {
  const char* wanted = std::getenv("RONDO_CASES");
  const uint64_t each =
      wanted == nullptr ? 2 : std::max<uint64_t>(2, std::strtoull(wanted, nullptr, 10) / 1600);
  int faults = 0, refuted = 0, twins = 0, proved = 0, certified = 0;
  std::map<std::string_view, int> missed, open, uncertified;
  for (size_t shape = 0; shape < kNames.size(); ++shape) {
    for (uint64_t seed = 1; seed <= each; ++seed) {
      const System s = Draw(static_cast<Shape>(shape), seed * 97 + shape);
      const Extent extent = Sample(s, seed);
      const bool upper = seed % 2 == 0;
      const double size = extent.most - extent.least;
      const double share = 0.05 + 0.25 * static_cast<double>(seed % 7) / 7;
      const double edge = upper ? extent.most : extent.least;
      const double outward = upper ? size : -size;
      const Decided faulty = Decide(s, upper, edge - share * outward);
      EXPECT_NE(faulty.answer, Answer::kProved) << kNames[shape] << ", seed " << seed << "\n" << s.text;
      ++faults;
      refuted += faulty.answer == Answer::kRefuted ? 1 : 0;
      if (faulty.answer != Answer::kRefuted) ++missed[kNames[shape]];
      const Decided safe = Decide(s, upper, edge + (0.1 + share) * outward);
      EXPECT_TRUE(safe.answer == Answer::kProved || safe.answer == Answer::kUnknown)
          << kNames[shape] << " (safe), seed " << seed << "\n"
          << s.text;
      ++twins;
      proved += safe.answer == Answer::kProved ? 1 : 0;
      certified += safe.certified ? 1 : 0;
      if (safe.answer == Answer::kUnknown) ++open[kNames[shape]];
      if (safe.answer == Answer::kProved && !safe.certified) ++uncertified[kNames[shape]];
    }
  }
  for (const auto& [name, count] : missed)
    std::printf("faults that are not refuted: %s %d\n", name.data(), count);
  for (const auto& [name, count] : open)
    std::printf("twins that are not decided: %s %d\n", name.data(), count);
  for (const auto& [name, count] : uncertified) std::printf("not certified: %s %d\n", name.data(), count);
  std::printf("%d of %d faults refuted, %d of %d twins proved, %d of these certified\n", refuted, faults,
              proved, twins, certified);
  EXPECT_GE(refuted * 20, faults * 19);
}

}  // namespace
}  // namespace rondo
