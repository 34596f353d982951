#pragma once

#include <set>
#include <string>

#include "choreo/syntax/ast.h"
#include "lang/expr_parser.h"

/// Shares the expressions of `.chor` and `.rosl` files.
namespace rondo::choreo {

/// Reads expressions of the original tool, which has two grammars for them: one of choreographies, one of
/// programs. In both, operators bind differently than in C or mathematics; where that matters there is a
/// warning.
class LegacyExprParser : public lang::ExprParser {
 public:
  /// Names the grammars. What binds looser comes first; operators of one level associate to the left.
  enum class Dialect : uint8_t {
    kChoreography,  // && ||  <  comparisons  <  + -  <  * / %  <  **  <  ! -
    kProgram,       // && || comparisons  <  !  <  + -  <  * / %  <  **  <  -
  };

 protected:
  LegacyExprParser(const lang::TokenStream& stream, Module& module, diag::Diagnostics& diagnostics,
                   Dialect dialect);

  /// Reads an expression.
  ExprId ParseLegacy();
  /// Reads arguments in parentheses.
  std::vector<ExprId> ParseLegacyArguments();
  /// Reads a name; `what` says in messages what it should name.
  Name ParseName(std::string_view what);
  /// Sets the names of the coordinates of a point: `fpx`, `fpy`, `fpz` unless a thread gives others.
  void SetPoint(std::string x, std::string y, std::string z);
  /// Returns the last world of the module, which names such as `cart_x` are about; nullptr if it has none.
  const WorldDef* world() const { return world_; }

 private:
  int LevelOf(std::string_view sign) const;
  std::string SignAhead() const;
  ExprId ParseLevel(int level);
  ExprId ParsePrefix();
  ExprId ParseAtom();
  ExprId Combine(std::string sign, ExprId a, ExprId b);
  ExprId Named(const lang::Token& token);
  ExprId Call(const lang::Token& name);
  ExprId Number(diag::Span span, std::string text, std::string unit);
  void Unusual(diag::Span span, std::string_view read, std::string_view help);

  Dialect dialect_;
  const WorldDef* world_ = nullptr;  // the last one of the module
  std::string point_[3];
  std::set<uint32_t> bracketed_;  // expressions that stood in brackets
  int depth_ = 0;
};

}  // namespace rondo::choreo
