// The satellite is on an epicycle about a guiding centre X_s, which passes the particles at the rate of the shear. A
// cell is short compared with 3π |X_s|, over which an epicycle turns once, so all particles of a streamline are taken
// to be at the column of the cell's particles: the force depends on X, the epicycle and the time, never on Y, and the
// box stays periodic along the orbit. The column is upright at t_u: only then have neighbouring streamlines, side by
// side, met the satellite at the times at which they do in a ring. In units of Ω:
//
//   t_n(X) = (X_s t_0 − X t_u) / (X_s − X) + n T X_s / (X_s − X)     passage n of a streamline
//   y_s − y = −S (X_s − X) (t − t_n) + (2/κ) (e_s sin φ_s − e sin φ)
//
// With a particle's current X in t_n, the change of X by the passage would shift the passage, as if X had always had
// that value. So t_n uses the X before the passage, to first order in the satellite's mass:
//   X − 2 G m / (κ² S d |d| √(1 + S² τ²)),  d = X_s − X, τ = t − t_n(X)
// This keeps |ΔX| = e²/(S |d|) correct to second order (docs/theory/satellite.md).
#include <keeler/forces/satellite.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::forces {
namespace {

// Internal units; times in rad since the run began.
struct SatelliteOrbit {
  double pull = 0.0; // G m, m³ rad⁻²
  double guiding_x = 0.0;
  double passage = 0.0, every = 0.0, upright = 0.0; // t_0, T (0: one passage alone), t_u
  double eccentricity = 0.0, phase = 0.0;           // m; φ at t_0
  double inclination = 0.0, vertical_phase = 0.0;   // m; ζ at t_0
};

class Satellite : public Force {
public:
  explicit Satellite(const SatelliteOrbit& orbit) : orbit_(orbit) {}

  void accelerate(const Boundary& boundary, std::span<Vec3> accelerations) override {
    assert(accelerations.size() == boundary.particles.size());
    const Frequencies& f = boundary.frequencies;
    const Rotation rotation = boundary.rotation();
    const double turned = f.kappa * (boundary.time - orbit_.passage) + orbit_.phase;
    const double raised = f.nu * (boundary.time - orbit_.passage) + orbit_.vertical_phase;
    // the satellite's epicycle, relative to its guiding centre
    const Vec3 epicycle_of_satellite(-orbit_.eccentricity * std::cos(turned),
                                     2.0 / f.kappa * orbit_.eccentricity * std::sin(turned),
                                     orbit_.inclination * std::sin(raised));
    parallel_for(accelerations.size(), [&](std::size_t k) {
      boundary.particles.prefetch_after(k);
      const Elements& el = boundary.particles.bodies[k].elements;
      const Vec3 swing = epicycle(el, f, rotation);
      const double d = orbit_.guiding_x - el.guiding_x;
      const double since = boundary.time - passage_time(el.guiding_x, boundary.time, f);
      const Vec3 away = Vec3(d, -f.shear() * d * since, 0.0) + epicycle_of_satellite - swing;
      const double square = away.squaredNorm();
      accelerations[k] = orbit_.pull / (square * std::sqrt(square)) * away;
    });
  }

private:
  // Returns a particle's position relative to its guiding centre.
  static Vec3 epicycle(const Elements& el, const Frequencies& f, const Rotation& r) {
    return {-(el.e_cos * r.cos_e - el.e_sin * r.sin_e), 2.0 / f.kappa * (el.e_sin * r.cos_e + el.e_cos * r.sin_e),
            el.i_sin * r.cos_i + el.i_cos * r.sin_i};
  }

  // Returns the time of the nearest passage of a streamline.
  double nearest_passage(double x, double time) const {
    const double d = orbit_.guiding_x - x, first = (orbit_.guiding_x * orbit_.passage - x * orbit_.upright) / d;
    const double period = orbit_.every * orbit_.guiding_x / d;
    return period > 0.0 ? first + period * std::round((time - first) / period) : first;
  }

  // Returns this time for a particle, by its X before the passage.
  double passage_time(double x, double time, const Frequencies& f) const {
    const double d = orbit_.guiding_x - x, at = f.shear() * (time - nearest_passage(x, time));
    const double gained = 2.0 * orbit_.pull / (f.kappa * f.kappa * f.shear() * d * std::fabs(d) * std::hypot(1.0, at));
    return nearest_passage(x - gained, time);
  }

