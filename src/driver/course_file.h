#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "driver/reachability.h"

namespace rondo::driver {

/// A trajectory that breaks a contract, as `rondo reach` writes it and `rondo replay` reads it.
struct CourseFile {
  std::vector<std::string> files;
  std::string spec;
  std::string contract, claim;
  reach::Course course;
  double time = 0;  ///< at which the claim fails
};

/// Writes it as a whole or not at all.
base::Result<bool> SaveCourse(const std::string& path, const CourseFile& file);

/// Is this the text of such a file?
bool IsCourse(std::string_view text);

/// @error says what is wrong with the text.
base::Result<CourseFile> ReadCourse(std::string_view text);

/// Integrates the trajectory again: does it break the claim at that time? The text says so, or why not.
base::Result<std::string> ReplayCourse(const CourseFile& file, Session& session);

}  // namespace rondo::driver
