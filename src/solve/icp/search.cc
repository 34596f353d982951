#include "solve/icp/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "solve/icp/tape/contractor.h"
#include "solve/icp/tape/descent.h"

namespace rondo::solve::icp {
namespace {

using Kind = SearchResult::Kind;

constexpr int kDescents = 12;

/// What the threads of one search share.
class Shared {
 public:
  Shared(const Tape& the_tape, const SearchOptions& the_options) : tape(the_tape), options(the_options) {}

  // A stack of boxes: bounds and, for each, its node in the tree.
  struct Boxes {
    std::vector<double> bounds;
    std::vector<uint32_t> ids;
    size_t size() const { return ids.size(); }
  };

  const Tape& tape;
  const SearchOptions& options;
  std::atomic<bool> done{false};
  std::atomic<uint64_t> boxes{0};

  bool Idle() const { return waiting_.load(std::memory_order_relaxed) > 0; }

  void Offer(Boxes boxes_to_share) {
    const std::scoped_lock lock(mutex_);
    offers_.push_back(std::move(boxes_to_share));
    wake_.notify_one();
  }

  // Waits for boxes; false when all threads have run out of them.
  bool Take(Boxes& out, unsigned threads) {
    std::unique_lock lock(mutex_);
    waiting_.fetch_add(1);
    if (waiting_.load() == threads && offers_.empty()) done = true, wake_.notify_all();
    wake_.wait(lock, [&] { return done.load() || !offers_.empty(); });
    if (offers_.empty()) return false;
    waiting_.fetch_sub(1);
    out = std::move(offers_.back());
    offers_.pop_back();
    return true;
  }

  // A solution beats anything that was not decided.
  void Finish(std::vector<double> point) {
    const std::scoped_lock lock(mutex_);
    if (result_.kind == Kind::kPoint) return;
    result_.kind = Kind::kPoint;
    result_.point = std::move(point);
    done = true;
    wake_.notify_all();
  }

  // One at a time, and none after the search has ended: what they leave behind belongs to the answer.
  bool Verify(const std::vector<double>& point) {
    const std::scoped_lock lock(verify_mutex_);
    return !done && options.verify(point) && (done = true);
  }

  void GiveUp() {
    const std::scoped_lock lock(mutex_);
    gave_up_ = true;
    done = true;
    wake_.notify_all();
  }

  void Undecided(const FlatBox& box) {
    const std::scoped_lock lock(mutex_);
    if (result_.box.empty()) result_.box = box;
    if (++undecided_ < kUndecidedLimit) return;
    done = true;
    wake_.notify_all();
  }

  // The next two ids of the tree.
  uint32_t Split(uint32_t parent, uint32_t variable, double value) {
    if (!options.record_tree) return 0;
    const std::scoped_lock lock(tree_mutex_);
    const auto first = static_cast<uint32_t>(result_.tree.size());
    result_.tree.resize(first + 2);
    result_.tree[parent] = {first, variable, value};
    return first;
  }

  SearchResult Result() {
    if (result_.kind != Kind::kPoint) {
      result_.kind = undecided_ > 0 ? Kind::kUndecided : gave_up_ ? Kind::kGaveUp : Kind::kEmpty;
    }
    if (result_.kind != Kind::kEmpty) result_.tree.clear();
    result_.boxes = boxes;
    return std::move(result_);
  }

  // Contracts the box of the bounds as far as that goes. Its widths are what widths are compared with later.
  // False if it is empty.
  bool Start() {
    result_.tree.resize(options.record_tree ? 1 : 0);
    for (const TapeVariable& v : tape.variables) root.insert(root.end(), {v.root.lo, v.root.hi});
    Contractor contractor(tape, *options.kernels);
    for (int l = 0; l < kLanes; ++l) contractor.Load(l, root.data());
    if (contractor.Contract(kRootSweeps) == 0) return false;
    contractor.Store(0, root.data());
    return true;
  }

  FlatBox root;

 private:
  static constexpr int kUndecidedLimit = 32;
  static constexpr int kRootSweeps = 20;
  std::mutex mutex_, tree_mutex_, verify_mutex_;
  std::condition_variable wake_;
  std::atomic<unsigned> waiting_{0};
  std::vector<Boxes> offers_;
  SearchResult result_;
  int undecided_ = 0;
  bool gave_up_ = false;
};

class Worker {
 public:
  Worker(Shared& shared, unsigned threads)
      : shared_(shared),
        tape_(shared.tape),
        count_(tape_.variables.size()),
        threads_(threads),
        contractor_(tape_, *shared.options.kernels),
        points_(tape_, *shared.options.kernels),
        meter_(tape_, *shared.options.kernels),
        box_(2 * count_) {
    bool multiple = false;
    for (const TapeVariable& v : tape_.variables) multiple = multiple || !v.single;
    for (const TapeVariable& v : tape_.variables) branchable_.push_back(!multiple || !v.single);
  }

