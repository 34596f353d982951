// Programs as C++ (`codegen`) do what the machine does: everything that each robot could do, what a round makes of it, and what
// the specification says of it, in states that runs reach and in random ones. All programs are one library, which is compiled here.
#include "runs/build.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "build_programs.h"
#include "codegen/koord/generate.h"
#include "koord/native/state_bytes.h"
#include "koord/semantics/fallback.h"
#include "koord/semantics/program_transition.h"
#include "koord_texts.h"
#include "program/core.h"

namespace rondo::koord {
namespace {

using program::Answer;
using program::Core;
using program::CoreEffect;
using runtime::codec::Bytes;
using semantics::Effect;
using semantics::Layout;
using semantics::Team;
using semantics::Word;

constexpr uint32_t kCapacity = 64;

/// A program, a team of it, and its C++.
struct Case {
  std::unique_ptr<Loaded> loaded;  // nullptr for examples
  std::unique_ptr<workspace::Session> session;
  std::optional<runs::BuildSource> example;
  std::unique_ptr<Team> own;
  codegen::GeneratedProgram cpp;

  Team& team() const { return example ? *example->team : *own; }
  const diag::SourceSet& sources() const { return example ? session->sources : loaded->sources; }
  std::string_view text() const { return sources().text(team().model().program->Files()[0]); }
};

std::unique_ptr<Team> TeamOf(const Model& model, size_t robots, diag::Diagnostics& diagnostics) {
  semantics::TeamOptions options;
  options.robots = robots;
  options.hosted = [](size_t) { return true; };
  return Team::Make(model, options, diagnostics);
}

// What a question is answered with follows from the question alone.
class World {
 public:
  explicit World(const Team& team) : team_(team) {}

  Answer Ask(size_t f, int64_t robot, std::span<const uint8_t> arguments, semantics::Heap& heap,
             std::vector<Word>& result) {
    std::mt19937_64 random(runtime::codec::Sum(arguments) + 977 * f + static_cast<uint64_t>(robot));
    const uint64_t kind = random() % 12;
    if (kind < 2) return kind == 0 ? Answer::kNone : Answer::kLater;
    result = Random(team_.model().functions[f].result, random, heap);
    return Answer::kValue;
  }

  // A value of a type: small, mostly.
  std::vector<Word> Random(TypeId type, std::mt19937_64& random, semantics::Heap& heap) const {
    const auto& types = team_.model().types;
    const lang::Type& t = types[type];
    std::vector<Word> words;
    const auto pick = [&](uint64_t n) { return random() % n; };
    switch (t.kind) {
      case lang::TypeKind::kBool:
        return {pick(2)};
      case lang::TypeKind::kEnum:
        return {pick(t.fields.size())};
      case lang::TypeKind::kFloat: {
        constexpr double kValues[] = {0, 0, 0.5, 1, 1, 2, -1, -0.25, 3.75, 1e-9, 1e6, 1e200, -1e308};
        return {semantics::FromFloat(kValues[pick(std::size(kValues))])};
      }
      case lang::TypeKind::kString: {
        constexpr const char* kTexts[] = {"", "none", "a", "n is 1, x is 1!"};
        return {heap.InternText(kTexts[pick(std::size(kTexts))])};
      }
      case lang::TypeKind::kRecord:
      case lang::TypeKind::kTuple:
        for (const TypeId part : t.parts) {
          const auto more = Random(part, random, heap);
          words.insert(words.end(), more.begin(), more.end());
        }
        return words;
      case lang::TypeKind::kList:
      case lang::TypeKind::kArray: {
        const size_t size = t.kind == lang::TypeKind::kArray ? team_.lengths().at(t.length) : pick(4);
        for (size_t k = 0; k < size; ++k) {
          const auto more = Random(t.parts[0], random, heap);
          words.insert(words.end(), more.begin(), more.end());
        }
        return {heap.Intern(words)};
      }
      case lang::TypeKind::kOpaque:
        for (size_t k = pick(3); k > 0; --k) words.push_back(pick(5));
        return {heap.Intern(words)};
      default: {
        constexpr int64_t kValues[] = {0, 0, 0, 1, 1, 1, 2, 2, 3, -1, 4, INT64_MAX, INT64_MIN, -7};
        return {semantics::FromInt(kValues[pick(std::size(kValues))])};
      }
    }
  }

