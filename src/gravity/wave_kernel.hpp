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
  /// For clouds of this radius and wave numbers k up to the highest one, both by the spacing of z. Higher waves are left
  /// out.
  WaveKernel(const ForceSplit& split, double radius, double highest_k);

  /// From wave m's masses, all planes, to the potential at G = 1, without its sign (masses attract up its gradient).
  void apply(const MeshShape& shape, const ShearedTransform& transform, std::size_t m, const MeshKernels& kernels,
             const std::complex<float>* from, std::complex<float>* to) const;

private:
  void tabulate(const ForceSplit& split, double radius);

  /// For wave number k (per spacing of z): near[0 … reach] at distances of that many planes, the factor of the tail
  /// times k, each times the spacing of z; the entries of one k stand together.
  std::vector<float> table_;
  std::vector<float> window_; // what takes the window out of one axis, against k times its spacing
  std::size_t reach_ = 0;
  double highest_k_;
};

} // namespace keeler
