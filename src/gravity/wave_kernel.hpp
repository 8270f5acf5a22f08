// The mesh's kernel: from a wave's masses on the planes to its potential there, with open space above and below.
//
// A wave k of mass per area on a thin plane attracts by e^{−k|Δz|} 2π/k. With clouds in place of particles, only
// distances within a few cut-off radii differ from that. So the sum over planes is a short symmetric one, plus the
// exponential tail, which two recursions along z compute for any number of planes. The factors are tabulated against k.
// They deconvolve spreading and interpolation in x, y and z in the sense of least squares over all aliases of a wave
// (Hockney & Eastwood's optimal influence function, for the potential). The wave k = 0 is kept: its tail is −2π |Δz|,
// the attraction of a sheet.
#pragma once

#include "force_split.hpp"
#include "mesh.hpp"
#include "mesh_kernels.hpp"
#include "sheared_transform.hpp"

#include <complex>
#include <vector>

namespace keeler::gravity {

class WaveKernel {
public:
  /// Tabulates the kernel for clouds of this radius and wave numbers up to max_k, both in units of the spacing along z.
  /// Higher waves are omitted.
  WaveKernel(const ForceSplit& split, double radius, double max_k);

  /// Prepares scratch memory for apply() on meshes of that shape.
  void prepare(const MeshShape& shape);

  /// Writes the potential `to` of wave m from its masses `from`, all planes, at G = 1 and without its sign:
  /// accelerations point along its gradient. Precondition: prepare() was called for the shape.
  void apply(const MeshShape& shape, const ShearedTransform& transform, std::size_t m, const MeshKernels& kernels,
             const std::complex<float>* from, std::complex<float>* to);

private:
  static constexpr std::size_t block = 8; // waves at a time: 16 numbers

  /// Factors of a block of waves, 16 numbers each, for MeshKernels::convolve.
  struct Factors {
    float *near, *far, *decay;
  };

  void tabulate(const ForceSplit& split, double radius);
  void factors_of_block(const MeshShape& shape, const ShearedTransform& transform, std::size_t m, std::size_t begin,
                        const Factors& factors) const;
  float window(double angle) const;

  /// For each k: near[0 … reach], and the factor of the tail times k; in units of the spacing along z.
  std::vector<float> table_;
  std::vector<float> window_;                ///< deconvolution of one axis, against k times its spacing
  std::vector<AlignedArray<float>> scratch_; ///< per thread
  std::size_t reach_ = 0;
  double max_k_;
};

} // namespace keeler::gravity
