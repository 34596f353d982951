#pragma once

#include <array>
#include <optional>
#include <vector>

#include "runtime/rounds/assembly.h"
#include "runtime/rounds/merge.h"
#include "runtime/rounds/outputs.h"
#include "runtime/rounds/register.h"
#include "runtime/rounds/settings.h"

/// The round protocol of one robot, as a deterministic machine: no thread, clock, socket, file or random
/// number is in it (docs/runtime.md).
namespace rondo::runtime::rounds {

using codec::Member;

/// Keeps records where a crash cannot reach them.
class Disk {
 public:
  virtual ~Disk() = default;
  /// Puts a record in the place of the one before: after a crash there is the one or the other, as a whole.
  /// Returns whether it did. Until the next record is kept, the core neither votes nor counts.
  virtual bool Keep(View record) = 0;
};

/// Names where a robot is in a round.
enum class Phase : uint8_t {
  kOutside,     ///< no epoch has it as a member
  kFetching,    ///< it lacks the store that its epoch begins with
  kStored,      ///< it has the store of the round, and waits until a majority has
  kCommitted,   ///< a majority has; the next round begins when it is time
  kCollecting,  ///< it said what it does in this round, and waits for the others
  kHalted,      ///< for ever
};

/// Returns `outside`, `fetching`, `stored`, `committed`, `collecting` or `halted`.
std::string_view Name(Phase phase);

/// Runs the protocol for one robot. What it guarantees (docs/theory.md, "Rounds on robots"): no two robots ever
/// commit different stores for one round; a robot acts only on committed stores, and not beyond its lease; nobody
/// acts in an epoch before the leases of those who are no members of it are over. Rounds go on only while a
/// strict majority of the fleet has forgotten nothing. Requires clocks within `drift_ppm` of each other and
/// adapters that keep `stop_time`.
class Core {
 public:
  /// @param settings  with at most `codec::kMostRobots` robots; the incarnation is greater than in any life before,
  /// also if the disk was lost.
  /// @param program  outlives the core; its store is the one before `init`, or what `record` says.
  /// @param disk  nullptr: nothing is kept, and a robot does not vote after a crash until an epoch admits it
  /// and it has the store of that. Else stores and promises are kept before anybody hears of them.
  /// @param record  what was last kept by an earlier life on the same disk, if there is one.
  Core(const Settings& settings, Program& program, Disk* disk, std::optional<View> record);
  /// Copies a core, for searches; `program` and `disk` are copies of the other's.
  Core(const Core& other, Program& program, Disk* disk);
  Core& operator=(const Core&) = delete;

  /// Takes a datagram, or none (time went on), at a moment that is not before the last one, and appends what
  /// is to be done, in order.
  void Step(Time now, View datagram, Outputs& outputs);
  /// Returns when to come back, if no datagram comes before.
  Time wake() const { return wake_; }

  Phase phase() const { return phase_; }
  Place place() const { return place_; }
  bool active() const { return active_; }
  /// Reports whether its vote counts for the next epoch.
  bool votes() const { return MayVote(Epoch() + 1); }
  /// Appends everything that decides what the core does from now on, with moments as they lie from now: cores with the
  /// same description and the same store do the same. For searches (docs/theory.md, "Rounds on robots").
  void Describe(Bytes& out) const;
  /// Returns when a robot was heard last; nothing if it never was.
  std::optional<Time> heard(uint32_t robot) const {
    return peers_[robot].heard ? std::optional(peers_[robot].last) : std::nullopt;
  }
  /// Returns how many datagrams were refused, by reason.
  const std::array<uint64_t, 5>& refused() const { return refused_; }

 private:
  Core(const Core&) = default;

  struct Peer {
    uint64_t incarnation = 0;
    bool heard = false;
    Time last = 0;
    Place at;
    bool holds = false, counts = false;
    bool final = false;  // it committed that store
  };

