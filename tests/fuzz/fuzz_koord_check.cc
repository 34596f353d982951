// Any bytes: the checker ends, on whatever the parser could save.
#include <cstdint>

#include "diag/render.h"
#include "koord/check/check.h"
#include "koord/syntax/parser.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  koord::Program program;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  koord::Parse(sources, file, program, diagnostics);
  koord::Check(program, diagnostics);
  size_t length = 0;
  for (const diag::Diagnostic& d : diagnostics.Sorted())
    length += diag::RenderText(sources, d, diag::Colour::kOff).size();
  return length == 1 ? 1 : 0;
}
