#include "lang/smtlib/script.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace rondo::lang::smtlib {
namespace {

using diag::Kind;
using expr::Rational;
using expr::TermId;

class ScriptReader {
 public:
  ScriptReader(Script& script, diag::Diagnostics& diagnostics, const Extension& extension)
      : script_(script),
        arena_(script.arena),
        diagnostics_(diagnostics),
        extension_(extension),
        terms_(script.arena, diagnostics) {}

  // False at the end of the script.
  bool Read(const SExpr& e) {
    if (!e.IsList() || e.items.empty() || e.items[0].kind != SExpr::Kind::kSymbol) {
      diagnostics_.Report(Kind::kSmtSyntax, e.span, "a command should stand here, such as `(assert ...)`");
      return true;
    }
    const std::string& head = e.items[0].text;
    using Handler = void (ScriptReader::*)(const SExpr&);
    static const std::map<std::string, Handler, std::less<>> kCommands{
        {"set-logic", &ScriptReader::Ignore},
        {"set-info", &ScriptReader::Ignore},
        {"set-option", &ScriptReader::Option},
        {"get-info", &ScriptReader::Ignore},
        {"get-option", &ScriptReader::Ignore},
        {"declare-fun", &ScriptReader::Declaration},
        {"declare-const", &ScriptReader::Declaration},
        {"define-fun", &ScriptReader::Definition},
        {"define-const", &ScriptReader::Definition},
        {"assert", &ScriptReader::Assertion},
        {"push", &ScriptReader::Levels},
        {"pop", &ScriptReader::Levels},
        {"check-sat", &ScriptReader::Simple},
        {"check-sat-assuming", &ScriptReader::Assuming},
        {"get-model", &ScriptReader::Simple},
        {"reset", &ScriptReader::Simple},
        {"reset-assertions", &ScriptReader::Simple},
        {"get-value", &ScriptReader::Values},
        {"echo", &ScriptReader::Echo}};
    if (head == "exit") return false;
    const auto it = kCommands.find(head);
    if (it == kCommands.end()) {
      if (extension_ && extension_(e, terms_)) return true;
      diagnostics_.Report(Kind::kSmtUnsupported, e.items[0].span,
                          fmt::format("the command `{}` is not supported", head));
      return true;
    }
    (this->*it->second)(e);
    return true;
  }

 private:
  void Ignore(const SExpr&) {}

  void Malformed(const SExpr& e, std::string_view form) {
    diagnostics_.Report(Kind::kSmtSyntax, e.span, fmt::format("this command is written {}", form));
  }

  void Option(const SExpr& e) {
    if (e.items.size() != 3 || !e.items[1].Is(":precision")) return;
    const auto value = Rational::Parse(e.items[2].text);
    if (!value || *value <= Rational(0)) {
      diagnostics_.Report(Kind::kSmtSort, e.items[2].span, "the precision is a positive number");
      return;
    }
    script_.precision = *value;
  }

  // (declare-fun x () Real [0, 1]), (declare-const x Real [0, 1])
  void Declaration(const SExpr& e) {
    const bool fun = e.items[0].text == "declare-fun";
    const size_t sort_at = fun ? 3 : 2;
    const bool bounded = e.items.size() == sort_at + 2 && e.items.back().kind == SExpr::Kind::kBracket;
    if ((e.items.size() != sort_at + 1 && !bounded) || e.items[1].kind != SExpr::Kind::kSymbol ||
        (fun && !e.items[2].IsList()))
      return Malformed(e, fun ? "(declare-fun name () sort)" : "(declare-const name sort)");
    if (fun && !e.items[2].items.empty()) {
      diagnostics_
          .Report(Kind::kSmtUnsupported, e.items[2].span, "functions with arguments are not supported")
          .Help("define it: `(define-fun name ((x Real)) Real term)`");
      return;
    }
    const auto sort = terms_.ReadSort(e.items[sort_at]);
    if (!sort || !New(e.items[1])) return;
    const TermId variable = Variable(e.items[1].text, *sort);
    terms_.Declare(e.items[1], variable);
    Add({Command::Kind::kDeclare, e.span, {variable}, 1, ""});
    if (!bounded) return;
    const SExpr& bounds = e.items.back();
    if (bounds.items.size() != 2 || *sort == arena_.Bool())
      return Malformed(e, "(declare-fun name () Real [lower, upper])");
    const TermId lo = terms_.As(terms_.Read(bounds.items[0]), *sort, bounds.items[0]);
    const TermId hi = terms_.As(terms_.Read(bounds.items[1]), *sort, bounds.items[1]);
    if (!lo.valid() || !hi.valid()) return;
    Add({Command::Kind::kAssert,
         bounds.span,
         {arena_.And(arena_.Le(lo, variable), arena_.Le(variable, hi))},
         1,
         ""});
  }

  // A name may come again, after `(reset)` or `(pop)`, with the same sort or another one.
  TermId Variable(const std::string& name, expr::SortId sort) {
    for (const TermId v : script_.variables) {
      if (script_.NameOf(v) == name && arena_.sort_of(v) == sort) return v;
    }
    const TermId variable = arena_.Variable(arena_.Fresh(name, {}, sort));
    if (script_.NameOf(variable) != name) script_.names[variable] = name;
    script_.variables.push_back(variable);
    return variable;
  }

  bool New(const SExpr& name) {
    if (TermReader::IsReserved(name.text)) {
      diagnostics_.Report(Kind::kSmtUndeclared, name.span,
                          fmt::format("`{}` has a meaning already", name.text));
      return false;
    }
    if (names_.emplace(name.text, depth_).second) return true;
    diagnostics_.Report(Kind::kSmtUndeclared, name.span, fmt::format("`{}` is declared twice", name.text));
    return false;
  }

