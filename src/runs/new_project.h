#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

/// Makes first projects.
namespace rondo::runs {

/// Returns the names of the templates.
std::vector<std::string> Templates();

/// Says why no project can be called so; empty if one can: a letter, then letters, digits and `_`, and no word of the languages.
std::string WrongName(const std::string& name);

/// Writes a project of this template into a folder, which it makes. Returns the names of its files.
/// @error if the folder is there and not empty, or something cannot be written.
base::Result<std::vector<std::string>> WriteProject(const std::filesystem::path& folder,
                                                    const std::string& name, const std::string& of);

}  // namespace rondo::runs
