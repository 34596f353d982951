#pragma once

#include <functional>
#include <initializer_list>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The command line of a verb. Behind it is CLI11, which only a few sources include: it costs each of them as
/// much time to compile as all the rest of a verb.
namespace rondo::driver {

/// One option, to say more about it.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option* option) : option_(option) {}

  CommandOption& Required();
  /// Only values of [least, most], of the type of the option's variable: `double`, `int64_t`, `uint32_t`,
  /// `uint64_t`.
  template <typename T>
  CommandOption& Between(T least, T most);
  CommandOption& OneOf(std::initializer_list<const char*> words);
  /// An option with several values takes one each time that it is written, so that files may stand behind it.
  CommandOption& OneEach();
  /// So many values belong to it, which the help calls `names`.
  CommandOption& Takes(int values, const char* names);
  CommandOption& Excludes(const CommandOption& other);

 private:
  CLI::Option* option_;
};

class Command {
 public:
  /// A verb of `app`. It lives as long as `app`; so must the variables of its options.
  Command(CLI::App& app, const char* name, const char* what);

  /// A verb of a verb, which is then nothing without one.
  Command Verb(const char* name, const char* what);

  /// A name in capitals is a place, not an option. T: std::string, double, uint32_t, uint64_t, int64_t, an
  /// optional uint64_t, or a vector of std::string or uint64_t.
  template <typename T>
  CommandOption Option(const char* name, T& value, const char* what);
  CommandOption Flag(const char* name, bool& value, const char* what);
  /// Below the options: examples, and what the exit status means.
  void Footer(const char* text);
  void Run(std::function<void()> callback);

  /// Whether the user wrote the option.
  bool Given(const char* name) const;

 private:
  explicit Command(CLI::App* verb) : verb_(verb) {}

  CLI::App* verb_;
};

/// Ends a callback as if the command line had been refused: exit status 2.
[[noreturn]] void RefuseOption(const std::string& name, const std::string& why);

}  // namespace rondo::driver
