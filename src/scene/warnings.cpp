#include <keeler/scene/warnings.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/derived.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace keeler {
namespace {

using Lines = std::vector<std::string>;

// c_x of N particles at random has the standard error c_x / √(2N).
void doubt_number(std::size_t count, Lines& lines) {
  constexpr std::size_t few = 900, enough = 1000;
  if (count < few)
    lines.push_back(
        fmt::format("{} {} few: one measurement of their velocity dispersion scatters by {} % (1 / sqrt(2 N)), "
                    "and structures cannot be seen; {} make that {} %",
                    pluralize(count, "particle"), count == 1 ? "is" : "are",
                    format_number(100.0 / std::sqrt(2.0 * static_cast<double>(count)), 2), enough,
                    format_number(100.0 / std::sqrt(2.0 * enough), 2)));
}

// Dispersion and viscosity in wakes were measured in boxes of 4 × 4 and 8 × 8 λ_cr (docs/dev/diagnostics.md).
void doubt_room_for_wakes(const PatchScale& patch, Lines& lines) {
  constexpr double edges_felt = 4.0, enough = 8.0; // λ_cr
  constexpr double rounding = 0.99;
  const double spans = std::min(patch.size_x, patch.size_y) / patch.lambda_cr;
  if (spans < rounding * edges_felt)
    lines.push_back(
        fmt::format("the box spans {} lambda_cr: below {:g} self-gravity wakes feel its edges, and it holds so "
                    "few that their pitch and spacing mean little",
                    format_number(spans, 2), edges_felt));
  else if (spans < rounding * enough)
    lines.push_back(
        fmt::format("the box spans {} lambda_cr: in wakes, 4 x 4 show 12 % less velocity dispersion and 18 % "
                    "less viscosity than {:g} x {:g}",
                    format_number(spans, 2), enough, enough));
}

void doubt_step(const Scene& scene, Lines& lines) {
  const double held = oscillations_a_step(scene);
  if (!(held > few_oscillations))
    return;
  lines.push_back(fmt::format("a step of {} orbits holds {} of a particle's oscillations: beyond {:g} searches for "
                              "contacts take several times as long; {} orbits hold so many",
                              format_number(scene.time.step), format_number(held, 3), few_oscillations,
                              format_number(few_oscillations * scene.time.step / held, 3)));
}

// `density`: of the particles, 0 where only a start file knows it.
void doubt_kicks(const Scene& scene, double density, Lines& lines) {
  constexpr double resolved = 0.02; // orbits
  const double apart = scene.time.step * static_cast<double>(scene.kick_interval());
  if (apart > resolved)
    lines.push_back(fmt::format("kicks are {} orbits apart: beyond {:g} self-gravity is hardly resolved in time",
                                format_number(apart, 3), resolved));
  if (!scene.gravity->by_pairs() || !(density > 0.0))
    return;
  // Contacts at rest carry kicks that move a surface by up to an eighth of a radius sum. At the surface of a pile of
  // 300 spheres gravity is eleven times that of a pair, which is G ρ π/3 times the radius sum.
  constexpr double most = 0.125, surface = 11.0;
  const double interval = two_pi * apart;
  const double pull = newton_g(scene.planet.orbital_frequency) * density * pi / 3.0;
  const double longest = std::sqrt(most / (surface * pull)) / two_pi;
  const double r_h = hill_parameter(density, distance_from_saturn(scene.planet));
  if (r_h > 1.1 && surface * pull * interval * interval > most)
    lines.push_back(
        fmt::format("kicks are {} orbits apart: aggregates last at r_h {} and cannot rest between kicks that far "
                    "apart, so they heat and lose energy without end; let them be {} at most",
                    format_number(apart, 3), format_number(r_h, 2), format_number(longest, 2)));
}

// The speed of impacts at which a coefficient that falls with it is the critical one.
double equilibrium_speed(const Scene& scene, double radius, double critical, double fast) {
  double slow = 1e-9;
  for (int k = 0; k < 60; ++k) {
    const double between = std::sqrt(slow * fast);
    (scene.collisions.restitution({between, radius, radius}) >= critical ? slow : fast) = between;
  }
  return fast;
}

// Laws whose coefficient falls with the speed find an equilibrium at some speed, and the layer is as high as it takes.
// Friction loses energy besides, and the critical value is one of smooth spheres.
void doubt_equilibrium(const Scene& scene, const PatchScale& patch, Lines& lines) {
  constexpr double fast = 100.0;        // m/s: far above any speed in a ring
  constexpr double most_upright = 10.0; // times as high as the box is wide
  if (scene.collisions.friction || patch.particle_count < 2)
    return;
  // A scene of particles that it makes leaves moonlets out; a stored one does not know the law of its sizes.
  const bool fresh = !scene.start_from && scene.particles.sizes.mean_power;
  const double depth = fresh ? scene.optical_depth() : patch.optical_depth;
  const double radius = fresh ? scene.particles.sizes.largest : patch.largest.radius;
  const double kept = scene.collisions.restitution({fast, radius, radius}), critical = critical_restitution(depth);
  if (kept >= critical) {
    lines.push_back(fmt::format(
        "the coefficient of restitution is {} however fast particles collide: above {} at an optical depth of {} "
        "collisions lose less than the shear gives, there is no equilibrium, and the velocity dispersion grows without "
        "end (critical value of Goldreich & Tremaine 1978, (1 - eps^2)(1 + tau^2) = 0.61, right to 0.03)",
        format_number(kept, 3), format_number(critical, 3), format_number(depth, 3)));
    return;
  }
  const double speed = equilibrium_speed(scene, radius, critical, fast);
  const double height = speed / (2.0 * scene.planet.orbital_frequency), side = std::min(patch.size_x, patch.size_y);
  if (2.0 * height > most_upright * side)
    lines.push_back(fmt::format(
        "particles heat until they collide at some {} m/s, where the coefficient of restitution is {}, and the layer "
        "then "
        "reaches some {} m from its mid-plane: a box of {} m is far too narrow for it; give other sizes, lengths are "
        "in m",
        format_number(speed, 2), format_number(critical, 2), format_number(height, 2), format_number(side, 3)));
}

// Waves of a sheet: what is shorter than some tens of particle radii belongs to the particles themselves.
void doubt_waves(const GravitySettings& gravity, const PatchScale& patch, Lines& lines) {
  constexpr double short_of = 10.0; // radii
  if (gravity.solver == GravitySettings::Solver::axisymmetric &&
      gravity.shortest_wavelength < short_of * patch.grain.radius)
    lines.push_back(
        fmt::format("gravity.shortest_wavelength is {} m: the pull of waves shorter than some tens of particle "
                    "radii (here {} m) is that of single particles spread along a line, and costs much; raise it",
                    format_number(gravity.shortest_wavelength, 3), format_number(patch.grain.radius, 2)));
}

void doubt_room(const PatchScale& patch, Lines& lines) {
  constexpr double enough = 10.0; // diameters
  const double side = std::min(patch.size_x, patch.size_y), spans = side / (2.0 * patch.largest.radius);
  if (patch.largest.radius > 0.0 && spans < enough)
    lines.push_back(fmt::format(
        "the box spans {} diameters of its largest body: below {:g} this body, its neighbours and "
        "their images act on each other, and nothing longer than the box can form; widen it, or compare with "
        "a wider one",
        format_number(spans, 2), enough));
}

const ForceSettings* satellite_of(const Scene& scene) {
  for (const ForceSettings& force : scene.external_forces)
    if (std::string_view(force.entry->table) == "satellite")
      return &force;
  return nullptr;
}

// Passages that drag by at least so much.
std::optional<SatellitePassage> passage_between(const Scene& scene, const ForceSettings& satellite, double min_drag,
                                                double from, double until) {
  return dragging_passage(satellite.parameters, scene.planet.orbital_frequency, scene.planet.frequencies, min_drag,
                          from, until);
}

void doubt_satellite(const Scene& scene, Lines& lines) {
  const ForceSettings* const satellite = satellite_of(scene);
  if (!satellite)
    return;
  const double end = static_cast<double>(scene.time.end_step) * scene.time.step;
  if (const std::optional<SatellitePassage> passage = doubtful_passage(scene, 0.0, end))
    lines.push_back(in_words(*passage));
  const std::optional<SatellitePassage> first = passage_between(scene, *satellite, 0.0, 0.0, HUGE_VAL);
  if (first && first->orbits > end)
    lines.push_back(fmt::format("the satellite first passes at orbit {}, and the run ends at orbit {} without it; let "
                                "it pass earlier (satellite.passage), or the run end later (time.end)",
                                format_number(first->orbits, 4), format_number(end, 4)));
}

// Of a fresh patch, before there is one.
StartScale start_of(const Scene& scene) {
  const ParticleSettings& particles = scene.particles;
  const double largest = particles.sizes.largest;
  StartScale start;
  start.particle_count = particles.count;
  start.optical_depth = scene.optical_depth();
  start.mean_radius = particles.sizes.mean_power(1);
  start.usual_dispersion =
      usual_dispersion(largest, 4.0 / 3.0 * pi * particles.density * std::pow(largest, 3), scene.surface_density(),
                       newton_g(scene.planet.orbital_frequency), scene.planet.frequencies.kappa);
  start.dispersion = particles.velocity_dispersion * start.mean_radius;
  start.orbital_frequency = scene.planet.orbital_frequency;
  start.shear = scene.planet.frequencies.shear();
  return start;
}

} // namespace