 private:
  const Team& team_;
};

/// Answers for the machine.
class MachineHost final : public semantics::Host {
 public:
  MachineHost(World& world, Team& team) : world_(world), team_(team) {}
  semantics::Answer Call(size_t f, size_t robot, std::span<const Word> arguments,
                         std::span<Word> result) override {
    Bytes bytes;
    runtime::codec::Writer writer(bytes);
    const Function& function = team_.model().functions[f];
    const auto& types = team_.model().types;
    size_t at = 0;
    for (const TypeId parameter : function.parameters) {
      const uint32_t width = Layout::Width(types, parameter);
      node::EncodeValue(types, team_.heap(), parameter, arguments.subspan(at, width), writer);
      at += width;
    }
    std::vector<Word> words;
    const Answer answer = world_.Ask(f, static_cast<int64_t>(robot), bytes, team_.heap(), words);
    if (answer == Answer::kValue) std::copy(words.begin(), words.end(), result.begin());
    return answer == Answer::kValue  ? semantics::Answer::kValue
           : answer == Answer::kNone ? semantics::Answer::kNone
                                     : semantics::Answer::kLater;
  }
  void Log(size_t, size_t, std::span<const Word>) override {}

 private:
  World& world_;
  Team& team_;
};

/// Answers for the C++, and chooses as it is told.
class CppHost final : public program::CoreHost {
 public:
  CppHost(World& world, Team& team, const Core& core) : world_(world), team_(team) {
    for (const std::string& name : core.questions()) {
      for (size_t f = 0; f < team.model().functions.size(); ++f) {
        if (team.model().functions[f].name == name) functions_.push_back(f);
      }
    }
  }
  Answer Ask(size_t number, int64_t robot, std::span<const uint8_t> arguments,
             program::Bytes& result) noexcept override {
    const size_t f = functions_[number];
    std::vector<Word> words;
    const Answer answer = world_.Ask(f, robot, arguments, team_.heap(), words);
    runtime::codec::Writer writer(result);
    if (answer == Answer::kValue)
      node::EncodeValue(team_.model().types, team_.heap(), team_.model().functions[f].result, words, writer);
    return answer;
  }
  uint64_t Pick(uint64_t possibilities) noexcept override {
    if (met_ == picks_.size()) picks_.push_back({0, possibilities});
    return picks_[met_++].first;
  }

  void Begin() { picks_.clear(); }
  void Again() { met_ = 0; }
  bool Next() {
    while (!picks_.empty() && picks_.back().first + 1 >= picks_.back().second) picks_.pop_back();
    if (picks_.empty()) return false;
    ++picks_.back().first;
    return true;
  }

 private:
  World& world_;
  Team& team_;
  std::vector<size_t> functions_;
  std::vector<std::pair<uint64_t, uint64_t>> picks_;
  size_t met_ = 0;
};

/// Compares one program with its C++.
class Comparison {
 public:
  Comparison(Case& c, Core& core, uint64_t seed)
      : team_(c.team()),
        sources_(c.sources()),
        core_(core),
        bytes_(team_),
        world_(team_),
        machine_host_(world_, team_),
        host_(world_, team_, core),
        transition_(team_),
        random_(seed) {
    team_.machine().SetHost(&machine_host_);
    team_.machine().KeepSaid(true);
  }

  void Run(size_t states, size_t rounds) {
    std::vector<Word> state = Beginning();
    Init(state);
    for (size_t round = 0; round < rounds && !::testing::Test::HasFailure(); ++round) state = Round(state);
    for (size_t k = 0; k < states && !::testing::Test::HasFailure(); ++k) Round(RandomState());
  }

  std::vector<uint64_t> faults = std::vector<uint64_t>(20);
  uint64_t compared = 0, merged = 0;

