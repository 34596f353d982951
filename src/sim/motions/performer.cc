#include "sim/motions/performer.h"

#include <fmt/format.h>

#include <algorithm>

#include "choreo/prove/sampler.h"
#include "expr/substitute.h"

namespace rondo::sim::motions {

using runtime::sessions::Progress;

namespace {

constexpr runtime::sessions::Time kResend = 20'000'000;  // nanoseconds

}  // namespace

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
                     MotionLibrary& library, std::mt19937_64& random, Audience& audience)
    : cast_(cast),
      scene_(scene),
      library_(library),
      random_(random),
      audience_(audience),
      robot_(robot),
      script_(choreo::ScriptOf(cast, robot, *this)) {
  runtime::sessions::Program& program = *this;
  runtime::sessions::Motions& motions = *this;
  session_.emplace(uint64_t{1}, robot.value, kResend, program, motions);
}

// What the script says, with everybody told of it.
runtime::sessions::Step Performer::Next() {
  runtime::sessions::Step step = script_->Next();
  cases_ = step.cases;
  return step;
}

void Performer::Took(size_t which, const std::vector<double>& values) {
  audience_.Takes(robot_, cases_[which], values);
  script_->Took(which, values);
}

void Performer::Begin(size_t motion) {
  const auto code = library_.Find(motion);
  if (!code.ok()) {
    problem_ = code.error().message;
    return;
  }
  motion_.emplace(*code.value(), scene_, random_);
  audience_.Begins(*motion_);
}

Progress Performer::Tick() {
  if (!motion_) return problem_.empty() ? Progress::kStopped : Progress::kFailed;
  const Progress progress = motion_->progress();
  if (progress == Progress::kStopped) Halt();
  return progress;
}

// What moves as it is told stops at once; with a controller, too: its contract holds at every moment.
void Performer::Halt() {
  audience_.Ends(*motion_);
  motion_.reset();
}

const expr::Numeric::Point& Performer::Now() { return now_ = scene_.Point(); }

// Bools first; then numbers that satisfy what is left, as the state is.
std::optional<std::vector<double>> Performer::Choose(const choreo::Node& message) {
  expr::Arena& arena = cast_.declarations->evaluator().arena();
  const expr::Numeric::Point now = scene_.Point();
  expr::Substitution known;
  for (const auto& [variable, value] : now)
    known.emplace(variable, arena.Number(arena.Real(), expr::Rational::FromDouble(value)));
  const expr::TermId refinement = expr::Substitute(arena, message.refinement, known);
  constexpr int kTries = 20, kDraws = 200;
  for (int i = 0; i < kTries; ++i) {
    expr::Substitution formulas;
    for (const robot::Value& value : message.payload) {
      for (const expr::TermId t : value.terms) {
        if (arena.op(t) == expr::Op::kVariable && arena.sort_of(t) == arena.Bool())
          formulas.emplace(t, arena.Constant(random_() % 2 == 0));
      }
    }
    const expr::TermId wanted = expr::Substitute(arena, refinement, formulas);
    const auto drawn = choreo::Sampler(arena, wanted).Draw(random_, kDraws);
    if (!drawn) continue;
    expr::Numeric::Point point = now;
    for (const auto& [variable, value] : *drawn) point.insert_or_assign(variable, value);
    std::vector<robot::Value> payload = message.payload;
    for (robot::Value& value : payload) {
      for (expr::TermId& t : value.terms) t = expr::Substitute(arena, t, formulas);
    }
    if (auto values = choreo::ValuesOf(arena, payload, point)) return values;
  }
  problem_ = fmt::format("no value was found that `{}` may carry", message.label);
  return std::nullopt;
}

}  // namespace rondo::sim::motions