  Shared::Boxes stack;

  void Run() {
    while (!shared_.done.load(std::memory_order_relaxed)) {
      if (stack.size() == 0) {
        if (!shared_.Take(stack, threads_)) return;
        continue;
      }
      if (shared_.options.stop.StopRequested() ||
          shared_.boxes.load(std::memory_order_relaxed) > shared_.options.max_boxes) {
        shared_.GiveUp();
        return;
      }
      Step();
      if (threads_ > 1 && stack.size() > size_t{2} * kLanes && shared_.Idle()) Share();
    }
  }

 private:
  // Gives away the oldest quarter of the stack: the largest boxes.
  void Share() {
    const size_t n = stack.size() / 4;
    Shared::Boxes gift;
    gift.ids.assign(stack.ids.begin(), stack.ids.begin() + static_cast<std::ptrdiff_t>(n));
    gift.bounds.assign(stack.bounds.begin(),
                       stack.bounds.begin() + static_cast<std::ptrdiff_t>(n * 2 * count_));
    stack.ids.erase(stack.ids.begin(), stack.ids.begin() + static_cast<std::ptrdiff_t>(n));
    stack.bounds.erase(stack.bounds.begin(),
                       stack.bounds.begin() + static_cast<std::ptrdiff_t>(n * 2 * count_));
    shared_.Offer(std::move(gift));
  }

  void Step() {
    const size_t n = std::min<size_t>(kLanes, stack.size());
    const size_t first = stack.size() - n;
    std::array<uint32_t, kLanes> ids{};
    for (int l = 0; l < kLanes; ++l) {
      const size_t from = first + std::min<size_t>(static_cast<size_t>(l), n - 1);
      contractor_.Load(l, stack.bounds.data() + from * 2 * count_);
      ids[static_cast<size_t>(l)] = stack.ids[from];
    }
    stack.ids.resize(first);
    stack.bounds.resize(first * 2 * count_);
    shared_.boxes.fetch_add(n, std::memory_order_relaxed);
    ++steps_;
    const auto used = static_cast<Lanes>((1u << n) - 1);
    const auto alive = static_cast<Lanes>(contractor_.Contract(kSweeps) & used);
    if (alive == 0) return;
    if ((steps_ < 256 || steps_ % 8 == 0) && Probe(alive)) return;
    contractor_.Open(open_);
    meter_.Measure(contractor_.values(), open_, scores_);
    for (int l = 0; l < kLanes; ++l) {
      if ((alive >> l & 1) == 0) continue;
      contractor_.Store(l, box_.data());
      Branch(l, ids[static_cast<size_t>(l)]);
    }
  }

  // Is the middle of a box a solution?
  bool Probe(Lanes alive) {
    std::vector<double> point(2 * count_);
    for (int l = 0; l < kLanes; ++l) {
      contractor_.Store(l, box_.data());
      for (size_t v = 0; v < count_; ++v) {
        const interval::Interval range{box_[2 * v], box_[2 * v + 1]};
        double middle = (alive >> l & 1) != 0 ? range.Middle() : 0;
        if (tape_.variables[v].integral) middle = std::floor(middle);
        point[2 * v] = point[2 * v + 1] = middle;
      }
      points_.Load(l, point.data());
    }
    const auto possible = static_cast<Lanes>(points_.Evaluate() & alive);
    for (int l = 0; l < kLanes; ++l) {
      if ((possible >> l & 1) == 0) continue;
      points_.Store(l, point.data());
      std::vector<double> candidate(count_);
      for (size_t v = 0; v < count_; ++v) candidate[v] = point[2 * v];
      if (!shared_.Verify(candidate)) continue;
      shared_.Finish(std::move(candidate));
      return true;
    }
    return false;
  }

  double Width(size_t v) const { return box_[2 * v + 1] - box_[2 * v]; }

  bool Splittable(size_t v) const {
    const double lo = box_[2 * v];
    const double hi = box_[2 * v + 1];
    if (tape_.variables[v].integral) return lo < hi;
    constexpr double kFarAway = 0x1p1000;  // nothing that matters is decided out there
    if (std::isinf(hi - lo)) return lo < kFarAway && hi > -kFarAway;
    const double size = std::max(1.0, std::min(std::fabs(lo), std::fabs(hi)));
    return hi - lo > shared_.options.precision * size;
  }

