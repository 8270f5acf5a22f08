// Scattering laws of ring particles: how much of the light that meets a sphere leaves it in which direction.
//
// Two kinds. A surface law is a property of each point of the sphere (Lambert, Lommel–Seeliger): it depends on the
// local normal. A particle law is the phase function P(α) of a whole sphere: the point that a ray meets shows
// I/F = ϖ P(α)/4, wherever on the disc it is (Dones, Cuzzi & Showalter 1993, Icarus 105, 184; Salo & Karjalainen 2003,
// Icarus 164, 428). The albedo ϖ is the light that a sphere in a parallel beam scatters over the light that meets its
// cross-section. I/F is π times the intensity over the flux of the beam, πF.
#pragma once

#include <keeler/core/vector.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace keeler {
class RandomStream;
}

namespace keeler::light {

/// A direction from which light came to a point, and the weight of the light along it.
struct Scattering {
  Vec3 from = Vec3::UnitZ(); ///< unit vector towards where the light came from
  double weight = 0.0;       ///< mean contribution of the intensity along `from` to that in the asked direction
};

/// A scattering law. All vectors are unit vectors that point away from the sphere's surface point: `normal`, `to`
/// (where the light goes), `from` (where it came from). Functions are called from several threads at once.
class ScatteringLaw {
public:
  virtual ~ScatteringLaw() = default;

  /// Returns the I/F that the point shows in the direction `to` if the beam comes from `from` unhindered. It is
  /// symmetric in `to` and `from` but for the factor normal·from of a surface law.
  virtual double brightness(const Vec3& normal, const Vec3& to, const Vec3& from) const = 0;

  /// Draws a direction from which light came that goes to `to`. The stream of random numbers is Keeler's own: laws of
  /// one's own are made by particle_law() and surface_law().
  virtual Scattering scatter(const Vec3& normal, const Vec3& to, RandomStream& random) const = 0;

  /// True for a particle law: the light belongs to a place of the disc, not to a point of the surface.
  virtual bool of_particle() const = 0;
};

/// A law that several threads share.
using SharedLaw = std::shared_ptr<const ScatteringLaw>;

/// A phase function: P(α), α in [0, π] is the phase angle, 0 for light that goes back. Its scale does not matter.
using PhaseFunction = std::function<double(double)>;

/// P(α) as given, normalised so that its mean over all directions is 1. Tabulated once at 8193 angles, and linear in α
/// between them: the function is called only here. Throws UsageError if a value is negative or not finite, or all are
/// 0.
SharedLaw particle_law(const PhaseFunction& phase_function, double albedo);

/// The I/F of a point of a surface as a function of μ₀ and μ, the cosines of the angles between the surface's normal
/// and the directions to source and observer, both in (0, 1], and of the phase angle α, rad. Its scale does not matter.
using SurfaceFunction = std::function<double(double cosine_of_source, double cosine_of_observer, double phase)>;

/// A surface law as given, scaled so that a sphere scatters the fraction `albedo`. Tabulated once, over both angles to
/// the normal and the azimuth between them, every 2.5°, and linear between: the function is called only here, and what
/// is narrower than that is lost. Throws UsageError if a value is negative or not finite, or all are 0.
SharedLaw surface_law(const SurfaceFunction& brightness, double albedo);

/// P = 1.
SharedLaw isotropic_law(double albedo);

/// P ∝ (π − α)^n, n > −1: Callisto has n = 3.092 (Dones, Cuzzi & Showalter 1993, their eq. 9).
SharedLaw power_law(double exponent, double albedo);

/// P = (1 − g²)/(1 + g² + 2 g cos α)^{3/2} (Henyey & Greenstein 1941, ApJ 93, 70), −1 < g < 1: g < 0 scatters back.
SharedLaw henyey_greenstein_law(double asymmetry, double albedo);

/// Lambert's surface: I/F = ϖ μ₀.
SharedLaw lambert_law(double albedo);

/// Lommel and Seeliger's surface, I/F ∝ μ₀/(μ + μ₀) (Seeliger 1887; Hapke 1993, §8), with the factor for which a whole
/// sphere scatters the fraction `albedo`: I/F = ϖ/(8 (1 − ln 2)/3) · μ₀/(μ + μ₀). Above ϖ = 0.2046 the grains of a
/// surface would have an albedo above 1, and grazing light leaves brighter than it came; the sphere as a whole
/// conserves.
SharedLaw lommel_seeliger_law(double albedo);

/// A law that commands call by name.
struct LawEntry {
  const char* name;                                   ///< "power_law"
  const char* parameter;                              ///< what NAME=VALUE sets; empty: nothing
  double fallback;                                    ///< of the parameter, where none is given
  double low;                                         ///< its open range: from here
  double high;                                        ///< to here
  const char* meaning;                                ///< a line for the manual
  SharedLaw (*make)(double parameter, double albedo); ///< makes it
};

/// Returns all laws.
std::span<const LawEntry> law_entries();

/// Returns the law of a text NAME or NAME=VALUE: "lambert", "henyey_greenstein=-0.35". Throws UsageError if there is
/// none of that name, or for a value or an albedo out of range (0 < ϖ ≤ 1).
SharedLaw law_named(const std::string& text, double albedo);

/// Registers a law of the calling program: law_named() then finds its name. Throws UsageError if the name is empty or
/// taken.
void add_law(const std::string& name, SharedLaw (*make)(double albedo));

} // namespace keeler::light
