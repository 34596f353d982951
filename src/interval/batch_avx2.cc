#include "interval/batch_impl.h"
#include "interval/isa_avx2.h"
#include "interval/widening.h"

#ifdef __AVX2__

namespace rondo::interval {

extern const Kernels kAvx2Kernels = BatchImpl<Widened<avx2::Isa>>::Table("AVX2");

}  // namespace rondo::interval

#endif  // __AVX2__
