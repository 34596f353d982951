#include "koord/semantics/machine/machine.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "koord/semantics/machine/nested_lists.h"

namespace rondo::koord::semantics {

namespace {

constexpr size_t kLongest = 1'000'000;        // items of a list
constexpr uint64_t kMostSteps = 100'000'000;  // iterations and calls of one run

// How many words an instruction can push.
size_t Pushes(const Instruction& i) {
  switch (i.op) {
    case Op::kParam:
    case Op::kGlobal:
    case Op::kOwn:
    case Op::kCell:
    case Op::kGlobalAt:
    case Op::kOwnAt:
    case Op::kFrame:
    case Op::kReplace:
    case Op::kUnpack:
      return i.b;
    case Op::kExternal:
      return i.c;
    case Op::kListAt:
    case Op::kAnyItem:
      return i.a;
    default:
      return 3;
  }
}

// Zero has one sign, so that equal numbers are equal words.
Word Float(double x) { return FromFloat(x + 0.0); }

}  // namespace

Machine::Machine(const Code& code, const Layout& layout, Heap& heap)
    : code_(code), layout_(layout), heap_(heap) {
  size_t depth = 64;
  for (const Instruction& i : code.instructions) depth += Pushes(i);
  stack_.resize(depth);
  frame_.resize(code.frame_words + 1);
  params_.resize(layout.param_words());
  logged_.resize(layout.words());
}

bool Machine::Stop(Fault fault, size_t at) {
  fault_ = fault;
  fault_span_ = code_.spans[at];
  top_ = 0;
  in_summary_ = false;
  return false;
}

void Machine::Undo() {
  for (auto it = writes_.rbegin(); it != writes_.rend(); ++it) memory_[it->at] = it->before;
  writes_.clear();
  units_.clear();
}

// One function: the state of the machine stays in registers, and a switch is what compilers make fast.
// NOLINTNEXTLINE(readability-function-cognitive-complexity,readability-function-size)
bool Machine::Run(uint32_t entry, size_t robot, bool total) {
  writes_.clear();
  units_.clear();
  calls_.clear();
  fault_ = Fault::kNone;
  locked_ = stopped_ = in_summary_ = used_default_ = false;
  if (++run_ == 0) {
    std::fill(logged_.begin(), logged_.end(), 0);
    run_ = 1;
  }
  Word* s = stack_.data();  // the first free word
  Word* const frame = frame_.data();
  const Word* memory = memory_;
  const uint32_t own = layout_.block(robot);
  const size_t robots = layout_.robots();
  uint64_t steps = 0;
  const Instruction* const code = code_.instructions.data();
  const auto pop_floats = [&](double& a, double& b) {
    b = ToFloat(s[-1]);
    a = ToFloat(s[-2]);
    s -= 1;
  };
  const auto write = [&](uint32_t at, const Word* from, uint32_t width) {
    for (uint32_t i = 0; i < width; ++i) {
      // Once for each address: a loop may write it often.
      if (logged_[at + i] != run_) writes_.push_back({at + i, memory_[at + i]});
      logged_[at + i] = run_;
      memory_[at + i] = from[i];
    }
  };
  const auto unit = [&](uint32_t at, uint32_t width) {
    const Unit u{at, width};
    if (std::find(units_.begin(), units_.end(), u) == units_.end()) units_.push_back(u);
  };
  const auto cells = [&](uint32_t at, uint32_t words, uint32_t cell) {
    for (uint32_t k = 0; k < words; k += cell) unit(at + k, cell);
  };
  const auto array = [&](const Word* from, uint32_t words) { *s++ = heap_.Intern({from, words}); };
#define RONDO_FAIL(what) return Stop(Fault::what, static_cast<size_t>(i - code))
// In a formula, an operation without a value is zero.
#define RONDO_TOTAL(what)         \
  do {                            \
    if (!total) RONDO_FAIL(what); \
    used_default_ = true;         \
  } while (false)
#define RONDO_FINITE(x)                                \
  do {                                                 \
    const double value_ = (x);                         \
    if (!std::isfinite(value_)) RONDO_FAIL(kOverflow); \
    s[-1] = Float(value_);                             \
  } while (false)
  const Instruction* i = code + entry;
  while (true) {
    switch (i->op) {
      case Op::kEnd:
        top_ = static_cast<size_t>(s - stack_.data());
        return true;
      case Op::kConstant:
        *s++ = code_.constants[i->a];
        break;
      case Op::kPop:
        s -= i->a;
        break;
      case Op::kParam:
        for (uint32_t k = 0; k < i->b; ++k) *s++ = params_[i->a + k];
        break;
      case Op::kGlobal:
        for (uint32_t k = 0; k < i->b; ++k) *s++ = memory[i->a + k];
        break;
      case Op::kOwn:
        for (uint32_t k = 0; k < i->b; ++k) *s++ = memory[own + i->a + k];
        break;
      case Op::kCell: {
        const int64_t r = ToInt(*--s);
        if (r < 0 || static_cast<uint64_t>(r) >= robots) {
          RONDO_TOTAL(kIndex);
          for (uint32_t k = 0; k < i->b; ++k) *s++ = 0;
          break;
        }
        const Word* from = memory + layout_.block(static_cast<size_t>(r)) + i->a;
        for (uint32_t k = 0; k < i->b; ++k) *s++ = from[k];
        break;
      }
      case Op::kCellArray: {
        const int64_t r = ToInt(*--s);
        const bool robot_exists = r >= 0 && static_cast<uint64_t>(r) < robots;
        if (!robot_exists) RONDO_TOTAL(kIndex);
        if (robot_exists)
          array(memory + layout_.block(static_cast<size_t>(r)) + i->a, i->b * i->c);
        else
          *s++ = 0;
        break;
      }
      case Op::kRow: {
        buffer_.clear();
        for (size_t r = 0; r < robots; ++r) {
          const Word* from = memory + layout_.block(r) + i->a;
          buffer_.insert(buffer_.end(), from, from + i->b);
        }
        *s++ = heap_.Intern(buffer_);
        break;
      }
      case Op::kGlobalArray:
        array(memory + i->a, i->b * i->c);
        break;
      case Op::kOwnArray:
        array(memory + own + i->a, i->b * i->c);
        break;
      case Op::kGlobalAt:
      case Op::kOwnAt: {
        const int64_t k = ToInt(*--s);
        const bool inside = k >= 0 && static_cast<uint64_t>(k) < i->c;
        if (!inside) RONDO_TOTAL(kIndex);
        const size_t item = inside ? static_cast<size_t>(k) : 0;
        const Word* from = memory + (i->op == Op::kOwnAt ? own : 0) + i->a + item * i->b;
        for (uint32_t w = 0; w < i->b; ++w) *s++ = inside ? from[w] : 0;
        break;
      }
      case Op::kFlatIndex: {
        const int64_t k = ToInt(*--s);
        const int64_t outer = ToInt(s[-1]);
        int64_t flat = 0;
        const bool inside = k >= 0 && static_cast<uint64_t>(k) < i->a && outer >= 0 &&
                            !__builtin_mul_overflow(outer, static_cast<int64_t>(i->a), &flat) &&
                            !__builtin_add_overflow(flat, k, &flat);
        if (!inside) RONDO_TOTAL(kIndex);
        s[-1] = FromInt(inside ? flat : -1);
        break;
      }
      case Op::kPack:
        s -= i->b;
        *s = Pack(heap_, code_.shapes[i->a], {s, i->b});
        ++s;
        break;
      case Op::kUnpack:
        --s;
        if (!Unpack(heap_, code_.shapes[i->a], *s, s)) {
          RONDO_TOTAL(kIndex);
          std::fill_n(s, i->b, 0);
        }
        s += i->b;
        break;
      case Op::kFrame:
        for (uint32_t k = 0; k < i->b; ++k) *s++ = frame[i->a + k];
        break;
      case Op::kSetFrame:
        s -= i->b;
        for (uint32_t k = 0; k < i->b; ++k) frame[i->a + k] = s[k];
        break;
      case Op::kSetGlobal:
        s -= i->b;
        write(i->a, s, i->b);
        if (i->d == 0)
          unit(i->a, i->b);
        else
          cells(i->a, i->b, i->d);
        break;
      case Op::kSetOwn:
        s -= i->b;
        write(own + i->a, s, i->b);
        break;
      case Op::kSetParam:
        s -= i->b;
        for (uint32_t k = 0; k < i->b; ++k) params_[i->a + k] = s[k];
        break;
      case Op::kSetGlobalAt:
      case Op::kSetOwnAt: {
        const int64_t k = ToInt(*--s);
        s -= i->b;
        if (k < 0 || static_cast<uint64_t>(k) >= i->c) {
          RONDO_TOTAL(kIndex);
          break;
        }
        const uint32_t at = (i->op == Op::kSetOwnAt ? own : 0) + i->a + static_cast<uint32_t>(k) * i->b;
        write(at, s, i->b);
        if (i->op == Op::kSetGlobalAt) cells(at, i->b, i->d);
        break;
      }
      case Op::kSetGlobalArray:
      case Op::kSetOwnArray: {
        const auto items = heap_[*--s];
        if (items.size() != static_cast<size_t>(i->b) * i->c) RONDO_FAIL(kIndex);
        write((i->op == Op::kSetOwnArray ? own : 0) + i->a, items.data(), i->b * i->c);
        if (i->op == Op::kSetGlobalArray) cells(i->a, i->b * i->c, i->b);
        break;
      }
      case Op::kSlice:
        s -= i->c;
        for (uint32_t k = 0; k < i->b; ++k) s[k] = s[i->a + k];
        s += i->b;
        break;
      case Op::kReplace: {
        // value, record -> record
        Word* record = s - i->c;
        Word* value = record - i->b;
        for (uint32_t k = 0; k < i->b; ++k) std::swap(record[i->a + k], value[k]);
        for (uint32_t k = 0; k < i->c; ++k) value[k] = record[k];
        s = value + i->c;
        break;
      }
      case Op::kRobot:
        *s++ = robot;
        break;
      case Op::kAddInt:
      case Op::kSubInt:
      case Op::kMulInt: {
        const int64_t b = ToInt(*--s);
        const int64_t a = ToInt(s[-1]);
        int64_t r = 0;
        const bool over = i->op == Op::kAddInt   ? __builtin_add_overflow(a, b, &r)
                          : i->op == Op::kSubInt ? __builtin_sub_overflow(a, b, &r)
                                                 : __builtin_mul_overflow(a, b, &r);
        if (over) RONDO_FAIL(kOverflow);
        s[-1] = FromInt(r);
        break;
      }
      case Op::kDivInt:
      case Op::kModInt: {
        // Euclidean: the remainder is never negative.
        const int64_t b = ToInt(*--s);
        const int64_t a = ToInt(s[-1]);
        if (b == 0) {
          RONDO_TOTAL(kDivision);
          s[-1] = 0;
          break;
        }
        if (a == std::numeric_limits<int64_t>::min() && b == -1) {
          if (i->op == Op::kDivInt) RONDO_FAIL(kOverflow);
          s[-1] = 0;
          break;
        }
        const int64_t rest = a % b;
        const int64_t low = rest < 0 ? (b > 0 ? rest + b : rest - b) : rest;
        s[-1] = FromInt(i->op == Op::kModInt ? low : rest < 0 ? a / b - (b > 0 ? 1 : -1) : a / b);
        break;
      }
      case Op::kNegInt:
      case Op::kAbsInt: {
        const int64_t a = ToInt(s[-1]);
        if (a == std::numeric_limits<int64_t>::min()) RONDO_FAIL(kOverflow);
        s[-1] = FromInt(i->op == Op::kNegInt || a < 0 ? -a : a);
        break;
      }
      case Op::kAddFloat: {
        double a = 0, b = 0;
        pop_floats(a, b);
        RONDO_FINITE(a + b);
        break;
      }
      case Op::kSubFloat: {
        double a = 0, b = 0;
        pop_floats(a, b);
        RONDO_FINITE(a - b);
        break;
      }
      case Op::kMulFloat: {
        double a = 0, b = 0;
        pop_floats(a, b);
        RONDO_FINITE(a * b);
        break;
      }
      case Op::kDivFloat: {
        double a = 0, b = 0;
        pop_floats(a, b);
        if (b == 0) {
          RONDO_TOTAL(kDivision);
          s[-1] = 0;
          break;
        }
        RONDO_FINITE(a / b);
        break;
      }
      case Op::kNegFloat:
        s[-1] = Float(-ToFloat(s[-1]));
        break;
      case Op::kAbsFloat:
        s[-1] = Float(std::fabs(ToFloat(s[-1])));
        break;
      case Op::kToFloat:
        s[-1] = FromFloat(static_cast<double>(ToInt(s[-1])));
        break;
      case Op::kSplat:
        s[0] = s[1] = s[-1];
        s += 2;
        break;
      case Op::kAddPos:
      case Op::kSubPos:
      case Op::kMulPos:
      case Op::kDivPos:
      case Op::kMidPos: {
        s -= 3;
        for (int k = 0; k < 3; ++k) {
          const double a = ToFloat(s[k - 3]);
          const double b = ToFloat(s[k]);
          if (i->op == Op::kDivPos && b == 0) {
            RONDO_TOTAL(kDivision);
            s[k - 3] = 0;
            continue;
          }
          const double r = i->op == Op::kAddPos   ? a + b
                           : i->op == Op::kSubPos ? a - b
                           : i->op == Op::kMulPos ? a * b
                           : i->op == Op::kDivPos ? a / b
                                                  : (a + b) / 2;
          if (!std::isfinite(r)) RONDO_FAIL(kOverflow);
          s[k - 3] = Float(r);
        }
        break;
      }
      case Op::kNegPos:
        for (int k = 1; k <= 3; ++k) s[-k] = Float(-ToFloat(s[-k]));
        break;
      case Op::kDistPos: {
        s -= 5;
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
          const double d = ToFloat(s[k - 1]) - ToFloat(s[k + 2]);
          sum += d * d;
        }
        RONDO_FINITE(std::sqrt(sum));
        break;
      }
      case Op::kInRect: {
        s -= 8;
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
          const double p = ToFloat(s[k - 1]);
          inside = inside && ToFloat(s[k + 2]) <= p && p <= ToFloat(s[k + 5]);
        }
        s[-1] = inside;
        break;
      }
      case Op::kLessInt:
        --s;
        s[-1] = ToInt(s[-1]) < ToInt(s[0]);
        break;
      case Op::kLessEqualInt:
        --s;
        s[-1] = ToInt(s[-1]) <= ToInt(s[0]);
        break;
      case Op::kLessFloat:
        --s;
        s[-1] = ToFloat(s[-1]) < ToFloat(s[0]);
        break;
      case Op::kLessEqualFloat:
        --s;
        s[-1] = ToFloat(s[-1]) <= ToFloat(s[0]);
        break;
      case Op::kEqual: {
        s -= size_t{2} * i->a;
        bool equal = true;
        for (uint32_t k = 0; k < i->a; ++k) equal = equal && s[k] == s[k + i->a];
        *s++ = equal;
        break;
      }
      case Op::kNot:
        s[-1] = s[-1] == 0;
        break;
      case Op::kIsRobot:
        s[-1] = ToInt(s[-1]) >= 0 && s[-1] < robots;
        break;
      case Op::kMinInt:
        --s;
        s[-1] = FromInt(std::min(ToInt(s[-1]), ToInt(s[0])));
        break;
      case Op::kMaxInt:
        --s;
        s[-1] = FromInt(std::max(ToInt(s[-1]), ToInt(s[0])));
        break;
      case Op::kMinFloat:
        --s;
        s[-1] = FromFloat(std::min(ToFloat(s[-1]), ToFloat(s[0])));
        break;
      case Op::kMaxFloat:
        --s;
        s[-1] = FromFloat(std::max(ToFloat(s[-1]), ToFloat(s[0])));
        break;
      case Op::kListMake: {
        s -= static_cast<size_t>(i->a) * i->b;
        const Word list = heap_.Intern({s, static_cast<size_t>(i->a) * i->b});
        *s++ = list;
        break;
      }
      case Op::kListLength:
        s[-1] = heap_[s[-1]].size() / i->a;
        break;
      case Op::kListAt: {
        s -= 2;
        const auto items = heap_[s[0]];
        const int64_t k = ToInt(s[1]);
        const bool inside = k >= 0 && static_cast<uint64_t>(k) < items.size() / i->a;
        if (!inside) RONDO_TOTAL(kIndex);
        for (uint32_t w = 0; w < i->a; ++w) *s++ = inside ? items[static_cast<size_t>(k) * i->a + w] : 0;
        break;
      }
      case Op::kListSet: {
        // value, list, index -> list
        s -= 2 + i->a;
        const auto items = heap_[s[i->a]];
        const int64_t k = ToInt(s[i->a + 1]);
        if (k < 0 || static_cast<uint64_t>(k) >= items.size() / i->a) {
          RONDO_TOTAL(kIndex);
          s[0] = s[i->a];
          ++s;
          break;
        }
        buffer_.assign(items.begin(), items.end());
        std::copy(s, s + i->a, buffer_.begin() + k * i->a);
        *s++ = heap_.Intern(buffer_);
        break;
      }
      case Op::kListAppend: {
        // list, value -> list
        s -= i->a;
        const auto items = heap_[s[-1]];
        if (items.size() >= kLongest) RONDO_FAIL(kTooLong);
        buffer_.assign(items.begin(), items.end());
        buffer_.insert(buffer_.end(), s, s + i->a);
        s[-1] = heap_.Intern(buffer_);
        break;
      }
      case Op::kListRemove:
      case Op::kListContains: {
        s -= i->a;
        const auto items = heap_[s[-1]];
        size_t at = 0;
        while (at < items.size() && !std::equal(s, s + i->a, items.begin() + static_cast<ptrdiff_t>(at)))
          at += i->a;
        if (i->op == Op::kListContains) {
          s[-1] = at < items.size();
          break;
        }
        if (at >= items.size()) {
          RONDO_TOTAL(kRemove);
          break;
        }
        buffer_.assign(items.begin(), items.end());
        buffer_.erase(buffer_.begin() + static_cast<ptrdiff_t>(at),
                      buffer_.begin() + static_cast<ptrdiff_t>(at + i->a));
        s[-1] = heap_.Intern(buffer_);
        break;
      }
      case Op::kConcatenate: {
        --s;
        const std::string text = heap_.Text(s[-1]) + heap_.Text(s[0]);
        if (text.size() > kLongest) RONDO_FAIL(kTooLong);
        s[-1] = heap_.InternText(text);
        break;
      }
      case Op::kShow: {
        const size_t width = i->b;
        s -= width;
        const std::string text = show_ ? show_(i->a, {s, width}) : std::string();
        *s++ = heap_.InternText(text);
        break;
      }
      case Op::kAnyItem: {
        const auto items = heap_[*--s];
        if (items.empty()) RONDO_FAIL(kNoValue);
        const size_t item = chooser_ ? chooser_(items.size() / i->a) : 0;
        for (uint32_t w = 0; w < i->a; ++w) *s++ = items[item * i->a + w];
        break;
      }
      case Op::kAnyInt: {
        const int64_t high = ToInt(*--s);
        const int64_t low = ToInt(s[-1]);
        if (low > high) RONDO_FAIL(kNoValue);
        const uint64_t above = static_cast<uint64_t>(high) - static_cast<uint64_t>(low);
        if (above == std::numeric_limits<uint64_t>::max()) RONDO_FAIL(kTooMany);
        if (chooser_) s[-1] = static_cast<Word>(static_cast<uint64_t>(low) + chooser_(above + 1));
        break;
      }
      case Op::kGridInt: {
        s -= 2;
        const int64_t low = ToInt(s[-1]);
        const int64_t high = ToInt(s[0]);
        const int64_t step = ToInt(s[1]);
        if (step <= 0) RONDO_FAIL(kGrid);
        buffer_.clear();
        for (int64_t x = low; x <= high;) {
          buffer_.push_back(FromInt(x));
          if (buffer_.size() > kLongest) RONDO_FAIL(kTooLong);
          if (__builtin_add_overflow(x, step, &x)) break;
        }
        s[-1] = heap_.Intern(buffer_);
        break;
      }
      case Op::kGridFloat:
      case Op::kGridPos: {
        const ptrdiff_t axes = i->op == Op::kGridPos ? 3 : 1;
        const double step = ToFloat(*--s);
        s -= 2 * axes;
        if (!(step > 0)) RONDO_FAIL(kGrid);
        size_t count[3] = {1, 1, 1};
        double low[3] = {0, 0, 0};
        for (int k = 0; k < axes; ++k) {
          low[k] = ToFloat(s[k]);
          // A point that rounding puts just behind the end belongs to the grid.
          const double steps_on_axis = std::floor((ToFloat(s[k + axes]) - low[k]) / step + 1e-9);
          if (!(steps_on_axis < static_cast<double>(kLongest))) RONDO_FAIL(kTooLong);
          count[k] = steps_on_axis < 0 ? 0 : static_cast<size_t>(steps_on_axis) + 1;
        }
        if (count[0] * count[1] > kLongest || count[0] * count[1] * count[2] > kLongest) RONDO_FAIL(kTooLong);
        buffer_.clear();
        for (size_t x = 0; x < count[0]; ++x) {
          for (size_t y = 0; y < count[1]; ++y) {
            for (size_t z = 0; z < count[2]; ++z) {
              const size_t point[3] = {x, y, z};
              for (int k = 0; k < axes; ++k)
                buffer_.push_back(Float(low[k] + static_cast<double>(point[k]) * step));
            }
          }
        }
        *s++ = heap_.Intern(buffer_);
        break;
      }
      case Op::kJump:
        i = code + i->a;
        continue;
      case Op::kJumpUnless:
        if (*--s == 0) {
          i = code + i->a;
          continue;
        }
        break;
      case Op::kJumpIf:
        if (*--s != 0) {
          i = code + i->a;
          continue;
        }
        break;
      case Op::kForNext: {
        if (++steps > kMostSteps) RONDO_FAIL(kRunaway);
        const int64_t next = ToInt(frame[i->a]) + 1;
        frame[i->a] = FromInt(next);
        if (next < ToInt(frame[i->b])) {
          i = code + i->c;
          continue;
        }
        break;
      }
      case Op::kCall:
        if (++steps > kMostSteps) RONDO_FAIL(kRunaway);
        calls_.push_back(static_cast<uint32_t>(i - code) + 1);
        i = code + code_.function_entry[i->a];
        continue;
      case Op::kReturn:
        i = code + calls_.back();
        calls_.pop_back();
        continue;
      case Op::kExternal: {
        s -= i->b;
        buffer_.assign(i->c, 0);
        std::vector<Word> result;
        result.swap(buffer_);
        const bool known = host_ != nullptr && host_->Call(i->a, robot, {s, i->b}, result);
        if (!known) RONDO_TOTAL(kExternal);
        for (const Word w : result) *s++ = w;
        buffer_.swap(result);
        break;
      }
      case Op::kSummaryBegin:
        if (!check_summaries_ || in_summary_ || total) {
          i = code + i->a;
          continue;
        }
        in_summary_ = true;
        total = true;
        break;
      case Op::kSummaryTest:
        if (*--s == 0 && violated_summary_ < 0) violated_summary_ = static_cast<int>(i->a);
        break;
      case Op::kSummaryEnd:
        in_summary_ = false;
        total = false;
        break;
      case Op::kLock:
        if (lock_taken_) RONDO_FAIL(kNoLock);
        locked_ = true;
        break;
      case Op::kStop:
        stopped_ = true;
        break;
      case Op::kFault:
        if (!total) return Stop(static_cast<Fault>(i->a), static_cast<size_t>(i - code));
        used_default_ = true;
        break;
      case Op::kOld:
        memory = old_;
        break;
      case Op::kNow:
        memory = memory_;
        break;
      case Op::kLog:
        s -= i->b;
        if (host_ != nullptr) host_->Log(robot, i->a, {s, i->b});
        break;
      case Op::kMark:
        marks_[i->a] = true;
        break;
    }
    ++i;
  }
#undef RONDO_FAIL
#undef RONDO_TOTAL
#undef RONDO_FINITE
}

}  // namespace rondo::koord::semantics
