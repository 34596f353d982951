#pragma once

#include <cmath>
#include <limits>

#include "program/fault.h"
#include "program/text.h"
#include "program/values.h"

/// Evaluates the expressions of programs that were made by `rondo build`, to the letter of the language.
namespace rondo::program {

/// Says what came of a call of an external function.
enum class Answer : uint8_t {
  kValue,
  kNone,   ///< the function has no value there: `Fault::kExternal`
  kLater,  ///< it is not finished: the robot skips, and asks again in the next round
};

/// Chooses for `any`.
class Choice {
 public:
  virtual ~Choice() = default;
  /// Returns a number below `possibilities`.
  virtual uint64_t Pick(uint64_t possibilities) noexcept = 0;
};

/// Bounds the iterations of loops and calls of functions in one event, both together.
inline constexpr uint64_t kMostSteps = 100'000'000;

/// Is the value that an operation without a value has where one is needed.
template <typename T>
inline const T kZero{};

/// Follows one evaluation of an event or a formula. An operation that has no value says so here and goes on with zero: the first
/// fault counts, and nothing that comes after it has an effect. In formulas (`total`) operations without a value are zero, which
/// `used_default` tells.
class Step {
 public:
  /// @param robot  who evaluates; `choice`: for `any`, nullptr where there is none.
  explicit Step(int64_t robot, bool total = false, Choice* choice = nullptr) noexcept
      : pid(robot), total_(total), choice_(choice) {}

  const int64_t pid;

  bool failed() const noexcept { return fault_ != Fault::kNone; }
  Fault fault() const noexcept { return fault_; }
  Place place() const noexcept { return place_; }
  bool used_default() const noexcept { return used_default_; }

  /// Says that the evaluation cannot be completed.
  void Fail(Fault fault, Place at) noexcept {
    if (failed()) return;
    fault_ = fault;
    place_ = at;
  }
  /// Says that an operation has no value.
  void Undefined(Fault fault, Place at) noexcept {
    if (!total_) return Fail(fault, at);
    used_default_ = true;
  }

  // Integers of 64 bits that never wrap, with Euclidean division.
  int64_t Add(int64_t a, int64_t b, Place at) noexcept {
    int64_t sum = 0;
    if (__builtin_add_overflow(a, b, &sum)) Fail(Fault::kOverflow, at);
    return sum;
  }
  int64_t Sub(int64_t a, int64_t b, Place at) noexcept {
    int64_t difference = 0;
    if (__builtin_sub_overflow(a, b, &difference)) Fail(Fault::kOverflow, at);
    return difference;
  }
  int64_t Mul(int64_t a, int64_t b, Place at) noexcept {
    int64_t product = 0;
    if (__builtin_mul_overflow(a, b, &product)) Fail(Fault::kOverflow, at);
    return product;
  }
  int64_t Div(int64_t a, int64_t b, Place at) noexcept {
    if (b == 0) return Undefined(Fault::kDivision, at), 0;
    if (a == kLeast && b == -1) return Fail(Fault::kOverflow, at), 0;
    const int64_t towards_zero = a / b;
    return a % b < 0 ? towards_zero - (b > 0 ? 1 : -1) : towards_zero;
  }
  int64_t Mod(int64_t a, int64_t b, Place at) noexcept {
    if (b == 0) return Undefined(Fault::kDivision, at), 0;
    if (b == -1) return 0;
    const int64_t rest = a % b;
    return rest < 0 ? (b > 0 ? rest + b : rest - b) : rest;
  }
  int64_t Neg(int64_t a, Place at) noexcept { return Sub(0, a, at); }
  int64_t Abs(int64_t a, Place at) noexcept { return a < 0 ? Neg(a, at) : a; }

  // Doubles that are always finite, with one zero.
  double Add(double a, double b, Place at) noexcept { return Finite(a + b, at); }
  double Sub(double a, double b, Place at) noexcept { return Finite(a - b, at); }
  double Mul(double a, double b, Place at) noexcept { return Finite(a * b, at); }
  double Div(double a, double b, Place at) noexcept {
    if (b == 0) return Undefined(Fault::kDivision, at), 0;
    return Finite(a / b, at);
  }
  double Neg(double a, Place) noexcept { return -a + 0.0; }
  double Abs(double a, Place) noexcept { return std::fabs(a); }
  double Sqrt(double a, Place at) noexcept {
    if (a < 0) return Undefined(Fault::kRoot, at), 0;
    return std::sqrt(a) + 0.0;
  }
  double Hypot(double a, double b, Place at) noexcept { return Finite(std::sqrt(a * a + b * b), at); }
  int64_t Floor(double a, Place at) noexcept { return Whole(std::floor(a), at); }
  int64_t Ceil(double a, Place at) noexcept { return Whole(std::ceil(a), at); }
  int64_t Round(double a, Place at) noexcept { return Whole(std::round(a), at); }
  int64_t Sign(double a) noexcept { return a > 0 ? 1 : a < 0 ? -1 : 0; }

