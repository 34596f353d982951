// Tubes against trajectories: nothing that a controlled system can do is outside of what was computed. The
// trajectories come from an integrator that shares no code with the tubes (Runge-Kutta-Fehlberg,
// Boost.Odeint). RONDO_AUDIT: how many trajectories for each problem; 1000 by default.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "contracts/decide.h"
#include "contracts/load.h"

namespace rondo {
namespace {

size_t Wanted() {
  const char* text = std::getenv("RONDO_AUDIT");
  return text != nullptr ? std::strtoul(text, nullptr, 10) : 1000;
}

// Proofs of many seconds, which are looked at with RONDO_AUDIT only (`./dev nightly`).
bool IsLong(const std::string& contract) {
  return std::getenv("RONDO_AUDIT") == nullptr && contract.starts_with("Chaser: Abort") &&
         contract != "Chaser: AbortAt(loss)";
}

struct Loaded {
  workspace::Session session;
  std::unique_ptr<workspace::LoadedModule> module;
  std::vector<contracts::ContractResult> contracts;
};

std::unique_ptr<Loaded> Load(const std::string& file) {
  auto loaded = std::make_unique<Loaded>();
  loaded->module = workspace::LoadModule({file}, {}, loaded->session);
  if (loaded->module && loaded->module->declarations)
    loaded->contracts = contracts::ContractsOf(*loaded->module);
  return loaded;
}

// A start in the initial box: corners first, then anywhere.
std::vector<double> Draw(const interval::Box& box, size_t number, std::mt19937_64& random) {
  std::vector<double> x;
  size_t free = 0;
  for (const interval::Interval& side : box) free += side.Width() > 1e-13 ? 1 : 0;
  const bool corner = number < 64 || number % 2 == 0;
  size_t bit = 0;
  for (const interval::Interval& side : box) {
    if (!(side.Width() > 1e-13)) {
      x.push_back(side.Middle());
      continue;
    }
    const bool up = free <= 6 && number < 64 ? (number >> bit) % 2 == 1 : random() % 2 == 1;
    ++bit;
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    x.push_back(corner ? (up ? side.hi : side.lo) : side.lo + u * (side.hi - side.lo));
  }
  return x;
}

bool IsPoint(const reach::Problem& p) {
  for (const interval::Interval& side : p.initial) {
    if (side.Width() > 1e-13) return false;
  }
  return p.inputs.empty();
}

size_t LeafOf(const reach::Proved& proved, const std::vector<double>& start) {
  for (size_t l = 0; l < proved.leaves.size(); ++l) {
    bool inside = true;
    for (size_t i = 0; i < start.size(); ++i)
      inside = inside && proved.leaves[l].initial[i].Contains(start[i]);
    if (inside) return l;
  }
  return proved.leaves.size();
}

// The segments of a tube by the time that they may be about: where events happen, they overlap.
class Tube {
 public:
  Tube(const reach::Leaf& leaf, double horizon) : slice_(horizon / kSlices), slices_(kSlices + 2) {
    for (const reach::TubeSegment& s : leaf.tube) {
      for (size_t k = Slice(s.from - kLate); k <= Slice(s.to + kLate); ++k) slices_[k].push_back(&s);
    }
  }

  bool Holds(double t, std::span<const double> x) const {
    return std::ranges::any_of(slices_[Slice(t)], [&](const reach::TubeSegment* s) {
      if (t < s->from - kLate || t > s->to + kLate) return false;
      for (size_t i = 0; i < x.size(); ++i) {
        const double slack = 1e-9 * (1 + std::fabs(x[i]));  // of the trajectory
        if (x[i] < s->during[i].lo - slack || x[i] > s->during[i].hi + slack) return false;
      }
      return true;
    });
  }

