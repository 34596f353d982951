#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "codegen/koord/emitter.h"
#include "codegen/koord/names.h"
#include "codegen/koord/writes.h"
#include "koord/check/targets.h"

namespace rondo::codegen {

using koord::Builtin;
using koord::Ref;
using koord::RefKind;
using koord::StmtKind;
using koord::VariableKind;
using lang::ExprKind;
using lang::TypeKind;

// Forgets the body before.
void Emitter::Begin() {
  out_.clear();
  taken_.clear();
  apart_.clear();
  depth_ = 1;
  view_ = "v";
  function_ = -1;
  uses_view_ = false;
}

std::string Emitter::Body(const std::vector<Stmt>& body, bool apart) {
  Begin();
  if (apart) apart_ = OnlyWritten(model_, body);
  Statements(body);
  return std::move(out_);
}

std::string Emitter::Initial(size_t v, ExprId value) {
  Begin();
  TypeId type = model_.variables[v].type;
  const bool filled = model_.filled.contains(v);
  while (filled && types_.Is(type, TypeKind::kArray)) type = model_.types[type].parts[0];
  const Code code = GenAs(value, type);
  const std::string target = fmt::format("to.{}()", Accessor(v, 0));
  Line(filled ? fmt::format("Fill({}, {});", target, Typed(code))
              : fmt::format("{} = {};", target, code.text));
  return std::move(out_);
}

std::string Emitter::Formula(ExprId e) {
  Begin();
  return fmt::format("  return {};\n", GenAs(e, model_.types.boolean()).text);
}

void Emitter::Line(const std::string& text) { out_ += std::string(2 * depth_, ' ') + text + "\n"; }

// What stands in the source, so that who steps through sees it.
void Emitter::Comment(const Stmt& stmt) {
  if (!stmt.span.file.valid()) return;
  const diag::Position at = sources_.Locate(stmt.span.file, stmt.span.begin);
  std::string text(sources_.Line(stmt.span.file, at.line));
  const size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  while (!text.empty() && (text.back() == '\\' || text.back() == ' ')) text.pop_back();  // no line goes on
  Line(fmt::format("// {}: {}", at.line, diag::Escaped(begin < text.size() ? text.substr(begin) : "")));
}

void Emitter::Statements(const std::vector<Stmt>& body) {
  for (const Stmt& stmt : body) {
    Comment(stmt);
    Execute(stmt);
  }
}

// The lines of a block, one level deeper.
std::string Emitter::Nested(const std::vector<Stmt>& body, const std::string& first) {
  std::string outside = std::exchange(out_, {});
  ++depth_;
  if (!first.empty()) Line(first);
  Statements(body);
  --depth_;
  return std::exchange(out_, std::move(outside));
}

void Emitter::Execute(const Stmt& stmt) {
  span_ = stmt.span;
  switch (stmt.kind) {
    case StmtKind::kAssign: {
      const Code value = GenAs(stmt.value, model_.TypeOf(stmt.target));
      span_ = stmt.span;
      return Assign(stmt.target, value);
    }
    case StmtKind::kAddAssign:
    case StmtKind::kIncrement: {
      const TypeId type = model_.TypeOf(stmt.target);
      const bool text = types_.Is(type, TypeKind::kString);
      const Code before = Gen(stmt.target);
      Code value = stmt.kind == StmtKind::kIncrement ? Code{types_.Is(type, TypeKind::kInt) ? "1_i" : "1.0"}
                                                     : GenAs(stmt.value, type);
      span_ = stmt.span;
      if (text && !types_.Is(model_.TypeOf(stmt.value), TypeKind::kString))
        value = {fmt::format("r.Shown<Str>({}, {})", Typed(value), Here()), true};
      return Assign(stmt.target, Ordered(
                                     {before, {Typed(value), value.effects}},
                                     [&](const std::vector<std::string>& t) {
                                       return fmt::format("r.{}({}, {}, {})", text ? "Join" : "Add", t[0],
                                                          t[1], Here());
                                     },
                                     true));
    }
    case StmtKind::kLocal: {
      const uint32_t binding = model_.bound_by.at(&stmt)[0];
      const TypeId type = model_.bindings[binding].type;
      const Code value = GenAs(stmt.value, type);
      span_ = stmt.span;
      const std::string cpp = types_.Of(type, stmt.span);  // the name stands for another one in the value
      return Line(fmt::format("{} {} = {};", cpp, Bind(binding), value.text));
    }
    case StmtKind::kPass:
      return;
    case StmtKind::kCall:
      return Method(stmt);
    case StmtKind::kStream:
      return Log(stmt);
    case StmtKind::kStop:
      return Line("return to.Stop();");
    case StmtKind::kBreak:
      return Line("break;");
    case StmtKind::kContinue:
      return Line("continue;");
    case StmtKind::kReturn:
      if (function_ < 0) return Line("return;");
      if (stmt.value.valid())
        return Line(fmt::format(
            "return {};", GenAs(stmt.value, model_.functions[static_cast<size_t>(function_)].result).text));
      Line(fmt::format("r.Undefined(Fault::kReturn, {});", Here()));
      return Line("return {};");
    case StmtKind::kIf:
      return If(stmt);
    case StmtKind::kForIn:
      return LoopIn(stmt);
    case StmtKind::kForRange:
      return LoopRange(stmt);
    case StmtKind::kWhile:
      return LoopWhile(stmt);
    case StmtKind::kAtomic:
      Line("{");
      out_ += Nested(stmt.body, "to.effect.locks = true;");
      return Line("}");
  }
}

void Emitter::Log(const Stmt& stmt) {
  std::vector<Code> values;
  for (const ExprId e : stmt.operands) {
    const Code value = Gen(e);
    if (types_.Is(model_.TypeOf(e), TypeKind::kOpaque))
      Fail("what an external type holds cannot be written as text");
    values.push_back({Typed(value), value.effects});
  }
  const auto say = [&](const std::vector<std::string>& t) {
    return fmt::format("r.Say(to.effect.said, {}, {})", PlaceOf(stmt.span), fmt::join(t, ", "));
  };
  Line(Ordered(values, say, true).text + ";");
}

void Emitter::If(const Stmt& stmt) {
  const Code condition = Gen(stmt.value);
  Line(fmt::format("if ({}) {{", condition.text));
  out_ += Nested(stmt.body);
  // `elif` is the only statement of an `else`.
  const Stmt* branch = &stmt;
  while (branch->orelse.size() == 1 && branch->orelse[0].kind == StmtKind::kIf && branch->orelse[0].elif) {
    branch = &branch->orelse[0];
    span_ = branch->span;
    const Code next = Gen(branch->value);
    Line(fmt::format("}} else if ({}) {{", next.text));
    ++depth_;
    Comment(*branch);
    --depth_;
    out_ += Nested(branch->body);
  }
  if (!branch->orelse.empty()) {
    Line("} else {");
    out_ += Nested(branch->orelse);
  }
  Line("}");
}

void Emitter::LoopRange(const Stmt& stmt) {
  const Code from = Gen(stmt.value);
  const Code to = Gen(stmt.operands[0]);
  const std::string index = Bind(model_.bound_by.at(&stmt)[0]), end = Fresh(index + "_end");
  const std::string body = Nested(stmt.body);
  Line(fmt::format("for (int64_t {0} = {1}, {4} = {2}; {0} < {4}; r.Next({0}, {4}, {3})) {{", index,
                   from.text, to.text, Here(), end));
  out_ += body;
  Line("}");
}

// A loop that is repeated more often than it says has no value.
void Emitter::LoopWhile(const Stmt& stmt) {
  const Code most = Gen(stmt.operands[0]);
  const Code condition = Gen(stmt.value);
  const std::string count = Fresh("count"), end = Fresh("most");
  const std::string place = PlaceOf(stmt.span);
  const std::string body = Nested(
      stmt.body, fmt::format("if ({} >= {}) {{ r.Fail(Fault::kLoop, {}); break; }}", count, end, place));
  Line(fmt::format("for (int64_t {0} = 0, {4} = {1}; {2} && !r.failed(); r.Next({0}, {4}, {3})) {{", count,
                   most.text, Operand(condition), Here(), end));
  out_ += body;
  Line("}");
}

// Does a body write this variable, of the program or of its own?
bool Emitter::Writes(const std::vector<Stmt>& body, const Ref& variable) const {
  const auto binding = [](const Ref& ref) { return ref.kind == RefKind::kBinding; };
  return std::ranges::any_of(body, [&](const Stmt& stmt) {
    ExprId target = stmt.target;
    if (stmt.kind == StmtKind::kCall && model_.RefOf(stmt.value).kind == RefKind::kBuiltin)
      target = exprs_[exprs_[stmt.value].args[0]].args[0];
    if (target.valid()) {
      const Ref written = RootOf(target);
      if (binding(written) == binding(variable) && written.index == variable.index) return true;
    }
    return Writes(stmt.body, variable) || Writes(stmt.orelse, variable);
  });
}

// The variable that an expression reads or writes a part of; none if it is no part of one.
Ref Emitter::RootOf(ExprId part) const {
  while (true) {
    const Ref ref = model_.RefOf(part);
    if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kBinding)
      return ref;
    const lang::Expr& e = exprs_[part];
    if (e.kind != ExprKind::kField && e.kind != ExprKind::kIndex) return {};
    part = e.args[0];
  }
}

