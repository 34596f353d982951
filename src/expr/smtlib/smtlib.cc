#include "expr/smtlib/smtlib.h"

#include <fmt/format.h>

#include <set>

#include "expr/substitute.h"

namespace rondo::expr {
namespace {

// What SMT-LIB, Z3 and cvc5 call something themselves: quotes do not make another symbol of it.
bool MeansSomething(std::string_view name) {
  static const std::set<std::string_view> kWords{
      "_",     "as",    "let",     "par",       "match",   "forall",  "exists", "true",   "false",
      "not",   "and",   "or",      "xor",       "ite",     "implies", "iff",    "if",     "distinct",
      "div",   "mod",   "rem",     "abs",       "to_real", "to_int",  "is_int", "select", "store",
      "const", "map",   "default", "is",        "update",  "sin",     "cos",    "tan",    "csc",
      "sec",   "cot",   "arcsin",  "arccos",    "arctan",  "exp",     "log",    "sqrt",   "pi",
      "pow",   "power", "min",     "max",       "asin",    "acos",    "atan",   "atan2",  "sinh",
      "cosh",  "tanh",  "euler",   "divisible", "iand",    "pow2",    "lambda", "choice", "tuple",
      "Bool",  "Int",   "Real",    "Array",     "String",  "Set",     "Tuple",  "assert", "push",
      "pop",   "exit",  "echo",    "reset"};
  return kWords.contains(name);
}

std::string NumberText(const Arena& arena, TermId t) {
  const Rational& value = arena.number(t);
  const bool negative = value < Rational(0);
  const Rational magnitude = negative ? Rational(0) - value : value;
  std::string text = magnitude.Numerator();
  if (arena.sort_of(t) == arena.Real()) {
    text += ".0";
    if (!magnitude.IsInteger()) text = fmt::format("(/ {} {}.0)", text, magnitude.Denominator());
  }
  return negative ? fmt::format("(- {})", text) : text;
}

}  // namespace

std::string Quoted(std::string_view name) {
  const bool plain =
      !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") ==
          std::string_view::npos;
  return plain ? std::string(name) : fmt::format("|{}|", name);
}

std::string SmtPrinter::SymbolName(SymbolId id) const {
  const std::string& name = arena_.symbol(id).name;
  constexpr std::string_view kMark = " (a name)";
  // A name that has the mark gets another one, so that different names stay different.
  const bool marked =
      functions_ == SmtFunctions::kSpelledOut && (MeansSomething(name) || name.ends_with(kMark));
  return Quoted(marked ? fmt::format("{}{}", name, kMark) : name);
}

std::string SmtPrinter::SortName(SortId id) const {
  const Sort& s = arena_.sort(id);
  if (s.kind == SortKind::kArray)
    return fmt::format("(Array {} {})", SortName(s.parts[0]), SortName(s.parts[1]));
  if (s.kind == SortKind::kBool || s.kind == SortKind::kInt || s.kind == SortKind::kReal) return s.name;
  return Quoted("sort " + s.name);
}

std::string SmtPrinter::FieldName(SortId record, uint32_t field) const {
  const Sort& s = arena_.sort(record);
  return Quoted(fmt::format("field {}.{}", s.name, s.names[field]));
}

std::string SmtPrinter::Print(TermId t, bool definition) const {
  if (!definition) {
    if (const auto it = names_.find(t); it != names_.end()) return it->second;
  }
  const Term& term = arena_.term(t);
  const auto args = arena_.args(t);
  const auto call = [&](std::string_view head) {
    std::string text = fmt::format("({}", head);
    for (const TermId arg : args) text += " " + Print(arg);
    return text + ")";
  };
  switch (term.op) {
    case Op::kBool:
      return t == arena_.True() ? "true" : "false";
    case Op::kNumber:
      return NumberText(arena_, t);
    case Op::kMember: {
      const Sort& s = arena_.sort(term.sort);
      return Quoted(fmt::format("{}.{}", s.name, s.names[term.payload]));
    }
    case Op::kVariable:
      return SymbolName(SymbolId(term.payload));
    case Op::kApply:
      return call(SymbolName(SymbolId(term.payload)));
    case Op::kNot:
    case Op::kAnd:
    case Op::kOr:
    case Op::kEq:
    case Op::kIte:
    case Op::kAdd:
    case Op::kMul:
    case Op::kDivide:
    case Op::kIntDiv:
    case Op::kMod:
    case Op::kLe:
    case Op::kLt:
    case Op::kToReal:
    case Op::kSelect:
    case Op::kStore:
      return call(Name(term.op));
    case Op::kElementary: {
      const auto function = static_cast<Elementary>(term.payload);
      // These have no names in SMT-LIB that all solvers know.
      const auto choose = [&](std::string_view relation, const std::string& a, const std::string& b) {
        return fmt::format("(ite ({} {} {}) {} {})", relation, a, b, a, b);
      };
      if (functions_ == SmtFunctions::kNamed) return call(Name(function));
      const std::string first = Print(args[0]);
      if (function == Elementary::kAbs)
        return fmt::format("(ite (<= 0.0 {}) {} (- {}))", first, first, first);
      if (function == Elementary::kMin) return choose("<=", first, Print(args[1]));
      if (function == Elementary::kMax) return choose(">=", first, Print(args[1]));
      return call(Name(function));
    }
    case Op::kForall:
    case Op::kExists: {
      std::string text = fmt::format("({} (", Name(term.op));
      for (size_t i = 0; i < term.payload; ++i) {
        text +=
            fmt::format("{}({} {})", i == 0 ? "" : " ", Print(args[i]), SortName(arena_.sort_of(args[i])));
      }
      return text + fmt::format(") {})", Print(args.back()));
    }
    case Op::kRecord:
      return call(Quoted("make " + arena_.sort(term.sort).name));
    case Op::kField:
      return call(FieldName(arena_.sort_of(args[0]), term.payload));
    case Op::kListMake: {
      const std::string name = Quoted(ListFunctionName(arena_, term.op, term.sort, args.size()));
      return args.empty() ? name : call(name);
    }
    case Op::kListLength:
    case Op::kListAt:
    case Op::kListAppend:
    case Op::kListRemove:
    case Op::kListSet:
    case Op::kListInsert:
    case Op::kListDrop:
    case Op::kListSlice:
      return call(Quoted(ListFunctionName(arena_, term.op, arena_.sort_of(args[0]), args.size())));
  }
  return "";
}

namespace {

// Writes the declarations that the terms need, each before its first use.
class Declarations {
 public:
  Declarations(const Arena& arena, const SmtPrinter& printer) : arena_(arena), printer_(printer) {}