  void Definition(const SExpr& e) {
    const bool fun = e.items[0].text == "define-fun";
    if (e.items.size() != (fun ? 5u : 4u) || e.items[1].kind != SExpr::Kind::kSymbol ||
        (fun && !e.items[2].IsList()))
      return Malformed(
          e, fun ? "(define-fun name ((parameter sort) ...) sort term)" : "(define-const name sort term)");
    Macro macro;
    if (fun) {
      for (const SExpr& p : e.items[2].items) {
        if (!p.IsList() || p.items.size() != 2 || p.items[0].kind != SExpr::Kind::kSymbol)
          return Malformed(e, "(define-fun name ((parameter sort) ...) sort term)");
        const auto sort = terms_.ReadSort(p.items[1]);
        if (!sort) return;
        macro.parameters.emplace_back(p.items[0].text, *sort);
      }
    }
    const auto result = terms_.ReadSort(e.items[fun ? 3 : 2]);
    if (!result || !New(e.items[1])) return;
    // Without parameters it is a name for a term.
    if (macro.parameters.empty()) {
      const SExpr& body = e.items.back();
      const TermId value = terms_.As(terms_.Read(body), *result, body);
      if (value.valid()) terms_.Declare(e.items[1], value);
      return;
    }
    macro.result = *result;
    macro.body = e.items.back();
    terms_.Define(e.items[1], std::move(macro));
  }

  void Assertion(const SExpr& e) {
    if (e.items.size() != 2) return Malformed(e, "(assert formula)");
    const TermId formula = terms_.ReadFormula(e.items[1]);
    if (formula.valid()) Add({Command::Kind::kAssert, e.span, {formula}, 1, ""});
  }

  void Levels(const SExpr& e) {
    const bool push = e.items[0].text == "push";
    size_t levels = 1;
    if (e.items.size() == 2) {
      const auto number = Rational::Parse(e.items[1].text);
      if (!number || !number->IsInteger() || *number < Rational(0) || *number > Rational(10'000))
        return Malformed(e, "(push n) or (pop n)");
      levels = static_cast<size_t>(number->ToDouble());
    } else if (e.items.size() > 2) {
      return Malformed(e, "(push n) or (pop n)");
    }
    if (!push && levels > depth_) {
      diagnostics_.Report(Kind::kSmtSyntax, e.span, "there is no level to pop");
      return;
    }
    depth_ = push ? depth_ + levels : depth_ - levels;
    std::erase_if(names_, [this](const auto& entry) { return entry.second > depth_; });
    Add({push ? Command::Kind::kPush : Command::Kind::kPop, e.span, {}, levels, ""});
  }

  void Simple(const SExpr& e) {
    const std::string& head = e.items[0].text;
    if (e.items.size() != 1) return Malformed(e, fmt::format("({})", head));
    if (head == "reset" || head == "reset-assertions") {
      depth_ = 0;
      names_.clear();
    }
    if (head == "reset") {
      terms_.Forget();
      script_.precision.reset();
    }
    Add({head == "check-sat"   ? Command::Kind::kCheckSat
         : head == "get-model" ? Command::Kind::kGetModel
         : head == "reset"     ? Command::Kind::kReset
                               : Command::Kind::kResetAssertions,
         e.span,
         {},
         1,
         ""});
  }

  void Assuming(const SExpr& e) {
    if (e.items.size() != 2 || !e.items[1].IsList())
      return Malformed(e, "(check-sat-assuming (formula ...))");
    Command command{Command::Kind::kCheckSat, e.span, {}, 1, ""};
    for (const SExpr& literal : e.items[1].items) {
      command.terms.push_back(terms_.ReadFormula(literal));
      if (!command.terms.back().valid()) return;
    }
    Add(std::move(command));
  }

  void Values(const SExpr& e) {
    if (e.items.size() != 2 || !e.items[1].IsList()) return Malformed(e, "(get-value (term ...))");
    Command command{Command::Kind::kGetValue, e.span, {}, 1, ""};
    for (const SExpr& t : e.items[1].items) {
      const TermId term = terms_.Read(t);
      if (!term.valid()) return;
      command.terms.push_back(term);
    }
    Add(std::move(command));
  }

  void Echo(const SExpr& e) {
    if (e.items.size() != 2 || e.items[1].kind != SExpr::Kind::kString)
      return Malformed(e, "(echo \"text\")");
    Add({Command::Kind::kEcho, e.span, {}, 1, e.items[1].text});
  }

  void Add(Command command) { script_.commands.push_back(std::move(command)); }

  Script& script_;
  expr::Arena& arena_;
  diag::Diagnostics& diagnostics_;
  const Extension& extension_;
  TermReader terms_;
  std::map<std::string, size_t> names_;  // and the level at which they were declared
  size_t depth_ = 0;
};

}  // namespace

std::string Script::NameOf(TermId variable) const {
  const auto it = names.find(variable);
  return it == names.end() ? arena.symbol(arena.symbol_of(variable)).name : it->second;
}

void ReadScript(const diag::SourceSet& sources, diag::FileId file, Script& script,
                diag::Diagnostics& diagnostics, const Extension& extension) {
  const std::vector<SExpr> commands = ReadSExprs(sources, file, diagnostics);
  ScriptReader reader(script, diagnostics, extension);
  for (const SExpr& command : commands) {
    if (!reader.Read(command)) break;
  }
}

}  // namespace rondo::lang::smtlib
