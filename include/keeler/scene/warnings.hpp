// What is allowed but seldom meant, and what a patch cannot show: said before a run by `keeler check`, and by the run.
#pragma once

#include <keeler/forces/satellite.hpp>
#include <keeler/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// How dense and how fast the particles of a start are, in metres and radians of orbit.
struct StartScale {
  std::size_t particle_count = 0;   ///< 0: nothing is known, and nothing is judged
  double optical_depth = 0.0;       ///< Σ π r² over the area of the box
  double mean_radius = 0.0;         ///< m
  double usual_dispersion = 0.0;    ///< usual_dispersion(), m rad^-1
  double dispersion = 0.0;          ///< largest of c_x, c_y and c_z about the mean flow at each x, m rad^-1
  double height = 0.0;              ///< standard deviation of z, m
  double spread_x = 0.0;            ///< the box's size over the extent of the particles, both along x
  double spread_y = 0.0;            ///< both along y
  bool flat = false;                ///< the particles lie in a layer, and not in a ball
  std::optional<double> shear_seen; ///< −dv_y/dx over the shear rate S: 1 on circular orbits; none: too uncertain
  double orbital_frequency = 0.0;   ///< rad/s, for messages
  double shear = 0.0;               ///< S in units of it
};

/// The velocity dispersion (m rad^-1) that collisions and self-gravity keep up in a ring, within a factor of a few: the
/// largest of r Ω and the escape speed of the largest particle and the dispersion of Toomre's Q = 2. `newton_g` and
/// `kappa` are in internal units.
double usual_dispersion(double largest_radius, double largest_mass, double surface_density, double newton_g,
                        double kappa);

/// What makes a start far from any ring, so that a unit or the shear is probably wrong: a line each.
std::vector<std::string> warnings(const StartScale& start);

/// Radial or vertical oscillations, whichever are faster, in one step; 0 of an automatic one, which follows contacts. A
/// scene with more than most_oscillations is refused, with more than few_oscillations doubted.
double oscillations_a_step(const Scene& scene);
inline constexpr double few_oscillations = 0.5, max_oscillations = 1.5;

/// How large a patch is, and of what.
struct PatchScale {
  struct Sphere {
    double radius = 0.0, mass = 0.0; ///< m, kg
  };
  std::size_t particle_count = 0;
  double size_x = 0.0, size_y = 0.0; ///< m
  double lambda_cr = 0.0;            ///< m
  double density = 0.0;              ///< of the particles themselves, kg m^-3: asked where the scene does not give it
  double mass = 0.0;                 ///< of all, kg
  double optical_depth = 0.0;        ///< Σ π r² / area
  Sphere largest;                    ///< the largest body
  Sphere grain;                      ///< a particle of the others: R = ⟨r³⟩/⟨r²⟩, of the density of all
  StartScale start = {};             ///< of a start; of a later state nothing
};

/// Sums over the bodies of a patch from which its scale follows.
struct BodySums {
  double mass = 0.0;                               ///< kg
  double squares = 0.0, cubes = 0.0, sixths = 0.0; ///< of radii, m², m³, m⁶
  PatchScale::Sphere largest;
};
PatchScale scale_of(const BodySums& sums, std::size_t particle_count, double size_x, double size_y, double lambda_cr);

/// The scale of a fresh start, moonlets included.
PatchScale scale_of(const Scene& scene);

/// A line each, with numbers; none where nothing is amiss.
std::vector<std::string> warnings(const Scene& scene, const PatchScale& patch);

/// The same before there is a patch: of one that a start file holds only the time step and forces can be judged.
std::vector<std::string> warnings(const Scene& scene);

/// Returns the first passage of the scene's satellite from `from` to `until` (orbits) that a cell cannot show well.
std::optional<SatellitePassage> doubtful_passage(const Scene& scene, double from, double until);

/// What such a passage does, and what to do instead.
std::string in_words(const SatellitePassage& passage);

/// The coefficient of restitution above which bounces of smooth spheres lose less than the shear gives at an optical
/// depth, so that the velocity dispersion grows without end: (1 − ε²)(1 + τ²) = 0.61 (Goldreich & Tremaine 1978).
double critical_restitution(double optical_depth);

} // namespace keeler
