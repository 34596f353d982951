#include "codegen/koord/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace rondo::codegen {

namespace {

// The words of C++20, then those that the text that is made uses itself.
constexpr auto kWords = std::to_array<std::string_view>(
    {"alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break", "case",
     "catch", "char", "char16_t", "char32_t", "char8_t", "class", "co_await", "co_return", "co_yield",
     "compl", "concept", "const", "const_cast", "consteval", "constexpr", "constinit", "continue", "decltype",
     "default", "delete", "do", "double", "dynamic_cast", "else", "enum", "explicit", "export", "extern",
     "false", "float", "for", "friend", "goto", "if", "inline", "int", "long", "mutable", "namespace", "new",
     "noexcept", "not", "not_eq", "nullptr", "operator", "or", "or_eq", "private", "protected", "public",
     "register", "reinterpret_cast", "requires", "return", "short", "signed", "sizeof", "static",
     "static_assert", "static_cast", "struct", "switch", "template", "this", "thread_local", "throw", "true",
     "try", "typedef", "typeid", "typename", "union", "unsigned", "using", "virtual", "void", "volatile",
     "wchar_t", "while", "xor", "xor_eq",
     // of `rondo/program`
     "Answer", "Any", "AskCore", "BasicEffect", "Begin", "ByteReader", "ByteWriter", "Bytes", "Choice",
     "Contains", "Core", "CoreEffect", "CoreHost", "CoreOf", "Describe", "Effects", "EventCode", "FallBack",
     "Fault", "Fill", "First", "FormulaCode", "Holds", "HoldsFor", "InRect", "Init", "Len", "Less",
     "LessEqual", "Lines", "List", "Members", "Merge", "NamesOf", "Opaque", "Pen", "Place", "Pos", "Record",
     "RunEvent", "Same", "Self", "Show", "ShowFloat", "ShowPlain", "Splat", "Step", "Team", "Text", "Truth",
     "Turn", "Two", "View", "Writing", "detail", "kCoreVersion", "kIsArray", "kIsList", "kMostSteps", "kZero",
     "swap",
     // of programs
     "Asking", "Calls", "Changes", "Effect", "Event", "In", "IsRobot", "Local", "MakeCore", "Out", "Program",
     "Shared", "Str", "To", "cell", "events", "formulas", "functions", "kCount", "kRobots", "koord", "param",
     // of the standard library, macros among them
     "assert", "errno", "int64_t", "linux", "major", "minor", "rondo", "size_t", "std", "stderr", "stdin",
     "stdout", "uint8_t", "uint16_t", "uint64_t", "unix",
     // what is passed around
     "at", "me", "old", "pid", "r", "result", "robot", "stopped", "to", "v"});

// Macros are written so.
bool IsShouted(std::string_view name) {
  return name.size() > 2 &&
         std::ranges::none_of(name, [](char c) { return std::islower(static_cast<unsigned char>(c)) != 0; });
}

}  // namespace

std::string CppName(std::string_view name) {
  std::string cpp(name);
  std::ranges::replace(cpp, '.', '_');
  // With the underscores that it ends with, so that no two names become one.
  const std::string_view word = std::string_view(cpp).substr(0, cpp.find_last_not_of('_') + 1);
  const bool taken = std::ranges::find(kWords, word) != kWords.end() || IsShouted(word);
  return cpp + (taken ? "_" : "");
}

std::string CppStem(std::string_view name) {
  std::string stem;
  for (const char c : name) stem += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ? c : '_';
  if (stem.empty() || std::isdigit(static_cast<unsigned char>(stem[0])) != 0) stem = "program_" + stem;
  return CppName(stem);
}

std::string CppString(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += fmt::format("\\{}", c);
    } else if (c == '?' || byte < 32 || byte > 126) {
      result += fmt::format("\\{:03o}", byte);  // no trigraphs
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string ParameterText(const std::string& type, const std::string& name) {
  const bool small = type == "int64_t" || type == "double" || type == "bool";
  return small ? fmt::format("{} {}", type, name) : fmt::format("const {}& {}", type, name);
}

std::string CppFloat(double value) {
  std::string text = fmt::format("{}", value + 0.0);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace rondo::codegen
