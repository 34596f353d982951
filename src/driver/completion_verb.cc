#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

std::string Options(const CLI::App& verb) {
  std::string text;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) text += " --" + name;
  }
  return text.empty() ? "" : text.substr(1);
}

std::string Bash(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs += verb->get_name() + " ";
    cases += fmt::format("    {}) words=\"{}\" ;;\n", verb->get_name(), Options(*verb));
  }
  return fmt::format(R"bash(_rondo() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words=""
  if [ "$COMP_CWORD" -eq 1 ]; then
    words="{}--help --version"
  else
    case "${{COMP_WORDS[1]}}" in
{}    esac
  fi
  case "$current" in
    -*) COMPREPLY=($(compgen -W "$words" -- "$current")) ;;
    *)
      if [ "$COMP_CWORD" -eq 1 ]; then COMPREPLY=($(compgen -W "$words" -- "$current"))
      elif [ "${{COMP_WORDS[1]}}" = explain ]; then
        COMPREPLY=($(compgen -W "$(rondo explain 2>/dev/null | cut -d' ' -f1)" -- "$current"))
      else COMPREPLY=($(compgen -f -- "$current")); fi ;;
  esac
}}
complete -o filenames -F _rondo rondo
)bash",
                     verbs, cases);
}

// A description between brackets or after a colon, in single quotes.
std::string ForZsh(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string Zsh(const CLI::App& app) {
  std::string verbs, cases;
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs += fmt::format("    '{}:{}'\n", verb->get_name(), ForZsh(verb->get_description()));
    cases += fmt::format("    {}) _arguments", verb->get_name());
    for (const CLI::Option* option : verb->get_options()) {
      const bool value = option->get_type_size() > 0;
      for (const std::string& name : option->get_lnames()) {
        cases += fmt::format(" \\\n      '--{}{}[{}]{}'", name, value ? "=" : "",
                             ForZsh(option->get_description()), value ? ":value:_files" : "");
      }
    }
    const bool explains = verb->get_name() == "explain";
    cases += fmt::format(" \\\n      '*:{}' ;;\n",
                         explains ? "kind:($(rondo explain 2>/dev/null | cut -d\" \" -f1))" : "file:_files");
  }
  return fmt::format(R"zsh(#compdef rondo
_rondo() {{
  local -a verbs
  verbs=(
{}  )
  if (( CURRENT == 2 )); then
    _describe verb verbs
    return
  fi
  local verb=$words[2]
  shift words
  (( CURRENT-- ))
  case $verb in
{}  esac
}}
if [ "$funcstack[1]" = _rondo ]; then _rondo "$@"; else compdef _rondo rondo; fi
)zsh",
                     verbs, cases);
}

// What stands in single quotes.
std::string ForFish(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return result;
}

std::string Fish(const CLI::App& app) {
  std::string text;
  for (const CLI::App* verb : app.get_subcommands({})) {
    text += fmt::format("complete -c rondo -n __fish_use_subcommand -a {} -d '{}'\n", verb->get_name(),
                        ForFish(verb->get_description()));
    for (const CLI::Option* option : verb->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        text += fmt::format("complete -c rondo -n '__fish_seen_subcommand_from {}' -l {}{} -d '{}'\n",
                            verb->get_name(), name, option->get_type_size() > 0 ? " -r" : "",
                            ForFish(option->get_description()));
      }
    }
  }
  return text;
}

}  // namespace

void AddCompletionVerb(CLI::App& app, ExitStatus& status) {
  auto shell = std::make_shared<std::string>();
  Command verb(app, "completion", "print a completion script for a shell");
  verb.Option("SHELL", *shell, "bash, zsh or fish").Required().OneOf({"bash", "zsh", "fish"});
  verb.Footer("example: source <(rondo completion bash)");
  verb.Run([shell, &app, &status] {
    status = ExitStatus::kEstablished;
    if (*shell == "fish") return Print(Fish(app));
    Print(*shell == "zsh" ? Zsh(app) : Bash(app));
  });
}

}  // namespace rondo::driver