  SatelliteOrbit orbit_;
};

// Returns G m in internal units.
double pull_of(const Parameters& p, double orbital_frequency) {
  return newton_g(orbital_frequency) * p.number("mass");
}

void require_outside(const Parameters& p, double size_x) {
  const double distance = p.number("distance"), eccentricity = p.number("eccentricity");
  if (!(std::fabs(distance) - eccentricity > 0.5 * size_x))
    throw UsageError(
        fmt::format("satellite.distance = {} m with its eccentricity of {} m is inside the box (it reaches "
                    "{} m from its middle); move it out, or make it a [[moonlet]]",
                    format_number(distance, 4), format_number(eccentricity, 4), format_number(0.5 * size_x, 4)));
}

// An encounter at d moves a particle by about 2.24 G m/(Ω² d²): at two Hill radii by as much as its distance.
void require_weak(const Parameters& p, const ForceContext& context) {
  const double hill_radius = std::cbrt(pull_of(p, context.orbital_frequency) / 3.0);
  const double apart = std::fabs(p.number("distance")) - p.number("eccentricity") - 0.5 * context.box.size_x;
  if (!(apart >= 2.0 * hill_radius))
    throw UsageError(
        fmt::format("satellite.mass = {} kg is too large (its Hill radius is {} m, and it comes within {} m of "
                    "the box; closer than two Hill radii it throws particles out of the ring); lower it, or "
                    "move the satellite out",
                    format_number(p.number("mass"), 4), format_number(hill_radius, 4), format_number(apart, 4)));
}

// Checks a run from its beginning; a continued run may have passed the last passage.
void require_passages(const Parameters& p) {
  constexpr double shortest = 0.1; // orbits; a / (S |d|) is above 1 / (3 π), for a is above |d|
  const double every = p.number("every"), passage = p.number("passage");
  if (every > 0.0 && every < shortest)
    throw UsageError(
        fmt::format("satellite.every = {} orbits is too short (no satellite returns before {}); raise it, or "
                    "give 0 for a single passage",
                    format_number(every, 4), shortest));
  if (every == 0.0 && passage < 0.0)
    throw UsageError(
        fmt::format("satellite.passage = {} orbits is before the run begins, and every = 0 allows only one passage "
                    "(the run would not see it); give a passage from 0 up, or every",
                    format_number(passage, 4)));
}

void check(const Parameters& p, double size_x) {
  require_outside(p, size_x);
  require_passages(p);
}

std::unique_ptr<Force> make(const Parameters& p, const ForceContext& context) {
  require_outside(p, context.box.size_x);
  require_weak(p, context);
  const double degree = pi / 180.0;
  SatelliteOrbit orbit;
  orbit.pull = pull_of(p, context.orbital_frequency);
  orbit.guiding_x = p.number("distance");
  orbit.passage = two_pi * p.number("passage");
  orbit.every = two_pi * p.number("every");
  orbit.upright = orbit.passage + two_pi * p.number("downstream_time");
  orbit.eccentricity = p.number("eccentricity");
  orbit.phase = degree * p.number("eccentricity_phase");
  orbit.inclination = p.number("inclination");
  orbit.vertical_phase = degree * p.number("inclination_phase");
  return std::make_unique<Satellite>(orbit);
}

Key number(const char* name, const char* fallback, const char* unit, const char* meaning, const KeyRange& range = {}) {
  return {
      .path = name, .type = KeyType::number, .fallback = fallback, .unit = unit, .meaning = meaning, .range = range};
}

Key needed(Key key) {
  key.example = key.fallback;
  key.fallback.clear();
  return key;
}

Key formerly(const char* name, Key key) {
  key.former_name = name;
  return key;
}

} // namespace

std::optional<SatellitePassage> dragging_passage(const Parameters& parameters, double orbital_frequency,
                                                 const Frequencies& frequencies, double min_drag, double from,
                                                 double until) {
  assert(parameters.number("distance") != 0.0);
  const double first = parameters.number("passage"), every = parameters.number("every");
  const double upright = first + parameters.number("downstream_time");
  const double h =
      newton_g(orbital_frequency) * parameters.number("mass") / std::pow(std::fabs(parameters.number("distance")), 3);
  const double drag_per_orbit = 4.0 / (3.0 * std::sqrt(3.0)) * h * two_pi / (frequencies.kappa * frequencies.kappa);
  const double apart = min_drag / drag_per_orbit; // orbits from upright
  const auto not_before = [&](double time) {      // returns the first passage from then on
    return every > 0.0 ? first + every * std::ceil((time - first) / every) : first;
  };
  for (const double passage : {not_before(from), not_before(std::max(from, upright + apart))})
    if (passage >= from && passage <= until && std::fabs(passage - upright) >= apart)
      return SatellitePassage{passage, drag_per_orbit * std::fabs(passage - upright)};
  return std::nullopt;
}

ForceEntry satellite_entry() {
  const KeyRange turn = {.low = -360, .high = 360}, lengths = {.low = 0, .high = 1e7};
  return {
      "satellite",
      {needed(number("mass", "1.6e17", "kg", "mass of a satellite that passes outside the box",
                     {.low = 0, .high = 1e24, .low_open = true})),
       needed(number("distance", "1e6", "m", "distance of its guiding centre from the middle of the box, outward",
                     {.low = -1e7, .high = 1e7})),
       needed(number("passage", "2.0", "orbits", "time at which it passes the middle of the box",
                     {.low = -1e6, .high = 1e6})),
       number("every", "0.0", "orbits",
              "its synodic period, a / (S |distance|), from passage to passage; 0: a single passage",
              {.low = 0, .high = 1e6}),
       formerly(
           "upright_after",
           number("downstream_time", "0.0", "orbits",
                  "time after the passage at which neighbouring streamlines have the phases that they have side by "
                  "side in a ring",
                  {.low = -1e6, .high = 1e6})),
       number("eccentricity", "0.0", "m", "its eccentricity times its distance from the planet", lengths),
       number("eccentricity_phase", "0.0", "degrees", "phase of its epicycle at the passage; 0: at its innermost point",
              turn),
       number("inclination", "0.0", "m", "its inclination times its distance from the planet", lengths),
       number("inclination_phase", "0.0", "degrees", "phase of its vertical motion at the passage; 0: rising", turn)},
      make,
      check};
}

} // namespace keeler::forces
