#include "lsp/outline.h"

#include "choreo/syntax/parser.h"
#include "koord/syntax/parser.h"
#include "workspace/module_files.h"

namespace rondo::lsp {

namespace {

// What items are called: those of both languages say it in different ways.
template <class Item>
std::string NameOf(const Item& item) {
  if constexpr (requires { item.name.text; })
    return item.name.text;
  else if constexpr (requires { item.robot.text; })
    return "process " + item.robot.text;
  else if constexpr (requires { item.decl.name; })
    return item.decl.name;
  else if constexpr (requires { item.name; })
    return item.name;
  else if constexpr (requires { item.function; })
    return "summary " + item.function;
  else
    return "";
}

SymbolKind KindOf(const koord::Item& item) {
  if (std::holds_alternative<koord::EventDef>(item)) return SymbolKind::kEvent;
  if (std::holds_alternative<koord::FunctionDef>(item)) return SymbolKind::kFunction;
  if (std::holds_alternative<koord::AdtDef>(item)) return SymbolKind::kClass;
  if (std::holds_alternative<koord::EnumDef>(item)) return SymbolKind::kEnum;
  if (std::holds_alternative<koord::ModuleDef>(item)) return SymbolKind::kModule;
  if (std::holds_alternative<koord::ParamDef>(item)) return SymbolKind::kConstant;
  return SymbolKind::kProperty;
}

SymbolKind KindOf(const choreo::Item& item) {
  if (std::holds_alternative<robot::RobotDef>(item)) return SymbolKind::kClass;
  if (std::holds_alternative<robot::WorldDef>(item)) return SymbolKind::kModule;
  if (std::holds_alternative<choreo::ProcessDef>(item)) return SymbolKind::kMethod;
  return SymbolKind::kFunction;
}

std::vector<Symbol> Koord(diag::FileId file, workspace::Session& session) {
  std::vector<Symbol> symbols;
  koord::Program program;
  koord::Parse(session.sources, file, program, session.diagnostics);
  for (size_t i = 0; i < program.items.size(); ++i) {
    const koord::Item& item = program.items[i];
    const diag::Span span = i < program.item_spans.size() ? program.item_spans[i] : diag::Span();
    if (const auto* section = std::get_if<koord::Section>(&item)) {
      for (const koord::Decl& d : section->decls) symbols.push_back({d.name, SymbolKind::kVariable, d.span});
      continue;
    }
    const std::string name = std::visit([](const auto& i_) { return NameOf(i_); }, item);
    if (!name.empty()) symbols.push_back({name, KindOf(item), span});
  }
  return symbols;
}

}  // namespace

std::vector<Symbol> OutlineOf(const std::string& file, workspace::Session& session) {
  const bool module = workspace::IsModuleFile(file);
  const auto source =
      workspace::ReadSource(file, module ? workspace::Wanted::kMotion : workspace::Wanted::kKoord, session);
  if (!source) return {};
  if (!module) return Koord(*source, session);
  std::vector<Symbol> symbols;
  choreo::Module read;
  choreo::Parse(session.sources, *source, read, session.diagnostics);
  for (const choreo::Item& item : read.items) {
    const std::string name = std::visit([](const auto& i) { return NameOf(i); }, item);
    const diag::Span span = std::visit([](const auto& i) { return i.span; }, item);
    if (!name.empty()) symbols.push_back({name, KindOf(item), span});
  }
  return symbols;
}

}  // namespace rondo::lsp
