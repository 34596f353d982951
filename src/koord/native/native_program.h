#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "diag/source.h"
#include "koord/semantics/team.h"
#include "program/core.h"

/// Runs programs that `rondo build` made in place of the machine.
namespace rondo::koord::native {

/// Returns a number for what a program in C++ is made of: the texts of the program and its specification, the number of robots, the
/// values of parameters. The same for the same, whatever else there is.
uint64_t DigestOf(const semantics::Team& team, const diag::SourceSet& sources);

/// Is a library with a program in C++. Stays loaded as long as the process lives.
class Library {
 public:
  /// Loads a library that the project of `rondo build` makes (`libkoord_NAME_core.so`).
  /// @error if there is none, or it is none, or one of another version.
  static base::Result<Library> Load(const std::string& path);

  /// Returns for how many robots it was made.
  size_t robots() const;
  /// Lets the library run the events of a team, which must outlive neither it nor `sources`. Questions go to the host of the
  /// team's machine.
  /// @error if it was made of another program, for another number of robots, or with other parameters.
  base::Result<bool> Attach(semantics::Team& team, const diag::SourceSet& sources) const;

 private:
  explicit Library(std::string path, program::Core* (*make)()) : path_(std::move(path)), make_(make) {}
  std::string path_;
  program::Core* (*make_)();
};

/// Lets a core run the events of a team.
void Attach(semantics::Team& team, const diag::SourceSet& sources, std::unique_ptr<program::Core> core);

}  // namespace rondo::koord::native