double critical_restitution(double optical_depth) {
  return std::sqrt(1.0 - 0.61 / (1.0 + optical_depth * optical_depth));
}

std::optional<SatellitePassage> doubtful_passage(const Scene& scene, double from, double until) {
  const ForceSettings* const satellite = satellite_of(scene);
  return satellite ? passage_between(scene, *satellite, doubtful_drag, from, until) : std::nullopt;
}

std::string in_words(const SatellitePassage& passage) {
  return fmt::format(
      "the satellite's passage at orbit {} moves particles at {} of the speed at which it sweeps over the "
      "cell, and drags them along: up to {:g} the cell shows what a ring does, at 1 particles are thrown "
      "across it; end the run before this passage, or give each passage a run of its own (--from the "
      "last snapshot, with upright_after from that passage)",
      format_number(passage.orbits, 4), format_number(passage.drag, 2), doubtful_drag);
}

double oscillations_a_step(const Scene& scene) {
  const Frequencies& frequencies = scene.planet.frequencies;
  return scene.time.automatic ? 0.0 : scene.time.step * std::max(frequencies.kappa, frequencies.nu);
}

std::vector<std::string> warnings(const Scene& scene, const PatchScale& patch) {
  Lines lines = warnings(patch.start);
  doubt_number(patch.particle_count, lines);
  const double density = scene.start_from ? patch.density : scene.particles.density;
  if (density > 0.0 && density < 50.0)
    lines.push_back("the density is in kg/m^3: water ice has 917");
  doubt_room(patch, lines);
  doubt_equilibrium(scene, patch, lines);
  if (scene.gravity && scene.gravity->by_pairs())
    doubt_room_for_wakes(patch, lines);
  doubt_step(scene, lines);
  if (scene.gravity) {
    doubt_kicks(scene, density, lines);
    doubt_waves(*scene.gravity, patch, lines);
  }
  doubt_satellite(scene, lines);
  return lines;
}

