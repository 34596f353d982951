// Any bytes: a certificate is accepted or rejected.
#include <cstdint>

#include "solve/certify/checker.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  solve::certify::Certificate certificate;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  solve::certify::ReadCertificate(sources, file, certificate, diagnostics);
  if (diagnostics.has_errors()) return 0;
  const base::StopToken stop;
  solve::certify::Check(certificate, diagnostics,
                        stop.WithDeadline(base::StopToken::Clock::now() + std::chrono::seconds(1)));
  return 0;
}
