#pragma once

#include <string>
#include <string_view>

/// Names of programs as names of C++.
namespace rondo::codegen {

/// Returns the name as C++ may have it: with underscores for dots, and with one behind it if it is a word of the language or of the text that is made.
std::string CppName(std::string_view name);

/// Returns a name for a namespace or a file: of letters, digits and underscores.
std::string CppStem(std::string_view name);

/// Returns a text as C++ has it, with its quotes.
std::string CppString(std::string_view text);

/// Returns a float as C++ has it: the shortest form that reads back as the same number, and never an integer.
std::string CppFloat(double value);

/// Returns a parameter of a function: numbers and truth values go by value.
std::string ParameterText(const std::string& type, const std::string& name);

}  // namespace rondo::codegen
