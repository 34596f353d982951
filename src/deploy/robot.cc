#include "deploy/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "base/file.h"
#include "deploy/announcer.h"
#include "deploy/clocked_way.h"
#include "deploy/echo.h"
#include "deploy/log_name.h"
#include "deploy/round_thread.h"
#include "deploy/status.h"
#include "platform/orders.h"
#include "platform/ports.h"
#include "platform/senses.h"
#include "ros/names.h"
#include "runtime/durable/file_disk.h"
#include "transport/dds/way.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

namespace rounds = runtime::rounds;
using rounds::Time;
using transport::Seconds;

namespace {

uint64_t Agreement(const RobotOptions& options, const Replica& replica) {
  runtime::codec::Bytes bytes;
  runtime::codec::Writer writer(bytes);
  for (const std::string* text : {&options.program, &options.spec, &options.fleet})
    writer.Block({reinterpret_cast<const uint8_t*>(text->data()), text->size()});
  writer.Block(replica.before());
  return runtime::codec::Sum(bytes);
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
        name_(fleet.robots[self_].name),
        clock_(fleet.ros.use_sim_time),
        announcer_(fleet.robots[self_].node_namespace, options.tell) {}

  base::Result<bool> Prepare() {
    const size_t before = diagnostics_.errors();
    ports_ = platform::PortsOf(model_, fleet_, diagnostics_);
    if (diagnostics_.errors() != before) return Reported();
    planner_ = std::make_unique<PlannerThread>(fleet_.clearance / 2);
    replica_ = Make(planner_.get());
    if (replica_ == nullptr) return Reported();
    if (options_.attach) {
      if (const auto attached = options_.attach(replica_->team()); !attached.ok()) return attached.error();
    }
    agreement_ = Agreement(options_, *replica_);
    auto participant = dds::Participant::Open(options_.network);
    if (!participant.ok()) return participant.error();
    participant_ = std::move(participant).value();
    node_ = participant_->AddNode({"/" + fleet_.robots[self_].node_namespace, "rondo"});
    if (auto begun = clock_.Begin(*participant_, node_); !begun.ok()) return begun;
    senses_ = std::make_unique<platform::Senses>(model_, fleet_, ports_, self_, replica_->body(self_),
                                                 replica_->team().heap(), clock_);
    if (auto begun = senses_->Begin(*participant_, node_); !begun.ok()) return begun;
    replica_->node().SetSensors(senses_.get());
    orders_ = std::make_unique<platform::Orders>(model_, fleet_, ports_, self_, *senses_, clock_);
    if (auto begun = orders_->Begin(*participant_, node_); !begun.ok()) return begun;
    auto diagnostics = participant_->Publish(node_, "/diagnostics",
                                             ros::diagnostic_msgs::DiagnosticArray::kMessage, ros::kDefault);
    if (!diagnostics.ok()) return diagnostics.error();
    status_ = std::move(diagnostics).value();
    if (auto begun = announcer_.Begin(*participant_, node_); !begun.ok()) return begun;
    if (auto echoes = Echo(); !echoes.ok()) return echoes;
    std::vector<std::string> names;
    for (const sim::FleetRobot& robot : fleet_.robots) names.push_back(robot.name);
    auto way =
        transport::dds::Connect(*participant_, node_, {ros::Plain(options_.program_name), names, self_});
    if (!way.ok()) return way.error();
    way_ = std::move(way).value();
    return OpenFiles(names);
  }

  RobotReport Run() {
    if (WaitForSensors()) {
      rounds_ =
          std::make_unique<RoundThread>(fleet_, self_, *replica_, *senses_, *orders_, clock_, log_.get());
      ClockedWay way(*way_, clock_);
      const base::StopToken ended;
      std::thread thread([&] { rounds_->Run(settings_, disk_.get(), record_, way, ended); });
      report_.ending = Watch();
      ended.RequestStop();
      thread.join();
      Fill(rounds_->View());
    } else {
      report_.ending = RobotEnding::kInterrupted;
    }
    if (const auto place = senses_->place()) orders_->Stay(place->position);
    report_.late = orders_->late();
    return report_;
  }

  base::Result<bool> Finish() { return log_ == nullptr ? base::Result<bool>(true) : log_->Finish(); }

 private:
  using Level = Announcer::Level;
  static base::Error Reported() { return {}; }
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
      if (const auto made = base::MakeFolders(options_.folder); !made.ok())
        return base::Error{
            fmt::format("cannot use the folder `{}`: {}", options_.folder, made.error().message)};
      disk_ = std::make_unique<runtime::durable::FileDisk>(
          std::filesystem::path(options_.folder) /
          fmt::format("{}-{:016x}.record", name_, settings_.session));
      record_ = disk_->Read();
    }
    if (options_.log.empty()) return true;
    auto replica = Make(nullptr);
    if (replica == nullptr) return Reported();
    const LogHead head{
        self_, settings_.incarnation, settings_.session, options_.seed, settings_.lease, settings_.stop_time,
        names, options_.program_name, options_.program,  options_.spec, options_.fleet,  options_.files};
    report_.log = UnusedLogName(options_.log);
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

  void Tell(const std::string& text, Level level) { announcer_.Tell(text, level, clock_.Stamp()); }

