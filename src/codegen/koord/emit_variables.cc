#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "codegen/koord/emitter.h"
#include "codegen/koord/names.h"

namespace rondo::codegen {

using koord::Ref;
using koord::RefKind;
using koord::VariableKind;
using koord::semantics::Layout;
using lang::ExprKind;

// `Motion_psn` may be a variable as well as a port.
void Emitter::NameVariables() {
  std::set<std::string> taken;
  for (const koord::Variable& v : model_.variables) {
    std::string name = CppName(v.name);
    while (!taken.insert(name).second) name += "_2";
    names_.push_back(name);
  }
}

std::string Emitter::PathOf(size_t variable) const {
  const koord::Variable& v = model_.variables[variable];
  if (v.module.empty()) return CppName(v.name);
  return fmt::format("{}.{}", CppName(v.module), CppName(v.name.substr(v.module.size() + 1)));
}

Code Emitter::Named(ExprId id, const lang::Expr& e) {
  const Ref ref = model_.RefOf(id);
  switch (ref.kind) {
    case RefKind::kVariable:
      return ReadVariable(ref.index);
    case RefKind::kCell: {
      const Code robot = Gen(e.args[1]);
      return ReadCell(ref.index, robot, e.args[1]);
    }
    case RefKind::kPortOf: {
      const ExprId index = exprs_[e.args[0]].args[1];
      const Code robot = Gen(index);
      return ReadCell(ref.index, robot, index);
    }
    case RefKind::kBinding:
      return {bindings_.at(ref.index)};
    case RefKind::kMember: {
      const TypeId type = model_.TypeOf(id);
      return {fmt::format("{}::{}", types_.Of(type, e.span), CppName(model_.types[type].fields[ref.index]))};
    }
    case RefKind::kStopped: {
      const Code robot = Gen(e.args[1]);
      span_ = e.span;
      uses_view_ = true;
      return {fmt::format("r.At({}.locals, {}, {}).stopped", view_, robot.text, Here()), true};
    }
    case RefKind::kSystemSize:
      return {"kRobots"};
    case RefKind::kOpaqueField:
      return CallWith(ref.index, {Gen(e.args[0])});
    case RefKind::kFunction:
    case RefKind::kBuiltin:
    case RefKind::kNone:
      break;
  }
  if (e.kind != ExprKind::kField) return Index(id);
  const Code base = Gen(e.args[0]);
  return {fmt::format("{}.{}", Operand(base), types_.Member(model_.TypeOf(e.args[0]), ref.index)),
          base.effects};
}

Code Emitter::ReadVariable(size_t v) {
  const koord::Variable& variable = model_.variables[v];
  const std::string path = PathOf(v);
  if (variable.kind == VariableKind::kParam) return {"param::" + path};
  uses_view_ = true;
  switch (variable.kind) {
    case VariableKind::kLocal:
      return {fmt::format("{}.me.{}", view_, path)};
    case VariableKind::kSensor:
      return {fmt::format("{}.in.{}", view_, path)};
    case VariableKind::kActuator:
      return {fmt::format("{}.out.{}", view_, path)};
    default:
      return {fmt::format("{}.shared.{}", view_, path)};
  }
}

Code Emitter::ReadCell(size_t v, const Code& robot, ExprId index) {
  uses_view_ = true;
  const koord::Variable& variable = model_.variables[v];
  // These are robots for sure. Of the robot itself, arrays have their length still.
  const Ref ref = model_.RefOf(index);
  const bool own = exprs_[index].kind == ExprKind::kPid && team_.layout()[v].dimensions.empty();
  const bool sure = own || (ref.kind == RefKind::kBinding && robots_.contains(ref.index));
  const auto item = [&](const std::string& all) {
    return sure ? fmt::format("{}[{}]", all, robot.text)
                : fmt::format("r.At({}, {}, {})", all, robot.text, Here());
  };
  if (variable.kind == VariableKind::kAllread) return {item(ReadVariable(v).text), !sure};
  if (own) return ReadVariable(v);
  const char* part = variable.kind == VariableKind::kLocal    ? "locals"
                     : variable.kind == VariableKind::kSensor ? "ins"
                                                              : "outs";
  return {fmt::format("{}.{}", item(fmt::format("{}.{}", view_, part)), PathOf(v)), !sure};
}

// Which item it is, among all of so many levels.
Code Emitter::FlatIndex(const std::vector<ExprId>& indices, const std::vector<uint32_t>& dimensions) {
  Code flat;
  for (size_t i = 0; i < indices.size(); ++i) {
    const Code index = Gen(indices[i]);
    span_ = exprs_[indices[i]].span;
    if (i == 0) {
      flat = index;
      continue;
    }
    flat = Ordered(
        {flat, index},
        [&](const std::vector<std::string>& t) {
          return fmt::format("r.Flat({}, {}, {}, {})", t[0], t[1], dimensions[i], Here());
        },
        true);
  }
  return flat;
}

Code Emitter::Index(ExprId id) {
  const lang::Expr& e = exprs_[id];
  if (const auto element = ElementOf(model_, team_.layout(), id)) {
    const Layout::Place& place = team_.layout()[element->variable];
    const size_t levels = element->indices.size();
    const Code flat = FlatIndex(element->indices, place.dimensions);
    span_ = e.span;
    const std::string array = ReadVariable(element->variable).text;
    if (levels > 1) return {fmt::format("r.AtFlat<{}>({}, {}, {})", levels, array, flat.text, Here()), true};
    int64_t known = -1;
    if (flat.number) std::from_chars(flat.text.data(), flat.text.data() + flat.text.size(), known);
    if (known >= 0 && known < place.dimensions[0]) return {fmt::format("{}[{}]", array, known)};
    return {fmt::format("r.At({}, {}, {})", array, flat.text, Here()), true};
  }
  const Code list = Gen(e.args[0]);
  const Code index = Gen(e.args[1]);
  span_ = e.span;
  return Ordered(
      {list, index},
      [&](const std::vector<std::string>& t) { return fmt::format("r.At({}, {}, {})", t[0], t[1], Here()); },
      true);
}

}  // namespace rondo::codegen
