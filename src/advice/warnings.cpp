#include <keeler/advice/warnings.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>

namespace keeler::advice {
namespace {

using Lines = std::vector<std::string>;

// The standard error of c_x of N independent particles is c_x / √(2N).
void warn_of_few_particles(std::size_t count, Lines& lines) {
  constexpr std::size_t few = 900, enough = 1000;
  if (count < few)
    lines.push_back(
        fmt::format("{} {} few: one measurement of the velocity dispersion scatters by {} % (1 / sqrt(2 N)), "
                    "and structures cannot be resolved; with {} particles it scatters by {} %",
                    pluralize(count, "particle"), count == 1 ? "is" : "are",
                    format_number(100.0 / std::sqrt(2.0 * static_cast<double>(count)), 2), enough,
                    format_number(100.0 / std::sqrt(2.0 * enough), 2)));
}

// Dispersion and viscosity in wakes were measured in boxes of 4 × 4 and 8 × 8 λ_cr (docs/dev/diagnostics.md). The
// viscosity goes with the length along the orbit, whatever the width (docs/trade-offs/box-and-sizes.md).
void warn_of_narrow_wakes(const scene::PatchScale& patch, Lines& lines) {
  constexpr double min_spans = 4.0, enough = 8.0; // λ_cr
  constexpr double rounding = 0.99;
  const double spans = std::min(patch.size_x, patch.size_y) / patch.lambda_cr, length = patch.size_y / patch.lambda_cr;
  if (spans < rounding * min_spans)
    lines.push_back(
        fmt::format("the box spans {} lambda_cr: below {:g} its size changes self-gravity wakes, and it holds too "
                    "few of them to measure pitch and spacing",
                    format_number(spans, 2), min_spans));
  else if (length < rounding * enough)
    lines.push_back(
        fmt::format("the box is {} lambda_cr long along the orbit: the viscosity of wakes goes with this length, "
                    "whatever the width: at {:g} it is some 15 % lower than at {:g}; a box of {:g} x {:g} will do",
                    format_number(length, 2), min_spans, enough, min_spans, enough));
}

void warn_of_long_step(const Scene& scene, Lines& lines) {
  const double oscillations = scene.oscillations_per_step();
  if (!(oscillations > scene::TimeSettings::few_oscillations))
    return;
  lines.push_back(
      fmt::format("a step of {} orbits is {} oscillations of a particle: above {:g} the searches for "
                  "contacts take several times longer; use steps of at most {} orbits",
                  format_number(scene.time.step), format_number(oscillations, 3), scene::TimeSettings::few_oscillations,
                  format_number(scene::TimeSettings::few_oscillations * scene.time.step / oscillations, 3)));
}

// `density`: of the particles; 0 if a start file holds it.
void warn_of_rare_kicks(const Scene& scene, double density, Lines& lines) {
  assert(scene.gravity);
  constexpr double resolved = 0.02; // orbits
  const double apart = scene.time.step * static_cast<double>(scene.kick_interval());
  if (apart > resolved)
    lines.push_back(fmt::format("kicks are {} orbits apart: above {:g} self-gravity is poorly resolved in time",
                                format_number(apart, 3), resolved));
  if (!scene.gravity->by_pairs() || !(density > 0.0))
    return;
  // Contacts at rest carry kicks that move a surface by up to an eighth of a radius sum. At the surface of a pile of
  // 300 spheres gravity is 11 times that of a pair, which is G ρ π/3 times the radius sum.
  constexpr double max_move = 0.125, surface = 11.0;
  const double interval = two_pi * apart;
  const double pull = newton_g(scene.planet.orbital_frequency) * density * pi / 3.0;
  const double longest = std::sqrt(max_move / (surface * pull)) / two_pi;
  const double r_h = scene::hill_parameter(density, distance_from_saturn(scene.planet));
  if (r_h > 1.1 && surface * pull * interval * interval > max_move)
    lines.push_back(
        fmt::format("kicks are {} orbits apart: aggregates form at r_h {}, cannot rest between kicks that far "
                    "apart, and would heat and lose energy without limit; use intervals of at most {} orbits",
                    format_number(apart, 3), format_number(r_h, 2), format_number(longest, 2)));
}

// Returns the impact speed at which the coefficient of restitution is critical. Precondition: it decreases with speed,
// and is below critical at `fast`.
double equilibrium_speed(const Scene& scene, double radius, double critical, double fast) {
  assert(scene.collisions.restitution({fast, radius, radius}) < critical);
  double slow = 1e-9;
  for (int k = 0; k < 60; ++k) {
    const double between = std::sqrt(slow * fast);
    (scene.collisions.restitution({between, radius, radius}) >= critical ? slow : fast) = between;
  }
  return fast;
}

// A law that decreases with speed has an equilibrium at some speed, which sets the height of the layer.
// The critical value is that of smooth spheres; friction loses additional energy.
void warn_of_no_equilibrium(const Scene& scene, const scene::PatchScale& patch, Lines& lines) {
  constexpr double fast = 100.0;      // m/s: far above any speed in a ring
  constexpr double max_aspect = 10.0; // height of the layer over the width of the box
  if (scene.collisions.friction || patch.particle_count < 2)
    return;
  // The scene's own optical depth excludes moonlets. A stored scene has no law of sizes.
  const bool fresh = !scene.start_from && scene.particles.sizes.mean_power;
  const double depth = fresh ? scene.optical_depth() : patch.optical_depth;
  const double radius = fresh ? scene.particles.sizes.largest : patch.largest.radius;
  const double kept = scene.collisions.restitution({fast, radius, radius}), critical = critical_restitution(depth);
  if (kept >= critical) {
    lines.push_back(fmt::format(
        "the coefficient of restitution is {} even in fast impacts: above {} at an optical depth of {} collisions "
        "lose "
        "less energy than the shear supplies, so that there is no equilibrium and the velocity dispersion grows "
        "without "
        "limit (critical value of Goldreich & Tremaine 1978, (1 - eps^2)(1 + tau^2) = 0.61, accurate to 0.03)",
        format_number(kept, 3), format_number(critical, 3), format_number(depth, 3)));
    return;
  }
  const double speed = equilibrium_speed(scene, radius, critical, fast);
  const double height = speed / (2.0 * scene.planet.orbital_frequency), side = std::min(patch.size_x, patch.size_y);
  if (2.0 * height > max_aspect * side)
    lines.push_back(fmt::format(
        "particles heat until they collide at about {} m/s, where the coefficient of restitution is {}; the layer then "
        "reaches about {} m from its mid-plane, and a box of {} m is far too narrow for it; check the sizes (in m)",
        format_number(speed, 2), format_number(critical, 2), format_number(height, 2), format_number(side, 3)));
}

// Self-gravity of a sheet has no meaning below some tens of particle radii.
void warn_of_short_waves(const GravitySettings& gravity, const scene::PatchScale& patch, Lines& lines) {
  constexpr double min_radii = 10.0;
  if (gravity.solver == GravitySettings::Solver::axisymmetric &&
      gravity.shortest_wavelength < min_radii * patch.grain.radius)
    lines.push_back(
        fmt::format("gravity.shortest_wavelength is {} m: waves shorter than some tens of particle radii (here "
                    "{} m) resolve single particles, spread along the orbit, at a high cost; raise it",
                    format_number(gravity.shortest_wavelength, 3), format_number(patch.grain.radius, 2)));
}

void warn_of_narrow_box(const scene::PatchScale& patch, Lines& lines) {
  constexpr double enough = 10.0; // diameters
  const double side = std::min(patch.size_x, patch.size_y), spans = side / (2.0 * patch.largest.radius);
  if (patch.largest.radius > 0.0 && spans < enough)
    lines.push_back(fmt::format(
        "the box spans {} diameters of its largest body: below {:g} this body interacts with its own images, and "
        "no structure longer than the box can form; widen it, or compare with a wider one",
        format_number(spans, 2), enough));
}

const scene::ForceSettings* satellite_of(const Scene& scene) {
  for (const scene::ForceSettings& force : scene.external_forces)
    if (std::string_view(force.entry->table) == "satellite")
      return &force;
  return nullptr;
}

// Returns the first passage in the interval that drags by at least `min_drag`.
std::optional<forces::SatellitePassage> passage_between(const Scene& scene, const scene::ForceSettings& satellite,
                                                        double min_drag, double from, double until) {
  return forces::dragging_passage(satellite.parameters, scene.planet.orbital_frequency, scene.planet.frequencies,
                                  min_drag, from, until);
}

void warn_of_satellite(const Scene& scene, Lines& lines) {
  const scene::ForceSettings* const satellite = satellite_of(scene);
  if (!satellite)
    return;
  const double end = static_cast<double>(scene.time.end_step) * scene.time.step;
  if (const std::optional<forces::SatellitePassage> passage = unresolved_passage(scene, 0.0, end))
    lines.push_back(in_words(*passage));
  const std::optional<forces::SatellitePassage> first = passage_between(scene, *satellite, 0.0, 0.0, HUGE_VAL);
  if (first && first->orbits > end)
    lines.push_back(fmt::format("the satellite first passes at orbit {}, after the end of the run at orbit {}; lower "
                                "satellite.passage, or raise time.end",
                                format_number(first->orbits, 4), format_number(end, 4)));
}

} // namespace

double critical_restitution(double optical_depth) {
  assert(optical_depth >= 0.0);
  return std::sqrt(1.0 - 0.61 / (1.0 + optical_depth * optical_depth));
}

std::optional<forces::SatellitePassage> unresolved_passage(const Scene& scene, double from, double until) {
  const scene::ForceSettings* const satellite = satellite_of(scene);
  return satellite ? passage_between(scene, *satellite, forces::doubtful_drag, from, until) : std::nullopt;
}

std::string in_words(const forces::SatellitePassage& passage) {
  return fmt::format(
      "the satellite's passage at orbit {} moves particles at {} of the speed at which it crosses the cell, and "
      "drags them along: up to {:g} the cell behaves as a ring, at 1 particles are thrown across it; end the run "
      "before this passage, or run each passage separately (--from the last snapshot, with downstream_time counted "
      "from "
      "that passage)",
      format_number(passage.orbits, 4), format_number(passage.drag, 2), forces::doubtful_drag);
}

std::vector<std::string> warnings(const Scene& scene, const scene::PatchScale& patch) {
  Lines lines = warnings(patch.start);
  warn_of_few_particles(patch.particle_count, lines);
  const double density = scene.start_from ? patch.density : scene.particles.density;
  if (density > 0.0 && density < 50.0)
    lines.push_back("the density of the particles is below 50 kg/m^3: is it in kg/m^3? (water ice has 917)");
  warn_of_narrow_box(patch, lines);
  warn_of_no_equilibrium(scene, patch, lines);
  if (scene.gravity && scene.gravity->by_pairs())
    warn_of_narrow_wakes(patch, lines);
  warn_of_long_step(scene, lines);
  if (scene.gravity) {
    warn_of_rare_kicks(scene, density, lines);
    warn_of_short_waves(*scene.gravity, patch, lines);
  }
  warn_of_satellite(scene, lines);
  return lines;
}

std::vector<std::string> warnings(const Scene& scene) {
  if (!scene.start_from)
    return warnings(scene, scale_of(scene));
  Lines lines;
  warn_of_long_step(scene, lines);
  if (scene.gravity)
    warn_of_rare_kicks(scene, 0.0, lines);
  warn_of_satellite(scene, lines);
  return lines;
}

} // namespace keeler::advice