  // Nobody can run `init` without knowing where it is.
  bool WaitForSensors() {
    std::string last;
    for (int i = 0;; ++i) {
      if (options_.stop.StopRequested()) return false;
      const std::string why = senses_->Unusable();
      if (why.empty()) return true;
      if (i % 20 == 10 && why != last) Tell("waiting: " + (last = why), Level::kWarning);
      if (i % 10 == 0) Publish(why, nullptr);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

  RobotEnding Watch() {
    using Clock = std::chrono::steady_clock;
    auto next = Clock::now();
    bool blind = false;
    for (int seconds = 0;;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const RoundView view = rounds_->View();
      const std::optional<RobotEnding> ending = Ending(view);
      if (Clock::now() >= next || ending) {
        next = Clock::now() + std::chrono::seconds(1);
        const std::string still = ClockNews();
        const std::string why = still.empty() ? senses_->Unusable() : still;
        Publish(why, &view);
        if (blind != !why.empty())
          Tell(why.empty() ? "the sensors are usable again" : "skips: " + why, Level::kWarning);
        blind = !why.empty();
        if (!view.begun_at && seconds++ % 10 == 2) Tell(Awaited(view), Level::kWarning);
      }
      for (const auto& [text, level] : rounds_->TakeNews()) Tell(text, static_cast<Level>(level));
      if (const std::string problem = orders_->TakeProblem(); !problem.empty()) Tell(problem, Level::kError);
      if (ending) return *ending;
    }
  }

  // Says what is wrong with a clock that is simulated: it may be meant to stand still.
  std::string ClockNews() {
    if (!clock_.simulated()) return {};
    if (const uint64_t back = clock_.set_back(); std::exchange(set_back_, back) != back)
      Tell("/clock was set back: is there more than one who sends it?", Level::kWarning);
    const Time now = clock_.Now(), here = transport::BootTime();
    if (std::exchange(clock_stood_at_, now) != now) clock_moved_ = here;
    const double still = Seconds(here - clock_moved_);
    return still > 2 ? fmt::format("/clock stands still for {:.0f} s", still) : "";
  }

  // Says whom it waits for, in the beginning.
  std::string Awaited(const RoundView& view) const {
    return view.foreign > 0       ? "waiting: somebody runs another program, specification or fleet file"
           : view.strange > 0     ? "waiting: the others are in another session (`--session`)"
           : view.unheard.empty() ? "waiting for the others to begin"
                                  : fmt::format("waiting for {}", fmt::join(view.unheard, ", "));
  }

  std::optional<RobotEnding> Ending(const RoundView& view) const {
    const Time now = clock_.Now();
    if (!view.broken.empty()) return RobotEnding::kBroken;
    if (options_.stop.StopRequested()) return RobotEnding::kInterrupted;
    if (view.phase == rounds::Phase::kHalted) return RobotEnding::kHalted;
    // The others have to hear of the last round, too.
    if (view.stopped_at && now - *view.stopped_at > settings_.lease) return RobotEnding::kStopped;
    if (options_.duration > 0 && view.begun_at && Seconds(now - *view.begun_at) > options_.duration)
      return RobotEnding::kTime;
    return std::nullopt;
  }

  void Fill(const RoundView& view) {
    report_.rounds = view.rounds;
    report_.fallbacks = view.fallbacks;
    report_.blind = view.blind;
    report_.failed = view.failed;
    report_.broken = view.broken;
    report_.median = view.median;
    report_.p99 = view.p99;
    report_.most = view.most;
  }

  // @param view  nullptr: it has not begun.
  void Publish(const std::string& sensors, const RoundView* view) {
    RobotStatus s;
    s.robot = name_;
    s.program = options_.program_name;
    s.agreement = fmt::format("{:016x}", agreement_);
    s.sensors = sensors;
    s.late = orders_->late();
    s.phase = view == nullptr ? "waiting" : std::string(Name(view->phase));
    if (view != nullptr) {
      s.epoch = view->place.epoch;
      s.round = view->place.round;
      s.active = view->active;
      s.median = 1e3 * view->median;
      s.p99 = 1e3 * view->p99;
      s.fallbacks = view->fallbacks;
      s.blind = view->blind;
      s.refused = view->refused;
      s.foreign = view->foreign;
      s.strange = view->strange;
      s.unheard = view->unheard;
    }
    (void)status_->Publish(MessageOf(s, clock_.Stamp())).ok();
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
  platform::Clock clock_;
  std::unique_ptr<platform::Senses> senses_;
  std::unique_ptr<platform::Orders> orders_;
  std::unique_ptr<dds::Publisher> status_;
  Announcer announcer_;
  std::unique_ptr<dds::Publisher> echo_answers_;
  std::unique_ptr<dds::Subscription> echo_questions_;
  std::unique_ptr<transport::Transport> way_;
  std::unique_ptr<runtime::durable::FileDisk> disk_;
  std::optional<runtime::codec::Bytes> record_;
  std::unique_ptr<LogWriter> log_;
  rounds::Settings settings_;
  std::unique_ptr<RoundThread> rounds_;

  uint64_t set_back_ = 0;
  Time clock_stood_at_ = 0, clock_moved_ = transport::BootTime();
  RobotReport report_;
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
  const std::vector<sim::Port> ports = platform::PortsOf(model, fleet, diagnostics);
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
