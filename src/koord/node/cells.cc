#include "koord/node/cells.h"

#include <algorithm>

namespace rondo::koord::node {

using runtime::codec::Reader;
using runtime::codec::Writer;

Cells::Cells(semantics::Team& team) : team_(team) {
  const semantics::Layout& layout = team.layout();
  by_word_.resize(layout.shared_words() + layout.block_words());
  for (uint32_t v = 0; v < stopped(); ++v) {
    const auto& place = layout[v];
    const VariableKind kind = team.model().variables[v].kind;
    if (!place.exists || kind == VariableKind::kParam) continue;
    for (uint32_t i = 0; i < std::max<uint32_t>(1, place.length); ++i) {
      const Cell cell{v, i};
      (place.own ? own_ : shared_).push_back(cell);
      if (kind == VariableKind::kSensor) sensors_.push_back(cell);
      const uint32_t at = place.at + i * place.width + (place.own ? layout.shared_words() : 0);
      std::fill_n(by_word_.begin() + at, place.width, cell);
    }
  }
  const Cell mark{stopped(), 0};
  own_.push_back(mark);
  by_word_[layout.shared_words() + layout.stopped()] = mark;
}

Cell Cells::At(uint32_t address) const {
  const semantics::Layout& layout = team_.layout();
  if (address < layout.shared_words()) return by_word_[address];
  return by_word_[layout.shared_words() + (address - layout.shared_words()) % layout.block_words()];
}

uint32_t Cells::Address(Cell cell, size_t robot) const {
  const semantics::Layout& layout = team_.layout();
  if (cell.variable == stopped()) return layout.block(robot) + layout.stopped();
  return layout.Address(cell.variable, robot) + cell.item * layout[cell.variable].width;
}

uint32_t Cells::Width(Cell cell) const {
  return cell.variable == stopped() ? 1 : team_.layout()[cell.variable].width;
}

VariableKind Cells::Kind(Cell cell) const {
  return cell.variable == stopped() ? VariableKind::kLocal : team_.model().variables[cell.variable].kind;
}

void Cells::EncodeValueOf(Cell cell, std::span<const Word> words, Writer& writer) const {
  if (cell.variable == stopped()) return writer.Number(words[0]);
  EncodeValue(team_.model().types, team_.heap(), team_.layout()[cell.variable].item, words, writer);
}

void Cells::DecodeValueOf(Cell cell, Reader& reader, std::vector<Word>& words) const {
  if (cell.variable == stopped())
    words.push_back(reader.Number(1));
  else
    DecodeValue(team_.model().types, team_.heap(), team_.layout()[cell.variable].item, reader, words);
}

void Cells::Encode(Cell cell, size_t robot, std::span<const Word> state, std::span<const Word> words,
                   Writer& writer) const {
  writer.Number(cell.variable);
  writer.Number(cell.item);
  if (cell.variable == stopped()) return EncodeValueOf(cell, words, writer);
  EncodeChange(team_.model().types, team_.heap(), team_.layout()[cell.variable].item,
               state.subspan(Address(cell, robot), Width(cell)), words, writer);
}

Cell Cells::Decode(size_t robot, std::span<const Word> state, Reader& reader,
                   std::vector<Word>& words) const {
  Cell cell;
  cell.variable = static_cast<uint32_t>(reader.Number(stopped()));
  cell.item = static_cast<uint32_t>(reader.Number(UINT32_MAX));
  const auto known = [&](const std::vector<Cell>& cells) { return std::ranges::binary_search(cells, cell); };
  if (!reader.ok() || (!known(shared_) && !known(own_))) {
    reader.Fail();
    return {};
  }
  if (cell.variable == stopped())
    DecodeValueOf(cell, reader, words);
  else
    DecodeChange(team_.model().types, team_.heap(), team_.layout()[cell.variable].item,
                 state.subspan(Address(cell, robot), Width(cell)), reader, words);
  return cell;
}

}  // namespace rondo::koord::node
