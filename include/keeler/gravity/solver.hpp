// Self-gravity behind one interface: positions and masses in, accelerations out. The step turns them into kicks.
//
// A particle feels all images of all others, to infinity (lattice.hpp has the exact field of a pair), or, to compare
// with other codes, exactly n rings of them.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace keeler::gravity {

/// Particles at one instant, in any memory order and at any position relative to the cell. Over several ranks each has
/// its own particles, and solving is collective. The three spans have equal lengths.
struct GravityProblem {
  std::span<const Vec3> positions;    ///< m, Hill's frame
  std::span<const double> masses;     ///< kg
  std::span<const std::uint64_t> ids; ///< order sums where positions are equal
  ShearingBox box;                    ///< its size and shear
  double offset = 0.0;                ///< the box's shear offset at this instant, m
  double newton_g = 0.0;              ///< m^3 kg^-1 rad^-2
  Communicator ranks = {};            ///< of the run, each with a part of the particles
};

/// Computes self-gravity by one method.
class GravitySolver {
public:
  virtual ~GravitySolver() = default;

  /// Writes the acceleration (m rad^-2) of each particle. Its bits do not depend on memory order or threads.
  /// Precondition: `accelerations` has one entry per particle.
  virtual void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) = 0;

  virtual std::string name() const = 0; ///< of the method: "direct", "tree", "fft", …
};

/// Energy of a patch in its own gravity, images included.
struct GravityEnergy {
  double potential = 0.0; ///< Φ = −½ Σ G m_i m_j / d over all pairs and images, as the lattice counts it, kg m² rad⁻²
  double stress = 0.0; ///< dΦ/dγ under the shear y → y − γ x of patch and box, kg m² rad⁻²; over M S it is a viscosity
};

/// Measures GravityEnergy. Kicks change the energy of the motions relative to the shear by ∫ S stress dt − ΔΦ.
class EnergyMeter {
public:
  virtual ~EnergyMeter() = default;
  virtual GravityEnergy energy(const GravityProblem& problem) = 0; ///< collective
};

/// The images that attract.
struct ImageSettings {
  int rings = 1;   ///< rings of boxes around the cell that are summed one by one (1 is 9 boxes)
  bool far = true; ///< add all images beyond: the force is truly periodic; else exactly these rings act
};

/// The settings of self-gravity.
struct GravitySettings {
  /// Methods (docs/theory/gravity.md); chosen_for() replaces `automatic`.
  enum class Solver { direct, tree, fft, mesh, axisymmetric, automatic };
  Solver solver = Solver::tree;     ///< the method
  double opening_angle = 0.6;       ///< tree: a cell is opened when its size exceeds this times its distance
  ImageSettings images = {};        ///< direct and tree
  double force_error = 2e-3;        ///< fft and automatic: rms error asked for, over the rms force
  double mesh_spacing = 1.6;        ///< fft and mesh: of the mesh, in mean distances (particles per area)^−1/2
  double mesh_cut = 0.0;            ///< fft: cut-off of neighbours, in spacings; 0: by the force error
  double shortest_wavelength = 0.0; ///< axisymmetric: of the waves that attract, m
  int kick_every = 1;               ///< drifts per kick
  bool resting_contacts = true;     ///< contacts at rest carry the kicks

  /// True if particles attract each other individually: not only by their common radial field.
  bool by_pairs() const { return solver != Solver::axisymmetric; }
  /// True if contacts at rest carry the kicks (contact_solver/resting_contacts.hpp).
  bool carries() const { return by_pairs() && resting_contacts; }
};

/// Replaces the solver `automatic` by the cheapest one for `count` particles: direct for a few, else fft, which was
/// cheaper than the tree at every error and number measured (docs/theory/gravity.md). Other settings stay unchanged.
GravitySettings chosen_for(std::size_t count, GravitySettings settings);

/// Returns the solver for particles of these masses (kg) on an area (m²). Collective. Throws UsageError if the
/// environment variable KEELER_SIMD names an instruction set that the processor lacks (simd.hpp).
std::unique_ptr<GravitySolver> make_gravity_solver(const GravitySettings& settings, std::span<const double> masses,
                                                   double area, const Communicator& ranks = {});

/// True if make_energy_meter() returns a meter: unless only some rings of images act.
bool has_energy_meter(const GravitySettings& settings);
/// Returns the meter of energy and stress for the forces of such a solver: the periodic sum for `direct`, `tree` and
/// `fft`, the mesh or the radial waves alone for `mesh` and `axisymmetric`; null if only some rings of images act.
/// Collective. Throws as make_gravity_solver().
std::unique_ptr<EnergyMeter> make_energy_meter(const GravitySettings& settings, std::span<const double> masses,
                                               double area, const Communicator& ranks = {});

} // namespace keeler::gravity

namespace keeler {
using gravity::GravitySettings;
} // namespace keeler
