#pragma once

#include <optional>

#include "diag/diagnostic.h"
#include "lang/syntax_tree.h"
#include "lang/token.h"

namespace rondo::lang {

/// A cursor over tokens with the expression and type grammar. Languages derive their parsers from it.
///
/// Binding, from loose to tight: `forall`/`exists`; `implies` (to the right); `or`; `and`; `not`; one
/// comparison or `in`; `+ -`; `* / %`; unary `-`; `.name`, `[index]`, `(arguments)`. So `not a == b` is `not
/// (a == b)`.
class ExprParser {
 public:
  ExprParser(const TokenStream& stream, ExprPool& pool, diag::Diagnostics& diagnostics)
      : stream_(stream), pool_(pool), diagnostics_(diagnostics) {}

  ExprId ParseExpr();
  TypeSyntax ParseType();

 protected:
  /// A primary expression with members, indices and calls: what can stand left of an assignment.
  ExprId ParsePostfix();

  /// Words that cannot be names of variables in this language.
  virtual bool IsReserved(std::string_view word) const = 0;
  /// Words that may follow a literal number.
  virtual bool IsUnit(std::string_view /*word*/) const { return false; }
  /// Called where an expression must go on: languages in which lines end here may go on in the next line.
  virtual void AllowLineBreak() {}
  virtual ~ExprParser() = default;

  const Token& Peek(size_t ahead = 0) const;
  const Token& Take();
  bool At(std::string_view text) const;  ///< a name or sign with this text
  bool AtKind(TokenKind kind) const { return Peek().kind == kind; }
  bool Accept(std::string_view text);
  /// Reports and returns false when the next token is another one. One report for each token at most.
  bool Expect(std::string_view text, std::string_view after);
  /// A name that is not reserved; empty, with a report, if there is none.
  std::string ExpectName(std::string_view what);
  diag::Diagnostic& Unexpected(std::string_view expected);
  diag::Span PreviousSpan() const;
  bool failed() const { return failed_; }
  void ClearFailure() { failed_ = false; }
  /// Reports a chain of operators that would be too deep a tree.
  bool TooLong(int operators);
  ExprId Fail(diag::Span span) { return pool_.Add({ExprKind::kError, span, {}, {}, {}}); }

  const TokenStream& stream_;
  ExprPool& pool_;
  diag::Diagnostics& diagnostics_;
  size_t at_ = 0;

 private:
  ExprId ParseImplies();
  ExprId ParseQuantifier();
  ExprId ParseOr();
  ExprId ParseAnd();
  ExprId ParseNot();
  ExprId ParseComparison();
  ExprId ParseSum();
  ExprId ParseProduct();
  ExprId ParseUnary();
  ExprId ParsePrimary();
  ExprId ParseAny();
  std::vector<ExprId> ParseItems(std::string_view close);
  bool ParseBinder(Binder& binder);
  ExprId Binary(std::string text, ExprId a, ExprId b);

  int depth_ = 0;
  bool failed_ = false;
  static constexpr int kDeepest = 120;
  static constexpr int kLongest = 2000;
  class Depth;
};

}  // namespace rondo::lang
