#pragma once

#include <string>
#include <vector>

#include "diag/diagnostic.h"

/// The outer form of SMT-LIB 2 scripts: atoms and lists (SMT-LIB 2.6, Section 3.2, and brackets).
namespace rondo::lang::smtlib {

/// Is an atom, or a list in parentheses (or, for the bounds of declarations, in brackets).
struct SExpr {
  enum class Kind : uint8_t { kSymbol, kString, kList, kBracket };
  Kind kind = Kind::kSymbol;
  std::string text;          ///< of atoms, without quotes
  std::vector<SExpr> items;  ///< of lists
  diag::Span span;

  bool IsList() const { return kind == Kind::kList; }
  bool Is(std::string_view symbol) const { return kind == Kind::kSymbol && text == symbol; }
  /// Reports whether this is a list that begins with the symbol.
  bool Starts(std::string_view symbol) const { return IsList() && !items.empty() && items[0].Is(symbol); }
};

/// How deeply lists may be nested; what is deeper is reported.
inline constexpr size_t kDeepest = 1000;

/// Returns the lists of a file. What is not well-formed is reported, and reading goes on behind it.
std::vector<SExpr> ReadSExprs(const diag::SourceSet& sources, diag::FileId file,
                              diag::Diagnostics& diagnostics);

}  // namespace rondo::lang::smtlib