void Emitter::LoopIn(const Stmt& stmt) {
  const TypeId element = model_.types[model_.TypeOf(stmt.value)].parts[0];
  const Code list = Gen(stmt.value);
  span_ = stmt.span;
  const std::string items = Fresh("items"), at = Fresh("items_at"), end = Fresh("items_end");
  // The loop goes over the list as it was: over a copy where the body may change it, or nobody else keeps it.
  const Ref root = RootOf(stmt.value);
  const bool copy = root.kind == RefKind::kNone || Writes(stmt.body, root);
  const std::vector<uint32_t>& variables = model_.bound_by.at(&stmt);
  std::string first;
  if (variables.size() == 1) {
    const std::string type = types_.Of(element, stmt.span);
    first = fmt::format("const {}& {} = {}[{}];", type, Bind(variables[0]), items, at);
  } else {
    for (size_t i = 0; i < variables.size(); ++i)
      first += fmt::format("{}const auto& {} = {}[{}].{};", i == 0 ? "" : " ", Bind(variables[i]), items, at,
                           types_.Member(element, i));
  }
  const std::string body = Nested(stmt.body, first);
  Line(fmt::format("const auto{} {} = {};", copy ? "" : "&", items, list.text));
  Line(fmt::format("for (int64_t {1} = 0, {2} = Len({0}); {1} < {2}; r.Next({1}, {2}, {3})) {{", items, at,
                   end, Here()));
  out_ += body;
  Line("}");
}

