#include "deploy/round_thread.h"

#include <fmt/format.h>

#include <algorithm>

#include "platform/topics.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

namespace rounds = runtime::rounds;
using history::Kind;
using koord::node::Cell;
using transport::BootTime;

namespace {
constexpr Time kLook = 100'000'000;
}

RoundThread::RoundThread(const sim::Fleet& fleet, uint32_t robot, Replica& replica, platform::Senses& senses,
                         platform::Orders& orders, const platform::Clock& clock, LogWriter* log)
    : fleet_(fleet),
      self_(robot),
      replica_(replica),
      senses_(senses),
      orders_(orders),
      clock_(clock),
      log_(log),
      unheard_(fleet.robots.size()) {}

void RoundThread::Run(const rounds::Settings& settings, rounds::Disk* disk,
                      const std::optional<runtime::codec::Bytes>& record, transport::Transport& way,
                      const base::StopToken& stop) {
  settings_ = settings;
  Log(Kind::kStarted, {}, [](LogLine&) {});
  // What its actuators do, nobody knows: there may have been a life before.
  FallBack();
  core_ = std::make_unique<rounds::Core>(
      settings_, Node(), disk, record ? std::optional(runtime::codec::View(*record)) : std::nullopt);
  transport::Drive(
      *core_, way, stop,
      [this](Time now, const rounds::Output& output) {
        now_ = now;
        std::visit([&](const auto& o) { Do(o); }, output);
      },
      [this](Time now) {
        now_ = now;
        if (now - looked_at_ < kLook) return;
        looked_at_ = now;
        const std::lock_guard lock(mutex_);
        Look();
      });
}

RoundView RoundThread::View() const {
  const std::lock_guard lock(mutex_);
  RoundView view = view_;
  view.median = latencies_.Quantile(0.5);
  view.p99 = latencies_.Quantile(0.99);
  view.most = latencies_.Most();
  for (uint32_t r = 0; r < unheard_.size(); ++r) {
    if (unheard_[r]) view.unheard.push_back(fleet_.robots[r].name);
  }
  return view;
}

std::vector<std::pair<std::string, uint8_t>> RoundThread::TakeNews() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

template <class Fill>
void RoundThread::Log(Kind kind, rounds::Place at, const Fill& fill) {
  if (log_ == nullptr) return;
  log_->Put([&](LogLine& line) {
    line.kind = kind;
    // Robots with one simulated clock hear it at different moments: what was before what, the clock of the machine says.
    line.time = now_ == 0 || clock_.simulated() ? BootTime() : now_;
    line.until = 0;
    line.clock = clock_.simulated() ? std::optional(now_) : std::nullopt;
    line.stamp = platform::WallTime();
    line.epoch = at.epoch;
    line.round = at.round;
    line.bytes.clear();
    line.waits.clear();
    line.skips = false;
    line.calls.clear();
    line.members.clear();
    line.said.clear();
    fill(line);
  });
}

// Under the lock, like everything that others see.
void RoundThread::Look() {
  view_.phase = core_->phase();
  view_.place = core_->place();
  view_.active = core_->active();
  view_.refused = 0;
  for (size_t i = 1; i < core_->refused().size(); ++i) view_.refused += core_->refused()[i];
  view_.foreign = core_->refused()[static_cast<size_t>(runtime::codec::Refused::kForeign)];
  view_.strange = core_->refused()[static_cast<size_t>(runtime::codec::Refused::kSession)];
  for (uint32_t r = 0; r < settings_.robots; ++r) {
    const auto heard = core_->heard(r);
    unheard_[r] = r != self_ && (!heard || now_ - *heard > settings_.lease / 2);
  }
}

void RoundThread::Do(const rounds::Contributed& c) {
  Log(Kind::kContributed, c.at, [&](LogLine& line) {
    line.bytes.assign(c.payload.begin(), c.payload.end());
    line.waits = Node().waits();
    line.skips = Node().skips();
    line.calls = replica_.calls().answers();
    if (const auto& failed = Node().failed()) line.said = Told(*failed);
  });
  replica_.calls().Clear();
  (void)replica_.calls().functions().TakeLog();  // what is said counts when the round is final
  contributed_ = c.at;
  contributed_at_ = BootTime();
  if (Node().blind()) FallBack();
  const std::lock_guard lock(mutex_);
  if (!view_.begun_at) {
    view_.begun_at = now_;
    News("the first round begins");
  }
  if (Node().blind()) ++view_.blind;
  if (const auto& failed = Node().failed()) {
    ++view_.failed;
    if (view_.failed == 1) News(Told(*failed) + ": it skips", 40);
  }
  Look();
}

