// Attraction by neighbours within the cut-off radius, images included: the part that the mesh does not carry.
//
// Particles of a tile that are close in height make a group. Sources are found tile by tile for the whole group and go
// to the kernel in sorted order, so the order of each sum depends on the problem alone. Coordinates are taken relative
// to the group in double and only then rounded: the size of the box costs no digits. Boxes may be smaller than the
// cut-off radius: each image is a source, and a particle's own images attract it too.
#pragma once

#include "force_split.hpp"
#include "mesh_kernels.hpp"
#include "sorted_particles.hpp"

#include <array>

namespace keeler::gravity {

class NearForces {
public:
  NearForces(const ForceSplit& split, InstructionSet set);

  /// Sets the targets to sorted particles [begin, begin + count), and their accelerations at G = 1, in mass_unit() per
  /// square of the cut-off radius (m). Precondition: they are in one tile, 0 < count ≤ NearTargets::capacity.
  void attract(const SortedParticles& sorted, const ShearingBox& box, double offset, double radius, std::size_t begin,
               std::size_t count, NearTargets& targets) const;

  /// The contribution of neighbours to the energy of targets, at G = 1.
  struct Energy {
    double potential = 0.0; ///< Σ m_i m_j (1/u − cloud's potential), in mass_unit()² per cut-off radius
    double stress = 0.0;    ///< Σ m_i m_j u_x u_y (attraction over u), in that unit
  };
  /// Returns the energy of sorted particles [begin, begin + count). Precondition: as attract().
  Energy energy(const SortedParticles& sorted, const ShearingBox& box, double offset, double radius, std::size_t begin,
                std::size_t count) const;

private:
  template<class Flush>
  void visit(const SortedParticles& sorted, const ShearingBox& box, double offset, double radius, std::size_t begin,
             std::size_t count, NearTargets& targets, const Flush& flush) const;

  std::array<float, ForceSplit::terms> inside_;
  std::array<float, ForceSplit::terms + 1> potential_;
  MeshKernels kernels_;
};

} // namespace keeler::gravity
