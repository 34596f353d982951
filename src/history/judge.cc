#include "history/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "history/explain.h"
#include "koord/semantics/fallback.h"

namespace rondo::history {

namespace {

using Place = std::pair<uint64_t, uint64_t>;  // epoch, round

class Check {
 public:
  Check(koord::semantics::Team& team, const Record& record, const Judge::About& about,
        const base::StopToken& stop)
      : team_(team), record_(record), about_(about), stop_(stop), explainer_(team) {}

  std::vector<Finding> Run() {
    for (size_t i = 0; i < record_.entries.size(); ++i) {
      if (i % kLook == 0 && stop_.StopRequested()) break;
      const Entry& e = record_.entries[i];
      at_ = i;
      if (e.robot >= record_.robots) {
        Say(Wrong::kUnreadable, "there is no such robot");
        continue;
      }
      switch (e.kind) {
        case Kind::kStarted:
        case Kind::kCrashed:
          break;
        case Kind::kFellBack:
          FellBack(e);
          break;
        case Kind::kAdopted:
          Adopted(e);
          break;
        case Kind::kContributed:
          Contributed(e);
          break;
        case Kind::kStored:
          Stored(e);
          break;
        case Kind::kCommitted:
          Committed(e);
          break;
        case Kind::kActed:
          Acted(e);
          break;
      }
    }
    Alone();
    std::ranges::stable_sort(found_, {}, &Finding::entry);
    return std::move(found_);
  }
  size_t rounds() const { return rounds_; }

 private:
  void Say(Wrong wrong, std::string text) { found_.push_back({wrong, at_, std::move(text)}); }
  static std::string Of(const Entry& e) { return fmt::format("robot {}", e.robot); }
  static Life LifeOf(const Entry& e) { return {e.robot, e.incarnation}; }
  bool Takes(uint64_t epoch, Life life) const {
    const auto it = members_.find(epoch);
    return it != members_.end() && std::ranges::find(it->second, life) != it->second.end();
  }

  // Who runs the fallbacks again on what the sensors read then gets the same.
  void FellBack(const Entry& e) {
    if (team_.fallbacks().empty()) return;
    if (e.what >= record_.images.size()) return Say(Wrong::kUnreadable, "there is no such state");
    const std::vector<Word> seen = StateOf(team_, record_.images[e.what]);
    if (seen.empty()) return Say(Wrong::kUnreadable, "an image is none of this program's");
    std::vector<Word> again = seen;
    koord::semantics::FallBack(team_, again, e.robot);
    if (again != seen)
      Say(Wrong::kNoFallback, Of(e) + " has lost the others and does not do what its fallback says");
    fallen_[e.robot] = e.what;
  }

  void Adopted(const Entry& e) {
    if (e.what >= record_.members.size()) return Say(Wrong::kUnreadable, "there is no such list of members");
    const auto [it, fresh] = members_.emplace(e.epoch, record_.members[e.what]);
    if (fresh || it->second == record_.members[e.what]) return;
    Say(Wrong::kDiverged,
        fmt::format("{} knows other members of epoch {} than robots before it", Of(e), e.epoch));
  }

  void Contributed(const Entry& e) {
    const auto [it, fresh] = said_.emplace(std::tuple(LifeOf(e), e.epoch, e.round), e.what);
    if (!fresh && record_.texts[it->second] != record_.texts[e.what])
      Say(Wrong::kTwice, fmt::format("{} says two different things in round {}", Of(e), e.round));
    if (fresh && e.skips) skipped_.insert({e.robot, e.epoch, e.round});
    if (fresh && !e.waits.empty()) waiting_[{e.robot, e.epoch, e.round}] = e.waits;
    if (fresh) spoke_[{LifeOf(e), e.epoch, e.round}] = e.Clock();
    // What it set before it speaks can be part of what it says.
    if (const auto fell = fallen_.find(e.robot); fresh && fell != fallen_.end())
      fell_before_[{e.robot, e.epoch, e.round}] = fell->second;
    const auto acted = last_acted_.find(e.robot);
    if (acted != last_acted_.end() && e.round < acted->second)
      Say(Wrong::kWithdrawn,
          fmt::format("{} repeats round {}, and has acted on the state behind it", Of(e), e.round));
  }