  // Points, coordinate by coordinate.
  Pos Add(const Pos& a, const Pos& b, Place at) noexcept {
    return Coordinates(a, b, at, [](double p, double q) { return p + q; });
  }
  Pos Sub(const Pos& a, const Pos& b, Place at) noexcept {
    return Coordinates(a, b, at, [](double p, double q) { return p - q; });
  }
  Pos Mul(const Pos& a, const Pos& b, Place at) noexcept {
    return Coordinates(a, b, at, [](double p, double q) { return p * q; });
  }
  Pos Div(const Pos& a, const Pos& b, Place at) noexcept {
    if (b.x == 0 || b.y == 0 || b.z == 0) Undefined(Fault::kDivision, at);
    return Coordinates(a, b, at, [](double p, double q) { return q == 0 ? 0 : p / q; });
  }
  Pos Neg(const Pos& a, Place) noexcept { return {-a.x + 0.0, -a.y + 0.0, -a.z + 0.0}; }
  Pos Mid(const Pos& a, const Pos& b, Place at) noexcept {
    return Coordinates(a, b, at, [](double p, double q) { return (p + q) / 2; });
  }
  double Dist(const Pos& a, const Pos& b, Place at) noexcept {
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    double sum = x * x;
    sum += y * y;
    sum += z * z;
    return Finite(std::sqrt(sum), at);
  }

  template <typename T>
  auto Add(const Two<T>& two, Place at) noexcept {
    return Add(two.a, two.b, at);
  }
  template <typename T>
  auto Sub(const Two<T>& two, Place at) noexcept {
    return Sub(two.a, two.b, at);
  }
  template <typename T>
  auto Mul(const Two<T>& two, Place at) noexcept {
    return Mul(two.a, two.b, at);
  }
  template <typename T>
  auto Div(const Two<T>& two, Place at) noexcept {
    return Div(two.a, two.b, at);
  }
  template <typename T>
  auto Mod(const Two<T>& two, Place at) noexcept {
    return Mod(two.a, two.b, at);
  }

  // Items of lists, arrays, and of all robots.
  template <typename Items>
  const auto& At(const Items& items, int64_t index, Place at) noexcept {
    using T = std::remove_cvref_t<decltype(items[0])>;
    if (index >= 0 && static_cast<uint64_t>(index) < items.size()) [[likely]]
      return static_cast<const T&>(items[static_cast<size_t>(index)]);
    Undefined(Fault::kIndex, at);
    return kZero<T>;
  }
  /// Returns the place among all items of an array of arrays: `outer` is that of the inner array, and `index` that in it.
  int64_t Flat(int64_t outer, int64_t index, int64_t length, Place at) noexcept {
    int64_t flat = 0;
    if (index >= 0 && index < length && outer >= 0 && !__builtin_mul_overflow(outer, length, &flat) &&
        !__builtin_add_overflow(flat, index, &flat))
      return flat;
    Undefined(Fault::kIndex, at);
    return -1;
  }
  /// Returns the item at a place that `Flat` counted, `kLevels` arrays deep.
  template <int kLevels, typename Items>
  const auto& AtFlat(const Items& items, int64_t flat, Place at) noexcept {
    using T = std::remove_cvref_t<decltype(Nested<kLevels>(items, 0))>;
    if (flat >= 0 && static_cast<uint64_t>(flat) < Count<kLevels>(items)) [[likely]]
      return static_cast<const T&>(Nested<kLevels>(items, static_cast<size_t>(flat)));
    Undefined(Fault::kIndex, at);
    return kZero<T>;
  }
  /// Returns an item to write to; without it, something that nobody reads.
  template <typename Items>
  auto& Ref(Items& items, int64_t index, Place at) noexcept {
    using T = std::remove_cvref_t<decltype(items[0])>;
    if (index >= 0 && static_cast<uint64_t>(index) < items.size()) [[likely]]
      return static_cast<T&>(items[static_cast<size_t>(index)]);
    Undefined(Fault::kIndex, at);
    return Nowhere<T>();
  }
  template <typename T>
  static T& Nowhere() noexcept {
    static thread_local T nowhere;
    return nowhere;
  }
  template <int kLevels, typename Items>
  static auto& Nested(Items& items, size_t flat) noexcept {
    if constexpr (kLevels <= 1) {
      return items[flat];
    } else {
      const size_t inner = Count<kLevels - 1>(items[0]);
      return Nested<kLevels - 1>(items[flat / inner], flat % inner);
    }
  }
  template <int kLevels, typename Items>
  static constexpr size_t Count(const Items& items) noexcept {
    if constexpr (kLevels <= 1) {
      return items.size();
    } else {
      return items.size() * Count<kLevels - 1>(items[0]);
    }
  }