  // core.cc
  uint64_t Epoch() const { return decision_ ? decision_->epoch : 0; }
  bool Recent(uint32_t robot) const;
  int RankOf(Member member) const;
  void Receive(View bytes);
  void Wake();
  void On(Member from, const codec::Status& status);
  void On(Member from, const codec::Part& part);
  void SeeFinal(Place at);
  void Unpack(const codec::Part& part);
  void On(Member from, const codec::Prepare& prepare);
  void On(Member from, const codec::Promise& promise);
  void On(Member from, const codec::Accept& accept);
  void On(Member from, const codec::Accepted& accepted);
  void On(Member from, const codec::Refusal& refusal);
  void On(Member from, const codec::Decided& decided);
  void Timers();
  void Post(uint32_t to, codec::Body body);
  void Fail(const char* what);
  bool Majority(uint32_t count) const { return count >= settings_.majority(); }

  // round.cc
  void Begin();
  bool Acceptable(uint32_t robot, View frame);
  void TryMerge();
  void PassOn();
  void StoreNow();
  void TryCommit();
  void EndLease();

  // resend.cc
  void Progress();
  Time SlowestRepetition() const;
  codec::Status MyStatus(bool asks, bool forwards) const;
  void SendStatus();
  void Serve(Member from, const codec::Status& status);
  void SendFrames(uint32_t to, const std::vector<Assembly>& frames, Place at, const codec::Status& status);
  bool Waits() const;
  void Repeat();

  // epochs.cc
  bool MayVote(uint64_t epoch) const;
  bool Wanted() const;
  bool MayJoin(uint32_t robot) const;
  Time Silence() const;
  std::vector<Member> Candidates() const;
  void TryHalt();
  Time Turn() const;
  Time Again() const;
  void GiveWay(codec::Ballot other);
  void TryEpoch();
  void Ask();
  void Choose();
  void VoteForOwn();
  void Vote();
  void Adopt(const Decision& decision);
  void Enter();
  void TakePart();
  void KeepRecord();
  void Recall(View record);

  const Settings settings_;
  Program* program_;
  Disk* disk_;
  Time now_ = 0;
  Outputs* outputs_ = nullptr;
  Time wake_ = 0;
  Phase phase_ = Phase::kOutside;
  bool started_ = false;

  // The epoch and the round.
  std::optional<Decision> decision_;  // of the present epoch
  std::vector<uint32_t> members_;     // robots, in order
  int rank_ = -1;                     // among the members
  std::optional<uint32_t> collector_, counter_;
  Place place_;                            // where the protocol is
  Place held_;                             // the store that the program has
  Bytes store_;                            // that store
  uint64_t digest_ = 0;                    // of that
  std::vector<Assembly> frames_, before_;  // by member: of this round, and of the one before
  Assembly bundle_;                        // the frames of all, on their way from or to the collector
  Assembly base_;                          // what is fetched
  Time round_start_ = 0, first_sent_ = 0;
  bool asked_in_epoch_ = false;  // a frame of this robot was sent in this epoch

  // Acting.
  bool active_ = false;
  bool acted_ = false;  // or fell back, in this step
  Time lease_end_ = 0;
  Time not_before_ = 0;  // in this epoch nobody acts earlier

  // Others.
  std::vector<Peer> peers_;
  Time resend_at_ = 0, interval_ = 0;
  uint32_t attempt_ = 0;  // repetitions since the last progress
  Time progress_at_ = 0;
  std::optional<Time> merged_at_;  // the last round of this epoch

  // Epochs.
  Voter voter_;
  bool votes_ = false;  // it was admitted, and has lost nothing that it promised or stored since
  bool disk_failed_ = false;
  std::optional<Attempt> trial_;  // to decide the next epoch
  uint64_t highest_ballot_ = 0;
  Time try_at_ = 0;
  Time tried_at_ = 0;        // the last attempt, or when one became wanted
  Time give_way_until_ = 0;  // to the attempt of another
  uint32_t tries_ = 0;       // since it is wanted
  bool wanted_ = false;

  std::array<uint64_t, 5> refused_{};

  // Kept for their memory.
  codec::Message message_;
  Contribution checked_;
  std::vector<Contribution> contributions_;
  std::vector<rounds::Turn> turns_;
  Bytes record_;
};

}  // namespace rondo::runtime::rounds