  void Stored(const Entry& e) {
    if (e.what >= record_.images.size()) return Say(Wrong::kUnreadable, "there is no such state");
    const Place place{e.epoch, e.round};
    holders_[place].insert(e.robot);
    const auto [it, fresh] = states_.emplace(place, e.what);
    if (!fresh) {
      if (!Same(it->second, e.what))
        Say(Wrong::kDiverged,
            fmt::format("{} has another state at the start of round {} than robots before it", Of(e),
                        e.round));
      return;
    }
    // What an epoch begins with is what some epoch before it ended with; else there was a round.
    const auto before = e.round == 0 ? states_.end() : states_.find({e.epoch, e.round - 1});
    if (before != states_.end()) return Explain(e, before->second);
    if (e.round == 0) return;
    bool known = false;
    for (const auto& [other, image] : states_)
      known = known || (other.second == e.round && other.first < e.epoch && Same(image, e.what));
    if (!known)
      Say(Wrong::kLost,
          fmt::format("epoch {} begins with a state of round {} that nobody had", e.epoch, e.round));
  }

  bool Same(size_t a, size_t b) const { return a == b || record_.images[a] == record_.images[b]; }

  void Explain(const Entry& e, size_t before) {
    if (before != last_image_) last_state_ = StateOf(team_, record_.images[before]);
    const std::vector<Word> from = std::move(last_state_);
    last_image_ = e.what;  // most likely the one before the next round
    last_state_ = StateOf(team_, record_.images[e.what]);
    const std::vector<Word>& to = last_state_;
    if (from.empty() || to.empty()) return Say(Wrong::kUnreadable, "an image is none of this program's");
    std::vector<bool> may_skip(record_.robots, true);
    if (const auto it = members_.find(e.epoch); it != members_.end()) {
      for (const Life& life : it->second) may_skip[life.robot] = false;
    }
    ++rounds_;
    std::vector<std::vector<Word>> fallen(record_.robots);
    std::vector<std::vector<uint32_t>> waits(record_.robots);
    for (uint32_t r = 0; r < record_.robots; ++r) {
      const auto waiting = waiting_.find({r, e.epoch, e.round - 1});
      if (waiting != waiting_.end()) waits[r] = waiting->second;
      const auto it = fell_before_.find({r, e.epoch, e.round - 1});
      if (it != fell_before_.end()) fallen[r] = StateOf(team_, record_.images[it->second]);
    }
    if (about_) about_(e.epoch, e.round - 1);
    const auto how = explainer_.Explain(from, to, e.round == 1, may_skip, fallen, waits);
    if (!how)
      return Say(
          Wrong::kNoRound,
          fmt::format("no round of the program leads to the state at the start of round {} that {} has",
                      e.round, Of(e)));
    // Who could act and did not was refused a lock.
    for (uint32_t r = 0; r < record_.robots; ++r) {
      size_t& in_vain = in_vain_[{e.epoch, r}];
      const bool wanted =
          how->idle[r] && how->could_act[r] && !may_skip[r] && !skipped_.contains({r, e.epoch, e.round - 1});
      in_vain = wanted ? in_vain + 1 : 0;
      const size_t members = members_.contains(e.epoch) ? members_[e.epoch].size() : record_.robots;
      if (in_vain == members)
        Say(Wrong::kStarved, fmt::format("robot {} wanted to act in {} rounds up to round {}, and never did",
                                         r, in_vain, e.round - 1));
    }
    if (team_.heap().words_in_use() <= kMostWords) return;
    const std::span<const Word> states[] = {last_state_};
    team_.Collect(states);
  }

  void Committed(const Entry& e) {
    const auto it = states_.find({e.epoch, e.round});
    if (it == states_.end()) return Say(Wrong::kTooEarly, Of(e) + " calls a state final that nobody has");
    Majority(e, "calls final");
    const auto [final_one, fresh] = final_.emplace(e.round, it->second);
    if (!fresh && !Same(final_one->second, it->second))
      Say(Wrong::kLost,
          fmt::format("{} calls another state of round {} final than was final before", Of(e), e.round));
  }

  void Majority(const Entry& e, const char* does) {
    const auto it = holders_.find({e.epoch, e.round});
    const size_t count = it == holders_.end() ? 0 : it->second.size();
    if (2 * count <= record_.robots)
      Say(Wrong::kTooEarly,
          fmt::format("{} {} the state at the start of round {}, which {} of {} robots have", Of(e), does,
                      e.round, count, record_.robots));
  }

  void Acted(const Entry& e) {
    Majority(e, "acts on");
    last_acted_[e.robot] = std::max(last_acted_[e.robot], e.round);
    if (!Takes(e.epoch, LifeOf(e)))
      Say(Wrong::kTwoTeams, fmt::format("{} acts in epoch {}, in which it takes no part", Of(e), e.epoch));
    if (e.Clock() > e.until) Say(Wrong::kTooLate, fmt::format("{} acts when its lease is over", Of(e)));
    // The answer was to what it said in the round before.
    const auto spoke = spoke_.find({LifeOf(e), e.epoch, e.round - 1});
    if (e.round == 0 || spoke == spoke_.end() ||
        e.until > spoke->second + record_.lease + record_.lease / 500)
      Say(Wrong::kTooLate,
          fmt::format("{} may act longer than a lease after what it said in the round before {}", Of(e),
                      e.round));
    acts_.push_back(at_);
  }

