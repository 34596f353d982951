// How long a step of a robot takes: the effects of one robot in a state, by the machine and by C++ that `rondo build` made, in states
// that runs reach. External functions answer at once, the same to both. With --check it only makes sure that C++ takes no memory.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <new>
#include <random>

#include "koord/delivery.h"
#include "koord/mapping.h"
#include "koord/native/state_bytes.h"
#include "koord/semantics/program_transition.h"
#include "program/codec.h"
#include "runs/build.h"

static size_t allocations = 0;
void* operator new(size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) std::abort();
  return memory;
}
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace {

using rondo::koord::semantics::Word;
using rondo::program::Answer;
using rondo::program::List;
using rondo::program::Pos;

constexpr size_t kRobots = 8;

const List<Pos, 16> kPath{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {3, 2, 0}, {4, 5, 0}};

struct DeliveryAnswers final : koord::delivery::Calls {
  Answer Motion_planner(int64_t, const Pos&, List<Pos, 16>& path) noexcept override {
    path = kPath;
    return Answer::kValue;
  }
  Answer pathIsClear(int64_t, const std::array<List<Pos, 16>, kRobots>&, const List<Pos, 16>&, int64_t,
                     bool& clear) noexcept override {
    clear = true;
    return Answer::kValue;
  }
  Answer away(int64_t, const Pos&, const List<Pos, 16>&, double&) noexcept override { return Answer::kNone; }
  Answer apart(int64_t, const List<Pos, 16>&, const List<Pos, 16>&, double&) noexcept override {
    return Answer::kNone;
  }
};

struct MappingAnswers final : koord::mapping::Calls {
  using Map = rondo::program::Opaque<16>;
  Answer pickFrontierPos(int64_t, const Map&, const Pos& from, Pos& to) noexcept override {
    to = from;
    return Answer::kValue;
  }
  Answer findObs(int64_t, const Map& map, List<Map, 16>& cells) noexcept override {
    cells.Clear();
    cells.Append(map);
    return Answer::kValue;
  }
  Answer MotionWithScan_planner(int64_t, const Pos&, const List<Map, 16>&,
                                List<Pos, 16>& path) noexcept override {
    path = kPath;
    return Answer::kValue;
  }
  Answer scanToMap(int64_t, const Pos&, const Map& scan, Map& map) noexcept override {
    map = scan;
    return Answer::kValue;
  }
  Answer merge(int64_t, const Map& a, const Map&, Map& both) noexcept override {
    both = a;
    return Answer::kValue;
  }
  Answer right(int64_t, const Map&, bool&) noexcept override { return Answer::kNone; }
  Answer true_scan(int64_t, const Pos&, const Map&, bool&) noexcept override { return Answer::kNone; }
};

// Answers the machine as the classes above do, as fast as it can.
class Host final : public rondo::koord::semantics::Host {
 public:
  explicit Host(rondo::koord::semantics::Team& team) : heap_(team.heap()) {
    std::vector<Word> path;
    for (const Pos& p : kPath) {
      for (const double x : {p.x, p.y, p.z}) path.push_back(rondo::koord::semantics::FromFloat(x));
    }
    path_ = heap_.Intern(path);
    for (const auto& function : team.model().functions) {
      kinds_.push_back(function.name == "pathIsClear"       ? kYes
                       : function.name == "findObs"         ? kOneCell
                       : function.name == "pickFrontierPos" ? kPoint
                       : function.name == "scanToMap"       ? kScan
                       : function.name.ends_with("planner") ? kWay
                                                            : kFirst);
    }
  }
  rondo::koord::semantics::Answer Call(size_t f, size_t, std::span<const Word> arguments,
                                       std::span<Word> result) override {
    switch (kinds_[f]) {
      case kYes:
        result[0] = 1;
        break;
      case kOneCell:
        result[0] = heap_.Intern(arguments.first(1));
        break;
      case kWay:
        result[0] = path_;
        break;
      case kPoint:
        std::copy_n(arguments.begin() + 1, 3, result.begin());
        break;
      case kScan:
        result[0] = arguments[3];
        break;
      case kFirst:
        result[0] = arguments[0];
        break;
    }
    return rondo::koord::semantics::Answer::kValue;
  }
  void Log(size_t, size_t, std::span<const Word>) override {}

 private:
  enum Kind { kYes, kOneCell, kWay, kPoint, kScan, kFirst };
  rondo::koord::semantics::Heap& heap_;
  Word path_ = 0;
  std::vector<Kind> kinds_;
};

// Sensors of the programs: positions, whether the robot is there, and scans.
void Sense(rondo::koord::semantics::Team& team, std::mt19937_64& random, std::vector<Word>& state) {
  const auto& model = team.model();
  for (size_t v = 0; v < model.variables.size(); ++v) {
    if (model.variables[v].kind != rondo::koord::VariableKind::kSensor || !team.layout()[v].exists) continue;
    for (size_t r = 0; r < team.robots(); ++r) {
      Word* at = &state[team.layout().Address(v, r)];
      if (model.variables[v].name.ends_with("psn")) {
        for (int k = 0; k < 3; ++k)
          at[k] = rondo::koord::semantics::FromFloat(static_cast<double>(random() % 50) / 4);
      } else if (model.variables[v].name.ends_with("reached")) {
        at[0] = random() % 2;
      } else {
        const Word scan = team.heap().Intern(std::vector<Word>{1, 2, 3, 4});
        at[0] = team.heap().Intern(std::vector<Word>{0, 0, 0, scan, 0, 0, 0, scan});
      }
    }
  }
}

std::vector<std::vector<Word>> States(rondo::koord::semantics::Team& team, const char* tasks) {
  std::mt19937_64 random(1);
  std::vector<std::vector<Word>> states;
  rondo::koord::semantics::ProgramTransition transition(team);
  while (states.size() < 200) {
    std::vector<Word> state = team.blank();
    for (size_t v = 0; v < team.model().variables.size(); ++v) {
      if (team.model().variables[v].name != tasks) continue;
      std::vector<Word> list;
      for (Word id = 0; id < 12; ++id) {
        list.push_back(id);
        for (int k = 0; k < 3; ++k)
          list.push_back(rondo::koord::semantics::FromFloat(static_cast<double>(random() % 50)));
      }
      state[team.layout().Address(v, 0)] = team.heap().Intern(list);
    }
    for (int round = 0; round < 20 && states.size() < 200; ++round) {
      Sense(team, random, state);
      states.push_back(state);
      transition.Prepare(state);
      // Everybody who can acts: the last state that is visited.
      transition.Enumerate([&](std::span<const Word> next, bool) {
        state.assign(next.begin(), next.end());
        return random() % 64 != 0;
      });
    }
  }
  return states;
}

double Since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <typename P>
struct Typed {
  typename P::Shared shared;
  std::array<typename P::Local, kRobots> local;
  std::array<typename P::In, kRobots> in;
  std::array<typename P::Out, kRobots> out;
};

template <typename P, typename Answers>
bool Measure(const char* name, const char* tasks, bool check) {
  rondo::workspace::Session session;
  const std::string file = std::string("examples/koord/") + name + ".koord";
  auto source = rondo::runs::LoadToBuild(
      {file, "", std::string("examples/koord/") + name + ".toml", kRobots, {16, {}}}, session);
  if (!source) return fmt::print("{} cannot be loaded\n", file), false;
  rondo::koord::semantics::Team& team = *source->team;
  Host host(team);
  team.machine().SetHost(&host);
  const auto states = States(team, tasks);
  rondo::koord::native::StateBytes bytes(team);
  std::vector<Typed<P>> typed(states.size());
  for (size_t k = 0; k < states.size(); ++k) {
    rondo::runtime::codec::Bytes encoded;
    bytes.Encode(states[k], encoded);
    rondo::program::ByteReader reader(encoded);
    const auto read = [&](auto& value) { reader.Value(value); };
    P::EachShared(typed[k].shared, read);
    for (size_t r = 0; r < kRobots; ++r)
      P::EachOwn(r, typed[k].shared, typed[k].local[r], typed[k].in[r], typed[k].out[r], read);
    if (!reader.Complete()) return fmt::print("a state of {} does not fit\n", name), false;
  }
  Answers answers;
  std::vector<typename P::Effect> effects(P::kEvents.size());
  const uint64_t steps = check ? 200'000 : 4'000'000;
  uint64_t found = 0;
  const size_t before = allocations;
  auto begin = std::chrono::steady_clock::now();
  for (uint64_t k = 0; k < steps; ++k) {
    Typed<P>& t = typed[k / kRobots % typed.size()];
    const size_t r = k % kRobots;
    found += P::Effects({static_cast<int64_t>(r), t.shared, t.local[r], t.in[r], t.out[r]}, answers, nullptr,
                        effects);
  }
  const double cpp = Since(begin) / static_cast<double>(steps);
  const size_t taken = allocations - before;
  rondo::koord::semantics::ProgramTransition transition(team);
  const uint64_t fewer = steps / 20;
  uint64_t again = 0;
  begin = std::chrono::steady_clock::now();
  for (uint64_t k = 0; k < fewer; ++k) {
    transition.Prepare(states[k / kRobots % states.size()], k % kRobots);
    again += transition.Of(k % kRobots).size();
  }
  const double machine = Since(begin) / static_cast<double>(fewer);
  if (check) {
    if (taken != 0) fmt::print("{}: {} steps took memory {} times\n", name, steps, taken);
    return taken == 0 && found > 0 && again > 0;
  }
  fmt::print(
      "{:10} {:8.0f} ns by the machine {:8.1f} ns as C++ {:6.1f} times faster; {} allocations in {} steps, {:.2f} effects each\n",
      name, 1e9 * machine, 1e9 * cpp, machine / cpp, taken, steps,
      static_cast<double>(found) / static_cast<double>(steps));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const bool check = argc > 1 && std::string_view(argv[1]) == "--check";
  const bool good = Measure<koord::delivery::Program, DeliveryAnswers>("delivery", "all_tasks", check);
  return Measure<koord::mapping::Program, MappingAnswers>("mapping", "", check) && good ? 0 : 1;
}