  void Need(TermId t) {
    const Term& term = arena_.term(t);
    NeedSort(term.sort);
    if (term.op == Op::kVariable || term.op == Op::kApply) {
      const Symbol& symbol = arena_.symbol(SymbolId(term.payload));
      if (symbol.bound || !symbols_.insert(symbol.name).second) return;
      Function(printer_.SymbolName(SymbolId(term.payload)), symbol.parameters, symbol.result);
    }
    const auto args = arena_.args(t);
    const auto list_function = [&](SortId list, const std::vector<SortId>& parameters, SortId result) {
      const std::string name = ListFunctionName(arena_, term.op, list, args.size());
      if (symbols_.insert(name).second) Function(Quoted(name), parameters, result);
    };
    switch (term.op) {
      case Op::kListMake:
        list_function(term.sort, std::vector<SortId>(args.size(), arena_.sort(term.sort).parts[0]),
                      term.sort);
        break;
      case Op::kListLength:
        list_function(arena_.sort_of(args[0]), {arena_.sort_of(args[0])}, arena_.Int());
        break;
      case Op::kListAt:
        list_function(arena_.sort_of(args[0]), {arena_.sort_of(args[0]), arena_.Int()}, term.sort);
        break;
      case Op::kListAppend:
      case Op::kListRemove:
      case Op::kListDrop:
        list_function(term.sort, {term.sort, arena_.sort_of(args[1])}, term.sort);
        break;
      case Op::kListSet:
      case Op::kListInsert:
      case Op::kListSlice:
        list_function(term.sort, {term.sort, arena_.Int(), arena_.sort_of(args[2])}, term.sort);
        break;
      default:
        break;  // interpreted by the solver
    }
  }