  void Branch(int lane, uint32_t id) {
    // Of the variables that matter, only those that are still wide, compared with where they began: else one
    // would be split for ever.
    const auto score_of = [&](size_t v) { return scores_[v * kLanes + static_cast<size_t>(lane)]; };
    double widest = 0;
    for (size_t v = 0; v < count_; ++v) {
      if (branchable_[v] && Splittable(v) && score_of(v) > 0) widest = std::max(widest, RelativeWidth(v));
    }
    size_t best = count_;
    double best_score = -1;
    for (const bool any : {false, true}) {
      for (size_t v = 0; v < count_; ++v) {
        if (!Splittable(v)) continue;
        if (!any && (!branchable_[v] || RelativeWidth(v) < kAspect * widest)) continue;
        const double s = score_of(v);
        // Unbounded variables first: nothing can be said before they are cut.
        const double score = std::isinf(Width(v)) ? 1e300 : std::isfinite(s) ? s : 1e200;
        if (score > best_score) {
          best_score = score;
          best = v;
        }
      }
      if (best < count_) break;
    }
    if (best == count_) {
      if (StillEmpties()) return;
      std::vector<double> middle(count_);
      for (size_t v = 0; v < count_; ++v)
        middle[v] = interval::Interval{box_[2 * v], box_[2 * v + 1]}.Middle();
      if (shared_.Verify(middle)) {
        shared_.Finish(std::move(middle));
      } else {
        shared_.Undecided(box_);
      }
      return;
    }
    double middle = interval::Interval{box_[2 * best], box_[2 * best + 1]}.Middle();
    double next = middle;
    if (tape_.variables[best].integral) {
      middle = std::floor(middle);
      next = middle + 1;
    }
    const uint32_t child = shared_.Split(id, static_cast<uint32_t>(best), middle);
    for (const bool upper : {true, false}) {
      const size_t at = stack.bounds.size();
      stack.bounds.insert(stack.bounds.end(), box_.begin(), box_.end());
      stack.bounds[at + 2 * best + (upper ? 0 : 1)] = upper ? next : middle;
      stack.ids.push_back(child + (upper ? 1 : 0));
    }
  }

  // A box that contraction has just made small may be empty after some more.
  bool StillEmpties() {
    for (int l = 0; l < kLanes; ++l) points_.Load(l, box_.data());
    if (points_.Contract(kLastSweeps) == 0) return true;
    points_.Store(0, box_.data());
    return false;
  }

  double RelativeWidth(size_t v) const {
    const double scale = shared_.root[2 * v + 1] - shared_.root[2 * v];
    return std::isfinite(scale) && scale > 0 ? Width(v) / scale : std::min(1.0, Width(v));
  }

  static constexpr double kAspect = 0.1;
  static constexpr int kLastSweeps = 20;
  static constexpr int kSweeps = 2;
  Shared& shared_;
  const Tape& tape_;
  size_t count_;
  unsigned threads_;
  Contractor contractor_, points_;
  InfluenceMeter meter_;
  std::vector<Lanes> open_;
  FlatBox box_;
  std::vector<bool> branchable_;
  std::vector<double> scores_;
  uint64_t steps_ = 0;
};

}  // namespace

std::optional<FlatBox> ContractRoot(const Tape& tape, const interval::Kernels& kernels) {
  SearchOptions options;
  options.kernels = &kernels;
  Shared shared(tape, options);
  if (!shared.Start()) return std::nullopt;
  return shared.root;
}

SearchResult Search(const Tape& tape, const SearchOptions& options) {
  Shared shared(tape, options);
  ++shared.boxes;
  if (!shared.Start()) return shared.Result();
  Descent descent(tape, shared.root);
  for (int i = 0; i < kDescents && !options.stop.StopRequested(); ++i) {
    auto point = descent.Try();
    if (!point || !shared.Verify(*point)) continue;
    shared.Finish(std::move(*point));
    return shared.Result();
  }
  const unsigned threads = std::max(1u, options.jobs);
  std::vector<std::unique_ptr<Worker>> workers;
  for (unsigned i = 0; i < threads; ++i) workers.push_back(std::make_unique<Worker>(shared, threads));
  workers[0]->stack.bounds = shared.root;
  workers[0]->stack.ids.push_back(0);
  std::vector<std::thread> others;
  for (unsigned i = 1; i < threads; ++i) others.emplace_back([&workers, i] { workers[i]->Run(); });
  workers[0]->Run();
  for (std::thread& t : others) t.join();
  return shared.Result();
}

}  // namespace rondo::solve::icp
