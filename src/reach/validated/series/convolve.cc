#include "reach/validated/series/convolve.h"

namespace rondo::reach {

extern const Convolve kPortableConvolve;

#if defined(__x86_64__)
extern const Convolve kAvx2Convolve;
extern const Convolve kAvx512Convolve;

Convolve BestConvolve() {
  if (__builtin_cpu_supports("avx512f") != 0) return kAvx512Convolve;
  if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0) return kAvx2Convolve;
  return kPortableConvolve;
}
#else
Convolve BestConvolve() { return kPortableConvolve; }
#endif

}  // namespace rondo::reach
