// What the mesh does with a wave: from its masses on the planes to its potential there, in open space above and below.
//
// A wave k of mass per area on a thin plane pulls through e^{−k|Δz|} 2π/k, and with clouds in place of particles, only
// the distances within a few cut-off radii differ from that. So the sum over planes is a short symmetric one, plus the
// exponential tail, which two recursions along z carry however many planes there are. The factors are tabulated against
// k; what the spreading and its counterpart, the interpolation, do to a wave is taken out of them in x, y and z in the
// sense of least squares over all aliases of a wave (Hockney & Eastwood's optimal influence function, for the
// potential). The wave k = 0 is kept: its tail is −2π |Δz|, the sheet's own attraction.
#pragma once

#include "force_split.hpp"
#include "mesh.hpp"
#include "mesh_kernels.hpp"
#include "sheared_transform.hpp"

#include <complex>
#include <vector>

namespace keeler {

class WaveKernel {
public:
  /// For clouds of this radius and wave numbers k up to the highest one, both by the spacing of z. Higher waves are
  /// left out.
  WaveKernel(const ForceSplit& split, double radius, double highest_k);

  /// Before apply() on meshes of that shape.
  void prepare(const MeshShape& shape);

  /// From wave m's masses, all planes, to the potential at G = 1, without its sign (masses attract up its gradient).
  void apply(const MeshShape& shape, const ShearedTransform& transform, std::size_t m, const MeshKernels& kernels,
             const std::complex<float>* from, std::complex<float>* to);

private:
  static constexpr std::size_t block = 8; // waves at a time, which are 16 numbers

  /// Of a block of waves, number by number as MeshKernels::convolve takes them.
  struct Factors {
    float *near, *far, *decay;
  };

  void tabulate(const ForceSplit& split, double radius);
  void factors_of_block(const MeshShape& shape, const ShearedTransform& transform, std::size_t m, std::size_t begin,
                        const Factors& factors) const;
  float window(double angle) const;

  std::vector<float> table_; ///< for each k: near[0 … reach], and the factor of the tail times k; by the spacing of z
  std::vector<float> window_;                ///< what takes the window out of one axis, against k times its spacing
  std::vector<AlignedArray<float>> scratch_; ///< one a thread
  std::size_t reach_ = 0;
  double highest_k_;
};

} // namespace keeler
