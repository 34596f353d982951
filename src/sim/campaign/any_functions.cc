#include "sim/campaign/any_functions.h"

#include "base/mixed.h"

namespace rondo::sim::campaign {

using koord::semantics::Answer;
using koord::semantics::Layout;
using koord::semantics::Word;
using lang::TypeKind;

namespace {

constexpr int kMostLevels = 4;
constexpr size_t kMostItems = 3;

}  // namespace

Answer AnyFunctions::Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) {
  uint64_t random = koord::node::QuestionOf(team_, f, robot, arguments);
  std::vector<Word> words;
  Make(team_.model().functions[f].result, random, words, 0);
  if (words.size() != result.size()) return Answer::kNone;
  std::ranges::copy(words, result.begin());
  return Answer::kValue;
}

void AnyFunctions::Make(lang::TypeId id, uint64_t& random, std::vector<Word>& words, int level) {
  const lang::Type& type = team_.model().types[id];
  random = base::Mixed(random);
  switch (type.kind) {
    case TypeKind::kBool:
      words.push_back(random & 1);
      return;
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      words.push_back(random % 8);
      return;
    case TypeKind::kFloat:
      words.push_back(koord::semantics::FromFloat(static_cast<double>(random % 2000) / 100 - 10));
      return;
    case TypeKind::kEnum:
      words.push_back(type.fields.empty() ? 0 : random % type.fields.size());
      return;
    case TypeKind::kStream:
      return;
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      for (const lang::TypeId part : type.parts) Make(part, random, words, level + 1);
      return;
    case TypeKind::kArray:
    case TypeKind::kList: {
      std::vector<Word> items;
      const size_t count = level > kMostLevels ? 0 : random % (kMostItems + 1);
      for (size_t i = 0; i < count; ++i) Make(type.parts[0], random, items, level + 1);
      words.push_back(team_.heap().Intern(items));
      return;
    }
    case TypeKind::kString:
      words.push_back(team_.heap().InternText(std::string(random % 5, 'a')));
      return;
    case TypeKind::kOpaque:
      words.push_back(team_.heap().Intern(std::vector<Word>{random % 5}));
      return;
  }
}

}  // namespace rondo::sim::campaign