 private:
  static constexpr size_t kSlices = 1000;
  static constexpr double kLate = 1e-9;  // of instants
  size_t Slice(double t) const {
    return std::min(kSlices + 1, static_cast<size_t>(std::fmax(0, t) / slice_));
  }
  double slice_;
  std::vector<std::vector<const reach::TubeSegment*>> slices_;
};

class Audit : public testing::TestWithParam<std::string> {};

TEST_P(Audit, NoTrajectoryLeavesItsTube) {
  const auto loaded = Load(GetParam());
  ASSERT_FALSE(loaded->contracts.empty());
  for (contracts::ContractResult& contract : loaded->contracts) {
    const reach::Problem& problem = contract.made.problem;
    ASSERT_TRUE(contract.impossible.empty()) << problem.name << ": " << contract.impossible;
    if (IsLong(problem.name)) continue;
    reach::ProverOptions options;
    options.jobs = 2;
    auto outcome = reach::Decide(problem, options, base::StopToken());
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    const auto* proved = std::get_if<reach::Proved>(&outcome.value());
    if (proved == nullptr) continue;  // what is refuted has no tube
    auto trajectories = reach::Trajectories::Of(problem);
    ASSERT_TRUE(trajectories.ok());
    auto run = std::move(trajectories).value();
    std::mt19937_64 random(20261122);
    const size_t count = IsPoint(problem) ? 1 : Wanted();
    std::vector<Tube> tubes;
    for (const reach::Leaf& l : proved->leaves) tubes.emplace_back(l, problem.horizon.ToDouble());
    for (size_t number = 0; number < count; ++number) {
      reach::Execution execution;
      execution.start = Draw(problem.initial, number, random);
      execution.input_period = problem.horizon.ToDouble() / 12;
      for (int slot = 0; slot < 12 && !problem.inputs.empty(); ++slot) {
        std::vector<double> values;
        for (const reach::Input& i : problem.inputs)
          values.push_back(random() % 2 == 0 ? i.bounds.lo : i.bounds.hi);
        execution.inputs.push_back(values);
      }
      const size_t leaf = LeafOf(*proved, execution.start);
      ASSERT_LT(leaf, tubes.size()) << problem.name;
      bool escaped = false;
      const bool finished =
          run.Run(execution, problem.horizon.ToDouble() / 300, [&](double t, std::span<const double> x) {
            // A controller acts before the first segment begins.
            if (tubes[leaf].Holds(t, x) || (t == 0 && problem.controller)) return true;
            escaped = true;
            ADD_FAILURE() << problem.name << ": trajectory " << number << " is outside after " << t << " s";
            return false;
          });
      ASSERT_TRUE(finished) << problem.name;
      if (escaped) break;
    }
  }
}

std::vector<std::string> Files() {
  std::vector<std::string> files{"models/car.rondo", "models/driven.rondo", "models/quadrotor.rondo"};
  for (const auto& entry : std::filesystem::directory_iterator("examples/reach")) {
    if (entry.path().extension() == ".rondo") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Files, Audit, testing::ValuesIn(Files()),
                         [](const auto& file) { return std::filesystem::path(file.param).stem().string(); });

// Where a parameter does not matter, its contract is proved for one value of it: trajectories keep it for
// others.
TEST(Symmetry, OtherPlacesKeepTheContract) {
  const auto loaded = Load("models/car.rondo");
  const std::string name = "Car: FollowLine(x0, y0, heading)";
  const auto find = [&](const std::vector<contracts::ContractResult>& all) {
    return *std::ranges::find(all, name, [](const auto& r) { return r.made.problem.name; });
  };
  const contracts::ContractResult reduced = find(loaded->contracts);
  EXPECT_EQ(reduced.anywhere, (std::vector<std::string>{"x0", "y0", "heading"}));
  const auto outcome = reach::Decide(reduced.made.problem, {}, base::StopToken());
  ASSERT_TRUE(outcome.ok() && std::holds_alternative<reach::Proved>(outcome.value()));
  const contracts::ContractResult whole = find(contracts::ContractsOf(*loaded->module, false));
  auto trajectories = reach::Trajectories::Of(whole.made.problem);
  ASSERT_TRUE(trajectories.ok());
  auto run = std::move(trajectories).value();
  std::mt19937_64 random(20261123);
  size_t looked_at = 0;
  while (looked_at < Wanted() / 10) {
    reach::Execution execution;
    execution.start = Draw(whole.made.problem.initial, 65, random);
    // Near its own line.
    const auto at = [&](const char* state) -> double& {
      return execution
          .start[static_cast<size_t>(std::ranges::find(whole.made.names, state) - whole.made.names.begin())];
    };
    at("x") = at("x0") + 0.1 * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    at("y") = at("y0") + 0.1 * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    at("theta") = at("heading") + 0.087 * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    if (run.MissAssumed(execution.start) > 0) continue;
    ++looked_at;
    const reach::Violation worst = run.Worst(execution, 0.05, 0, 1e-10, base::StopToken());
    ASSERT_LE(worst.miss, 0) << "heading " << at("heading");
  }
}

// Much sharper than boxes: at each step the polynomials say where the trajectory with these symbols is, up to
// an error.
TEST(Polynomials, FollowEachTrajectory) {
  for (const char* name : {"laub_loomis", "van_der_pol", "coupled_van_der_pol_2023", "production_destruction",
                           "quadrotor_altitude"}) {
    const auto loaded = Load(fmt::format("examples/reach/{}.rondo", name));
    const reach::Problem& problem = loaded->contracts.back().made.problem;
    auto program = reach::Compile(*problem.arena, problem.states, problem.rates);
    ASSERT_TRUE(program.ok());
    const reach::Dynamics dynamics{std::move(program).value(), problem.states.size(), {}};
    interval::Box box = problem.initial;
    std::vector<int> symbol_of;
    int symbols = 0;
    for (interval::Interval& side : box) {
      const bool free = side.Width() > 1e-13;
      if (free) {  // a tenth of it: the whole may need to be split
        const double middle = side.Middle();
        side = {middle - 0.05 * side.Width(), middle + 0.05 * side.Width()};
      }
      symbol_of.push_back(free ? symbols++ : -1);
    }
    auto monomials = std::make_shared<reach::Monomials>(static_cast<size_t>(symbols));
    const double horizon = std::min(5.0, problem.horizon.ToDouble());
    reach::Problem shorter = problem;
    shorter.horizon = expr::Rational(5);
    if (problem.horizon < shorter.horizon) shorter.horizon = problem.horizon;
    auto trajectories = reach::Trajectories::Of(shorter);
    ASSERT_TRUE(trajectories.ok());
    auto run = std::move(trajectories).value();
    std::mt19937_64 random(7);
    std::vector<std::vector<double>> starts, symbol_values;
    for (size_t k = 0; k < 8; ++k) {
      std::vector<double> start, values;
      for (size_t i = 0; i < box.size(); ++i) {
        if (symbol_of[i] < 0) {
          start.push_back(box[i].Middle());
          continue;
        }
        const double s = k < 4 ? (k % 2 == 0 ? 1 : -1) : static_cast<double>(random() >> 11) * 0x1p-52 - 1;
        values.push_back(s);
        start.push_back(box[i].Middle() + s * (box[i].hi - box[i].Middle()));
      }
      starts.push_back(start);
      symbol_values.push_back(values);
    }
    // The trajectories on a grid; steps are checked at the grid points in them.
    constexpr size_t kGrid = 80;
    std::vector<std::vector<std::vector<double>>> states(starts.size());
    for (size_t k = 0; k < starts.size(); ++k) {
      run.Run({starts[k], {}, 1}, horizon / kGrid, [&](double, std::span<const double> x) {
        states[k].emplace_back(x.begin(), x.end());
        return true;
      });
      ASSERT_GE(states[k].size(), kGrid);
    }
    reach::Flow flow(dynamics, monomials, {}, horizon);
    flow.Start(reach::FromBox(box, *monomials, symbol_of), 0);
    size_t checked = 0;
    while (flow.time() < horizon) {
      ASSERT_TRUE(flow.Step(horizon)) << name << " at " << flow.time();
      for (size_t g = 0; g < kGrid; ++g) {
        const double t = horizon * static_cast<double>(g) / kGrid;
        if (t < flow.begin() || t > flow.time()) continue;
        for (size_t k = 0; k < starts.size(); ++k) {
          for (size_t i = 0; i < box.size(); ++i) {
            const interval::Interval range = flow.stepper().StateAt(i, symbol_values[k], t - flow.begin());
            const double x = states[k][g][i];
            const double slack = 1e-10 * (1 + std::fabs(x));
            ASSERT_LE(range.lo - slack, x) << name << " state " << i << " at " << t;
            ASSERT_GE(range.hi + slack, x) << name << " state " << i << " at " << t;
            ++checked;
          }
        }
      }
    }
    EXPECT_GT(checked, 1000u) << name;
  }
}

}  // namespace
}  // namespace rondo