  std::string text() const { return text_; }

 private:
  void NeedSort(SortId id) {
    if (!sorts_.insert(id).second) return;
    const Sort& s = arena_.sort(id);
    for (const SortId part : s.parts) NeedSort(part);
    const std::string name = Quoted("sort " + s.name);
    switch (s.kind) {
      case SortKind::kBool:
      case SortKind::kInt:
      case SortKind::kReal:
      case SortKind::kArray:
        break;
      case SortKind::kEnum: {
        std::string members;
        for (const std::string& member : s.names)
          members += fmt::format(" ({})", Quoted(s.name + "." + member));
        text_ += fmt::format("(declare-datatypes (({} 0)) (({})))\n", name, members.substr(1));
        break;
      }
      case SortKind::kRecord: {
        std::string fields;
        for (uint32_t i = 0; i < s.parts.size(); ++i) {
          fields += fmt::format(" ({} {})", printer_.FieldName(id, i), printer_.SortName(s.parts[i]));
        }
        text_ +=
            fmt::format("(declare-datatypes (({} 0)) ((({}{}))))\n", name, Quoted("make " + s.name), fields);
        break;
      }
      case SortKind::kList:
      case SortKind::kOpaque:
        text_ += fmt::format("(declare-sort {} 0)\n", name);
        break;
    }
  }

  void Function(const std::string& name, const std::vector<SortId>& parameters, SortId result) {
    std::string sorts;
    for (const SortId p : parameters) {
      NeedSort(p);
      sorts += (sorts.empty() ? "" : " ") + printer_.SortName(p);
    }
    NeedSort(result);
    text_ += fmt::format("(declare-fun {} ({}) {})\n", name, sorts, printer_.SortName(result));
  }

  const Arena& arena_;
  const SmtPrinter& printer_;
  std::unordered_set<SortId> sorts_;
  std::unordered_set<std::string> symbols_;
  std::string text_;
};

}  // namespace

std::string ListFunctionName(const Arena& arena, Op op, SortId list, size_t arity) {
  const std::string& name = arena.sort(list).name;
  return op == Op::kListMake ? fmt::format("list{}<{}>", arity, name) : fmt::format("{}<{}>", Name(op), name);
}

std::string ToSmtLib(const Arena& arena, TermId term) { return SmtPrinter(arena).Print(term); }

std::string ToSmtLib(const Arena& arena, std::span<const SmtAssertion> assertions, SmtFunctions functions) {
  SmtPrinter printer(arena, functions);
  Declarations declarations(arena, printer);
  std::unordered_set<TermId> seen;
  std::vector<TermId> order;
  for (const SmtAssertion& assertion : assertions) {
    VisitPostorder(arena, assertion.formula, seen, [&](TermId t) { order.push_back(t); });
  }
  std::unordered_map<TermId, int> uses;
  for (const TermId t : order) {
    declarations.Need(t);
    for (const TermId arg : arena.args(t)) ++uses[arg];
  }
  std::string body;
  int serial = 0;
  std::unordered_set<TermId> defined;
  // Definitions come right before the first assertion that needs them.
  for (const SmtAssertion& assertion : assertions) {
    std::unordered_set<TermId> local;
    std::vector<TermId> needed;
    VisitPostorder(arena, assertion.formula, local, [&](TermId t) { needed.push_back(t); });
    for (const TermId t : needed) {
      if (arena.args(t).empty() || uses[t] < 2 || arena.IsOpen(t) || !defined.insert(t).second) continue;
      std::string name;
      do {
        name = fmt::format("$t{}", serial++);
      } while (arena.IsDeclared(name));
      body += fmt::format("(define-fun {} () {} {})\n", name, printer.SortName(arena.sort_of(t)),
                          printer.Print(t, true));
      printer.Define(t, name);
    }
    if (!assertion.comment.empty()) body += fmt::format("; {}\n", assertion.comment);
    body += fmt::format("(assert {})\n", printer.Print(assertion.formula));
  }
  return fmt::format("(set-logic ALL)\n{}{}(check-sat)\n", declarations.text(), body);
}

}  // namespace rondo::expr
