#include "deploy/replica.h"

#include "sim/choice.h"
#include "sim/start.h"

namespace rondo::deploy {

std::unique_ptr<Replica> Replica::Make(const koord::Model& model, const sim::Fleet& fleet,
                                       const std::vector<sim::Port>& ports, uint32_t robot, uint64_t seed,
                                       PlannerThread* planner, diag::Diagnostics& diagnostics) {
  std::unique_ptr<Replica> replica(new Replica(model, fleet, ports, seed, planner));
  replica->team_ = sim::TeamOf(model, fleet, replica->calls_.functions(), diagnostics);
  if (replica->team_ == nullptr) return nullptr;
  for (const sim::FleetRobot& r : fleet.robots) {
    replica->bodies_.push_back(r.make());
    replica->bodies_.back()->Place(r.position, r.yaw);
  }
  koord::semantics::Team& team = *replica->team_;
  std::mt19937_64 random(seed);
  replica->calls_.Attach(team, nullptr);
  const auto state = sim::StateBeforeInit({model, fleet, team, ports, replica->bodies_}, random, diagnostics);
  if (!state) return nullptr;
  team.machine().SetChooser({});
  replica->node_ = std::make_unique<koord::node::Node>(team, robot, nullptr, seed);
  replica->node_->Reset(*state, seed);
  replica->node_->Save(replica->before_);
  replica->node_->SetChoose(
      [&fleet, seed](uint64_t round, size_t r, std::span<const koord::semantics::Effect> effects) {
        return sim::Choose(fleet, seed, round, r, effects);
      });
  replica->calls_.Attach(team, replica->node_.get());
  return replica;
}

std::optional<std::vector<Word>> Replica::StateOf(runtime::codec::View bytes) {
  if (!node_->Load(bytes)) return std::nullopt;
  // Lists of states that nobody has any more.
  if (team_->heap().words_in_use() > collect_at_) {
    const std::span<const Word> states[] = {node_->state(), node_->real()};
    team_->Collect(states);
    collect_at_ = 1'000'000 + 2 * team_->heap().words_in_use();
  }
  return node_->state();
}

}  // namespace rondo::deploy
