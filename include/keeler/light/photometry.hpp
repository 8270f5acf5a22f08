// Reflection and transmission of a patch by Monte Carlo ray tracing among its spheres (docs/theory/light.md): the
// indirect method of Salo & Karjalainen (2003, Icarus 164, 428). Rays go from the observer into the ring; where they
// meet a sphere, its light is added if no other sphere shadows it from the Sun, and a new direction is drawn from which
// light of the next order comes. All periodic images in the sheared box take part, at any order of scattering.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/light/scattering.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/statistics/measured.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::light {

/// True if this Keeler was built with Embree, Intel's library of ray tracing; without it no ray is traced.
bool can_trace();

/// Throws Error that says what is missing and how to get it, unless can_trace().
void require_tracer();

/// A direction from the patch to a far body. Angles in rad.
struct Bearing {
  double elevation = 0.0; ///< B above the ring plane, in [−π/2, π/2]
  double azimuth = 0.0;   ///< φ from the radius outward (+x) towards the orbital motion (+y)

  Vec3 direction() const; ///< unit vector
};

/// Where the observer and the Sun are, seen from the patch. A patch at the ring longitude θ, counted from the point
/// below the observer in the direction of motion, has the observer at the azimuth −θ.
struct Sight {
  Bearing observer; ///< elevation ≠ 0
  Bearing sun;      ///< elevation ≠ 0

  double phase() const;     ///< α, the angle between the two directions, rad
  double longitude() const; ///< θ of the patch, in [0, 2π), rad
  bool lit() const;         ///< true if the observer sees the face on which the Sun shines
};

/// Returns the sight with this phase angle and the Sun at the azimuth beyond the observer's (in the direction of
/// motion). Throws UsageError, with the possible range, if the elevations do not allow the phase angle. All in rad.
Sight sight_at_phase(const Bearing& observer, double sun_elevation, double phase);

/// Returns the sights of a grid of angles (rad), azimuths fastest, then phases. Without elevations of the Sun it has
/// that of the observer. Throws UsageError as sight_at_phase().
std::vector<Sight> sight_grid(std::span<const double> elevations, std::span<const double> sun_elevations,
                              std::span<const double> phases, std::span<const double> azimuths);

/// How a measurement is made.
struct PhotometrySettings {
  SharedLaw law;                     ///< of all particles
  std::uint64_t rays = 100000;       ///< per sight and snapshot; a whole number of rounds of `round_rays` is traced
  std::optional<double> error;       ///< traces until the relative standard error of I/F is this, at most `max_rays`
  std::uint64_t max_rays = 1u << 30; ///< per sight and snapshot, with `error`
  std::uint64_t seed = 1;            ///< of the random numbers
};

/// Rays of one snapshot between two looks at error and stop.
inline constexpr std::uint64_t round_rays = 8192;

/// What an observer sees of a patch at one sight: means over the snapshots.
struct Photometry {
  Sight sight;                   ///< where observer and Sun are
  Estimate reflectance;          ///< I/F, all orders; error by the finite number of rays
  Estimate single;               ///< I/F of light that was scattered once
  Estimate multiple;             ///< I/F of light that was scattered more often
  Estimate transmission;         ///< T towards the observer: fraction of rays that meet no sphere
  std::optional<double> scatter; ///< standard deviation of the I/F of single snapshots; none if fewer than two
  std::uint64_t rays = 0;        ///< per snapshot
  double scatterings = 0.0;      ///< mean number of spheres that a ray meets
};

/// Returns the photometry of the snapshots at each sight. The result of a sight depends neither on threads nor on the
/// other sights. When the work is to be abandoned (interrupt.hpp), returns the sights that are done, and the one in
/// work with the rays that it has. Precondition: patches of particles, a law. Throws Error without Embree, UsageError
/// for a patch without particles.
std::vector<Photometry> photometry(std::span<const Patch> patches, std::span<const Sight> sights,
                                   const PhotometrySettings& settings,
                                   const std::function<void(const Progress&)>& report = {});

/// The change of I/F with azimuth at one elevation: (max − min)/(max + min) of the I/F, and the longitude of the
/// minimum in [0, π), of the fit I/F = Σ c_k cos 2kθ + s_k sin 2kθ, k ≤ 3.
struct BrightnessAsymmetry {
  double amplitude = 0.0;         ///< in [0, 1]
  double error = 0.0;             ///< standard error of the amplitude by that of the I/F
  double minimum_longitude = 0.0; ///< rad
};

/// Returns the asymmetry of sights over at least 8 azimuths; nothing for fewer.
std::optional<BrightnessAsymmetry> brightness_asymmetry(std::span<const Photometry> of_one_elevation);

} // namespace keeler::light
