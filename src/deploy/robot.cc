#include "deploy/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <thread>

#include "deploy/echo.h"
#include "deploy/latencies.h"
#include "deploy/status.h"
#include "platform/orders.h"
#include "platform/senses.h"
#include "ros/rcl_interfaces.h"
#include "runtime/durable/file_disk.h"
#include "transport/dds/way.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

namespace rounds = runtime::rounds;
using history::Kind;
using koord::node::Cell;
using rounds::Time;
using transport::BootTime;

namespace {

constexpr Time kSecond = 1'000'000'000;

Time Nanoseconds(double seconds) { return static_cast<Time>(std::llround(seconds * 1e9)); }

// A part of a ROS name.
std::string Plain(const std::string& text) {
  std::string name;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0 ? "p" + name : name;
}

uint64_t Agreement(const RobotOptions& options, const Replica& replica) {
  runtime::codec::Bytes bytes;
  runtime::codec::Writer writer(bytes);
  for (const std::string* text : {&options.program, &options.spec, &options.fleet})
    writer.Block({reinterpret_cast<const uint8_t*>(text->data()), text->size()});
  writer.Block(replica.before());
  return runtime::codec::Sum(bytes);
}

// A log of an earlier life stays: `bot0.mcap`, `bot0.2.mcap`, ...
std::string Unused(const std::string& wanted) {
  std::error_code ignored;
  const std::filesystem::path path(wanted);
  std::string name = wanted;
  for (int life = 2; std::filesystem::is_regular_file(name, ignored) ||
                     std::filesystem::is_regular_file(name + ".partial", ignored);
       ++life)
    name =
        (path.parent_path() / fmt::format("{}.{}{}", path.stem().string(), life, path.extension().string()))
            .string();
  return name;
}

class RobotProcess {
 public:
  RobotProcess(const koord::Model& model, const sim::Fleet& fleet, const RobotOptions& options,
               diag::Diagnostics& diagnostics)
      : model_(model),
        fleet_(fleet),
        options_(options),
        diagnostics_(diagnostics),
        self_(options.robot),
        name_(fleet.robots[self_].name) {}

  base::Result<bool> Prepare() {
    const size_t before = diagnostics_.errors();
    ports_ = sim::FindPorts(model_, fleet_.robots, diagnostics_);
    platform::CheckPorts(model_, fleet_, ports_, diagnostics_);
    if (diagnostics_.errors() != before) return Reported();
    planner_ = std::make_unique<PlannerThread>(fleet_.clearance / 2);
    replica_ = Make(planner_.get());
    if (replica_ == nullptr) return Reported();
    agreement_ = Agreement(options_, *replica_);
    auto participant = dds::Participant::Open(options_.network);
    if (!participant.ok()) return participant.error();
    participant_ = std::move(participant).value();
    node_ = participant_->AddNode({"/" + fleet_.robots[self_].node_namespace, "rondo"});
    senses_ = std::make_unique<platform::Senses>(model_, fleet_, ports_, self_, replica_->body(self_),
                                                 replica_->team().heap());
    if (auto begun = senses_->Begin(*participant_, node_); !begun.ok()) return begun;
    Node().SetSensors(senses_.get());
    orders_ = std::make_unique<platform::Orders>(model_, fleet_, ports_, self_, *senses_);
    if (auto begun = orders_->Begin(*participant_, node_); !begun.ok()) return begun;
    auto diagnostics = participant_->Publish(node_, "/diagnostics",
                                             ros::diagnostic_msgs::DiagnosticArray::kMessage, ros::kDefault);
    if (!diagnostics.ok()) return diagnostics.error();
    status_ = std::move(diagnostics).value();
    auto rosout = participant_->Publish(node_, "/rosout", ros::rcl_interfaces::Log::kMessage, ros::kLog);
    if (!rosout.ok()) return rosout.error();
    rosout_ = std::move(rosout).value();
    if (auto echoes = Echo(); !echoes.ok()) return echoes;
    std::vector<std::string> names;
    for (const sim::FleetRobot& robot : fleet_.robots) names.push_back(robot.name);
    auto way = transport::dds::Connect(*participant_, node_, {Plain(options_.program_name), names, self_});
    if (!way.ok()) return way.error();
    way_ = std::move(way).value();
    return OpenFiles(names);
  }

