#include "solve/portfolio/portfolio.h"

#include <fmt/format.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "base/file.h"

namespace rondo::solve::portfolio {
namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// All engines at once.
class Race {
 public:
  explicit Race(bool compare) : compare_(compare) {}

  using Ask = std::function<Answer(const base::StopToken&)>;

  std::vector<std::optional<Answer>> Run(const std::vector<std::pair<std::string, Ask>>& engines,
                                         const base::StopToken& stop, std::vector<Outcome>& outcomes) {
    answers_.resize(engines.size());
    outcomes.resize(engines.size());
    std::vector<std::thread> threads;
    for (size_t i = 0; i < engines.size(); ++i) {
      threads.emplace_back([&, i] {
        const Clock::time_point start = Clock::now();
        Answer answer = engines[i].second(race_);
        const std::scoped_lock lock(mutex_);
        outcomes[i] = {engines[i].first, Describe(answer), Since(start)};
        if (IsDefinite(answer) && !compare_) race_.RequestStop();
        answers_[i] = std::move(answer);
        ++finished_;
        wake_.notify_all();
      });
    }
    {
      std::unique_lock lock(mutex_);
      while (
          !wake_.wait_for(lock, std::chrono::milliseconds(20), [&] { return finished_ == engines.size(); })) {
        if (stop.StopRequested()) race_.RequestStop();
      }
    }
    for (std::thread& t : threads) t.join();
    return std::move(answers_);
  }

 private:
  bool compare_;
  base::StopToken race_;
  std::mutex mutex_;
  std::condition_variable wake_;
  size_t finished_ = 0;
  std::vector<std::optional<Answer>> answers_;
};

}  // namespace

std::string Describe(const Answer& answer) {
  const auto* unknown = std::get_if<Unknown>(&answer);
  return unknown != nullptr ? unknown->reason : std::string(Name(KindOf(answer)));
}

Answer PortfolioSolver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  return Decide(query, budget, stop).answer;
}

Report PortfolioSolver::Decide(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  Report report;
  const bool alone = options_.others.empty();
  const Clock::time_point start = Clock::now();
  const base::StopToken limited = stop.WithDeadline(start + budget.time);
  if (limited.StopRequested()) {
    report.answer = Unknown{"stopped", false};
    return report;
  }
  icp::Options quick = options_.icp;
  if (!alone) quick.max_boxes = 20'000;
  report.answer = icp::IcpSolver(quick).Check(query, budget, limited, report.icp);
  report.outcomes.push_back({"icp", Describe(report.answer), Since(start)});
  if (alone || (IsDefinite(report.answer) && !options_.compare)) return report;

  // What is left is for all of them.
  Budget rest = budget;
  rest.time -= std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start);
  if (rest.time.count() <= 0) return report;
  std::vector<std::pair<std::string, Race::Ask>> engines;
  std::optional<Answer> known;
  if (IsDefinite(report.answer)) {
    known = report.answer;
  } else {
    report.outcomes.clear();
    engines.emplace_back("icp", [&](const base::StopToken& race) {
      return icp::IcpSolver(options_.icp).Check(query, rest, race, report.icp);
    });
  }
  for (const Solver* other : options_.others)
    engines.emplace_back(other->name(),
                         [&, other](const base::StopToken& race) { return other->Check(query, rest, race); });
  std::vector<Outcome> outcomes;
  auto answers = Race(options_.compare).Run(engines, stop, outcomes);
  report.outcomes.insert(report.outcomes.end(), outcomes.begin(), outcomes.end());
  if (known) answers.insert(answers.begin(), *known);

  const Answer* definite = nullptr;
  for (const auto& answer : answers) {
    if (!IsDefinite(*answer)) continue;
    if (definite != nullptr && definite->index() != answer->index()) report.disagreement = true;
    if (definite == nullptr) definite = &*answer;
  }
  if (report.disagreement) {
    const auto written = base::WriteFileAtomically(options_.reproducer, ToSmtLib(query));
    report.answer =
        Unknown{written.ok() ? fmt::format("engines contradict each other; the question is in {}",
                                           options_.reproducer.string())
                             : fmt::format("engines contradict each other; {}", written.error().message)};
    return report;
  }
  if (definite != nullptr) {
    report.answer = *definite;
    return report;
  }
  report.answer = *answers.front();
  if (std::holds_alternative<Unknown>(report.answer)) {
    Unknown unknown;
    for (const Outcome& o : report.outcomes)
      unknown.reason += fmt::format("{}{}: {}", unknown.reason.empty() ? "" : "; ", o.engine, o.answer);
    for (const auto& answer : answers) {
      const auto* one = std::get_if<Unknown>(&*answer);
      unknown.timed_out = unknown.timed_out || (one != nullptr && one->timed_out);
    }
    report.answer = std::move(unknown);
  }
  return report;
}

}  // namespace rondo::solve::portfolio
