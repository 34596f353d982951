#include "deploy/planner.h"

#include <algorithm>

namespace rondo::deploy {

using sim::Functions;
using sim::PlanRequest;
using sim::World;

namespace {
constexpr std::chrono::seconds kFresh(2);
}

PlannerThread::~PlannerThread() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

PlannerThread::Question* PlannerThread::Find(const World& world, const PlanRequest& request) {
  for (Question& q : questions_) {
    if (q.request.goal == request.goal && q.request.flies == request.flies && q.world.boxes == world.boxes &&
        sim::Distance(q.request.start, request.start) <= near_)
      return &q;
  }
  return nullptr;
}

Functions::Planned PlannerThread::Ask(const World& world, const PlanRequest& request, bool wait) {
  std::unique_lock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(questions_, [&](const Question& q) { return q.answer && now - q.asked > kFresh; });
  Question* question = Find(world, request);
  if (question == nullptr) {
    question = &questions_.emplace_back(Question{world, request, now, std::nullopt});
    if (!thread_.joinable()) thread_ = std::thread([this] { Run(); });
    changed_.notify_all();
  }
  if (wait) changed_.wait(lock, [&] { return question->answer || ended_; });
  Functions::Planned planned = question->answer.value_or(Functions::Planned{false, std::nullopt});
  if (planned.path && !planned.path->empty() && planned.path->front() != request.start)
    planned.path->insert(planned.path->begin(), request.start);
  return planned;
}

void PlannerThread::Run() {
  std::unique_lock lock(mutex_);
  const auto open = [](const Question& q) { return !q.answer; };
  while (true) {
    changed_.wait(lock, [&] { return ended_ || std::ranges::any_of(questions_, open); });
    if (ended_) return;
    Question& question = *std::ranges::find_if(questions_, open);  // lists do not move what they hold
    const World world = question.world;
    const PlanRequest request = question.request;
    lock.unlock();
    auto path = sim::Plan(world, request);
    lock.lock();
    question.answer = {true, std::move(path)};
    question.asked = std::chrono::steady_clock::now();
    changed_.notify_all();
  }
}

}  // namespace rondo::deploy
