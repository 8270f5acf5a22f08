#include "mesh_kernels.hpp"

namespace keeler::gravity {

namespace mesh_portable {
extern const MeshKernels mesh;
}
#if defined(__x86_64__)
namespace mesh_avx2 {
extern const MeshKernels mesh;
}
namespace mesh_avx512 {
extern const MeshKernels mesh;
}
#endif

MeshKernels mesh_kernels([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return mesh_avx512::mesh;
  if (set == InstructionSet::avx2)
    return mesh_avx2::mesh;
#endif
  return mesh_portable::mesh;
}

} // namespace keeler::gravity
