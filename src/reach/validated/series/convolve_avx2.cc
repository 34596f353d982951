#include "reach/validated/series/convolve_impl.h"

#ifdef __AVX2__

namespace rondo::reach {

extern const Convolve kAvx2Convolve = ConvolveHere;

}  // namespace rondo::reach

#endif  // __AVX2__
