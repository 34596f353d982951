#pragma once

#include <string>
#include <vector>

#include "codegen/koord/types.h"
#include "diag/source.h"

/// Turns checked Koord programs into C++.
namespace rondo::codegen {

/// Says what is to be made.
struct GenerateOptions {
  std::string name;  ///< of the program: names files and the namespace
  Capacities capacities;
  uint64_t digest = 0;  ///< of what it is made of
};

/// Is a program as C++: what stands in `NAME.h` and `NAME.cc`, which include the headers of `rondo/program`, and the name that
/// they go by.
struct GeneratedProgram {
  std::string name;
  std::string header, source;
  std::string core;                ///< `MakeCore`, for who does not know its types: `rondo/program/core.h`
  std::vector<std::string> calls;  ///< the methods of its class `Calls`
};

/// Returns the program of a team for as many robots, with these values of its parameters. Reports, with its place, each thing that
/// cannot be said in C++ without memory that grows; the text is of no use then.
///
/// What is made does what the machine does: `Effects` has the effects that `ProgramTransition::Of` lists, with the same faults at the
/// same places, but for lists and texts beyond their capacity, which are `Fault::kTooLong` earlier. Cost: linear in the program.
GeneratedProgram Generate(const koord::semantics::Team& team, const diag::SourceSet& sources,
                          const GenerateOptions& options, diag::Diagnostics& diagnostics);

}  // namespace rondo::codegen
