#pragma once

#include <span>
#include <string_view>

namespace rondo::runs {

/// Is a file of `templates/`. `NAME` in its name and its text stands for the name of the project.
struct TemplateFile {
  std::string_view project;  ///< the template that it belongs to: `koord`
  std::string_view name;     ///< `NAME.koord`
  bool executable = false;
  std::string_view text;
};

/// Returns the files of all templates, by template and name.
std::span<const TemplateFile> TemplateFiles();

}  // namespace rondo::runs
