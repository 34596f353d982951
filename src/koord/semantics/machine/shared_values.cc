#include "koord/semantics/machine/shared_values.h"

#include "base/check.h"

namespace rondo::koord::semantics {

using lang::TypeKind;

size_t SharedValues::Hash::operator()(const std::vector<Word>& words) const {
  uint64_t h = 0x9e3779b97f4a7c15u ^ words.size();
  for (const Word w : words) {
    h = (h ^ w) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return h;
}

SharedValues::SharedValues() { Number({}); }

uint32_t SharedValues::Number(std::span<const Word> words) {
  std::vector<Word> key(words.begin(), words.end());
  const std::scoped_lock lock(mutex_);
  const auto [it, fresh] = numbers_.try_emplace(std::move(key), static_cast<uint32_t>(by_number_.size()));
  if (fresh) {
    CHECK(by_number_.size() < 0xfffffffeu) << "too many different values";
    by_number_.push_back(&it->first);
    words_ += words.size() + 8;
  }
  return it->second;
}

std::vector<Word> SharedValues::Words(uint32_t number) const {
  const std::scoped_lock lock(mutex_);
  return *by_number_[number];
}

size_t SharedValues::words() const {
  const std::scoped_lock lock(mutex_);
  return words_;
}

HandleExchange::HandleExchange(const lang::TypeTable& types, Heap& heap, SharedValues& shared)
    : types_(types), heap_(heap), shared_(shared) {}

template <typename Translate>
std::vector<Word> HandleExchange::Translated(TypeId type, std::span<const Word> words,
                                             const Translate& translate) {
  std::vector<Word> result(words.begin(), words.end());
  const lang::Type& t = types_[type];
  if (t.kind != TypeKind::kList && t.kind != TypeKind::kArray) return result;
  std::vector<TypeId> parts;
  Layout::Parts(types_, t.parts[0], parts);
  for (size_t i = 0; i < result.size(); ++i) {
    const TypeId part = parts[i % parts.size()];
    if (Layout::Kind(types_, part) == WordKind::kHandle) result[i] = translate(part, result[i]);
  }
  return result;
}

uint32_t& HandleExchange::Known(std::vector<std::vector<uint32_t>>& by_type, TypeId type, Word value) {
  if (type.index() >= by_type.size()) by_type.resize(type.index() + 1);
  std::vector<uint32_t>& known = by_type[type.index()];
  if (value >= known.size()) known.resize(value + value / 2 + 1);
  return known[value];
}

Word HandleExchange::ToNumber(TypeId type, Word handle) {
  if (handle == 0) return 0;
  if (const uint32_t known = Known(numbers_, type, handle); known != 0) return known;
  const std::vector<Word> words =
      Translated(type, heap_[handle], [&](TypeId part, Word inner) { return ToNumber(part, inner); });
  return Known(numbers_, type, handle) = shared_.Number(words);
}

Word HandleExchange::ToHandle(TypeId type, Word number) {
  if (number == 0) return 0;
  if (const uint32_t known = Known(handles_, type, number); known != 0) return known;
  const std::vector<Word> words = Translated(type, shared_.Words(static_cast<uint32_t>(number)),
                                             [&](TypeId part, Word inner) { return ToHandle(part, inner); });
  return Known(handles_, type, number) = static_cast<uint32_t>(heap_.Intern(words));
}

}  // namespace rondo::koord::semantics
