#pragma once

#include <string>

/// Names files.
namespace rondo::workspace {

/// Returns the text as the name of a file: all but letters, digits, `-` and `_` become `_`.
std::string FileName(std::string text);

/// Returns the absolute path of a file; an empty one for an empty one.
std::string Absolute(const std::string& file);

/// Returns where a run that breaks a property goes unless the user says where: a file in the folder for
/// cached data, which it makes.
std::string DefaultRunFile(const std::string& program, const std::string& property);

}  // namespace rondo::workspace
