#pragma once

#include <optional>

#include "diag/diagnostic.h"
#include "lang/syntax_tree.h"
#include "lang/token.h"

/// The grammar of expressions and types that all of Rondo's languages share.
namespace rondo::lang {

/// Moves a cursor over tokens and reads expressions and types. Languages derive their parsers from it.
///
/// Binding, from loose to tight: `a if c else b` (in languages that have it); `forall`/`exists`; `implies` (to the right); `or`; `and`; `not`; one
/// comparison or `in`; `+ -`; `* / %`; unary `-`; `.name`, `[index]`, `(arguments)`. So `not a == b` is `not
/// (a == b)`.
///
/// What is wrong is reported, and stands in the tree as kError. Trees are at most `kDeepest` deep, chains at
/// most `kLongest` operators long, so that no input exhausts the stack.
class ExprParser {
 public:
  ExprParser(const TokenStream& stream, ExprPool& pool, diag::Diagnostics& diagnostics)
      : stream_(stream), pool_(pool), diagnostics_(diagnostics) {}

  /// Reads the longest expression that begins here.
  ExprId ParseExpr();
  /// Reads a type: a name, arguments in angle brackets, dimensions in square brackets.
  TypeSyntax ParseType();

 protected:
  /// Reads a primary expression with members, indices and calls: what can stand left of an assignment.
  ExprId ParsePostfix();

  /// Reports whether the word cannot be the name of a variable in this language.
  virtual bool IsReserved(std::string_view word) const = 0;
  /// Returns the words of the language that somebody may have mistyped.
  virtual std::vector<std::string> Words() const { return {}; }
  /// Reports whether the word may follow a literal number as its unit.
  virtual bool IsUnit(std::string_view /*word*/) const { return false; }
  /// Reports whether this language has `a if c else b`.
  virtual bool HasConditionals() const { return false; }
  /// Reports whether the language has `sum i in X: e` and its like.
  virtual bool HasFolds() const { return false; }
  /// Is called where an expression must go on: languages in which lines end here may go on in the next line.
  virtual void AllowLineBreak() {}
  virtual ~ExprParser() = default;

  bool Mistyped(const Token& token, std::string_view expected, diag::Diagnostic& report) const;

  /// Returns the next token, or one behind it, without taking it; kEnd beyond the end.
  const Token& Peek(size_t ahead = 0) const;
  /// Returns the next token and moves on; stays at kEnd.
  const Token& Take();
  bool At(std::string_view text) const;  ///< whether the next token is a name or sign with this text
  bool AtKind(TokenKind kind) const { return Peek().kind == kind; }
  /// Takes the next token if it has this text; reports nothing if it has not.
  bool Accept(std::string_view text);
  /// Takes the next token if it has this text; else reports it and returns false. `after` says for people
  /// what came before. At most one report for each failure.
  bool Expect(std::string_view text, std::string_view after);
  /// Takes a name that is not reserved and returns it; empty, with a report, if there is none.
  std::string ExpectName(std::string_view what);
  /// Reports the next token, saying what should stand there.
  diag::Diagnostic& Unexpected(std::string_view expected);
  /// Returns the place of the token that was taken last.
  diag::Span PreviousSpan() const;
  /// Reports whether something was reported since the last ClearFailure; further reports are held back till
  /// then.
  bool failed() const { return failed_; }
  void ClearFailure() { failed_ = false; }
  /// Reports a chain of operators that would be too deep a tree, and returns whether it is.
  bool TooLong(int operators);
  ExprId Fail(diag::Span span) { return pool_.Add({ExprKind::kError, span, {}, {}, {}}); }

  const TokenStream& stream_;
  ExprPool& pool_;
  diag::Diagnostics& diagnostics_;
  size_t at_ = 0;

 private:
  ExprId ParseImplies();
  ExprId ParseQuantifier();
  bool AtFold() const;
  bool AtQuantifier() const;
  ExprId ParseRange(const std::vector<std::string>& names);
  ExprId ParseOr();
  ExprId ParseAnd();
  ExprId ParseNot();
  ExprId ParseComparison();
  ExprId ParseSum();
  ExprId ParseProduct();
  ExprId ParseUnary();
  ExprId ParsePrimary();
  ExprId ParseAny();
  ExprId ParseSlice(ExprId list, ExprId from);
  std::vector<ExprId> ParseItems(std::string_view close);
  ExprId ParseBinders(diag::Span start, ExprKind kind, const std::string& text);
  bool ParseBinder(Binder& binder, ExprId& range);
  ExprId Binary(std::string text, ExprId a, ExprId b);

  int depth_ = 0;
  bool failed_ = false;
  static constexpr int kDeepest = 120;
  static constexpr int kLongest = 2000;
  class Depth;
};

}  // namespace rondo::lang
