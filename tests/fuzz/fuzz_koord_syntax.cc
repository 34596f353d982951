// Any bytes: reading ends, and what is read without errors survives formatting.
#include <cstdint>

#include "base/check.h"
#include "koord/syntax/format.h"
#include "koord/syntax/parser.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  koord::Program program;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  koord::Parse(sources, file, program, diagnostics);
  if (diagnostics.has_errors()) return 0;
  const std::string text = koord::Format(sources, program);
  diag::SourceSet again;
  diag::Diagnostics more;
  koord::Program second;
  koord::Parse(again, again.Add("formatted", text), second, more);
  CHECK(!more.has_errors()) << text;
  CHECK(koord::Skeleton(program) == koord::Skeleton(second)) << text;
  CHECK(koord::Format(again, second) == text) << text << "---\n" << koord::Format(again, second);
  CHECK(program.comments.size() == second.comments.size()) << text;
  return 0;
}