void Emitter::Method(const Stmt& stmt) {
  const Ref ref = model_.RefOf(stmt.value);
  const lang::Expr& call = exprs_[stmt.value];
  const auto builtin = ref.kind == RefKind::kBuiltin ? static_cast<Builtin>(ref.index) : Builtin::kPos;
  if (!koord::WritesList(builtin)) return Line(fmt::format("(void){};", Gen(stmt.value).text));
  const ExprId target = exprs_[call.args[0]].args[0];
  const TypeId element = model_.types[model_.TypeOf(target)].parts[0];
  if (builtin == Builtin::kClear) return Line(fmt::format("{}.Clear();", Target(target).text));
  (void)Gen(target);  // moves on the place of faults, as reading it does
  std::vector<Code> arguments;
  switch (builtin) {
    case Builtin::kInsert:
      arguments.push_back(Gen(call.args[1]));
      arguments.push_back(GenAs(call.args[2], element));
      break;
    case Builtin::kPop:
      arguments.push_back(call.args.size() > 1 ? Gen(call.args[1]) : Code{"0"});
      break;
    default:
      arguments.push_back(GenAs(call.args[1], element));
  }
  Code list = Target(target);
  span_ = stmt.span;
  const char* name = builtin == Builtin::kAppend   ? "Append"
                     : builtin == Builtin::kInsert ? "Insert"
                     : builtin == Builtin::kPop    ? "Drop"
                                                   : "Remove";
  if (list.effects) {
    // Which list it is comes first.
    const std::string which = Fresh("list");
    Line(fmt::format("auto& {} = {};", which, list.text));
    list = {which};
  }
  std::vector<Code> parts{list};
  for (const Code& a : arguments) parts.push_back({builtin == Builtin::kPop ? a.text : Typed(a), a.effects});
  if (parts.size() > 2 && parts[1].effects && parts[2].effects) {
    const std::string index = Fresh("index");
    Line(fmt::format("const int64_t {} = {};", index, parts[1].text));
    parts[1] = {index};
  }
  std::string text;
  for (const Code& part : parts) text += part.text + ", ";
  Line(fmt::format("r.{}({}{});", name, text, Here()));
}

