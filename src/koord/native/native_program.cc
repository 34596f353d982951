#include "koord/native/native_program.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>

#include "koord/native/state_bytes.h"

namespace rondo::koord::native {

using program::Answer;
using program::CoreEffect;
using runtime::codec::Reader;
using runtime::codec::Writer;
using semantics::Effect;
using semantics::Fault;
using semantics::kMostWays;
using semantics::Layout;

namespace {

Fault FaultOf(program::Fault fault) {
  switch (fault) {
    case program::Fault::kNone:
      return Fault::kNone;
    case program::Fault::kIndex:
      return Fault::kIndex;
    case program::Fault::kDivision:
      return Fault::kDivision;
    case program::Fault::kRoot:
      return Fault::kRoot;
    case program::Fault::kRemove:
      return Fault::kRemove;
    case program::Fault::kReturn:
      return Fault::kReturn;
    case program::Fault::kOverflow:
      return Fault::kOverflow;
    case program::Fault::kExternal:
      return Fault::kExternal;
    case program::Fault::kNoValue:
      return Fault::kNoValue;
    case program::Fault::kTooLong:
      return Fault::kTooLong;
    case program::Fault::kTooMany:
      return Fault::kTooMany;
    case program::Fault::kNotYet:
      return Fault::kNotYet;
    case program::Fault::kLoop:
      return Fault::kLoop;
    case program::Fault::kRunaway:
      return Fault::kRunaway;
  }
  return Fault::kExternal;
}

// Asks the host of a machine.
class Questions final : public program::CoreHost {
 public:
  Questions(semantics::Team& team, const program::Core& core) : team_(team) {
    const auto& functions = team.model().functions;
    for (const std::string& name : core.questions()) {
      const auto it = std::ranges::find(functions, name, &Function::name);
      functions_.push_back(static_cast<size_t>(it - functions.begin()));
    }
  }

  Answer Ask(size_t number, int64_t robot, std::span<const uint8_t> arguments,
             program::Bytes& result) noexcept override {
    const lang::TypeTable& types = team_.model().types;
    if (team_.machine().host() == nullptr || functions_[number] >= team_.model().functions.size())
      return Answer::kNone;
    const Function& function = team_.model().functions[functions_[number]];
    std::vector<Word> words, back(Layout::Width(types, function.result));
    Reader reader(arguments);
    for (const TypeId parameter : function.parameters)
      node::DecodeValue(types, team_.heap(), parameter, reader, words);
    if (!reader.Complete()) return Answer::kNone;
    switch (team_.machine().host()->Call(functions_[number], static_cast<size_t>(robot), words, back)) {
      case semantics::Answer::kNone:
        return Answer::kNone;
      case semantics::Answer::kLater:
        return Answer::kLater;
      case semantics::Answer::kValue:
        break;
    }
    Writer writer(result);
    node::EncodeValue(types, team_.heap(), function.result, back, writer);
    return Answer::kValue;
  }
  uint64_t Pick(uint64_t possibilities) noexcept override { return choices.Pick(possibilities); }

  semantics::Choices choices;  // of the event that is running

 private:
  semantics::Team& team_;
  std::vector<size_t> functions_;
};

class NativeTeam final : public semantics::Native {
 public:
  NativeTeam(semantics::Team& team, const diag::SourceSet& sources, std::unique_ptr<program::Core> core)
      : team_(team), sources_(sources), core_(std::move(core)), bytes_(team), questions_(team, *core_) {}

  void Find(std::span<const Word> state, size_t robot, std::vector<Effect>& effects) override {
    effects.clear();
    if (!Load(state)) {
      // A list of the state has no room, which nothing can go on with.
      for (uint32_t e = 0; e < team_.events().size(); ++e)
        effects.push_back(TooLong(e, team_.events()[e].def->span));
      return;
    }
    questions_.choices.Clear();
    questions_.choices.Begin();
    const std::vector<CoreEffect> first = core_->Effects(robot, questions_);
    if (!questions_.choices.any()) {
      for (const CoreEffect& effect : first) effects.push_back(Told(effect, robot, state));
      return;
    }
    for (const CoreEffect& effect : first) {
      if (!effect.ran) {
        effects.push_back(Told(effect, robot, state));
        continue;
      }
      questions_.choices.Clear();
      size_t ways = 0;
      do {
        questions_.choices.Begin();
        effects.push_back(Told(core_->RunEvent(robot, effect.event, questions_), robot, state));
        if (++ways == kMostWays && effects.back().fault == Fault::kNone)
          effects.back().fault = Fault::kTooMany;
      } while (ways < kMostWays && questions_.choices.Next());
    }
  }

  void FindInit(std::span<const Word> state, size_t robot, std::vector<Effect>& effects) override {
    effects.clear();
    if (!Load(state)) {
      effects.push_back(TooLong(0, team_.events().front().def->span));
      return;
    }
    questions_.choices.Clear();
    do {
      questions_.choices.Begin();
      effects.push_back(Told(core_->Init(robot, questions_), robot, state));
    } while (effects.size() < kMostWays && questions_.choices.Next());
  }

