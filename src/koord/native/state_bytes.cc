#include "koord/native/state_bytes.h"

#include <algorithm>
#include <set>

namespace rondo::koord::native {

using runtime::codec::Reader;
using runtime::codec::Writer;
using semantics::Effect;
using semantics::Layout;

StateBytes::StateBytes(semantics::Team& team) : team_(team) {
  const auto& variables = team.model().variables;
  for (size_t v = 0; v < variables.size(); ++v) {
    const Layout::Place& place = team.layout()[v];
    if (!place.exists || variables[v].kind == VariableKind::kParam ||
        variables[v].kind == VariableKind::kSensor)
      continue;
    for (uint32_t item = 0; item < std::max<uint32_t>(1, place.length); ++item) cells_.push_back({v, item});
  }
  cells_.push_back({variables.size(), 0});
}

uint32_t StateBytes::AddressOf(Cell cell, size_t robot) const {
  const Layout& layout = team_.layout();
  if (cell.variable == team_.model().variables.size()) return layout.block(robot) + layout.stopped();
  return layout.Address(cell.variable, robot) + cell.item * layout[cell.variable].width;
}

TypeId StateBytes::TypeOf(Cell cell) const {
  return cell.variable == team_.model().variables.size() ? team_.model().types.boolean()
                                                         : team_.layout()[cell.variable].item;
}

uint32_t StateBytes::WidthOf(Cell cell) const { return Layout::Width(team_.model().types, TypeOf(cell)); }

// What all robots may write, and then what each has of its own.
template <typename Visit>
void StateBytes::EachValue(const Visit& visit) const {
  const auto& variables = team_.model().variables;
  const auto items = [&](size_t v, size_t robot) {
    const Layout::Place& place = team_.layout()[v];
    if (!place.exists || variables[v].kind == VariableKind::kParam) return;
    for (uint32_t item = 0; item < std::max<uint32_t>(1, place.length); ++item) visit(Cell{v, item}, robot);
  };
  for (size_t v = 0; v < variables.size(); ++v) {
    if (!team_.layout()[v].own) items(v, 0);
  }
  for (size_t r = 0; r < team_.robots(); ++r) {
    for (size_t v = 0; v < variables.size(); ++v) {
      if (team_.layout()[v].own) items(v, r);
    }
    visit(cells_.back(), r);
  }
}

void StateBytes::Encode(std::span<const Word> state, Bytes& bytes) const {
  Writer writer(bytes);
  EachValue([&](Cell cell, size_t robot) {
    node::EncodeValue(team_.model().types, team_.heap(), TypeOf(cell),
                      state.subspan(AddressOf(cell, robot), WidthOf(cell)), writer);
  });
}

bool StateBytes::Decode(std::span<const uint8_t> bytes, std::span<Word> state) const {
  Reader reader(bytes);
  std::vector<Word> words;
  EachValue([&](Cell cell, size_t robot) {
    words.clear();
    node::DecodeValue(team_.model().types, team_.heap(), TypeOf(cell), reader, words);
    if (reader.ok()) std::ranges::copy(words, state.begin() + AddressOf(cell, robot));
  });
  return reader.Complete();
}

std::map<uint32_t, Bytes> StateBytes::ChangesOf(const Effect& effect, size_t robot,
                                                std::span<const Word> before) const {
  std::vector<Word> after(before.begin(), before.end());
  std::set<uint32_t> written;
  const auto write = [&](uint32_t at, Word value) {
    after[at] = value;
    written.insert(at);
  };
  for (const Effect::Write& w : effect.own) write(w.at, w.value);
  for (const Effect::Shared& s : effect.shared) {
    for (uint32_t k = 0; k < s.unit.width; ++k) write(s.unit.at + k, effect.words[s.values + k]);
  }
  std::map<uint32_t, Bytes> changes;
  for (uint32_t number = 0; number < cells_.size(); ++number) {
    const uint32_t at = AddressOf(cells_[number], robot), width = WidthOf(cells_[number]);
    if (!written.contains(at)) continue;
    Writer writer(changes[number]);
    node::EncodeValue(team_.model().types, team_.heap(), TypeOf(cells_[number]),
                      std::span(after).subspan(at, width), writer);
  }
  return changes;
}

}  // namespace rondo::koord::native
