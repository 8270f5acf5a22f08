#include <keeler/gravity/kernels.hpp>

namespace keeler {

namespace kernels_portable {
extern const AttractionKernels kernels;
}
#if defined(__x86_64__)
namespace kernels_avx2 {
extern const AttractionKernels kernels;
}
namespace kernels_avx512 {
extern const AttractionKernels kernels;
}
#endif

AttractionKernels attraction_kernels([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return kernels_avx512::kernels;
  if (set == InstructionSet::avx2)
    return kernels_avx2::kernels;
#endif
  return kernels_portable::kernels;
}

} // namespace keeler