  // Lists. What has no room is a fault.
  template <typename ListType, typename T>
  void Append(ListType& list, const T& item, Place at) noexcept {
    if (list.full()) return Fail(Fault::kTooLong, at);
    list.Append(item);
  }
  template <typename ListType, typename T>
  void Insert(ListType& list, int64_t index, const T& item, Place at) noexcept {
    if (index < 0 || index > Len(list)) return Undefined(Fault::kIndex, at);
    if (list.full()) return Fail(Fault::kTooLong, at);
    list.Insert(static_cast<uint64_t>(index), item);
  }
  template <typename ListType>
  void Drop(ListType& list, int64_t index, Place at) noexcept {
    if (index < 0 || index >= Len(list)) return Undefined(Fault::kIndex, at);
    list.Drop(static_cast<uint64_t>(index));
  }
  template <typename ListType, typename T>
  void Remove(ListType& list, const T& item, Place at) noexcept {
    for (uint32_t k = 0; k < list.size(); ++k) {
      if (Same(list[k], item)) return list.Drop(k);
    }
    Undefined(Fault::kRemove, at);
  }
  template <typename ListType>
  ListType Slice(const ListType& list, int64_t from, int64_t to, Place at) noexcept {
    if (from < 0 || to < from || to > Len(list)) return Undefined(Fault::kIndex, at), list;
    ListType part;
    for (int64_t k = from; k < to; ++k) part.Append(list[static_cast<uint64_t>(k)]);
    return part;
  }
  template <typename ListType>
  ListType Slice(const ListType& list, int64_t from, Place at) noexcept {
    return Slice(list, from, Len(list), at);
  }

  // Texts.
  template <typename TextType>
  TextType Join(const TextType& a, const TextType& b, Place at) noexcept {
    if (a.size() + b.size() > TextType::kCapacity) return Fail(Fault::kTooLong, at), a;
    TextType both = a;
    for (const char c : b) both.Append(c);
    return both;
  }
  template <typename TextType, typename T>
  TextType Shown(const T& value, Place at) noexcept {
    char text[TextType::kCapacity];
    Pen pen(text, text + sizeof text);
    Show(pen, value);
    if (!pen.whole()) Fail(Fault::kTooLong, at);
    return TextType({text, static_cast<size_t>(pen.at() - text)});
  }
  /// Writes one line of these values.
  template <typename Said, typename... T>
  void Say(Said& said, Place at, const T&... values) noexcept {
    if (!failed() && !said.Say(values...)) Fail(Fault::kTooLong, at);
  }

  // `any`.
  template <typename Items>
  const auto& Any(const Items& items, Place at) noexcept {
    using T = std::remove_cvref_t<decltype(items[0])>;
    if (!failed() && items.size() == 0) Fail(Fault::kNoValue, at);
    if (failed()) return kZero<T>;
    return static_cast<const T&>(items[static_cast<size_t>(Pick(items.size()))]);
  }
  int64_t AnyInt(int64_t low, int64_t high, Place at) noexcept {
    if (low > high) Fail(Fault::kNoValue, at);
    const uint64_t above = static_cast<uint64_t>(high) - static_cast<uint64_t>(low);
    if (above == std::numeric_limits<uint64_t>::max()) Fail(Fault::kTooMany, at);
    if (failed()) return 0;
    return static_cast<int64_t>(static_cast<uint64_t>(low) + Pick(above + 1));
  }