void RoundThread::Do(const rounds::Stored& stored) {
  Log(Kind::kStored, stored.at, [&](LogLine& line) { Node().Save(line.bytes); });
}

void RoundThread::Do(const rounds::Committed& c) {
  Log(Kind::kCommitted, c.at, [](LogLine&) {});
  const std::lock_guard lock(mutex_);
  if (contributed_.epoch == c.at.epoch && contributed_.round + 1 == c.at.round)
    latencies_.Add(BootTime() - contributed_at_);
  view_.rounds = std::max(view_.rounds, c.at.round);
  Look();
}

void RoundThread::Do(const rounds::Act& act) {
  orders_.Extend(act.until);
  const bool fresh = act.at.round > acted_;
  std::string said;
  if (fresh) {
    acted_ = act.at.round;
    Give(Node().Act(), Node().state(), false);
    for (const std::string& text : Node().applied().said) said += (said.empty() ? "" : "\n") + text;
  }
  Log(Kind::kActed, act.at, [&](LogLine& line) {
    line.until = act.until;
    line.said = said;
  });
  const std::lock_guard lock(mutex_);
  if (!said.empty()) News(said);
  if (!view_.stopped_at && AllStopped()) {
    view_.stopped_at = now_;
    News("every robot stopped");
  }
  Look();
}

void RoundThread::Do(const rounds::FallBack&) {
  FallBack();
  const std::lock_guard lock(mutex_);
  ++view_.fallbacks;
  Look();
  std::vector<std::string> names;
  for (uint32_t r = 0; r < unheard_.size(); ++r) {
    if (unheard_[r]) names.push_back(fleet_.robots[r].name);
  }
  News(names.empty() ? "falls back" : fmt::format("falls back: does not hear {}", fmt::join(names, ", ")),
       40);
}

void RoundThread::Do(const rounds::Adopted& a) {
  Log(Kind::kAdopted, {a.decision.epoch, a.decision.base.round}, [&](LogLine& line) {
    for (const auto& m : a.decision.members) line.members.push_back({m.robot, m.incarnation});
  });
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const auto& m : a.decision.members) names.push_back(fleet_.robots[m.robot].name);
  News(fmt::format("the team is {}", fmt::join(names, ", ")));
  Look();
}

void RoundThread::Do(const rounds::Broken& broken) {
  const std::lock_guard lock(mutex_);
  view_.broken = broken.what;
  News(fmt::format("this is a mistake of the round protocol: {}", broken.what), 50);
}

std::string RoundThread::Told(const koord::node::Failure& failed) const {
  const std::string event =
      failed.event == koord::node::kInit ? "init" : replica_.team().events()[failed.event].def->name;
  return fmt::format("an operation of `{}` has no value: {}", event, Describe(failed.fault));
}

void RoundThread::FallBack() {
  const std::vector<Cell>& covered = Node().FallBack(acted_);
  Give(covered, Node().real(), true);
  Log(Kind::kFellBack, contributed_, [&](LogLine& line) {
    if (!covered.empty()) Node().Save(Node().real(), line.bytes);
  });
}

void RoundThread::Give(const std::vector<Cell>& cells, const std::vector<Word>& state, bool always) {
  for (const Cell cell : cells) {
    const Word* at = state.data() + Node().cells().Address(cell, self_);
    const auto& heap = replica_.team().heap();
    if (orders_.PathOf(cell.variable, heap, at, path_)) senses_.GoesAlong(path_);
    orders_.Give(cell.variable, heap, at, always);
  }
}

bool RoundThread::AllStopped() {
  const auto& layout = replica_.team().layout();
  for (size_t r = 0; r < fleet_.robots.size(); ++r) {
    if (Node().state()[layout.block(r) + layout.stopped()] == 0) return false;
  }
  return true;
}

}  // namespace rondo::deploy
