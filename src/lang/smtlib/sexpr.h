#pragma once

#include <string>
#include <vector>

#include "diag/diagnostic.h"

/// Reading of SMT-LIB 2 scripts.
namespace rondo::lang::smtlib {

/// An atom, or a list in parentheses (or, for the bounds of declarations, in brackets).
struct SExpr {
  enum class Kind : uint8_t { kSymbol, kString, kList, kBracket };
  Kind kind = Kind::kSymbol;
  std::string text;  ///< of atoms, without quotes
  std::vector<SExpr> items;
  diag::Span span;

  bool IsList() const { return kind == Kind::kList; }
  bool Is(std::string_view symbol) const { return kind == Kind::kSymbol && text == symbol; }
  /// Is this a list that begins with the symbol?
  bool Starts(std::string_view symbol) const { return IsList() && !items.empty() && items[0].Is(symbol); }
};

/// Lists may be nested this deeply.
inline constexpr size_t kDeepest = 1000;

/// The lists of a file. What is not well-formed is reported, and reading goes on behind it.
std::vector<SExpr> ReadSExprs(const diag::SourceSet& sources, diag::FileId file,
                              diag::Diagnostics& diagnostics);

}  // namespace rondo::lang::smtlib
