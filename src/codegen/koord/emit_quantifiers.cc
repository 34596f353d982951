#include <fmt/format.h>

#include <charconv>

#include "codegen/koord/emitter.h"
#include "codegen/koord/names.h"

namespace rondo::codegen {

using koord::DomainKind;
using koord::FoldKind;
using koord::semantics::Bound;
using lang::TypeKind;

// A name for the variable in the body at hand.
std::string Emitter::Bind(uint32_t binding) {
  std::string name = CppName(model_.bindings[binding].name);
  if (model_.named_types.contains(name)) name += "_";
  return bindings_[binding] = Fresh(name);
}

Code Emitter::Quantifier(ExprId id, const lang::Expr& e) {
  Code code = Loop(koord::semantics::BoundsOf(model_, id), 0, e.args[0], e.text == "forall");
  code.effects = true;  // it may take too long
  return code;
}

Code Emitter::Limit(const std::vector<koord::semantics::Limit>& limits, bool upper) {
  Code all;
  for (size_t i = 0; i < limits.size(); ++i) {
    Code one = Gen(limits[i].value);
    int64_t known = 0;
    if (one.number &&
        std::from_chars(one.text.data(), one.text.data() + one.text.size(), known).ec == std::errc() &&
        known < INT64_MAX) {
      one.text = fmt::format("{}", known + limits[i].plus);
    } else if (limits[i].plus != 0) {
      one = {fmt::format("r.Add({}, {}_i, {})", Typed(one), limits[i].plus, Here()), true};
    }
    all = i == 0 ? one
                 : Ordered(
                       {all, one},
                       [&](const std::vector<std::string>& t) {
                         return fmt::format("std::{}<int64_t>({}, {})", upper ? "min" : "max", t[0], t[1]);
                       },
                       false);
  }
  return all;
}

Code Emitter::Loop(const std::vector<Bound>& all, size_t i, ExprId body, bool forall) {
  if (i == all.size()) return Gen(body);
  const Bound& bound = all[i];
  const TypeId type = model_.bindings[bound.binding].type;
  const std::string name = forall ? "All" : "Some";
  const auto over_numbers = [&](const Code& from, const Code& to, const std::string& variable,
                                const std::string& first) {
    const Code inner = Loop(all, i + 1, body, forall);
    return Ordered(
        {from, to},
        [&](const std::vector<std::string>& t) {
          return fmt::format("r.{}({}, {}, {}, [&](int64_t {}) {{ {}return {}; }})", name, t[0], t[1], Here(),
                             variable, first, inner.text);
        },
        true);
  };
  if (bound.kind == DomainKind::kList) {
    const Code list = Gen(bound.list);
    const std::string variable = Bind(bound.binding);
    const Code inner = Loop(all, i + 1, body, forall);
    return {fmt::format("r.{}In({}, {}, [&](const {}& {}) {{ return {}; }})", name, list.text, Here(),
                        types_.Of(type, model_.bindings[bound.binding].span), variable, inner.text),
            true};
  }
  if (bound.kind == DomainKind::kRobots) {
    robots_.insert(bound.binding);
    return over_numbers({"0"}, {"kRobots"}, Bind(bound.binding), "");
  }
  if (types_.Is(type, TypeKind::kBool) || types_.Is(type, TypeKind::kEnum)) {
    const size_t count = types_.Is(type, TypeKind::kBool) ? 2 : model_.types[type].fields.size();
    const std::string variable = Bind(bound.binding), number = Fresh(variable + "_number");
    return over_numbers({"0"}, {fmt::format("{}", count)}, number,
                        fmt::format("const auto {} = static_cast<{}>({}); ", variable,
                                    types_.Of(type, model_.bindings[bound.binding].span), number));
  }
  const auto limits = koord::semantics::LimitsOf(model_, all, i, body, forall);
  const Code from = Limit(limits.lower, false);
  const Code to = Limit(limits.upper, true);
  return over_numbers(from, to, Bind(bound.binding), "");
}

Code Emitter::Fold(ExprId id, const lang::Expr& e) {
  const FoldKind kind = *koord::FoldOf(e.text);
  const uint32_t binding = model_.domains.at(id).bindings[0][0];
  robots_.insert(binding);
  const std::string robot = Bind(binding);
  const Code body = Gen(e.args[0]);
  span_ = e.span;
  const char* name = kind == FoldKind::kCount                              ? "CountOf"
                     : kind == FoldKind::kSum                              ? "SumOf"
                     : kind == FoldKind::kMin || kind == FoldKind::kArgmin ? "LeastOf"
                                                                           : "GreatestOf";
  const char* part = kind == FoldKind::kMin || kind == FoldKind::kMax         ? ".value"
                     : kind == FoldKind::kArgmin || kind == FoldKind::kArgmax ? ".robot"
                                                                              : "";
  return {fmt::format("r.{}(kRobots, {}, [&](int64_t {}) {{ return {}; }}){}", name, Here(), robot,
                      Typed(body), part),
          true};
}

}  // namespace rondo::codegen
