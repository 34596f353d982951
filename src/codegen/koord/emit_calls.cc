#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "codegen/koord/emitter.h"
#include "codegen/koord/names.h"

namespace rondo::codegen {

using koord::Builtin;
using koord::Function;
using koord::Ref;
using koord::RefKind;
using lang::TypeKind;

Code Emitter::Call(ExprId id, const lang::Expr& e) {
  const Ref ref = model_.RefOf(id);
  if (ref.kind == RefKind::kFunction) return CallFunction(e, ref.index);
  CHECK(ref.kind == RefKind::kBuiltin);
  return CallBuiltin(e, static_cast<Builtin>(ref.index), model_.TypeOf(id));
}

Code Emitter::CallFunction(const lang::Expr& e, size_t f) {
  const Function& function = model_.functions[f];
  std::vector<Code> arguments;
  for (size_t i = 0; i < function.parameters.size(); ++i)
    arguments.push_back(GenAs(e.args[i + 1], function.parameters[i]));
  span_ = e.span;
  return CallWith(f, arguments);
}

Code Emitter::CallWith(size_t f, const std::vector<Code>& arguments) {
  Define(f);
  const bool view = with_view_.contains(f);
  uses_view_ = uses_view_ || view;
  const std::string place = Here();
  return Ordered(
      arguments,
      [&](const std::vector<std::string>& t) {
        std::string text = fmt::format("functions::{}(r, {}", CppName(model_.functions[f].name),
                                       view ? fmt::format("{}, ", view_) : "");
        for (const std::string& argument : t) text += argument + ", ";
        return text + place + ")";
      },
      true);
}

// Functions do not call themselves, so that each is defined behind those that it calls.
void Emitter::Define(size_t f) {
  if (!defined_.insert(f).second) return;
  const Function& function = model_.functions[f];
  const auto given = model_.exploration.functions.find(f);
  if (function.external() && given == model_.exploration.functions.end()) return DefineExternal(f);

  const auto outside =
      std::tuple(std::exchange(out_, {}), std::exchange(depth_, 1), std::exchange(taken_, {}), span_,
                 std::exchange(function_, static_cast<int>(f)), std::exchange(view_, "v"),
                 std::exchange(uses_view_, false));
  const void* key = function.external() ? static_cast<const void*>(given->second) : function.def;
  const std::vector<uint32_t>& bindings = model_.bound_by.at(key);
  std::string parameters;
  for (size_t i = 0; i < bindings.size(); ++i) {
    const std::string name = Bind(bindings[i]);
    const std::string type = types_.Of(function.parameters[i], function.span);
    const bool written = !function.external() && Writes(function.def->body, {RefKind::kBinding, bindings[i]});
    parameters += (written ? fmt::format("{} {}", type, name) : ParameterText(type, name)) + ", ";
  }
  const std::string result = types_.Of(function.result, function.span);
  Line("if (r.Skips(at)) return {};");
  if (function.external()) {
    Line(fmt::format("return {};", GenAs(given->second->body, function.result).text));
  } else {
    Statements(function.def->body);
    if (function.def->body.empty() || function.def->body.back().kind != koord::StmtKind::kReturn) {
      Line(fmt::format("r.Undefined(Fault::kReturn, {});", PlaceOf(function.span)));
      Line("return {};");
    }
  }
  if (uses_view_) with_view_.insert(f);
  functions_.push_back({fmt::format("{} {}(Step& r, {}{}Place at)", result, CppName(function.name),
                                    uses_view_ ? "const View<Program>& v, " : "", parameters),
                        "{\n" + out_ + "}"});
  std::tie(out_, depth_, taken_, span_, function_, view_, uses_view_) = outside;
}

void Emitter::DefineExternal(size_t f) {
  const Function& function = model_.functions[f];
  External external{function.name, CppName(function.name), {}, {}, types_.Of(function.result, function.span)};
  std::string parameters, arguments;
  for (size_t i = 0; i < function.parameters.size(); ++i) {
    const bool named = i < function.parameter_names.size() && !function.parameter_names[i].empty();
    external.parameters.push_back(types_.Of(function.parameters[i], function.span));
    external.parameter_names.push_back(named ? CppName(function.parameter_names[i])
                                             : fmt::format("x{}", i + 1));
    parameters += ParameterText(external.parameters[i], external.parameter_names[i]) + ", ";
    arguments += external.parameter_names[i] + ", ";
  }
  with_view_.insert(f);
  functions_.push_back(
      {fmt::format("{} {}(Step& r, const View<Program>& v, {}Place at)", external.result, external.name,
                   parameters),
       fmt::format(
           "{{\n  {} result{{}};\n  if (!r.failed()) r.Take(v.calls.{}(r.pid, {}result), at);\n  return result;\n}}",
           external.result, external.name, arguments)});
  externals_.push_back(std::move(external));
}

Code Emitter::CallBuiltin(const lang::Expr& e, Builtin builtin, TypeId type) {
  const auto& types = model_.types;
  const auto simple = [&](const char* name, const std::vector<Code>& parts, bool effects) {
    return Ordered(
        parts,
        [&](const std::vector<std::string>& t) { return fmt::format("{}({})", name, fmt::join(t, ", ")); },
        effects);
  };
  // What may have no value says where it stands.
  const auto placed = [&](const char* name, const std::vector<Code>& parts) {
    return Ordered(
        parts,
        [&](const std::vector<std::string>& t) {
          return fmt::format("{}({}, {})", name, fmt::join(t, ", "), Here());
        },
        true);
  };
  const auto braced = [&](const std::vector<Code>& parts) { return Braced(types_.Of(type, e.span), parts); };
  switch (builtin) {
    case Builtin::kPos: {
      std::vector<Code> parts;
      for (size_t i = 1; i < e.args.size(); ++i) parts.push_back(GenAs(e.args[i], types.real()));
      return braced(parts);
    }
    case Builtin::kMid:
    case Builtin::kDist: {
      std::vector<ExprId> points(e.args.begin() + 1, e.args.end());
      if (points.size() == 1) points = exprs_[points[0]].args;
      std::vector<Code> parts;
      const bool records = types.Is(model_.TypeOf(points[0]), TypeKind::kRecord);
      for (const ExprId p : points) parts.push_back(records ? Gen(p) : GenAs(p, types.real()));
      span_ = e.span;
      if (records) return placed(builtin == Builtin::kMid ? "r.Mid" : "r.Dist", parts);
      if (builtin == Builtin::kDist) {
        Code distance = placed("r.Sub", parts);
        distance.text = fmt::format("std::fabs({})", distance.text);
        return distance;
      }
      return placed("r.Div", {placed("r.Add", parts), {"2.0"}});
    }
    case Builtin::kLen:
      return simple("Len", {Gen(e.args[1])}, false);
    case Builtin::kAbs: {
      const Code operand = Gen(e.args[1]);
      const TypeId of = model_.TypeOf(e.args[1]);
      if (!types.Is(of, TypeKind::kInt)) return simple("std::fabs", {operand}, false);
      return Convert(placed("r.Abs", {{Typed(operand), operand.effects}}), of, type);
    }
    case Builtin::kMin:
    case Builtin::kMax: {
      const std::string name =
          fmt::format("std::{}<{}>", builtin == Builtin::kMin ? "min" : "max", types_.Of(type, e.span));
      Code all = GenAs(e.args[1], type);
      for (size_t i = 2; i < e.args.size(); ++i)
        all = simple(name.c_str(), {all, GenAs(e.args[i], type)}, false);
      return all;
    }
    case Builtin::kRecord: {
      std::vector<Code> parts;
      for (size_t i = 1; i < e.args.size(); ++i) parts.push_back(GenAs(e.args[i], types[type].parts[i - 1]));
      return braced(parts);
    }
    case Builtin::kSqrt: {
      const Code operand = GenAs(e.args[1], types.real());
      span_ = e.span;
      return placed("r.Sqrt", {operand});
    }
    case Builtin::kHypot: {
      const std::vector<Code> parts{GenAs(e.args[1], types.real()), GenAs(e.args[2], types.real())};
      span_ = e.span;
      return placed("r.Hypot", parts);
    }
    case Builtin::kFloor:
    case Builtin::kCeil:
    case Builtin::kRound:
    case Builtin::kSign: {
      if (types.Is(model_.TypeOf(e.args[1]), TypeKind::kInt) && builtin != Builtin::kSign)
        return Gen(e.args[1]);
      const Code operand = GenAs(e.args[1], types.real());
      span_ = e.span;
      if (builtin == Builtin::kSign) return simple("r.Sign", {operand}, false);
      return placed(builtin == Builtin::kFloor  ? "r.Floor"
                    : builtin == Builtin::kCeil ? "r.Ceil"
                                                : "r.Round",
                    {operand});
    }
    case Builtin::kOld: {
      const char* now = std::exchange(view_, "old");
      Code code = Gen(e.args[1]);
      view_ = now;
      return code;
    }
    case Builtin::kRect:
    case Builtin::kContains: {
      const ExprId list = exprs_[e.args[0]].args[0];
      const Code items = Gen(list);
      const Code item = GenAs(e.args[1], types[model_.TypeOf(list)].parts[0]);
      return simple("Contains", {items, {Typed(item), item.effects}}, false);
    }
    case Builtin::kFront: {
      const Code list = Gen(exprs_[e.args[0]].args[0]);
      span_ = e.span;
      return placed("r.At", {list, {"0"}});
    }
    case Builtin::kSlice: {
      std::vector<Code> parts;
      for (size_t i = 1; i < e.args.size(); ++i) parts.push_back(Gen(e.args[i]));
      span_ = e.span;
      if (!types.Is(model_.TypeOf(e.args[1]), TypeKind::kList)) Fail("parts of arrays have no C++ type");
      return placed("r.Slice", parts);
    }
    case Builtin::kGrid:
      span_ = e.span;
      Fail("`grid` is for explorations");
      return {"{}"};
    case Builtin::kRemove:
    case Builtin::kInsert:
    case Builtin::kPop:
    case Builtin::kClear:
    case Builtin::kAppend:
      break;  // not values
  }
  CHECK(false) << "a builtin that is no value got past the checker";
  return {};
}

}  // namespace rondo::codegen
