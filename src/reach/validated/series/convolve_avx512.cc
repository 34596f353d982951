#include "reach/validated/series/convolve_impl.h"

#ifdef __AVX512F__

namespace rondo::reach {

extern const Convolve kAvx512Convolve = ConvolveHere;

}  // namespace rondo::reach

#endif  // __AVX512F__