 private:
  std::vector<Word> RandomState() {
    std::vector<Word> state = team_.blank();
    for (size_t v = 0; v < team_.model().variables.size(); ++v) {
      const Layout::Place& place = team_.layout()[v];
      if (!place.exists || team_.model().variables[v].kind == VariableKind::kParam) continue;
      for (size_t r = 0; r < (place.own ? team_.robots() : 1); ++r) {
        for (uint32_t at = 0; at < place.words(); at += std::max<uint32_t>(1, place.width)) {
          const auto value = world_.Random(place.item, random_, team_.heap());
          std::copy(value.begin(), value.end(), state.begin() + team_.layout().Address(v, r) + at);
        }
      }
    }
    return state;
  }

  Bytes Encode(std::span<const Word> state) {
    Bytes bytes;
    bytes_.Encode(state, bytes);
    return bytes;
  }
  std::vector<Word> Decode(const Bytes& bytes) {
    std::vector<Word> state = team_.blank();
    EXPECT_TRUE(bytes_.Decode(bytes, state));
    return state;
  }

  static program::Fault FaultOf(semantics::Fault fault) {
    using semantics::Fault;
    switch (fault) {
      case Fault::kNone:
        return program::Fault::kNone;
      case Fault::kIndex:
        return program::Fault::kIndex;
      case Fault::kDivision:
        return program::Fault::kDivision;
      case Fault::kRoot:
        return program::Fault::kRoot;
      case Fault::kRemove:
        return program::Fault::kRemove;
      case Fault::kReturn:
        return program::Fault::kReturn;
      case Fault::kOverflow:
        return program::Fault::kOverflow;
      case Fault::kExternal:
        return program::Fault::kExternal;
      case Fault::kNoValue:
        return program::Fault::kNoValue;
      case Fault::kTooLong:
        return program::Fault::kTooLong;
      case Fault::kTooMany:
        return program::Fault::kTooMany;
      case Fault::kNotYet:
        return program::Fault::kNotYet;
      case Fault::kLoop:
        return program::Fault::kLoop;
      case Fault::kRunaway:
        return program::Fault::kRunaway;
      case Fault::kGrid:
      case Fault::kNoLock:
        break;
    }
    ADD_FAILURE() << "an effect has a fault that it cannot have";
    return program::Fault::kNone;
  }

  void Same(const Effect& machine, const CoreEffect& cpp, size_t robot, std::span<const Word> state,
            const std::string& where) {
    ++compared;
    ++faults[static_cast<size_t>(cpp.fault)];
    ASSERT_EQ(machine.event, cpp.event) << where;
    ASSERT_EQ(machine.urgent, cpp.urgent) << where;
    const program::Fault fault = FaultOf(machine.fault);
    ASSERT_EQ(program::Describe(fault), program::Describe(cpp.fault)) << where << At(cpp.place);
    if (fault != program::Fault::kNone) {
      const diag::Position at = sources_.Locate(machine.fault_span.file, machine.fault_span.begin);
      const program::Place expected{at.line, at.column, machine.fault_span.end - machine.fault_span.begin,
                                    cpp.place.file};
      ASSERT_EQ(At(expected), At(cpp.place)) << where << program::Describe(fault);
      return;
    }
    ASSERT_EQ(machine.locks, cpp.locks) << where;
    std::map<uint32_t, Bytes> changes;
    for (const auto& change : cpp.changes) changes[change.cell] = change.value;
    ASSERT_EQ(bytes_.ChangesOf(machine, robot, state), changes) << where;
    std::vector<std::string> said;
    for (const auto& s : machine.said) said.push_back(team_.ShowLogged(s.type, s.value));
    ASSERT_EQ(said, cpp.said) << where;
  }
  static std::string At(program::Place place) {
    return fmt::format(" {}:{}+{} ", place.line, place.column, place.length);
  }

