#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace rondo::base {

CheckFailure::CheckFailure(const char* condition, const char* file, int line) {
  text_ << file << ":" << line << ": internal check failed: " << condition << " ";
}

CheckFailure::~CheckFailure() {
  std::fprintf(stderr, "rondo: bug: %s\n", text_.str().c_str());
  std::fflush(stderr);
  // Exit status 4 means "a bug of ours"; no destructor may run on broken state.
  std::_Exit(4);
}

}  // namespace rondo::base
