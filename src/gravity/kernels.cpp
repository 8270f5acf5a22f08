#include "kernels.hpp"
#include "far_kernels.hpp"

namespace keeler::gravity {

namespace kernels_portable {
extern const AttractionKernels kernels;
extern const FarKernels<float> far_single;
extern const FarKernels<double> far_double;
} // namespace kernels_portable
#if defined(__x86_64__)
namespace kernels_avx2 {
extern const AttractionKernels kernels;
extern const FarKernels<float> far_single;
extern const FarKernels<double> far_double;
} // namespace kernels_avx2
namespace kernels_avx512 {
extern const AttractionKernels kernels;
extern const FarKernels<float> far_single;
extern const FarKernels<double> far_double;
} // namespace kernels_avx512
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

template<> FarKernels<float> far_kernels([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return kernels_avx512::far_single;
  if (set == InstructionSet::avx2)
    return kernels_avx2::far_single;
#endif
  return kernels_portable::far_single;
}

template<> FarKernels<double> far_kernels([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return kernels_avx512::far_double;
  if (set == InstructionSet::avx2)
    return kernels_avx2::far_double;
#endif
  return kernels_portable::far_double;
}

} // namespace keeler::gravity