  // The values before `init`, with sensors of any value.
  std::vector<Word> Beginning() {
    std::vector<Word> state = team_.blank();
    const std::vector<Word> random = RandomState();
    for (size_t v = 0; v < team_.model().variables.size(); ++v) {
      if (team_.model().variables[v].kind != VariableKind::kSensor) continue;
      for (size_t r = 0; r < team_.robots(); ++r) {
        const uint32_t at = team_.layout().Address(v, r);
        std::copy_n(random.begin() + at, team_.layout()[v].words(), state.begin() + at);
      }
    }
    core_.Load(Encode(state));
    const bool good = core_.Begin(host_);
    bool all = true;
    team_.machine().SetMemory(state.data());
    for (const auto* codes : {&team_.declared(), &team_.derived()}) {
      for (const auto& code : *codes) {
        for (size_t r = 0; r < (team_.model().variables[code.variable].PerRobot() ? team_.robots() : 1);
             ++r) {
          if (team_.machine().Run(code.entry, r, false)) continue;
          team_.machine().Undo();
          all = false;
        }
      }
    }
    EXPECT_EQ(all, good);
    Bytes begun;
    core_.Save(begun);
    EXPECT_EQ(Encode(state), begun) << "the state before `init`";
    return state;
  }

  void Init(std::vector<Word>& state) {
    transition_.PrepareInit(state);
    core_.Load(Encode(state));
    for (size_t r = 0; r < team_.robots(); ++r) {
      host_.Begin();
      for (const Effect& effect : transition_.Of(r)) {
        host_.Again();
        Same(effect, core_.Init(r, host_), r, state, "init ");
        host_.Next();
      }
    }
    size_t failed = 0;
    if (transition_.Failed(&failed) != nullptr) return;
    transition_.Enumerate([&](std::span<const Word> next, bool) {
      state.assign(next.begin(), next.end());
      return false;
    });
  }

  std::vector<Word> Round(const std::vector<Word>& state) {
    const Bytes bytes = Encode(state);
    EXPECT_TRUE(core_.Load(bytes));
    transition_.Prepare(state);
    std::vector<std::vector<CoreEffect>> all(team_.robots());
    for (size_t r = 0; r < team_.robots(); ++r) {
      // With the first choices, as a robot runs it.
      host_.Begin();
      host_.Again();
      all[r] = core_.Effects(r, host_);
      size_t k = 0;
      const auto effects = transition_.Of(r);
      for (const CoreEffect& cpp : all[r]) {
        if (k >= effects.size()) {
          ADD_FAILURE() << "the C++ has event " << cpp.event << " enabled";
          return state;
        }
        const std::string where =
            team_.events()[effects[k].event].def->name + " of robot " + std::to_string(r) + ": ";
        Same(effects[k], cpp, r, state, where);
        if (::testing::Test::HasFailure()) return state;
        // The other choices of the same event.
        const uint32_t event = effects[k].event;
        host_.Begin();
        for (bool more = true; k < effects.size() && effects[k].event == event; ++k) {
          EXPECT_TRUE(more) << where << "fewer choices";
          if (cpp.ran) {
            host_.Again();
            Same(effects[k], core_.RunEvent(r, event, host_), r, state, where);
            more = host_.Next();
          }
          if (::testing::Test::HasFailure()) return state;
        }
      }
      EXPECT_EQ(k, effects.size()) << "the C++ has fewer events enabled";
    }
    Formulas(state);
    Fallback(state, bytes);
    return Merge(state, bytes, all);
  }

