#include "reach/validated/series/convolve_impl.h"

namespace rondo::reach {

extern const Convolve kPortableConvolve = ConvolveHere;

}  // namespace rondo::reach