  // Loops, functions.
  /// Goes on to the next number of a loop that ends before `end`.
  void Next(int64_t& index, int64_t end, Place at) noexcept {
    if (++steps_ > kMostSteps) Fail(Fault::kRunaway, at);
    index = failed() ? end : index + 1;
  }
  /// Begins the body of a function. Returns whether it is not to be run.
  bool Skips(Place at) noexcept {
    if (++steps_ > kMostSteps) Fail(Fault::kRunaway, at);
    return failed();
  }
  /// Says what came of a call.
  void Take(Answer answer, Place at) noexcept {
    if (answer == Answer::kLater && !total_) return Fail(Fault::kNotYet, at);
    if (answer != Answer::kValue) Undefined(Fault::kExternal, at);
  }

  // `forall`, `exists` and folds, over the numbers from `from` up to, not including, `to`, or the items of a list.
  template <typename Body>
  bool All(int64_t from, int64_t to, Place at, Body body) noexcept {
    for (int64_t k = from; k < to && !failed(); Next(k, to, at)) {
      if (!body(k)) return false;
    }
    return true;
  }
  template <typename Body>
  bool Some(int64_t from, int64_t to, Place at, Body body) noexcept {
    return !All(from, to, at, [&](int64_t k) { return !body(k); });
  }
  template <typename Items, typename Body>
  bool AllIn(const Items& items, Place at, Body body) noexcept {
    return All(0, Len(items), at, [&](int64_t k) { return body(items[static_cast<size_t>(k)]); });
  }
  template <typename Items, typename Body>
  bool SomeIn(const Items& items, Place at, Body body) noexcept {
    return Some(0, Len(items), at, [&](int64_t k) { return body(items[static_cast<size_t>(k)]); });
  }
  template <typename Body>
  int64_t CountOf(int64_t robots, Place at, Body body) noexcept {
    int64_t count = 0;
    for (int64_t k = 0; k < robots && !failed(); Next(k, robots, at)) count += body(k) ? 1 : 0;
    return count;
  }
  template <typename Body>
  auto SumOf(int64_t robots, Place at, Body body) noexcept {
    std::remove_cvref_t<decltype(body(0))> sum{};
    for (int64_t k = 0; k < robots && !failed(); Next(k, robots, at)) sum = Add(sum, body(k), at);
    return sum;
  }
  /// Returns the first robot whose value comes before that of all others.
  template <typename Body, typename Before>
  auto BestOf(int64_t robots, Place at, Body body, Before before) noexcept {
    struct Best {
      std::remove_cvref_t<decltype(body(0))> value{};
      int64_t robot = 0;
    } best;
    for (int64_t k = 0; k < robots && !failed(); Next(k, robots, at)) {
      const auto value = body(k);
      if (k == 0 || before(value, best.value)) best = {value, k};
    }
    return best;
  }
  template <typename Body>
  auto LeastOf(int64_t robots, Place at, Body body) noexcept {
    return BestOf(robots, at, body, [](auto a, auto b) { return a < b; });
  }
  template <typename Body>
  auto GreatestOf(int64_t robots, Place at, Body body) noexcept {
    return BestOf(robots, at, body, [](auto a, auto b) { return b < a; });
  }

 private:
  static constexpr int64_t kLeast = std::numeric_limits<int64_t>::min();

  uint64_t Pick(uint64_t possibilities) noexcept {
    return choice_ == nullptr ? 0 : choice_->Pick(possibilities);
  }
  double Finite(double value, Place at) noexcept {
    if (std::isfinite(value)) [[likely]]
      return value + 0.0;
    Fail(Fault::kOverflow, at);
    return 0;
  }
  int64_t Whole(double value, Place at) noexcept {
    if (value >= -0x1p63 && value < 0x1p63) [[likely]]
      return static_cast<int64_t>(value);
    Fail(Fault::kOverflow, at);
    return 0;
  }
  template <typename Operation>
  Pos Coordinates(const Pos& a, const Pos& b, Place at, Operation operation) noexcept {
    return {Finite(operation(a.x, b.x), at), Finite(operation(a.y, b.y), at),
            Finite(operation(a.z, b.z), at)};
  }

  bool total_;
  bool used_default_ = false;
  Choice* choice_;
  uint64_t steps_ = 0;
  Fault fault_ = Fault::kNone;
  Place place_;
};

}  // namespace rondo::program
