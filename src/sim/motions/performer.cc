#include "sim/motions/performer.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/motions/payload.h"

namespace rondo::sim::motions {

using runtime::sessions::Progress;

base::Result<MotionCode*> MotionLibrary::Find(size_t instance) {
  auto& known = known_[instance];
  if (known == nullptr) {
    auto code = CodeOf(graph_, graph_.instances[instance], arena_, scene_);
    if (!code.ok()) return code.error();
    known = std::make_unique<MotionCode>(std::move(code).value());
  }
  return known.get();
}

Performer::Performer(const choreo::Cast& cast, choreo::RobotId robot, SceneState& scene,
                     MotionLibrary& library, std::mt19937_64& random, Manner manner, Audience& audience)
    : cast_(cast),
      scene_(scene),
      library_(library),
      random_(random),
      manner_(manner),
      audience_(audience),
      robot_(robot),
      script_(choreo::ScriptOf(cast, robot, *this)) {}

// What the script says, with everybody told of it.
runtime::sessions::Step Performer::Next() { return step_ = script_->Next(); }

void Performer::Sent() {
  audience_.Sends(robot_, step_);
  script_->Sent();
}

void Performer::Took(size_t which, const std::vector<double>& values) {
  audience_.Takes(robot_, step_.cases[which], values);
  script_->Took(which, values);
}

void Performer::Begin(size_t motion) {
  const auto code = library_.Find(motion);
  if (!code.ok()) {
    problem_ = code.error().message;
    return;
  }
  motion_.emplace(*code.value(), scene_, random_, manner_);
  audience_.Begins(*motion_);
}

Progress Performer::Tick() {
  if (!motion_) return problem_.empty() ? Progress::kStopped : Progress::kFailed;
  const Progress progress = audience_.Checked(*motion_, motion_->progress());
  if (progress == Progress::kStopped) Halt();
  return progress;
}

// What moves as it is told stops at once; with a controller, too: its contract holds at every moment.
void Performer::Halt() {
  audience_.Ends(*motion_);
  motion_.reset();
}

const expr::Numeric::Point& Performer::Now() { return now_ = scene_.Point(); }

std::optional<std::vector<double>> Performer::Choose(const choreo::Node& message) {
  auto values = DrawPayload(cast_.declarations->evaluator().arena(), message, scene_.Point(), random_);
  if (!values) problem_ = fmt::format("no value was found that `{}` may carry", message.label);
  return values;
}

}  // namespace rondo::sim::motions
