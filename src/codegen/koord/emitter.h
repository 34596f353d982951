#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "codegen/koord/types.h"
#include "koord/semantics/compile/domains.h"
#include "koord/semantics/compile/element.h"

/// Turns checked expressions and statements into C++.
namespace rondo::codegen {

using koord::ExprId;
using koord::Stmt;

/// Is an expression of C++. Its operands have been put into the order in which the program evaluates them where that matters.
struct Code {
  std::string text;
  bool effects =
      false;  ///< it may have no value, choose, or ask an external function: what comes first counts
  bool compound = false;           ///< it needs parentheses as an operand
  bool number = false;             ///< it is an integer literal, which has no type yet
  std::string_view junction = {};  ///< `&&` or `||`, if it is one
};

/// Is a function of the program, as C++.
struct FunctionText {
  std::string signature;  ///< without the semicolon
  std::string body;       ///< with braces
};

/// Emits the code of one program. The rules follow those of `semantics::Compiler`, from which they share what quantifiers run over
/// and nothing else: the same order of evaluation, and the same places of faults.
class Emitter {
 public:
  Emitter(const koord::semantics::Team& team, const diag::SourceSet& sources, Types& types,
          diag::Diagnostics& diagnostics);

  /// Returns the lines of a body, indented by two spaces: of an event, a block of `init`, a fallback. `apart`: what it only writes
  /// may wait elsewhere until it is over.
  std::string Body(const std::vector<Stmt>& body, bool apart);
  /// Returns the line that sets a variable to its initial value.
  std::string Initial(size_t variable, ExprId value);
  /// Returns `return ...;` with the truth value of a formula. `old` is the state at the end of the program transition.
  std::string Formula(ExprId e);

  /// Returns the functions that were called so far, each behind those that it calls.
  const std::vector<FunctionText>& functions() const { return functions_; }
  /// Is a function without a body, as C++.
  struct External {
    std::string of;                       ///< its name in the program
    std::string name;                     ///< in C++
    std::vector<std::string> parameters;  ///< their types
    std::vector<std::string> parameter_names;
    std::string result;
  };
  /// Returns the external functions that were called so far, and the methods of `To` that events use.
  const std::vector<External>& external_functions() const { return externals_; }
  const std::map<std::string, std::string>& accessors() const { return accessors_; }

  /// Returns the C++ name of a variable: `x`, `Motion_psn`; and the path to it in its structure: `x`, `Motion.psn`.
  const std::string& NameOf(size_t variable) const { return names_[variable]; }
  std::string PathOf(size_t variable) const;
  /// Returns a place as an argument: `{31, 20, 7}`.
  std::string PlaceOf(diag::Span span) const;

 private:
  void Begin();  // emit_statements.cc

  // emit_expressions.cc
  Code Gen(ExprId e);
  Code GenAs(ExprId e, TypeId type);
  Code Literal(const lang::Expr& e);
  Code Unary(const lang::Expr& e);
  Code Binary(ExprId id, const lang::Expr& e);
  Code Comparison(const lang::Expr& e);
  Code Arithmetic(ExprId id, const lang::Expr& e);
  Code Membership(const lang::Expr& e);
  Code Sequence(const lang::Expr& e, TypeId type);
  Code Convert(Code code, TypeId from, TypeId to) const;
  static Code Braced(const std::string& type, const std::vector<Code>& parts);
  std::string Here() const { return PlaceOf(span_); }
  /// Puts operands together, evaluated from left to right.
  using Join = std::function<std::string(const std::vector<std::string>&)>;
  Code Ordered(const std::vector<Code>& parts, const Join& join, bool effects);
  static std::string Operand(const Code& code) { return code.compound ? "(" + code.text + ")" : code.text; }
  static std::string Typed(const Code& code) { return code.number ? code.text + "_i" : code.text; }
  std::string Fresh(const std::string& name);
  void Fail(const std::string& reason, const std::string& help = {});

  // emit_variables.cc
  void NameVariables();
  Code Named(ExprId id, const lang::Expr& e);
  Code ReadVariable(size_t variable);
  Code ReadCell(size_t variable, const Code& robot, ExprId index);
  Code Index(ExprId id);
  Code FlatIndex(const std::vector<ExprId>& indices, const std::vector<uint32_t>& dimensions);

  // emit_quantifiers.cc
  Code Quantifier(ExprId id, const lang::Expr& e);
  Code Loop(const std::vector<koord::semantics::Bound>& all, size_t i, ExprId body, bool forall);
  Code Fold(ExprId id, const lang::Expr& e);
  Code Limit(const std::vector<koord::semantics::Limit>& limits, bool upper);
  std::string Bind(uint32_t binding);

  // emit_calls.cc
  Code Call(ExprId id, const lang::Expr& e);
  Code CallFunction(const lang::Expr& e, size_t function);
  Code CallWith(size_t function, const std::vector<Code>& arguments);
  Code CallBuiltin(const lang::Expr& e, koord::Builtin builtin, TypeId type);
  void Define(size_t function);
  void DefineExternal(size_t function);

  // emit_statements.cc
  void Execute(const Stmt& stmt);
  void Statements(const std::vector<Stmt>& body);
  void Assign(ExprId target, const Code& value);
  Code Target(ExprId target);
  Code TargetElement(const koord::semantics::Element& element, ExprId target);
  std::string Accessor(size_t variable, size_t levels, bool apart = false);
  void If(const Stmt& stmt);
  void LoopIn(const Stmt& stmt);
  void LoopRange(const Stmt& stmt);
  void LoopWhile(const Stmt& stmt);
  std::string Nested(const std::vector<Stmt>& body, const std::string& first = {});
  void Method(const Stmt& stmt);
  void Log(const Stmt& stmt);
  bool Writes(const std::vector<Stmt>& body, const koord::Ref& variable) const;
  koord::Ref RootOf(ExprId part) const;
  void Line(const std::string& text);
  void Comment(const Stmt& stmt);

  const koord::semantics::Team& team_;
  const koord::Model& model_;
  const lang::ExprPool& exprs_;
  const diag::SourceSet& sources_;
  Types& types_;
  diag::Diagnostics& diagnostics_;
  std::vector<diag::FileId> files_;
  std::vector<std::string> names_;  // by variable
  diag::Span span_;
  std::string out_;
  size_t depth_ = 1;
  const char* view_ = "v";
  bool uses_view_ = false;
  std::set<size_t> apart_;                    // variables that the body at hand only writes
  int function_ = -1;                         // whose body is being made
  std::map<uint32_t, std::string> bindings_;  // by binding: its name
  std::set<std::string> taken_;               // names in the body at hand
  std::set<uint32_t> robots_;                 // bindings that are robots: those of quantifiers and folds
  std::set<size_t> defined_;                  // functions
  std::set<size_t> with_view_;                // functions that read the state, or ask external ones
  std::vector<FunctionText> functions_;
  std::vector<External> externals_;
  std::map<std::string, std::string> accessors_;  // by name
};

}  // namespace rondo::codegen