  // What the C++ makes of the round is among what can come of it.
  std::vector<Word> Merge(const std::vector<Word>& state, const Bytes& bytes,
                          const std::vector<std::vector<CoreEffect>>& all) {
    std::set<Bytes> possible;
    transition_.Prepare(state);
    size_t visited = 0;
    transition_.Enumerate([&](std::span<const Word> next, bool) {
      possible.insert(Encode(next));
      return ++visited < 500;
    });
    std::vector<Word> next = state;
    for (int repeat = 0; repeat < 3; ++repeat) {
      core_.Load(bytes);
      for (size_t r = 0; r < team_.robots(); ++r) {
        host_.Begin();
        host_.Again();
        core_.Effects(r, host_);
      }
      std::vector<Core::Wish> wishes;
      for (size_t r = 0; r < team_.robots(); ++r) {
        Core::Wish wish{r, {}};
        for (size_t k = 0; k < all[r].size(); ++k) {
          if (random_() % 3 != 0) wish.alternatives.push_back(k);
        }
        std::shuffle(wish.alternatives.begin(), wish.alternatives.end(), random_);
        wishes.push_back(wish);
      }
      std::shuffle(wishes.begin(), wishes.end(), random_);
      core_.Merge(wishes);
      Bytes after;
      core_.Save(after);
      next = Decode(after);
      if (visited >= 500) break;
      ++merged;
      EXPECT_TRUE(possible.contains(Encode(next))) << "the round is none that the semantics allows";
    }
    return next;
  }

  void Fallback(const std::vector<Word>& state, const Bytes& bytes) {
    for (size_t r = 0; r < team_.robots(); ++r) {
      std::vector<Word> machine = state;
      const bool good = semantics::FallBack(team_, machine, r);
      core_.Load(bytes);
      EXPECT_EQ(good, core_.FallBack(r, host_));
      Bytes after;
      core_.Save(after);
      EXPECT_EQ(Encode(machine), after) << "fallback of robot " << r;
    }
    core_.Load(bytes);
  }

  void Formulas(const std::vector<Word>& state) {
    team_.machine().SetMemory(const_cast<Word*>(state.data()));
    const auto compare = [&](const std::vector<semantics::FormulaCode>& formulas, Core::Kind kind) {
      const auto truths = core_.Holds(kind, host_);
      ASSERT_EQ(formulas.size(), truths.size());
      for (size_t i = 0; i < formulas.size(); ++i) {
        size_t robot = 0;
        bool defined = true;
        const bool holds = team_.Holds(formulas[i], &robot, &defined);
        ASSERT_EQ(holds, truths[i].holds) << formulas[i].name;
        ASSERT_EQ(defined, truths[i].defined) << formulas[i].name;
        if (!holds) {
          ASSERT_EQ(robot, static_cast<size_t>(truths[i].robot)) << formulas[i].name;
        }
      }
    };
    compare(team_.invariants(), Core::Kind::kInvariant);
    compare(team_.initially(), Core::Kind::kInitially);
    compare(team_.facts(), Core::Kind::kFact);
    compare(team_.port_facts(), Core::Kind::kPortFact);
    if (team_.promises().empty()) return;
    core_.Remember();
    std::vector<Word> later = RandomState();
    core_.Load(Encode(later));
    for (size_t r = 0; r < team_.robots(); ++r) {
      const auto told = core_.Promises(r, host_);
      for (size_t i = 0; i < told.size(); ++i) {
        const auto& promise = team_.promises()[i];
        team_.machine().SetMemory(const_cast<Word*>(state.data()));
        if (promise.when != 0) {
          EXPECT_EQ(team_.machine().RunFormula(promise.when, r), told[i].first.holds) << promise.name;
        }
        team_.machine().SetMemory(later.data(), state.data());
        EXPECT_EQ(team_.machine().RunFormula(promise.always, r), told[i].second.holds) << promise.name;
        EXPECT_EQ(team_.LastWasDefined(), told[i].second.defined) << promise.name;
      }
    }
    core_.Load(Encode(state));
  }