// The value of an assignment is evaluated first, in C++, too.
void Emitter::Assign(ExprId target, const Code& value) {
  Line(fmt::format("{} = {};", Target(target).text, value.text));
}

std::string Emitter::Accessor(size_t v, size_t levels, bool apart) {
  const koord::semantics::Layout::Place& place = team_.layout()[v];
  const koord::Variable& variable = model_.variables[v];
  const std::string name = NameOf(v);
  const std::string kept = "effect.changes." + name;
  std::string now = (variable.kind == VariableKind::kLocal      ? "me."
                     : variable.kind == VariableKind::kActuator ? "out."
                                                                : "shared.") +
                    PathOf(v);
  if (variable.kind == VariableKind::kAllread) now += "[pid]";
  const size_t depth = place.dimensions.size();
  // A word in front of each, so that none is like another, or like a member of `Writing`.
  std::string text, key;
  if (levels == 0 && depth == 0 && apart) {
    key = "new_" + name;
    text = fmt::format("auto& {}() noexcept {{ return New(cell::{}, {}); }}", key, name, kept);
  } else if (levels == 0) {
    key = "now_" + name;
    text = depth == 0
               ? fmt::format("auto& {}() noexcept {{ return Keep(cell::{}, {}, {}); }}", key, name, kept, now)
               : fmt::format("auto& {}() noexcept {{ return KeepAll<{}>(cell::{}, {}, {}); }}", key, depth,
                             name, kept, now);
  } else {
    key = depth == levels ? "item_" + name : fmt::format("part{}_{}", levels, name);
    text = fmt::format(
        "auto& {}(Step& r, int64_t index, Place at) noexcept {{ return KeepItem<{}, {}>(r, cell::{}, {}, {}, index, at); "
        "}}",
        key, levels, depth, name, kept, now);
  }
  accessors_[key] = text;
  return key;
}

Code Emitter::TargetElement(const koord::semantics::Element& element, ExprId target) {
  const size_t levels = element.indices.size();
  const Code flat = FlatIndex(element.indices, team_.layout()[element.variable].dimensions);
  span_ = exprs_[target].span;
  return {fmt::format("to.{}(r, {}, {})", Accessor(element.variable, levels), flat.text, Here()), true};
}

// What an assignment writes to. A member or an item of a variable is written in its place.
Code Emitter::Target(ExprId target) {
  const lang::Expr& e = exprs_[target];
  const Ref ref = model_.RefOf(target);
  if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell)
    return {fmt::format("to.{}()", Accessor(ref.index, 0, apart_.contains(ref.index)))};
  if (ref.kind == RefKind::kBinding) return {bindings_.at(ref.index)};
  if (e.kind == ExprKind::kField) {
    const Code inner = Target(e.args[0]);
    return {fmt::format("{}.{}", inner.text, types_.Member(model_.TypeOf(e.args[0]), ref.index)),
            inner.effects};
  }
  CHECK(e.kind == ExprKind::kIndex);
  if (const auto element = ElementOf(model_, team_.layout(), target)) return TargetElement(*element, target);
  const Code inner = Target(e.args[0]);
  const Code index = Gen(e.args[1]);
  span_ = e.span;
  if (inner.effects && index.effects) {
    const std::string list = Fresh("a"), at = Fresh("a");
    return {
        fmt::format(
            "[&]() -> auto& {{ auto& {0} = {1}; const int64_t {2} = {3}; return r.Ref({0}, {2}, {4}); }}()",
            list, inner.text, at, index.text, Here()),
        true};
  }
  return {fmt::format("r.Ref({}, {}, {})", inner.text, index.text, Here()), true};
}

}  // namespace rondo::codegen
