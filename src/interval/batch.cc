#include "interval/batch.h"

#include <array>

#include "base/check.h"

namespace rondo::interval {

extern const Kernels kPortableKernels;
#ifdef __x86_64__
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

namespace {

#ifdef __x86_64__
constexpr std::array kAll{Backend::kPortable, Backend::kAvx2, Backend::kAvx512};

size_t CountAvailable() {
  if (__builtin_cpu_supports("avx2") == 0) return 1;
  const bool avx512 = __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0;
  return avx512 ? 3 : 2;
}
#else
constexpr std::array kAll{Backend::kPortable};

size_t CountAvailable() { return 1; }
#endif

}  // namespace

std::span<const Backend> AvailableBackends() { return std::span(kAll).first(CountAvailable()); }

const Kernels& KernelsOf(Backend backend) {
#ifdef __x86_64__
  if (backend == Backend::kAvx2) return kAvx2Kernels;
  if (backend == Backend::kAvx512) return kAvx512Kernels;
#endif
  CHECK(backend == Backend::kPortable);
  return kPortableKernels;
}

const Kernels& BestKernels() { return KernelsOf(AvailableBackends().back()); }

}  // namespace rondo::interval
