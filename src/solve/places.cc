#include "solve/places.h"

#include <algorithm>
#include <functional>

#include "expr/substitute.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::Op;
using expr::TermId;

// An array term may be built from several arrays by stores and if-then-else: an index of it is an index of
// all.
void ArrayRoots(const Arena& arena, TermId array, std::vector<uint32_t>& roots) {
  switch (arena.op(array)) {
    case Op::kVariable:
      roots.push_back(arena.symbol_of(array).value);
      return;
    case Op::kStore:
      ArrayRoots(arena, arena.arg(array, 0), roots);
      return;
    case Op::kIte:
      ArrayRoots(arena, arena.arg(array, 1), roots);
      ArrayRoots(arena, arena.arg(array, 2), roots);
      return;
    default:
      return;  // the result of a function: no place that anything else shares
  }
}

// Calls `use(place, argument)` for each uninterpreted place that `t` offers to its arguments.
void ForEachPlace(const Arena& arena, TermId t, const std::function<void(Place, TermId)>& use) {
  const auto args = arena.args(t);
  const auto position = [](size_t i) { return static_cast<uint32_t>(i); };
  switch (arena.op(t)) {
    case Op::kApply:
      for (size_t i = 0; i < args.size(); ++i)
        use({Op::kApply, arena.symbol_of(t).value, position(i)}, args[i]);
      return;
    case Op::kSelect:
    case Op::kStore: {
      std::vector<uint32_t> roots;
      ArrayRoots(arena, args[0], roots);
      for (const uint32_t root : roots) use({Op::kSelect, root, 1}, args[1]);
      return;
    }
    case Op::kListMake:
    case Op::kListAppend:
    case Op::kListRemove:
    case Op::kListSet:
    case Op::kListInsert:
    case Op::kListDrop:
    case Op::kListSlice:
    case Op::kListLength:
    case Op::kListAt: {
      const expr::SortId list = arena.op(t) == Op::kListMake ? arena.sort_of(t) : arena.sort_of(args[0]);
      for (size_t i = 0; i < args.size(); ++i) use({arena.op(t), list.value, position(i)}, args[i]);
      return;
    }
    case Op::kField:
      use({Op::kField, arena.sort_of(args[0]).value, 0}, args[0]);
      return;
    case Op::kEq: {
      const expr::SortKind kind = arena.sort(arena.sort_of(args[0])).kind;
      const bool data = kind == expr::SortKind::kOpaque || kind == expr::SortKind::kList ||
                        kind == expr::SortKind::kRecord || kind == expr::SortKind::kEnum;
      if (!data) return;
      for (const TermId arg : args) use({Op::kEq, arena.sort_of(arg).value, 0}, arg);
      return;
    }
    default:
      return;  // interpreted
  }
}

}  // namespace

void PlaceIndex::Add(TermId formula) {
  expr::VisitPostorder(arena_, formula, seen_, [&](TermId t) {
    if (arena_.op(t) == Op::kApply && !arena_.IsOpen(t)) applications_[arena_.symbol_of(t)].push_back(t);
    ForEachPlace(arena_, t, [&](Place place, TermId arg) {
      if (!arena_.IsOpen(arg) && known_[place].insert(arg).second) terms_[place].push_back(arg);
    });
  });
}

const std::vector<TermId>& PlaceIndex::At(const Place& place) const {
  static const std::vector<TermId> none;
  const auto it = terms_.find(place);
  return it == terms_.end() ? none : it->second;
}

const std::vector<TermId>& PlaceIndex::Applications(expr::SymbolId function) const {
  static const std::vector<TermId> none;
  const auto it = applications_.find(function);
  return it == applications_.end() ? none : it->second;
}

std::map<TermId, std::vector<VariablePlace>> PlacesOf(const Arena& arena, TermId body,
                                                      const std::vector<TermId>& variables) {
  std::map<TermId, std::vector<VariablePlace>> result;
  const auto is_variable = [&](TermId t) {
    return std::find(variables.begin(), variables.end(), t) != variables.end();
  };
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, body, seen, [&](TermId t) {
    ForEachPlace(arena, t, [&](Place place, TermId arg) {
      if (is_variable(arg)) {
        result[arg].push_back({place, expr::Rational(0)});
      } else if (arena.op(arg) == Op::kAdd && arena.args(arg).size() == 2 &&
                 arena.IsNumber(arena.arg(arg, 0)) && is_variable(arena.arg(arg, 1))) {
        result[arena.arg(arg, 1)].push_back({place, arena.number(arena.arg(arg, 0))});
      }
    });
  });
  return result;
}

std::map<TermId, std::vector<TermId>> EqualTerms(const Arena& arena, TermId body,
                                                 const std::vector<TermId>& variables) {
  std::map<TermId, std::vector<TermId>> result;
  std::vector<TermId> equations;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, body, seen, [&](TermId t) {
    if (arena.op(t) == Op::kEq && arena.IsOpen(t)) equations.push_back(t);
  });
  for (const TermId equation : equations) {
    for (size_t side = 0; side < 2; ++side) {
      const TermId variable = arena.arg(equation, side);
      const TermId value = arena.arg(equation, 1 - side);
      if (arena.IsOpen(value) || std::find(variables.begin(), variables.end(), variable) == variables.end())
        continue;
      if (arena.sort_of(variable) == arena.Int() || arena.sort_of(variable) == arena.Real())
        result[variable].push_back(value);
    }
  }
  return result;
}

}  // namespace rondo::solve