  bool FallBack(std::span<Word> state, size_t robot) override {
    if (!Load(state)) return false;
    const bool all = core_->FallBack(robot, questions_);
    Bytes after;
    core_->Save(after);
    return bytes_.Decode(after, state) && all;
  }

 private:
  static Effect TooLong(uint32_t event, diag::Span where) {
    return {event, false, false, Fault::kTooLong, where, false, {}, {}, {}, {}};
  }

  bool Load(std::span<const Word> state) {
    Bytes bytes;
    bytes_.Encode(state, bytes);
    return core_->Load(bytes);
  }

  diag::Span SpanOf(program::Place place) const {
    const std::vector<diag::FileId> files = team_.model().program->Files();
    if (place.line == 0 || place.file >= files.size()) return {};
    const diag::FileId file = files[place.file];
    const std::string_view text = sources_.text(file);
    const std::string_view line = sources_.Line(file, place.line);
    auto begin = static_cast<uint32_t>(line.data() - text.data());
    // Columns count code points.
    for (uint32_t column = 1; column < place.column && begin < text.size(); ++column) {
      do {
        ++begin;
      } while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xc0) == 0x80);
    }
    return {file, begin, begin + place.length};
  }

  Effect Told(const CoreEffect& from, size_t robot, std::span<const Word> state) {
    Effect effect{
        from.event, from.urgent, from.locks, FaultOf(from.fault), SpanOf(from.place), !from.locks, {},
        {},         {},          {}};
    for (const CoreEffect::Change& change : from.changes) {
      const StateBytes::Cell cell = bytes_.cells()[change.cell];
      const uint32_t at = bytes_.AddressOf(cell, robot);
      std::vector<Word> words;
      Reader reader(change.value);
      node::DecodeValue(team_.model().types, team_.heap(), bytes_.TypeOf(cell), reader, words);
      if (at < team_.layout().shared_words()) {
        effect.shared.push_back(
            {{at, static_cast<uint32_t>(words.size())}, static_cast<uint32_t>(effect.words.size())});
        effect.words.insert(effect.words.end(), words.begin(), words.end());
        effect.idle = false;
        continue;
      }
      for (uint32_t k = 0; k < words.size(); ++k) {
        effect.own.push_back({at + k, words[k]});
        effect.idle = effect.idle && state[at + k] == words[k];
      }
    }
    for (const std::string& line : from.said)
      effect.said.push_back({semantics::kPlainText, {team_.heap().InternText(line)}});
    return effect;
  }

  semantics::Team& team_;
  const diag::SourceSet& sources_;
  std::unique_ptr<program::Core> core_;
  StateBytes bytes_;
  Questions questions_;
};

}  // namespace

uint64_t DigestOf(const semantics::Team& team, const diag::SourceSet& sources) {
  Bytes bytes;
  Writer writer(bytes);
  const auto text = [&](diag::FileId file) {
    const std::string_view t = sources.text(file);
    writer.Block({reinterpret_cast<const uint8_t*>(t.data()), t.size()});
  };
  const Model& model = team.model();
  for (const diag::FileId file : model.program->Files()) text(file);
  writer.Number(team.robots());
  for (size_t v = 0; v < model.variables.size(); ++v) {
    const Variable& variable = model.variables[v];
    const Layout::Place& place = team.layout()[v];
    if (variable.kind != VariableKind::kParam) continue;
    node::EncodeValue(model.types, team.heap(), variable.type, team.params().subspan(place.at, place.width),
                      writer);
  }
  return runtime::codec::Sum(bytes);
}

base::Result<Library> Library::Load(const std::string& path) {
  void* handle = ::dlopen(path.find('/') == std::string::npos ? ("./" + path).c_str() : path.c_str(),
                          RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr)
    return base::Error{fmt::format("cannot load the program `{}`: {}", path, ::dlerror())};
  const auto version = reinterpret_cast<int (*)()>(::dlsym(handle, "rondo_core_version"));
  const auto make = reinterpret_cast<program::Core* (*)()>(::dlsym(handle, "rondo_make_core"));
  if (version == nullptr || make == nullptr)
    return base::Error{fmt::format("`{}` is no program that `rondo build` made", path)};
  if (version() != program::kCoreVersion)
    return base::Error{
        fmt::format("`{}` was made by another version of Rondo: `rondo build` it again", path)};
  return Library(path, make);
}

size_t Library::robots() const { return std::unique_ptr<program::Core>(make_())->robots(); }

base::Result<bool> Library::Attach(semantics::Team& team, const diag::SourceSet& sources) const {
  std::unique_ptr<program::Core> core(make_());
  if (core->robots() != team.robots())
    return base::Error{
        fmt::format("`{}` was made for {} robots, and the fleet has {}: `rondo build` it again", path_,
                    core->robots(), team.robots())};
  if (core->digest() != DigestOf(team, sources))
    return base::Error{fmt::format(
        "`{}` was made of another program, specification or parameters than these: `rondo build` it again",
        path_)};
  native::Attach(team, sources, std::move(core));
  return true;
}

void Attach(semantics::Team& team, const diag::SourceSet& sources, std::unique_ptr<program::Core> core) {
  team.SetNative(std::make_unique<NativeTeam>(team, sources, std::move(core)));
}

}  // namespace rondo::koord::native
