// Attraction by neighbours within the cut-off radius, images included: what the mesh leaves over.
//
// Particles of a tile that are close in height make a group; sources are found tile by tile for the whole group and
// handed to the kernel in the order of the places, so each sum's order depends on the problem alone. Coordinates are
// taken relative to the group in double and only then rounded: the size of the box costs no digits. Boxes may be
// smaller than the cut-off radius: each image is a source of its own, and a particle's own images attract it too.
#pragma once

#include "force_split.hpp"
#include "mesh_kernels.hpp"
#include "places.hpp"

#include <array>

namespace keeler {

class NearForces {
public:
  NearForces(const ForceSplit& split, InstructionSet set);

  /// Sets the targets to places [begin, begin + count) of one tile, count ≤ NearTargets::capacity, and their
  /// accelerations at G = 1, in mass_unit() a square of the cut-off radius (m).
  void attract(const Places& places, const ShearingBox& box, double offset, double radius, std::size_t begin,
               std::size_t count, NearTargets& targets) const;

  /// What neighbours contribute to the energy of these targets, at G = 1.
  struct Energy {
    double potential = 0.0; ///< Σ m_i m_j (1/u − cloud's potential), in mass_unit()² a cut-off radius
    double stress = 0.0;    ///< Σ m_i m_j u_x u_y (attraction over u), the same
  };
  Energy energy(const Places& places, const ShearingBox& box, double offset, double radius, std::size_t begin,
                std::size_t count) const;

private:
  template<class Flush>
  void visit(const Places& places, const ShearingBox& box, double offset, double radius, std::size_t begin,
             std::size_t count, NearTargets& targets, const Flush& flush) const;

  std::array<float, ForceSplit::terms> inside_;
  std::array<float, ForceSplit::terms + 1> potential_;
  MeshKernels kernels_;
};

} // namespace keeler