  // While anybody who was left behind may still act, nobody acts in a later epoch.
  void Alone() {
    std::map<uint64_t, int64_t> first;  // by epoch: when somebody acted first
    for (const size_t i : acts_) {
      const Entry& e = record_.entries[i];
      const auto [it, fresh] = first.emplace(e.epoch, e.Clock());
      it->second = std::min(it->second, e.Clock());
    }
    for (const size_t i : acts_) {
      const Entry& e = record_.entries[i];
      for (auto it = first.upper_bound(e.epoch); it != first.end(); ++it) {
        if (Takes(it->first, LifeOf(e)) || e.until + record_.stop_time <= it->second) continue;
        at_ = i;
        Say(Wrong::kTwoTeams,
            fmt::format("{} may act until {:.3f} s, and robots act without it from {:.3f} s on", Of(e),
                        static_cast<double>(e.until) * 1e-9, static_cast<double>(it->second) * 1e-9));
        break;
      }
    }
  }

  static constexpr size_t kMostWords = 1'000'000;
  static constexpr size_t kLook = 256;  // entries between two looks for a stop

  koord::semantics::Team& team_;
  const Record& record_;
  const Judge::About& about_;
  const base::StopToken& stop_;
  Explainer explainer_;
  size_t at_ = 0;
  size_t last_image_ = kNothing;  // of the state that was explained last
  std::vector<Word> last_state_;
  size_t rounds_ = 0;
  std::vector<Finding> found_;
  std::map<uint64_t, std::vector<Life>> members_;                  // by epoch
  std::map<Place, size_t> states_;                                 // images
  std::map<Place, std::set<uint32_t>> holders_;                    // robots
  std::map<uint64_t, size_t> final_;                               // by round: images
  std::map<std::tuple<Life, uint64_t, uint64_t>, size_t> said_;    // texts
  std::map<std::tuple<Life, uint64_t, uint64_t>, int64_t> spoke_;  // times
  std::map<uint32_t, size_t> fallen_;                              // by robot: images
  std::map<std::tuple<uint32_t, uint64_t, uint64_t>, size_t>
      fell_before_;  // a robot spoke in a round: images
  std::map<std::tuple<uint32_t, uint64_t, uint64_t>, std::vector<uint32_t>>
      waiting_;                                                 // robot, epoch, round: events
  std::set<std::tuple<uint32_t, uint64_t, uint64_t>> skipped_;  // the same: it chose to
  std::map<uint32_t, uint64_t> last_acted_;                     // by robot: rounds
  std::map<std::pair<uint64_t, uint32_t>, size_t> in_vain_;     // by epoch and robot: rounds in a row
  std::vector<size_t> acts_;                                    // entries
};

}  // namespace

std::vector<Finding> Judge::Check(const Record& record, const base::StopToken& stop) {
  history::Check check(team_, record, about_, stop);
  std::vector<Finding> found = check.Run();
  rounds_ = check.rounds();
  return found;
}

std::string_view Name(Wrong wrong) {
  switch (wrong) {
    case Wrong::kDiverged:
      return "diverged";
    case Wrong::kNoRound:
      return "no-round";
    case Wrong::kLost:
      return "lost";
    case Wrong::kTooEarly:
      return "too-early";
    case Wrong::kTooLate:
      return "too-late";
    case Wrong::kTwoTeams:
      return "two-teams";
    case Wrong::kTwice:
      return "twice";
    case Wrong::kStarved:
      return "starved";
    case Wrong::kWithdrawn:
      return "withdrawn";
    case Wrong::kNoFallback:
      return "no-fallback";
    case Wrong::kUnreadable:
      return "unreadable";
  }
  return "";
}

std::string_view Meaning(Wrong wrong) {
  switch (wrong) {
    case Wrong::kDiverged:
      return "two robots know different things of one moment";
    case Wrong::kNoRound:
      return "a state does not follow from the one before by the program";
    case Wrong::kLost:
      return "a state that was final is lost";
    case Wrong::kTooEarly:
      return "a robot acts on what no majority has";
    case Wrong::kTooLate:
      return "a robot acts beyond its lease";
    case Wrong::kTwoTeams:
      return "robots act in two teams at once";
    case Wrong::kTwice:
      return "a robot says two different things in one round";
    case Wrong::kStarved:
      return "a robot never gets a lock";
    case Wrong::kWithdrawn:
      return "a robot repeats a round on which it has acted";
    case Wrong::kNoFallback:
      return "a robot that has lost the others does not do what its fallback says";
    case Wrong::kUnreadable:
      return "the record makes no sense";
  }
  return "";
}

}  // namespace rondo::history