  RobotReport Run() {
    if (WaitForSensors()) {
      Log(Kind::kStarted, {}, [](LogLine&) {});
      // What its actuators do after a crash, nobody knows.
      if (record_) FallBack();
      core_ = std::make_unique<rounds::Core>(
          settings_, Node(), disk_.get(),
          record_ ? std::optional(runtime::codec::View(*record_)) : std::nullopt);
      std::thread thread([this] {
        transport::Drive(
            *core_, *way_, ended_,
            [this](Time now, const rounds::Output& output) {
              now_ = now;
              std::visit([&](const auto& o) { Do(o); }, output);
            },
            [this](Time now) {
              now_ = now;
              if (now - looked_at_ < kSecond / 10) return;
              looked_at_ = now;
              const std::lock_guard lock(mutex_);
              Look();
            });
      });
      Watch();
      ended_.RequestStop();
      thread.join();
    } else {
      report_.ending = RobotEnding::kInterrupted;
    }
    if (const auto place = senses_->place()) orders_->Stay(place->position);
    report_.median = latencies_.Quantile(0.5);
    report_.p99 = latencies_.Quantile(0.99);
    report_.most = latencies_.Most();
    report_.late = orders_->late();
    return report_;
  }

  base::Result<bool> Finish() { return log_ == nullptr ? base::Result<bool>(true) : log_->Finish(); }

 private:
  static base::Error Reported() { return {}; }
  koord::node::Node& Node() { return replica_->node(); }
  std::unique_ptr<Replica> Make(PlannerThread* planner) {
    return Replica::Make(model_, fleet_, ports_, self_, options_.seed, planner, diagnostics_);
  }

  base::Result<bool> OpenFiles(const std::vector<std::string>& names) {
    settings_ = sim::SettingsOf(fleet_);
    settings_.self = self_;
    settings_.agreement = agreement_;
    settings_.session = agreement_ ^ options_.session;
    // Greater than in any life before, as long as the clock on the wall goes forward between lives.
    settings_.incarnation = static_cast<uint64_t>(platform::WallTime());
    if (!options_.folder.empty()) {
      std::error_code failed;
      std::filesystem::create_directories(options_.folder, failed);
      disk_ = std::make_unique<runtime::durable::FileDisk>(
          std::filesystem::path(options_.folder) /
          fmt::format("{}-{:016x}.record", name_, settings_.session));
      record_ = disk_->Read();
      if (failed)
        return base::Error{fmt::format("cannot use the folder `{}`: {}", options_.folder, failed.message())};
    }
    if (options_.log.empty()) return true;
    auto replica = Make(nullptr);
    if (replica == nullptr) return Reported();
    const LogHead head{
        self_, settings_.incarnation, settings_.session, options_.seed, settings_.lease, settings_.stop_time,
        names, options_.program_name, options_.program,  options_.spec, options_.fleet,  options_.files};
    report_.log = Unused(options_.log);
    auto log = LogWriter::Open(report_.log, head, std::move(replica));
    if (!log.ok()) return log.error();
    log_ = std::move(log).value();
    return true;
  }

  // Says back what it is asked, and what its clock on the wall says (`Doctor`).
  base::Result<bool> Echo() {
    const EchoTopics topics = EchoTopicsOf(fleet_, self_);
    auto answers = participant_->Publish(node_, topics.answers, EchoMessage(), kEchoes);
    if (!answers.ok()) return answers.error();
    echo_answers_ = std::move(answers).value();
    auto questions = participant_->Subscribe(node_, topics.questions, EchoMessage(), kEchoes,
                                             [this](std::string_view bytes, const dds::Received&) {
                                               if (const auto answer = AnswerTo(bytes))
                                                 (void)echo_answers_->Write(*answer).ok();
                                             });
    if (!questions.ok()) return questions.error();
    echo_questions_ = std::move(questions).value();
    return true;
  }

  void Tell(const std::string& text, uint8_t level = 20) {
    ros::rcl_interfaces::Log m;
    m.stamp = platform::StampOf(platform::WallTime());
    m.level = level;
    m.name = fleet_.robots[self_].node_namespace + ".rondo";
    m.msg = text;
    (void)rosout_->Publish(m).ok();
    if (options_.tell) options_.tell(text);
  }

