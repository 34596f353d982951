#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// Describes the command line of a verb. Behind it is CLI11, which only a few sources include: it costs each
/// of them as much time to compile as all the rest of a verb.
namespace rondo::driver {

/// Represents one option, to say more about it. Each function returns the option itself.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option* option) : option_(option) {}

  /// Refuses a command line without the option.
  CommandOption& Required();
  /// Allows only values of [least, most], of the type of the option's variable: `double`, `int64_t`,
  /// `uint32_t`, `uint64_t`.
  template <typename T>
  CommandOption& Between(T least, T most);
  /// Allows only these words as values.
  CommandOption& OneOf(std::initializer_list<const char*> words);
  /// Lets an option with several values take one each time that it is written, so that files may stand behind
  /// it.
  CommandOption& OneEach();
  /// Says how many values belong to it, which the help calls `names`.
  CommandOption& Takes(int values, const char* names);
  /// Refuses a command line with both options.
  CommandOption& Excludes(const CommandOption& other);

 private:
  CLI::Option* option_;
};

/// Represents a verb of the command line, while it is put together.
class Command {
 public:
  /// Adds a verb to `app`. It lives as long as `app`; so must the variables of its options.
  Command(CLI::App& app, const char* name, const char* what);

  /// Adds a verb of this verb, which is then nothing without one.
  Command Verb(const char* name, const char* what);

  /// Adds an option that sets `value`. A name in capitals is a place, not an option. T: std::string, double,
  /// uint32_t, uint64_t, int64_t, an optional uint64_t, or a vector of std::string or uint64_t.
  template <typename T>
  CommandOption Option(const char* name, T& value, const char* what);
  /// Adds an option without a value, which sets `value` to true.
  CommandOption Flag(const char* name, bool& value, const char* what);
  /// Takes all words behind the first one that is no option, and that one, whatever they are.
  void TakeRest();
  /// Returns these words.
  std::vector<std::string> Rest() const;
  /// Sets what the help says below the options: examples, and what the exit status means.
  void Footer(const char* text);
  /// Sets what runs when the verb is called, after its options are set.
  void Run(std::function<void()> callback);

  /// Reports whether the user wrote the option.
  bool Given(const char* name) const;

 private:
  explicit Command(CLI::App* verb) : verb_(verb) {}

  CLI::App* verb_;
};

/// Ends a callback as if the command line had been refused: exit status 2.
[[noreturn]] void RefuseOption(const std::string& name, const std::string& why);
/// Does so if the user wrote one of these options.
void RefuseAll(const Command& verb, std::initializer_list<const char*> names, const char* why);

}  // namespace rondo::driver
