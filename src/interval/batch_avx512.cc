#include "interval/batch_impl.h"
#include "interval/isa_avx512.h"

#ifdef __AVX512F__

namespace rondo::interval {

extern const Kernels kAvx512Kernels = BatchImpl<avx512::Isa>::Table("AVX-512");

}  // namespace rondo::interval

#endif  // __AVX512F__