  // Nobody can run `init` without knowing where it is.
  bool WaitForSensors() {
    std::string last;
    for (int i = 0;; ++i) {
      if (options_.stop.StopRequested()) return false;
      const std::string why = senses_->Unusable(BootTime());
      if (why.empty()) return true;
      if (i % 20 == 10 && why != last) Tell("waiting: " + (last = why), 30);
      if (i % 10 == 0) Publish(why);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

  // -- the thread that watches

  void Watch() {
    using Clock = std::chrono::steady_clock;
    auto next = Clock::now();
    bool blind = false;
    int waited = 0;  // seconds
    while (true) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const std::optional<RobotEnding> ending = Ending();
      if (Clock::now() >= next || ending) {
        next = Clock::now() + std::chrono::seconds(1);
        const std::string why = senses_->Unusable(BootTime());
        Publish(why);
        if (blind != !why.empty()) Tell(why.empty() ? "the sensors are usable again" : "skips: " + why, 30);
        blind = !why.empty();
        Wait(waited++);
      }
      std::vector<std::pair<std::string, uint8_t>> news;
      {
        const std::lock_guard lock(mutex_);
        news.swap(news_);
      }
      for (const auto& [text, level] : news) Tell(text, level);
      if (!ending) continue;
      report_.ending = *ending;
      return;
    }
  }

  // Says whom it waits for, in the beginning.
  void Wait(int seconds) {
    if (seconds % 10 != 2) return;
    std::string text;
    {
      const std::lock_guard lock(mutex_);
      if (begun_at_) return;
      text = foreign_ > 0       ? "waiting: somebody runs another program, specification or fleet file"
             : strange_ > 0     ? "waiting: the others are in another session (`--session`)"
             : unheard_.empty() ? "waiting for the others to begin"
                                : "waiting for " + Unheard();
    }
    Tell(text, 30);
  }

  std::optional<RobotEnding> Ending() {
    const std::lock_guard lock(mutex_);
    const Time now = BootTime();
    if (!report_.broken.empty()) return RobotEnding::kBroken;
    if (options_.stop.StopRequested()) return RobotEnding::kInterrupted;
    if (phase_ == rounds::Phase::kHalted) return RobotEnding::kHalted;
    // The others have to hear of the last round, too.
    if (stopped_at_ && now - *stopped_at_ > settings_.lease) return RobotEnding::kStopped;
    if (options_.duration > 0 && begun_at_ && now - *begun_at_ > Nanoseconds(options_.duration))
      return RobotEnding::kTime;
    return std::nullopt;
  }

  void Publish(const std::string& sensors) {
    RobotStatus s;
    s.robot = name_;
    s.program = options_.program_name;
    s.agreement = fmt::format("{:016x}", agreement_);
    s.sensors = sensors;
    s.late = orders_->late();
    {
      const std::lock_guard lock(mutex_);
      s.phase = core_ == nullptr ? "waiting" : std::string(Name(phase_));
      s.epoch = place_.epoch;
      s.round = place_.round;
      s.active = active_;
      s.median = 1e3 * latencies_.Quantile(0.5);
      s.p99 = 1e3 * latencies_.Quantile(0.99);
      s.fallbacks = report_.fallbacks;
      s.blind = report_.blind;
      s.refused = refused_;
      s.foreign = foreign_;
      s.strange = strange_;
      if (core_ != nullptr) {
        for (const uint32_t r : unheard_) s.unheard.push_back(fleet_.robots[r].name);
      }
    }
    (void)status_->Publish(MessageOf(s)).ok();
  }

  // -- the thread that runs the rounds

  template <class Fill>
  void Log(Kind kind, rounds::Place at, const Fill& fill) {
    if (log_ == nullptr) return;
    log_->Put([&](LogLine& line) {
      line.kind = kind;
      line.time = now_ == 0 ? BootTime() : now_;
      line.until = 0;
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

  void News(std::string text, uint8_t level = 20) { news_.emplace_back(std::move(text), level); }

  void Look() {
    phase_ = core_->phase();
    place_ = core_->place();
    active_ = core_->active();
    refused_ = 0;
    for (size_t i = 1; i < core_->refused().size(); ++i) refused_ += core_->refused()[i];
    foreign_ = core_->refused()[static_cast<size_t>(runtime::codec::Refused::kForeign)];
    strange_ = core_->refused()[static_cast<size_t>(runtime::codec::Refused::kSession)];
    unheard_.clear();
    for (uint32_t r = 0; r < settings_.robots; ++r) {
      const auto heard = core_->heard(r);
      if (r != self_ && (!heard || now_ - *heard > settings_.lease / 2)) unheard_.push_back(r);
    }
  }

  void Do(const rounds::Send&) {}

  void Do(const rounds::Contributed& c) {
    Log(Kind::kContributed, c.at, [&](LogLine& line) {
      line.bytes.assign(c.payload.begin(), c.payload.end());
      line.waits = Node().waits();
      line.skips = Node().skips();
      line.calls = replica_->calls().answers();
      if (const auto& failed = Node().failed()) line.said = Told(*failed);
    });
    replica_->calls().Clear();
    (void)replica_->calls().functions().TakeLog();  // what is said counts when the round is final
    contributed_ = c.at;
    contributed_at_ = now_;
    if (Node().blind()) FallBack();
    const std::lock_guard lock(mutex_);
    if (!begun_at_) {
      begun_at_ = now_;
      News("the first round begins");
    }
    if (Node().blind()) ++report_.blind;
    if (const auto& failed = Node().failed()) {
      ++report_.failed;
      if (report_.failed == 1) News(Told(*failed) + ": it skips", 40);
    }
    Look();
  }

  void Do(const rounds::Stored& stored) {
    Log(Kind::kStored, stored.at, [&](LogLine& line) { Node().Save(line.bytes); });
  }

  void Do(const rounds::Committed& c) {
    Log(Kind::kCommitted, c.at, [](LogLine&) {});
    const std::lock_guard lock(mutex_);
    if (contributed_.epoch == c.at.epoch && contributed_.round + 1 == c.at.round)
      latencies_.Add(now_ - contributed_at_);
    report_.rounds = std::max(report_.rounds, c.at.round);
    Look();
  }

  void Do(const rounds::Act& act) {
    orders_->Extend(act.until);
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
    if (!stopped_at_ && AllStopped()) {
      stopped_at_ = now_;
      News("every robot stopped");
    }
    Look();
  }

  void Do(const rounds::FallBack&) {
    FallBack();
    const std::lock_guard lock(mutex_);
    ++report_.fallbacks;
    Look();
    News(unheard_.empty() ? "falls back" : fmt::format("falls back: does not hear {}", Unheard()), 40);
  }

  void Do(const rounds::Adopted& a) {
    Log(Kind::kAdopted, {a.decision.epoch, a.decision.base.round}, [&](LogLine& line) {
      for (const auto& m : a.decision.members) line.members.push_back({m.robot, m.incarnation});
    });
    const std::lock_guard lock(mutex_);
    std::vector<std::string> names;
    for (const auto& m : a.decision.members) names.push_back(fleet_.robots[m.robot].name);
    News(fmt::format("the team is {}", fmt::join(names, ", ")));
    Look();
  }

  void Do(const rounds::Broken& broken) {
    const std::lock_guard lock(mutex_);
    report_.broken = broken.what;
    News(fmt::format("this is a mistake of the round protocol: {}", broken.what), 50);
  }

  std::string Told(const koord::node::Failure& failed) const {
    const std::string event =
        failed.event == koord::node::kInit ? "init" : replica_->team().events()[failed.event].def->name;
    return fmt::format("an operation of `{}` has no value: {}", event, Describe(failed.fault));
  }

  std::string Unheard() const {
    std::vector<std::string> names;
    for (const uint32_t r : unheard_) names.push_back(fleet_.robots[r].name);
    return fmt::format("{}", fmt::join(names, ", "));
  }

  void FallBack() {
    const std::vector<Cell>& covered = Node().FallBack(acted_);
    Give(covered, Node().real(), true);
    Log(Kind::kFellBack, contributed_, [&](LogLine& line) {
      if (!covered.empty()) Node().Save(Node().real(), line.bytes);
    });
  }

  void Give(const std::vector<Cell>& cells, const std::vector<Word>& state, bool always) {
    for (const Cell cell : cells) {
      const Word* at = state.data() + Node().cells().Address(cell, self_);
      const auto& heap = replica_->team().heap();
      if (orders_->PathOf(cell.variable, heap, at, path_)) senses_->GoesAlong(path_);
      orders_->Give(cell.variable, heap, at, always);
    }
  }

  bool AllStopped() {
    const auto& layout = replica_->team().layout();
    for (size_t r = 0; r < fleet_.robots.size(); ++r) {
      if (Node().state()[layout.block(r) + layout.stopped()] == 0) return false;
    }
    return true;
  }

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const RobotOptions& options_;
  diag::Diagnostics& diagnostics_;
  const uint32_t self_;
  const std::string name_;
  std::vector<sim::Port> ports_;
  std::unique_ptr<PlannerThread> planner_;
  std::unique_ptr<Replica> replica_;  // of the thread that runs the rounds
  uint64_t agreement_ = 0;
  std::unique_ptr<dds::Participant> participant_;
  size_t node_ = 0;
  std::unique_ptr<platform::Senses> senses_;
  std::unique_ptr<platform::Orders> orders_;
  std::unique_ptr<dds::Publisher> status_, rosout_;
  std::unique_ptr<dds::Publisher> echo_answers_;
  std::unique_ptr<dds::Subscription> echo_questions_;
  std::unique_ptr<transport::Transport> way_;
  std::unique_ptr<runtime::durable::FileDisk> disk_;
  std::optional<runtime::codec::Bytes> record_;
  std::unique_ptr<LogWriter> log_;
  rounds::Settings settings_;
  std::unique_ptr<rounds::Core> core_;
  base::StopToken ended_;

  // Of the thread that runs the rounds.
  Time now_ = 0;
  rounds::Place contributed_;
  Time contributed_at_ = 0, looked_at_ = 0;
  uint64_t acted_ = 0;
  std::vector<sim::Point> path_;  // kept for its memory

  // Of both.
  std::mutex mutex_;
  RobotReport report_;
  Latencies latencies_;
  rounds::Phase phase_ = rounds::Phase::kOutside;
  rounds::Place place_;
  bool active_ = false;
  uint64_t refused_ = 0, foreign_ = 0, strange_ = 0;
  std::vector<uint32_t> unheard_;
  std::optional<Time> begun_at_, stopped_at_;
  std::vector<std::pair<std::string, uint8_t>> news_;
};

}  // namespace

std::string_view Name(RobotEnding ending) {
  switch (ending) {
    case RobotEnding::kTime:
      return "time";
    case RobotEnding::kInterrupted:
      return "interrupted";
    case RobotEnding::kStopped:
      return "stopped";
    case RobotEnding::kHalted:
      return "halted";
    case RobotEnding::kBroken:
      return "broken";
  }
  return "";
}

std::string AgreementOf(const koord::Model& model, const sim::Fleet& fleet, const RobotOptions& options,
                        diag::Diagnostics& diagnostics) {
  const size_t before = diagnostics.errors();
  const std::vector<sim::Port> ports = sim::FindPorts(model, fleet.robots, diagnostics);
  if (diagnostics.errors() != before) return {};
  const auto replica = Replica::Make(model, fleet, ports, 0, options.seed, nullptr, diagnostics);
  return replica == nullptr ? std::string() : fmt::format("{:016x}", Agreement(options, *replica));
}

base::Result<RobotReport> RunRobot(const koord::Model& model, const sim::Fleet& fleet,
                                   const RobotOptions& options, diag::Diagnostics& diagnostics) {
  RobotProcess process(model, fleet, options, diagnostics);
  if (const auto prepared = process.Prepare(); !prepared.ok()) return prepared.error();
  const RobotReport report = process.Run();
  if (const auto finished = process.Finish(); !finished.ok())
    return base::Error{fmt::format("cannot write `{}`: {}", options.log, finished.error().message)};
  return report;
}

}  // namespace rondo::deploy
