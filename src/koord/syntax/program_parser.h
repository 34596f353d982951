#pragma once

#include "koord/syntax/ast.h"
#include "koord/syntax/parser.h"
#include "lang/expr_parser.h"

/// Declares the parser behind `Parse`; only its own sources include it.
namespace rondo::koord {

/// Parses Koord by recursive descent. Its grammar is split over files by what it reads: items, declarations,
/// statements, specifications.
class Parser : public lang::ExprParser {
 public:
  Parser(const lang::TokenStream& stream, Program& program, diag::Diagnostics& diagnostics)
      : ExprParser(stream, program.exprs, diagnostics), program_(program) {}

  void ParseProgram();

 protected:
  bool IsReserved(std::string_view word) const override { return IsReservedWord(word); }
  std::vector<std::string> Words() const override;
  bool HasConditionals() const override { return true; }
  bool HasFolds() const override { return true; }
  void AllowLineBreak() override {
    if (in_specification_) AcceptContinuation("");
  }

 private:
  // parser.cc
  void ParseItem();
  void ParseDef();
  void ParseFunction(std::string name, diag::Span span);
  void ParseEnum(std::string name, diag::Span span);
  void ParseModule();
  bool ParsePortGroup(ModuleDef& module);
  void ParseSection(SectionKind kind);
  void ParseInit();
  void ParseEvent();
  void ParseFallback();
  bool ParseEventBody(EventDef& event);

  // declaration_parser.cc
  void ParseDeclGroup(std::vector<Decl>& decls);
  bool ParseDecl(std::vector<Decl>& decls);
  void ParseDimensions(std::vector<ExprId>& dimensions);

  // statement_parser.cc
  std::vector<Stmt> ParseSuite(std::string_view after);
  std::vector<Stmt> ParseBlock();
  void ParseStatement(std::vector<Stmt>& out);
  bool ParseSimple(std::vector<Stmt>& out);
  bool AtWhile() const;
  void ParseWhile(std::vector<Stmt>& out);
  bool AtLocal() const;
  void AsRange(Stmt& stmt);
  bool IsForeign();
  void NoAssignment();
  void ParseIf(std::vector<Stmt>& out, bool elif);
  void ParseFor(std::vector<Stmt>& out);
  bool AtCompound() const;

  // specification_parser.cc
  bool ParseSpecItem();
  void ParseParam(diag::Span start);
  void ParseAssume(diag::Span start);
  void ParseSummary(diag::Span start);
  void ParseInvariant(diag::Span start);
  void ParseResponse(diag::Span start);
  void ParseExplore(diag::Span start);
  void ParsePlatform(diag::Span start);
  bool ParseExploreEntry(ExploreDef& def);
  bool AcceptContinuation(std::string_view word);
  ExprId ParseSpecBody();
  void EndSpecItem();

  // Recovery: skips to behind the end of the line, and over the block that belongs to it.
  void SkipLine();
  void SkipBlock();
  bool EndLine(std::string_view after);
  void AddItem(Item item, diag::Span start);

  Program& program_;
  int nesting_ = 0;
  bool in_specification_ = false;
  int continuation_ = 0;  // blocks opened by continuation lines of a specification item
};

}  // namespace rondo::koord
