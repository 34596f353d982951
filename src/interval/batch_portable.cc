#include "interval/batch_impl.h"
#include "interval/isa_portable.h"
#include "interval/widening.h"

namespace rondo::interval {

extern const Kernels kPortableKernels = BatchImpl<Widened<portable::Isa<kLanes>>>::Table("portable");

}  // namespace rondo::interval
