#include "solve/certify/proof_reader.h"

#include <fmt/format.h>

#include "lang/smtlib/term_reader.h"

namespace rondo::solve::certify {
namespace {

using diag::Kind;
using lang::smtlib::SExpr;
using lang::smtlib::TermReader;

class ProofReader {
 public:
  ProofReader(Certificate& certificate, diag::Diagnostics& diagnostics)
      : certificate_(certificate), diagnostics_(diagnostics) {}

  // False: no step of a proof.
  bool Read(const SExpr& e, TermReader& terms) {
    const std::string& head = e.items[0].text;
    if (head == "let") {
      if (e.items.size() != 3 || e.items[1].kind != SExpr::Kind::kSymbol)
        return Malformed(e, "(let name term)");
      // Names of variables and of what the language knows keep their meaning.
      if (!e.items[1].text.starts_with("$p")) return Malformed(e, "(let $pNUMBER term)");
      const expr::TermId t = terms.Read(e.items[2]);
      if (t.valid()) terms.Declare(e.items[1], t);
    } else if (head == "substitute") {
      if (e.items.size() != 3) return Malformed(e, "(substitute variable term)");
      Add(Step::Kind::kSubstitute, e, {terms.Read(e.items[1]), terms.Read(e.items[2])});
    } else if (head == "squares" || head == "fact" || head == "cases" || head == "case") {
      if (e.items.size() != 2) return Malformed(e, fmt::format("({} formula)", head));
      const auto kind = head == "squares" ? Step::Kind::kSquares
                        : head == "fact"  ? Step::Kind::kFact
                        : head == "case"  ? Step::Kind::kCase
                                          : Step::Kind::kCases;
      Add(kind, e, {terms.ReadFormula(e.items[1])});
    } else if (head == "period") {
      if (e.items.size() != 4) return Malformed(e, "(period variable number number)");
      Add(Step::Kind::kPeriod, e, {terms.Read(e.items[1]), terms.Read(e.items[2]), terms.Read(e.items[3])});
    } else if (head == "identity") {
      std::vector<expr::TermId> parts;
      for (size_t i = 1; i + 1 < e.items.size(); ++i) {
        if (!e.items[i].IsList() || e.items[i].items.size() != 2)
          return Malformed(e, "(identity (number term) ... number)");
        parts.push_back(terms.Read(e.items[i].items[0]));
        parts.push_back(terms.Read(e.items[i].items[1]));
      }
      if (parts.empty()) return Malformed(e, "(identity (number term) ... number)");
      parts.push_back(terms.Read(e.items.back()));
      Add(Step::Kind::kIdentity, e, std::move(parts));
    } else if (head == "end" || head == "contradiction") {
      if (e.items.size() != 1) return Malformed(e, fmt::format("({})", head));
      Add(head == "end" ? Step::Kind::kEnd : Step::Kind::kContradiction, e, {});
    } else if (head == "search") {
      if (e.items.size() != 3 || !e.items[1].IsList() || e.items[2].kind != SExpr::Kind::kString)
        return Malformed(e, "(search (variables) \"tree\")");
      std::vector<expr::TermId> variables;
      for (const SExpr& v : e.items[1].items) variables.push_back(terms.Read(v));
      if (Add(Step::Kind::kSearch, e, std::move(variables))) certificate_.steps.back().text = e.items[2].text;
    } else {
      return false;
    }
    return true;
  }

 private:
  bool Malformed(const SExpr& e, std::string_view form) {
    diagnostics_.Report(Kind::kSmtSyntax, e.span, fmt::format("this step is written {}", form));
    return true;
  }

  bool Add(Step::Kind kind, const SExpr& e, std::vector<expr::TermId> terms) {
    for (const expr::TermId t : terms) {
      if (!t.valid()) return false;
    }
    certificate_.steps.push_back({kind, e.span, std::move(terms), ""});
    return true;
  }

  Certificate& certificate_;
  diag::Diagnostics& diagnostics_;
};

}  // namespace

void ReadCertificate(const diag::SourceSet& sources, diag::FileId file, Certificate& certificate,
                     diag::Diagnostics& diagnostics) {
  ProofReader reader(certificate, diagnostics);
  lang::smtlib::ReadScript(sources, file, certificate.script, diagnostics,
                           [&](const SExpr& e, TermReader& terms) { return reader.Read(e, terms); });
  if (certificate.steps.empty()) return;
  for (const auto& command : certificate.script.commands) {
    if (command.span.begin > certificate.steps.front().span.begin)
      diagnostics.Report(Kind::kSmtSyntax, command.span, "the script ends where its refutation begins");
  }
}

}  // namespace rondo::solve::certify
