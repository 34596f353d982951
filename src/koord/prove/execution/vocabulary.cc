#include "koord/prove/execution/vocabulary.h"

#include "koord/check/spec_labels.h"

namespace rondo::koord {

using lang::TypeKind;

Vocabulary::Vocabulary(expr::Arena& arena, const Model& model, std::optional<int64_t> robots)
    : arena_(arena), model_(model), fixed_(robots) {
  robots_stop_ = RobotsStop(model);
  robots_ =
      robots ? arena.IntNumber(*robots) : arena.Variable(arena.Declare("number of robots", {}, arena.Int()));
}

SortId Vocabulary::SortOf(TypeId type) {
  type = model_.types.Resolve(type);
  if (const auto it = sorts_.find(type); it != sorts_.end()) return it->second;
  const lang::Type t = model_.types[type];
  SortId sort;
  switch (t.kind) {
    case TypeKind::kError:
    case TypeKind::kVariable:  // never constrained: any one sort will do
    case TypeKind::kBool:
      sort = arena_.Bool();
      break;
    case TypeKind::kInt:
      sort = arena_.Int();
      break;
    case TypeKind::kFloat:
      sort = arena_.Real();
      break;
    case TypeKind::kString:
      sort = arena_.Opaque("a string");
      break;
    case TypeKind::kStream:
      sort = arena_.Opaque("a stream");
      break;
    case TypeKind::kOpaque:
      sort = arena_.Opaque(t.name);
      break;
    case TypeKind::kEnum:
      sort = arena_.Enum(t.name, t.fields);
      break;
    case TypeKind::kArray:
      sort = arena_.Array(arena_.Int(), SortOf(t.parts[0]));
      break;
    case TypeKind::kList:
      sort = arena_.List(SortOf(t.parts[0]));
      break;
    case TypeKind::kRecord:
    case TypeKind::kTuple: {
      std::vector<SortId> parts;
      for (const TypeId part : t.parts) parts.push_back(SortOf(part));
      sort = arena_.Record(model_.types.Name(type), t.fields, std::move(parts));
      break;
    }
  }
  sorts_[type] = sort;
  return sort;
}

View Vocabulary::MakeView(const std::string& suffix) {
  View view;
  view.planner_suffix = suffix;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.function >= 0) {
      view.value.emplace_back();
      continue;
    }
    const SortId sort = variable.PerRobot() ? arena_.Array(arena_.Int(), CellSort(v)) : CellSort(v);
    const std::string name = variable.kind == VariableKind::kParam ? variable.name : variable.name + suffix;
    view.value.push_back(arena_.Variable(arena_.Declare(name, {}, sort)));
  }
  view.stopped =
      arena_.Variable(arena_.Declare("has stopped" + suffix, {}, arena_.Array(arena_.Int(), arena_.Bool())));
  return view;
}

expr::SymbolId Vocabulary::Function(size_t function, const std::string& planner_suffix) {
  const koord::Function& f = model_.functions[function];
  std::vector<SortId> parameters;
  if (f.port >= 0) parameters.push_back(arena_.Int());
  for (const TypeId p : f.parameters) parameters.push_back(SortOf(p));
  const std::string name = f.port >= 0 ? f.name + planner_suffix : "fun " + f.name;
  return arena_.Declare(name, std::move(parameters), SortOf(f.result));
}

expr::SymbolId Vocabulary::Dist() {
  uses_dist_ = true;
  const SortId pos = SortOf(model_.types.pos());
  return arena_.Declare("distance of points", {pos, pos}, arena_.Real());
}

expr::SymbolId Vocabulary::Floor() {
  uses_roundings_ = true;
  return arena_.Declare("greatest int below", {arena_.Real()}, arena_.Int());
}

expr::SymbolId Vocabulary::Sqrt() {
  uses_roundings_ = true;
  return arena_.Declare("root of", {arena_.Real()}, arena_.Real());
}

TermId Vocabulary::IsRobot(TermId i) {
  return arena_.And(arena_.Le(arena_.IntNumber(0), i), arena_.Lt(i, robots_));
}

TermId Vocabulary::StringLiteral(const std::string& text) {
  const TermId literal =
      arena_.Variable(arena_.Declare("literal " + text, {}, SortOf(model_.types.string())));
  if (std::find(literals_.begin(), literals_.end(), literal) == literals_.end()) literals_.push_back(literal);
  return literal;
}

std::vector<TermId> Vocabulary::Axioms() {
  std::vector<TermId> axioms{arena_.Le(arena_.IntNumber(1), robots_)};
  for (size_t i = 0; i < literals_.size(); ++i) {
    for (size_t j = 0; j < i; ++j) axioms.push_back(arena_.Not(arena_.Eq(literals_[i], literals_[j])));
  }
  return axioms;
}

}  // namespace rondo::koord
