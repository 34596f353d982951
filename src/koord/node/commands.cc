#include "koord/node/commands.h"

#include <algorithm>

namespace rondo::koord::node {

Commands::Commands(const semantics::Team& team, const Cells& cells, uint32_t robot)
    : cells_(cells), robot_(robot), real_(team.blank()) {
  for (const Cell cell : cells.own()) {
    if (cells.Kind(cell) != VariableKind::kActuator) continue;
    actuators_.push_back(cell);
    if (team.model().FallsBack(cell.variable)) covered_.push_back(cell);
  }
}

bool Commands::IsCovered(Cell cell) const { return std::ranges::binary_search(covered_, cell); }

void Commands::Reset(std::span<const Word> state) {
  real_.assign(state.begin(), state.end());
  due_.clear();
  all_due_ = true;
  begun_ = overtaken_ = false;
}

void Commands::FallBack(std::span<const Word> state) {
  real_.assign(state.begin(), state.end());
  begun_ = overtaken_ = true;
  std::erase_if(due_, [&](Cell cell) { return IsCovered(cell); });
}

const std::vector<Cell>& Commands::Tell(std::span<const Word> store) {
  overtaken_ = false;
  apart_.clear();
  if (!begun_) return apart_;
  // What it wrote and did not act on is lost, where there is a fallback.
  std::erase_if(due_, [&](Cell cell) { return IsCovered(cell); });
  for (const Cell cell : covered_) {
    const auto value = store.subspan(cells_.Address(cell, robot_), cells_.Width(cell));
    if (!std::ranges::equal(value, std::span(real_).subspan(cells_.Address(cell, robot_), value.size())))
      apart_.push_back(cell);
  }
  return apart_;
}

void Commands::Apply(std::span<const Cell> written) {
  for (const Cell cell : written) {
    if (cells_.Kind(cell) != VariableKind::kActuator) continue;
    if (overtaken_ && IsCovered(cell)) continue;
    if (std::ranges::find(due_, cell) == due_.end()) due_.push_back(cell);
  }
}

void Commands::Load() {
  std::erase_if(due_, [&](Cell cell) { return IsCovered(cell); });
  all_due_ = overtaken_ = true;
}

const std::vector<Cell>& Commands::Act(std::span<const Word> store) {
  driven_.clear();
  for (const Cell cell : actuators_) {
    const bool all = all_due_ && (!begun_ || !IsCovered(cell));
    if (!all && std::ranges::find(due_, cell) == due_.end()) continue;
    driven_.push_back(cell);
    const uint32_t at = cells_.Address(cell, robot_);
    std::copy_n(store.begin() + at, cells_.Width(cell), real_.begin() + at);
  }
  due_.clear();
  all_due_ = false;
  begun_ = true;
  return driven_;
}

}  // namespace rondo::koord::node
