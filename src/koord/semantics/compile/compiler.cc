#include "koord/semantics/compile/compiler.h"

#include <algorithm>
#include <utility>

namespace rondo::koord::semantics {

Compiler::Compiler(const Model& model, const Layout& layout, Heap& heap, Code& code)
    : model_(model), exprs_(model.program->exprs), layout_(layout), heap_(heap), code_(code) {
  // Address 0 is no entry.
  if (code_.instructions.empty()) Emit(Op::kEnd);
  code_.function_entry.resize(model.functions.size());
}

size_t Compiler::Emit(Op op, size_t a, size_t b, size_t c, size_t d) {
  code_.instructions.push_back({op, static_cast<uint32_t>(a), static_cast<uint32_t>(b),
                                static_cast<uint32_t>(c), static_cast<uint32_t>(d)});
  code_.spans.push_back(span_);
  return Here() - 1;
}

void Compiler::Constant(Word word) {
  Emit(Op::kConstant, code_.constants.size());
  code_.constants.push_back(word);
}

void Compiler::Fail(diag::Span span, std::string reason) {
  if (!unsupported_) unsupported_ = Unsupported{span, std::move(reason)};
}

std::optional<Unsupported> Compiler::TakeUnsupported() { return std::exchange(unsupported_, std::nullopt); }

uint32_t Compiler::NewFrame(uint32_t width) {
  const uint32_t at = code_.frame_words;
  code_.frame_words += width;
  return at;
}

uint32_t Compiler::FrameOf(uint32_t binding) {
  const auto it = frames_.find(binding);
  if (it != frames_.end()) return it->second;
  return frames_[binding] = NewFrame(Width(model_.bindings[binding].type));
}

void Compiler::Begin() {
  used_robot_ = false;
  locks_ = false;
}

uint32_t Compiler::Expression(ExprId e, TypeId type) {
  Begin();
  const auto entry = static_cast<uint32_t>(Here());
  GenAs(e, type);
  Emit(Op::kEnd);
  Functions();
  return entry;
}

uint32_t Compiler::Statements(const std::vector<Stmt>& body) {
  Begin();
  const auto entry = static_cast<uint32_t>(Here());
  Body(body);
  for (const size_t jump : std::exchange(returns_, {})) Patch(jump);
  Emit(Op::kEnd);
  Functions();
  return entry;
}

uint32_t Compiler::Initial(size_t v, ExprId e) {
  Begin();
  const auto entry = static_cast<uint32_t>(Here());
  TypeId type = model_.variables[v].type;
  const bool filled = model_.filled.contains(v);
  while (filled && model_.types.Is(type, lang::TypeKind::kArray)) type = model_.types[type].parts[0];
  GenAs(e, type);
  // From the innermost arrays outwards.
  const std::vector<uint32_t>& dimensions = layout_[v].dimensions;
  for (size_t d = dimensions.size(); filled && d-- > 0;)
    Emit(Op::kListFill, dimensions[d], d + 1 == dimensions.size() ? Width(type) : 1);
  Store(v);
  Emit(Op::kEnd);
  Functions();
  return entry;
}

void Compiler::Functions() {
  const bool used_robot = used_robot_;
  const bool locks = locks_;
  while (!wanted_.empty()) {
    const size_t f = wanted_.back();
    wanted_.pop_back();
    if (code_.function_entry[f] != 0) continue;
    code_.function_entry[f] = static_cast<uint32_t>(Here());
    const Function& function = model_.functions[f];
    function_ = static_cast<int>(f);
    const auto given = model_.exploration.functions.find(f);
    if (function.external()) {
      GenAs(given->second->body, function.result);
      Emit(Op::kReturn);
    } else {
      Body(function.def->body);
      span_ = function.span;
      Emit(Op::kFault, static_cast<size_t>(Fault::kReturn));
      for (uint32_t i = 0; i < Width(function.result); ++i) Constant(0);
      Emit(Op::kReturn);
    }
    function_ = -1;
  }
  used_robot_ = used_robot;
  locks_ = locks;
}

}  // namespace rondo::koord::semantics
