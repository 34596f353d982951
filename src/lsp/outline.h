#pragma once

#include <string>
#include <vector>

#include "diag/source.h"
#include "workspace/session.h"

namespace rondo::lsp {

/// Names what something that a file declares is, with the numbers of the protocol (SymbolKind).
enum class SymbolKind : uint8_t {
  kModule = 2,
  kClass = 5,
  kMethod = 6,
  kProperty = 7,
  kEnum = 10,
  kFunction = 12,
  kVariable = 13,
  kConstant = 14,
  kEvent = 24
};

/// Is something that a file declares.
struct Symbol {
  std::string name;
  SymbolKind kind = SymbolKind::kVariable;
  diag::Span span;
};

/// Lists what a file declares, as far as it can be read.
std::vector<Symbol> OutlineOf(const std::string& file, workspace::Session& session);

}  // namespace rondo::lsp
