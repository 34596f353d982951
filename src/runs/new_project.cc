#include "runs/new_project.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/file.h"
#include "runs/project_templates.h"
#include "workspace/module_files.h"

namespace rondo::runs {
namespace {

namespace fs = std::filesystem;

std::string Named(std::string_view text, const std::string& name) {
  constexpr std::string_view kPlace = "NAME";
  std::string result;
  for (size_t at = 0;;) {
    const size_t next = text.find(kPlace, at);
    result += text.substr(at, next - at);
    if (next == std::string_view::npos) return result;
    result += name;
    at = next + kPlace.size();
  }
}

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

std::vector<std::string> Templates() {
  std::vector<std::string> names;
  for (const TemplateFile& file : TemplateFiles()) {
    if (names.empty() || names.back() != file.project) names.emplace_back(file.project);
  }
  return names;
}

std::string WrongName(const std::string& name) {
  const auto fits = [](char c) { return IsLetter(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || !IsLetter(name[0]) || !std::ranges::all_of(name, fits))
    return fmt::format("`{}` cannot be a name: a letter, then letters, digits and `_`", name);
  // A choreography is called so, too.
  workspace::Session session;
  session.read = [&](const std::string&) -> base::Result<std::string> {
    return Named(
        "robot R { motion Wait() interruptible [0, inf) {} }\nworld W { a: R b: R }\nchoreography NAME in W { a -> b: go() }\n",
        name);
  };
  workspace::LoadModule({"name.rondo"}, {}, session);
  return session.diagnostics.has_errors()
             ? fmt::format("`{}` cannot be a name: it is a word of the language", name)
             : std::string();
}

base::Result<std::vector<std::string>> WriteProject(const fs::path& folder, const std::string& name,
                                                    const std::string& of) {
  std::error_code error;
  if (fs::exists(folder, error) && !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    return base::Error{fmt::format("`{}` is already there, and not an empty folder", folder.string())};
  const auto made = base::MakeFolders(folder);
  if (!made.ok())
    return base::Error{fmt::format("cannot make `{}`: {}", folder.string(), made.error().message)};
  std::vector<std::string> written;
  for (const TemplateFile& file : TemplateFiles()) {
    if (file.project != of) continue;
    const std::string own = Named(file.name, name);
    const auto done = base::WriteFileAtomically(folder / own, Named(file.text, name));
    if (!done.ok())
      return base::Error{fmt::format("cannot write `{}`: {}", (folder / own).string(), done.error().message)};
    constexpr auto kRun = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    if (file.executable) fs::permissions(folder / own, kRun, fs::perm_options::add, error);
    written.push_back(own);
  }
  return written;
}

}  // namespace rondo::runs