  Team& team_;
  const diag::SourceSet& sources_;
  Core& core_;
  native::StateBytes bytes_;
  World world_;
  MachineHost machine_host_;
  CppHost host_;
  semantics::ProgramTransition transition_;
  std::mt19937_64 random_;
};

/// Holds the C++ of all programs, compiled.
class Compiled {
 public:
  // Returns why not; empty if all is well.
  std::string Make(const std::vector<Case>& cases, const std::string& compiler) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        fmt::format("rondo-build-{}-{}", static_cast<int>(::getpid()), cases.size());
    std::filesystem::create_directories(folder);
    const size_t parts =
        std::max<size_t>(1, std::min<size_t>(std::thread::hardware_concurrency(), cases.size()));
    std::vector<std::string> texts(parts, "#include <rondo/program/core.h>\n");
    std::string table;
    for (size_t i = 0; i < cases.size(); ++i) {
      std::string& text = texts[i % parts];
      for (const std::string& part : {cases[i].cpp.header, cases[i].cpp.source, cases[i].cpp.core}) {
        std::istringstream lines(part);
        for (std::string line; std::getline(lines, line);) {
          if (!line.starts_with("#")) text += line + "\n";
        }
      }
      const std::string& name = cases[i].cpp.name;
      table +=
          fmt::format("namespace koord::{0} {{ std::unique_ptr<rondo::program::Core> MakeCore(); }}\n", name);
    }
    table += "extern \"C\" rondo::program::Core* MakeCore(size_t i) {\n  switch (i) {\n";
    for (size_t i = 0; i < cases.size(); ++i)
      table += fmt::format("    case {}: return koord::{}::MakeCore().release();\n", i, cases[i].cpp.name);
    texts[0] += table + "  }\n  return nullptr;\n}\n";
    std::string command = "set -e; ", objects;
    for (size_t p = 0; p < parts; ++p) {
      const std::string stem = (folder / fmt::format("part{}", p)).string();
      std::ofstream(stem + ".cc") << texts[p];
      command += fmt::format("{0} -c {1}.cc -o {1}.o & p{2}=$!; ", compiler, stem, p);
      objects += " " + stem + ".o";
    }
    for (size_t p = 0; p < parts; ++p) command += fmt::format("wait $p{}; ", p);
    const std::string library = (folder / "all.so").string();
    command += fmt::format("{} -shared{} -o {}", compiler, objects, library);
    if (std::system(command.c_str()) != 0) return "the C++ does not compile: " + folder.string();
    // Stays loaded: what it made may live longer.
    handle_ = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ == nullptr) return ::dlerror();
    make_ = reinterpret_cast<program::Core* (*)(size_t)>(::dlsym(handle_, "MakeCore"));
    if (std::getenv("RONDO_KEEP") == nullptr) std::filesystem::remove_all(folder);
    return make_ == nullptr ? "there is no MakeCore" : "";
  }
  std::unique_ptr<Core> CoreOf(size_t i) const { return std::unique_ptr<Core>(make_(i)); }

 private:
  void* handle_ = nullptr;
  program::Core* (*make_)(size_t) = nullptr;
};

