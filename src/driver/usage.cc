#include "driver/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "lang/suggest.h"

namespace rondo::driver {
namespace {

std::string Meant(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = lang::Suggest(name, names);
  return near.empty() ? "" : fmt::format("; did you mean `{}`?", near);
}

}  // namespace

const CLI::App* FindVerb(const CLI::App& app, const std::string& name) {
  const auto verbs = app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == name; });
  return verbs.empty() ? nullptr : verbs.front();
}

std::string NoSuchVerb(const CLI::App& app, const std::string& name) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  return fmt::format("there is no verb `{}`{}\n`rondo --help` lists them", name, Meant(name, verbs));
}

std::string NoSuchOption(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
  std::vector<std::string> names;
  for (const CLI::Option* option : verb->get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  std::string called = verb->get_name();
  for (const CLI::App* around = verb->get_parent(); around != nullptr; around = around->get_parent())
    called.insert(0, around->get_name() + " ");
  std::string text;
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || std::ranges::find(names, name) != names.end()) continue;
    text += fmt::format("`{}` has no option `{}`{}\n", called, name, Meant(name, names));
  }
  return text.empty() ? "" : fmt::format("{}`{} --help` lists them", text, called);
}

}  // namespace rondo::driver
