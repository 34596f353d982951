#pragma once

#include <string>

/// Holds the entry of the command line.
namespace rondo::driver {

/// Runs the command line `rondo VERB ...`. Returns the exit status: 0 everything asked for is established; 1
/// the input is wrong, or a property is refuted or not inductive; 2 usage; 3 unknown; 4 a bug of ours.
int Main(int argc, char** argv);

/// Returns the version, and the commit that it was built from: `rondo 0.2.0 (commit 0123456789)`.
std::string VersionText();

}  // namespace rondo::driver