void Finish(Case c, const std::string& name, std::vector<Case>& cases) {
  diag::Diagnostics diagnostics;
  c.cpp = codegen::Generate(c.team(), c.sources(), {name, {kCapacity, {}}}, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << name << ": " << diagnostics.all()[0].message;
  cases.push_back(std::move(c));
}

void Add(const std::string& text, const std::string& name, size_t robots, std::vector<Case>& cases) {
  Case c;
  c.loaded = std::make_unique<Loaded>(text);
  ASSERT_TRUE(c.loaded->good()) << name << ": " << c.loaded->diagnostics.all()[0].message << "\n" << text;
  diag::Diagnostics diagnostics;
  c.own = TeamOf(c.loaded->model, robots, diagnostics);
  ASSERT_NE(c.own, nullptr) << text;
  Finish(std::move(c), name, cases);
}

void AddExample(const std::filesystem::path& file, std::vector<Case>& cases) {
  Case c;
  c.session = std::make_unique<workspace::Session>();
  std::filesystem::path fleet = file;
  fleet.replace_extension(".toml");
  const std::string beside = std::filesystem::exists(fleet) ? fleet.string() : "";
  c.example = runs::LoadToBuild({file.string(), "", beside, 3, {}}, *c.session);
  ASSERT_TRUE(c.example) << file << ": " << c.session->diagnostics.all()[0].message;
  Finish(std::move(c), "example_" + file.stem().string(), cases);
}

/// Compares cases with their C++, and counts.
struct Tally {
  uint64_t compared = 0, merged = 0;
  std::vector<uint64_t> faults = std::vector<uint64_t>(20);
  std::set<semantics::Op> covered;

  void Compare(std::vector<Case>& cases, const char* compiler, size_t states, size_t rounds) {
    Compiled compiled;
    ASSERT_EQ(compiled.Make(cases, compiler), "");
    for (size_t i = 0; i < cases.size(); ++i) {
      const auto core = compiled.CoreOf(i);
      Comparison comparison(cases[i], *core, i + 1);
      comparison.Run(states, rounds);
      ASSERT_FALSE(::testing::Test::HasFailure()) << cases[i].cpp.name << "\n"
                                                  << cases[i].loaded->sources.text(cases[i].loaded->file);
      compared += comparison.compared;
      merged += comparison.merged;
      for (size_t f = 0; f < faults.size(); ++f) faults[f] += comparison.faults[f];
      for (const auto& instruction : cases[i].team().code().instructions) covered.insert(instruction.op);
    }
    fmt::print("{} programs, {} effects and {} rounds compared\n", cases.size(), compared, merged);
  }
};

TEST(BuildAgreement, ProgramsWithEverythingDoWhatTheMachineDoes) {
  std::vector<Case> cases, others;
  for (size_t i = 0; i < std::size(kBuildPrograms); ++i) {
    Add(std::string(kBuildPrograms[i]), fmt::format("all{}", i), 3, cases);
    Add(std::string(kBuildPrograms[i]), fmt::format("alone{}", i), 1, others);
  }
  for (const auto& entry : std::filesystem::directory_iterator("examples/koord")) {
    // Variants of LineForm have no fleet, and so no parameters.
    const bool variant = entry.path().filename().string().starts_with("lineform_");
    if (entry.path().extension() == ".koord" && !variant) AddExample(entry.path(), others);
  }
  EXPECT_GT(others.size(), 15U);
  Tally tally;
  tally.Compare(cases, RONDO_COMPILE " " RONDO_SANITIZERS, 60, 20);
  tally.Compare(others, RONDO_COMPILE " " RONDO_QUICKLY, 40, 20);
  EXPECT_GT(tally.compared, 5'000U);
  EXPECT_GT(tally.merged, 500U);
  // Every operation of the machine, but those that no event and no formula of a specification has.
  const std::set<semantics::Op> none{semantics::Op::kSetParam, semantics::Op::kGridInt,
                                     semantics::Op::kGridFloat, semantics::Op::kGridPos};
  for (int op = 0; op <= static_cast<int>(semantics::Op::kMark); ++op) {
    const auto one = static_cast<semantics::Op>(op);
    if (!none.contains(one)) {
      EXPECT_TRUE(tally.covered.contains(one)) << "no program has operation " << op;
    }
  }
  for (const auto fault :
       {program::Fault::kIndex, program::Fault::kDivision, program::Fault::kRoot, program::Fault::kRemove,
        program::Fault::kReturn, program::Fault::kOverflow, program::Fault::kExternal,
        program::Fault::kNoValue, program::Fault::kNotYet, program::Fault::kLoop})
    EXPECT_GT(tally.faults[static_cast<size_t>(fault)], 0U) << program::Describe(fault);
}

TEST(BuildAgreement, RandomProgramsDoWhatTheMachineDoes) {
  const char* wanted = std::getenv("RONDO_CASES");
  const uint64_t programs =
      wanted == nullptr ? 200 : std::max<uint64_t>(200, std::strtoull(wanted, nullptr, 10) / 500);
  uint64_t compared = 0;
  for (uint64_t first = 1; first <= programs; first += 200) {  // so many at once fit into memory
    std::vector<Case> cases;
    for (uint64_t seed = first; seed < first + 200 && seed <= programs; ++seed) {
      const std::string text = Texts(50'000 + seed).Whole();
      Add(text, fmt::format("random{}", seed), 1 + seed % 3, cases);
    }
    Tally tally;
    tally.Compare(cases, RONDO_COMPILE " " RONDO_QUICKLY, 20, 8);
    compared += tally.compared;
  }
  EXPECT_GT(compared, 20'000U);
}

}  // namespace
}  // namespace rondo::koord
