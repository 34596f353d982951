#include "koord/syntax/program_parser.h"

namespace rondo::koord {

using lang::TokenKind;

// On the same line, or one to a line in a block.
void Parser::ParseDeclGroup(std::vector<Decl>& decls) {
  if (!AtKind(TokenKind::kNewline)) {
    if (ParseDecl(decls))
      EndLine("a declaration");
    else
      SkipLine();
    return;
  }
  Take();
  if (!AtKind(TokenKind::kIndent)) return;  // an empty section
  Take();
  while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) {
    ClearFailure();
    if (ParseDecl(decls))
      EndLine("a declaration");
    else
      SkipLine();
  }
  if (AtKind(TokenKind::kDedent)) Take();
}

// type name [dims] [= value], separated by `;` on one line; or enum {a, b} name [= value]
bool Parser::ParseDecl(std::vector<Decl>& decls) {
  do {
    if (AtKind(TokenKind::kNewline)) break;
    Decl decl;
    if (At("enum") && Peek(1).text == "{") {
      decl.type.span = Take().span;
      Take();
      do {
        decl.members.push_back(ExpectName("a member"));
      } while (!failed() && Accept(","));
      Expect("}", "the members");
    } else {
      decl.type = ParseType();
    }
    if (failed()) return false;
    decl.span = Peek().span;
    decl.name = ExpectName("the name of a variable");
    if (failed()) return false;
    ParseDimensions(decl.dimensions);
    if (Accept("=")) decl.initial = ParseExpr();
    if (failed()) return false;
    decls.push_back(std::move(decl));
  } while (Accept(";"));
  return true;
}

void Parser::ParseDimensions(std::vector<ExprId>& dimensions) {
  while (At("[") && !failed()) {
    Take();
    if (At("]") || At("*")) {
      Accept("*");
      dimensions.emplace_back();
    } else {
      dimensions.push_back(ParseExpr());
    }
    Expect("]", "a dimension");
  }
}

}  // namespace rondo::koord