// A body that holds much of the mass by itself is not counted with the grains, as in crowd_of().
PatchScale scale_of(const BodySums& sums, std::size_t particle_count, double size_x, double size_y, double lambda_cr) {
  PatchScale scale;
  scale.particle_count = particle_count;
  scale.size_x = size_x;
  scale.size_y = size_y;
  scale.lambda_cr = lambda_cr;
  scale.mass = sums.mass;
  scale.density = sums.mass / (4.0 / 3.0 * pi * sums.cubes);
  scale.optical_depth = pi * sums.squares / (size_x * size_y);
  scale.largest = sums.largest;
  const double radius = (sums.cubes - sums.sixths / sums.cubes) / sums.squares;
  scale.grain = {radius, 4.0 / 3.0 * pi * scale.density * std::pow(radius, 3)};
  return scale;
}

PatchScale scale_of(const Scene& scene) {
  const ParticleSettings& particles = scene.particles;
  const SizeLaw& sizes = particles.sizes;
  const auto count = static_cast<double>(particles.count);
  const auto mass_of = [&](double cubes) { return 4.0 / 3.0 * pi * particles.density * cubes; };
  BodySums sums;
  sums.squares = count * sizes.mean_power(2);
  sums.cubes = count * sizes.mean_power(3);
  sums.sixths = count * sizes.mean_power(6);
  sums.mass = mass_of(sums.cubes);
  sums.largest = {sizes.largest, mass_of(std::pow(sizes.largest, 3))};
  for (const MoonletSettings& moonlet : scene.moonlets) {
    sums.squares += std::pow(moonlet.radius, 2);
    sums.cubes += std::pow(moonlet.radius, 3);
    sums.sixths += std::pow(moonlet.radius, 6);
    sums.mass += moonlet.mass;
    if (moonlet.radius > sums.largest.radius)
      sums.largest = {moonlet.radius, moonlet.mass};
  }
  PatchScale scale = scale_of(sums, particles.count, scene.size_x, scene.size_y,
                              critical_wavelength(scene.surface_density(), scene.planet));
  scale.start = start_of(scene);
  return scale;
}

std::vector<std::string> warnings(const Scene& scene) {
  if (!scene.start_from)
    return warnings(scene, scale_of(scene));
  Lines lines;
  doubt_step(scene, lines);
  if (scene.gravity)
    doubt_kicks(scene, 0.0, lines);
  doubt_satellite(scene, lines);
  return lines;
}

} // namespace keeler
