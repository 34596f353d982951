#include "koord/semantics/responses.h"

#include <optional>

namespace rondo::koord::semantics {

namespace {

// A byte for each wait: 0 for none, else how many rounds it has lasted, and one.
constexpr size_t kEach = 8;

}  // namespace

Responses::Responses(Team& team) : team_(team), undefined_(team.responses().size()) {
  const size_t waits = team.responses().size() * team.robots();
  words_ = (waits + kEach - 1) / kEach;
}

int Responses::Observe(std::span<const Word> state, std::span<Word> waits, size_t* robot) {
  // Formulas only read.
  team_.machine().SetMemory(const_cast<Word*>(state.data()));  // NOLINT
  int late = -1;
  size_t number = 0;
  for (size_t i = 0; i < team_.responses().size(); ++i) {
    const ResponseCode& response = team_.responses()[i];
    for (size_t r = 0; r < team_.robots(); ++r, ++number) {
      Word& word = waits[number / kEach];
      const size_t shift = 8 * (number % kEach);
      uint64_t wait = word >> shift & 0xff;
      // Where a formula has no value, nobody is judged by it.
      const auto holds = [&](const FormulaCode& formula) {
        const bool value = team_.machine().RunFormula(formula.entry, r);
        const bool known = team_.LastWasDefined();
        undefined_[i] = undefined_[i] || !known;
        return known ? std::optional(value) : std::nullopt;
      };
      const bool waits_on = wait > 0;
      if (holds(response.then).value_or(true))
        wait = 0;
      else if (waits_on || holds(response.when).value_or(false))
        ++wait;
      // In the state where it begins to wait, no round has passed yet.
      if (wait > response.rounds && late < 0) {
        late = static_cast<int>(i);
        if (robot != nullptr) *robot = r;
      }
      word = (word & ~(Word{0xff} << shift)) | std::min<uint64_t>(wait, response.rounds + 1) << shift;
    }
  }
  return late;
}

int Responses::Late(std::span<const Word> waits) const {
  size_t number = 0;
  for (size_t i = 0; i < team_.responses().size(); ++i) {
    for (size_t r = 0; r < team_.robots(); ++r, ++number) {
      const uint64_t wait = waits[number / kEach] >> 8 * (number % kEach) & 0xff;
      if (wait > team_.responses()[i].rounds) return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace rondo::koord::semantics
