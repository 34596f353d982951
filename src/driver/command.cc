#include "driver/command.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace rondo::driver {

CommandOption& CommandOption::Required() {
  option_->required();
  return *this;
}

template <typename T>
CommandOption& CommandOption::Between(T least, T most) {
  option_->check(CLI::Range(least, most));
  // What is no number is in every range, for comparisons with it are false.
  if constexpr (std::is_floating_point_v<T>)
    option_->check([](const std::string& text) {
      return std::isnan(std::strtod(text.c_str(), nullptr)) ? text + " is no number" : "";
    });
  return *this;
}

template CommandOption& CommandOption::Between(double, double);
template CommandOption& CommandOption::Between(int64_t, int64_t);
template CommandOption& CommandOption::Between(uint32_t, uint32_t);
template CommandOption& CommandOption::Between(uint64_t, uint64_t);

CommandOption& CommandOption::OneOf(std::initializer_list<const char*> words) {
  option_->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end())));
  return *this;
}

CommandOption& CommandOption::OneEach() {
  option_->allow_extra_args(false);
  return *this;
}

CommandOption& CommandOption::Takes(int values, const char* names) {
  option_->expected(values)->allow_extra_args(false)->type_name(names);
  return *this;
}

CommandOption& CommandOption::Excludes(const CommandOption& other) {
  option_->excludes(other.option_);
  return *this;
}

Command::Command(CLI::App& app, const char* name, const char* what) : verb_(app.add_subcommand(name, what)) {}

void Command::TakeRest() { verb_->prefix_command(); }

std::vector<std::string> Command::Rest() const { return verb_->remaining(); }

Command Command::Verb(const char* name, const char* what) {
  verb_->require_subcommand(1);
  return Command(verb_->add_subcommand(name, what));
}

template <typename T>
CommandOption Command::Option(const char* name, T& value, const char* what) {
  CLI::Option* option = verb_->add_option(name, value, what);
  // Else -1 would be the largest number.
  if constexpr (std::is_unsigned_v<T> || std::is_same_v<T, std::optional<uint64_t>> ||
                std::is_same_v<T, std::vector<uint64_t>>)
    option->check([](const std::string& text) { return text.starts_with('-') ? text + " is below 0" : ""; });
  return CommandOption(option);
}

template CommandOption Command::Option(const char*, std::string&, const char*);
template CommandOption Command::Option(const char*, double&, const char*);
template CommandOption Command::Option(const char*, uint32_t&, const char*);
template CommandOption Command::Option(const char*, uint64_t&, const char*);
template CommandOption Command::Option(const char*, int64_t&, const char*);
template CommandOption Command::Option(const char*, std::optional<uint64_t>&, const char*);
template CommandOption Command::Option(const char*, std::vector<std::string>&, const char*);
template CommandOption Command::Option(const char*, std::vector<uint64_t>&, const char*);

CommandOption Command::Flag(const char* name, bool& value, const char* what) {
  return CommandOption(verb_->add_flag(name, value, what));
}

void Command::Footer(const char* text) { verb_->footer(text); }

void Command::Run(std::function<void()> callback) { verb_->callback(std::move(callback)); }

bool Command::Given(const char* name) const { return verb_->get_option(name)->count() > 0; }

void RefuseOption(const std::string& name, const std::string& why) { throw CLI::ValidationError(name, why); }

void RefuseAll(const Command& verb, std::initializer_list<const char*> names, const char* why) {
  for (const char* name : names) {
    if (verb.Given(name)) RefuseOption(name, why);
  }
}

}  // namespace rondo::driver
