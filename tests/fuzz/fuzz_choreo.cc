// Any bytes as a `.rondo` file: reading, checking, projecting, drawing ends; formatting twice is formatting
// once.
#include <cstdint>

#include "choreo/syntax/format.h"
#include "choreo/syntax/parser.h"
#include "choreo_all.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  choreo::Module module;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  choreo::Parse(sources, file, module, diagnostics);
  if (!diagnostics.has_errors()) {
    const std::string once = choreo::Format(sources, file, choreo::Tokens(sources, file, diagnostics));
    const diag::FileId again = sources.Add("again", once);
    CHECK(choreo::Format(sources, again, choreo::Tokens(sources, again, diagnostics)) == once) << once;
  }
  return CheckEverything(sources, module, diagnostics);
}
