// Self-gravity behind one interface: positions and masses in, accelerations out. The step turns them into kicks.
//
// A particle feels all images of all others, as far as the box repeats (lattice.hpp has the exact field of a pair), or
// in a mode to compare with other codes exactly n rings of them.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace keeler {

/// What a solver sees: particles at one instant, in any memory order, wherever they stand relative to the cell. Of many
/// ranks each has its own particles, and all ask at once.
struct GravityProblem {
  std::span<const Vec3> positions;    ///< m, Hill's frame
  std::span<const double> masses;     ///< kg
  std::span<const std::uint64_t> ids; ///< fix the order of sums where positions do not
  ShearingBox box;
  double offset = 0.0;     ///< the box's shear offset at this instant, m
  double newton_g = 0.0;   ///< m^3 kg^-1 rad^-2
  Communicator ranks = {}; ///< only `fft` can do with many
};

class GravitySolver {
public:
  virtual ~GravitySolver() = default;

  /// Writes each particle's acceleration (m rad^-2). The bits depend on the problem, not on memory order or threads.
  virtual void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) = 0;

  virtual std::string name() const = 0;
};

/// Energy of a patch in its own gravity, images included.
struct GravityEnergy {
  double potential = 0.0; ///< Φ = −½ Σ G m_i m_j / d over all pairs and images, as the lattice counts it, kg m² rad⁻²
  double stress = 0.0; ///< dΦ/dγ under the shear y → y − γ x of patch and box, kg m² rad⁻²; over M S it is a viscosity
};

/// What kicks add to the motions beyond the shear is ∫ S stress dt − ΔΦ.
class EnergyMeter {
public:
  virtual ~EnergyMeter() = default;
  virtual GravityEnergy energy(const GravityProblem& problem) = 0;
};

/// How self-gravity is computed.
struct GravitySettings {
  enum class Solver { direct, tree, fft, mesh, axisymmetric, automatic };
  Solver solver = Solver::tree;
  double opening_angle = 0.6;       ///< tree: a cell is opened when its size exceeds this times its distance
  ImageSettings images = {};        ///< direct and tree
  double force_error = 2e-3;        ///< fft and automatic: rms error asked for, over the rms force
  double mesh_spacing = 1.6;        ///< fft and mesh: of the mesh, in mean distances (particles an area)^−1/2
  double mesh_cut = 0.0;            ///< fft: where neighbours end, in spacings; 0: by the force error
  double shortest_wavelength = 0.0; ///< axisymmetric: of the waves that pull, m
  int kick_every = 1;               ///< drifts per kick
  bool resting_contacts = true;     ///< contacts at rest carry the kicks

  /// Whether particles attract each other one by one: not by the radial pull of all alone.
  bool by_pairs() const { return solver != Solver::axisymmetric; }
  /// Whether contacts at rest carry the kicks (resting/resting_contacts.hpp).
  bool carries() const { return by_pairs() && resting_contacts; }
};

/// What `automatic` stands for in a patch of so many particles: fft, which was cheaper than the tree at every error and
/// number measured (docs/theory/gravity.md); direct for a few. Others are returned as they are.
GravitySettings chosen_for(std::size_t count, GravitySettings settings);

/// The solver for particles of these masses on an area (m²). Collective: of the particles of all ranks. Throws
/// UsageError when the environment variable KEELER_SIMD names instructions that are not to be had (simd.hpp).
std::unique_ptr<GravitySolver> make_gravity_solver(const GravitySettings& settings, std::span<const double> masses,
                                                   double area, const Communicator& ranks = {});

/// What measures the energy and the stress that belong to the forces of such a solver: of the same periodic sum for
/// `direct` and `tree`, of the mesh or the radial waves alone for `mesh` and `axisymmetric`; null where only some rings
/// of images act. Collective, and throws, as above.
bool has_energy_meter(const GravitySettings& settings);
std::unique_ptr<EnergyMeter> make_energy_meter(const GravitySettings& settings, std::span<const double> masses,
                                               double area, const Communicator& ranks = {});

} // namespace keeler
