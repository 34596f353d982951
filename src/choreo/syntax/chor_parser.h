#pragma once

#include "choreo/syntax/ast.h"
#include "diag/diagnostic.h"

/// Reads the files of the original tools: `.chor` and `.rosl`.
namespace rondo::choreo {

/// Adds the choreography of a `.chor` file to `module`: equations between states, as the original tool reads
/// them. It is about the last world that the module declares; `cart_x` is `x` of its robot `cart`. Numbers
/// are in SI units, angles in radians. Warns where the precedence of operators is not the usual one. Reports
/// every syntax error; never fails, whatever the bytes.
void ParseEquations(const diag::SourceSet& sources, diag::FileId file, Module& module,
                    diag::Diagnostics& diagnostics);

/// Adds the process of a `.rosl` file, a program of the original interpreter, for the robot that the file is
/// named after.
void ParseProgram(const diag::SourceSet& sources, diag::FileId file, const std::string& robot, Module& module,
                  diag::Diagnostics& diagnostics);

}  // namespace rondo::choreo
