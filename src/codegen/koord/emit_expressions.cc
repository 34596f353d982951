#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "base/check.h"
#include "codegen/koord/emitter.h"
#include "codegen/koord/names.h"
#include "lang/expr_queries.h"

namespace rondo::codegen {

using koord::Builtin;
using koord::Ref;
using koord::RefKind;
using koord::VariableKind;
using koord::semantics::Layout;
using lang::ExprKind;
using lang::TypeKind;

Emitter::Emitter(const koord::semantics::Team& team, const diag::SourceSet& sources, Types& types,
                 diag::Diagnostics& diagnostics)
    : team_(team),
      model_(team.model()),
      exprs_(team.model().program->exprs),
      sources_(sources),
      types_(types),
      diagnostics_(diagnostics),
      files_(model_.program->Files()) {
  NameVariables();
}

std::string Emitter::PlaceOf(diag::Span span) const {
  if (!span.file.valid()) return "{}";
  const diag::Position at = sources_.Locate(span.file, span.begin);
  const auto number = std::ranges::find(files_, span.file) - files_.begin();
  return fmt::format("{{{}, {}, {}{}}}", at.line, at.column, span.end - span.begin,
                     number == 0 ? "" : fmt::format(", {}", number));
}

void Emitter::Fail(const std::string& reason, const std::string& help) {
  auto& report = diagnostics_.Report(diag::Kind::kKoordNotBuildable, span_, reason);
  if (!help.empty()) report.Help(help);
}

std::string Emitter::Fresh(const std::string& name) {
  std::string fresh = name;
  for (int k = 2; !taken_.insert(fresh).second; ++k) fresh = fmt::format("{}_{}", name, k);
  return fresh;
}

Code Emitter::Ordered(const std::vector<Code>& parts, const Join& join, bool effects) {
  const auto first = std::ranges::count_if(parts, [](const Code& c) { return c.effects; });
  std::vector<std::string> texts;
  if (first < 2) {
    for (const Code& part : parts) texts.push_back(part.text);
    return {join(texts), effects || first > 0};
  }
  std::string before;
  for (const Code& part : parts) {
    texts.push_back(Fresh("a"));
    before += fmt::format("const auto {} = {}; ", texts.back(), Typed(part));
  }
  return {fmt::format("[&] {{ {}return {}; }}()", before, join(texts)), true};
}

Code Emitter::Convert(Code code, TypeId from, TypeId to) const {
  if (!types_.Is(from, TypeKind::kInt) || !types_.Is(to, TypeKind::kFloat)) return code;
  if (code.number) return {code.text + ".0", false, false, false};
  return {fmt::format("static_cast<double>({})", code.text), code.effects};
}

Code Emitter::GenAs(ExprId id, TypeId type) {
  const lang::Expr& e = exprs_[id];
  if (e.kind == ExprKind::kList && (types_.Is(type, TypeKind::kList) || types_.Is(type, TypeKind::kArray)))
    return Sequence(e, type);
  Code code = Gen(id);
  return Convert(std::move(code), model_.TypeOf(id), type);
}

// A value made of parts, which braces evaluate from left to right.
Code Emitter::Braced(const std::string& type, const std::vector<Code>& parts) {
  Code code{type + "{"};
  for (size_t i = 0; i < parts.size(); ++i) {
    code.text += (i == 0 ? "" : ", ") + parts[i].text;
    code.effects = code.effects || parts[i].effects;
  }
  code.text += "}";
  return code;
}

Code Emitter::Sequence(const lang::Expr& e, TypeId type) {
  std::vector<Code> items;
  for (const ExprId item : e.args) items.push_back(GenAs(item, model_.types[type].parts[0]));
  span_ = e.span;
  const std::string name = types_.Of(type, e.span);
  // Arrays have as many items as their type says, which the checker sees to.
  const auto most = types_.Is(type, TypeKind::kList) ? types_.CapacityOf(type) : std::nullopt;
  if (most && e.args.size() > *most)
    Fail(fmt::format("{} items where there is room for {}", e.args.size(), *most),
         fmt::format("`--capacity '{}={}'`", model_.types.Name(type), e.args.size()));
  return Braced(name, items);
}

Code Emitter::Literal(const lang::Expr& e) {
  switch (e.kind) {
    case ExprKind::kInt: {
      const size_t digits = std::min(e.text.find_first_not_of('0'), e.text.size() - 1);
      return {e.text.substr(digits), false, false, true};  // without zeros in front, which C++ reads as octal
    }
    case ExprKind::kFloat:
      return {CppFloat(std::strtod(e.text.c_str(), nullptr))};
    case ExprKind::kBool:
      return {e.text == "true" || e.text == "True" ? "true" : "false"};
    default: {
      const std::string text = lang::Unquoted(e.text);
      if (text.size() > types_.TextCapacity())
        Fail(fmt::format("this text has more than {} bytes", types_.TextCapacity()),
             "`--capacity string=1024`");
      return {fmt::format("Str({})", CppString(text))};
    }
  }
}

Code Emitter::Gen(ExprId id) {
  const lang::Expr& e = exprs_[id];
  span_ = e.span;
  switch (e.kind) {
    case ExprKind::kError:
    case ExprKind::kQuantity:
      break;
    case ExprKind::kInt:
    case ExprKind::kFloat:
    case ExprKind::kString:
    case ExprKind::kBool:
      return Literal(e);
    case ExprKind::kPid:
      return {"r.pid"};
    case ExprKind::kName:
    case ExprKind::kField:
    case ExprKind::kIndex:
      return Named(id, e);
    case ExprKind::kCall:
      return Call(id, e);
    case ExprKind::kUnary:
      return Unary(e);
    case ExprKind::kBinary:
      return Binary(id, e);
    case ExprKind::kList:
      return GenAs(id, model_.TypeOf(id));
    case ExprKind::kTuple: {
      std::vector<Code> items;
      for (const ExprId item : e.args) items.push_back(Gen(item));
      return Braced(types_.Of(model_.TypeOf(id), e.span), items);
    }
    case ExprKind::kQuantifier:
      return Quantifier(id, e);
    case ExprKind::kFold:
      return Fold(id, e);
    case ExprKind::kConditional: {
      const TypeId type = model_.TypeOf(id);
      const Code condition = Gen(e.args[0]);
      const Code yes = GenAs(e.args[1], type);
      const Code no = GenAs(e.args[2], type);
      return {fmt::format("{} ? {} : {}", Operand(condition), Typed({Operand(yes), false, false, yes.number}),
                          Typed({Operand(no), false, false, no.number})),
              condition.effects || yes.effects || no.effects, true};
    }
    case ExprKind::kAny: {
      std::vector<Code> parts;
      for (const ExprId arg : e.args) parts.push_back(Gen(arg));
      span_ = e.span;
      return Ordered(
          parts,
          [&](const std::vector<std::string>& t) {
            return t.size() > 1 ? fmt::format("r.AnyInt({}, {}, {})", t[0], t[1], Here())
                                : fmt::format("r.Any({}, {})", t[0], Here());
          },
          true);
    }
  }
  CHECK(false) << "an erroneous expression got past the checker";
  return {};
}

Code Emitter::Unary(const lang::Expr& e) {
  const Code operand = Gen(e.args[0]);
  span_ = e.span;
  if (e.text == "not") return {"!" + Operand(operand), operand.effects};
  if (operand.number && operand.text[0] != '-')
    return {operand.text == "0" ? "0" : "-" + operand.text, false, false, true};
  if (exprs_[e.args[0]].kind == ExprKind::kFloat)
    return {operand.text == "0.0" ? "0.0" : "-" + operand.text, false, true};
  const bool ints = types_.Is(model_.TypeOf(e.args[0]), TypeKind::kInt);
  return {fmt::format("r.Neg({}, {})", Typed(operand), Here()), operand.effects || ints};
}

Code Emitter::Binary(ExprId id, const lang::Expr& e) {
  if (e.text == "in") return Membership(e);
  if (e.text == "not in") {
    const Code in = Membership(e);
    return {"!" + Operand(in), in.effects};
  }
  if (e.text == "and" || e.text == "or" || e.text == "implies") {
    const Code a = Gen(e.args[0]);
    const Code b = Gen(e.args[1]);
    // `and` and `or` stop where C++ does; what a fault leaves behind does not matter.
    const char* junction = e.text == "and" ? "&&" : "||";
    // A chain of the same word needs no parentheses.
    const auto part = [&](const Code& c) { return c.junction == junction ? c.text : Operand(c); };
    Code code{fmt::format("{} {} {}", e.text == "implies" ? "!" + Operand(a) : part(a), junction, part(b)),
              a.effects || b.effects, true};
    code.junction = junction;
    return code;
  }
  if (e.text == "==" || e.text == "!=" || e.text[0] == '<' || e.text[0] == '>') return Comparison(e);
  return Arithmetic(id, e);
}

Code Emitter::Comparison(const lang::Expr& e) {
  const TypeId left = model_.TypeOf(e.args[0]);
  const TypeId right = model_.TypeOf(e.args[1]);
  const bool floats = types_.Is(left, TypeKind::kFloat) || types_.Is(right, TypeKind::kFloat);
  // An empty list literal has the type of the other side.
  const TypeId type = floats ? model_.types.real() : model_.types.HasVariable(left) ? right : left;
  const bool swap = e.text[0] == '>';  // what stands on the right is evaluated first
  const Code first = GenAs(e.args[swap ? 1 : 0], type);
  const Code second = GenAs(e.args[swap ? 0 : 1], type);
  span_ = e.span;
  const bool effects = first.effects || second.effects;
  const bool both = first.effects && second.effects;
  if (e.text != "==" && e.text != "!=") {
    if (both)
      return {fmt::format("{}(Two{{{}, {}}})", e.text.size() == 1 ? "Less" : "LessEqual", first.text,
                          second.text),
              true};
    return {fmt::format("{} {} {}", Operand(swap ? second : first), e.text, Operand(swap ? first : second)),
            effects, true};
  }
  const TypeKind kind = model_.types[type].kind;
  if (!both && (kind == TypeKind::kInt || kind == TypeKind::kBool || kind == TypeKind::kEnum))
    return {fmt::format("{} {} {}", Operand(first), e.text, Operand(second)), effects, true};
  Code same = Ordered(
      {first, second},
      [](const std::vector<std::string>& t) { return fmt::format("Same({}, {})", t[0], t[1]); }, effects);
  if (e.text == "!=") same.text = "!" + same.text;
  return same;
}

Code Emitter::Arithmetic(ExprId id, const lang::Expr& e) {
  const TypeId type = model_.TypeOf(id);
  std::vector<Code> parts;
  const bool points = types_.Is(type, TypeKind::kRecord);
  for (const ExprId arg : e.args) {
    if (types_.Is(type, TypeKind::kString)) {
      Code part = Gen(arg);
      if (!types_.Is(model_.TypeOf(arg), TypeKind::kString))
        part = {fmt::format("r.Shown<Str>({}, {})", Typed(part), PlaceOf(e.span)), true};
      parts.push_back(part);
    } else if (points && !types_.Is(model_.TypeOf(arg), TypeKind::kRecord)) {
      const Code number = Convert(Gen(arg), model_.TypeOf(arg), model_.types.real());
      parts.push_back({fmt::format("Splat({})", number.text), number.effects});
    } else {
      parts.push_back(points ? Gen(arg) : GenAs(arg, type));
    }
  }
  if (types_.Is(type, TypeKind::kString)) {
    return Ordered(
        parts,
        [&](const std::vector<std::string>& t) {
          return fmt::format("r.Join({}, {}, {})", t[0], t[1], Here());
        },
        true);
  }
  span_ = e.span;
  const char* name = e.text[0] == '+'   ? "Add"
                     : e.text[0] == '-' ? "Sub"
                     : e.text[0] == '*' ? "Mul"
                     : e.text[0] == '/' ? "Div"
                                        : "Mod";
  if (parts[0].effects && parts[1].effects)
    return {fmt::format("r.{}(Two{{{}, {}}}, {})", name, parts[0].text, parts[1].text, Here()), true};
  return {fmt::format("r.{}({}, {}, {})", name, Typed(parts[0]), Typed(parts[1]), Here()), true};
}

Code Emitter::Membership(const lang::Expr& e) {
  const lang::Expr& set = exprs_[e.args[1]];
  const Ref ref = model_.RefOf(e.args[1]);
  if (ref.kind == RefKind::kBuiltin && static_cast<Builtin>(ref.index) == Builtin::kRect) {
    return Ordered(
        {Gen(e.args[0]), Gen(set.args[1]), Gen(set.args[2])},
        [](const std::vector<std::string>& t) { return fmt::format("InRect({}, {}, {})", t[0], t[1], t[2]); },
        false);
  }
  if (set.kind == ExprKind::kName && ref.kind == RefKind::kNone) {
    const Code robot = Gen(e.args[0]);
    return {fmt::format("IsRobot({})", robot.text), robot.effects};
  }
  const Code list = Gen(e.args[1]);
  const Code item = GenAs(e.args[0], model_.types[model_.TypeOf(e.args[1])].parts[0]);
  return Ordered(
      {list, {Typed(item), item.effects}},
      [](const std::vector<std::string>& t) { return fmt::format("Contains({}, {})", t[0], t[1]); }, false);
}

}  // namespace rondo::codegen
