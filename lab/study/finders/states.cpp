#include "states.hpp"

#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/planet.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

constexpr double early_orbits = 0.25;  // erases the features of the initial state; too short for clumps
constexpr double clumped_orbits = 3.0; // in a box below four λ_cr, with too few wakes to settle soon

struct Recipe {
  const char* name;
  particles::SizeLaw sizes;
  const char* table; // `sizes` as in a scene file
  double optical_depth;
  double dispersion; // initial c_x, ⟨r⟩ Ω
};

// λ_cr is 61–62 m with both: a box of 10⁴ equal particles, or of 5000 with the power law, is at least 4 λ_cr wide.
const Recipe recipes[] = {{"equal", particles::equal_sizes(1.0), "{ law = \"equal\", radius = 1.0 }", 0.5, 3.5},
                          {"power", particles::power_sizes(2.9, 0.5, 5.0),
                           "{ law = \"power\", exponent = 2.9, min = 0.5, max = 5.0 }", 0.25, 3.7}};

Scene scene_of(const Recipe& r, std::size_t count) {
  const double size = std::sqrt(static_cast<double>(count) * pi * r.sizes.mean_power(2) / r.optical_depth);
  return parse_scene(fmt::format(R"(
title = "The finders' study, {0} sizes"
[planet]
preset = "saturn-a-ring"
[box]
size = [{1}, {1}]
[particles]
count = {2}
density = 600.0
sizes = {3}
velocity_dispersion = {4}
[collisions]
restitution = {{ law = "bridges", scale = 0.34 }}
[gravity]
solver = "tree"
opening_angle = 0.6
[time]
step = 1e-3
end = 1.0
)",
                                 r.name, size, count, r.table, r.dispersion),
                     "study");
}

struct Made {
  Patch patch;
  std::string how; // one sentence for the report
};

Made evolve(const Scene& scene, double orbits) {
  Simulation simulation(scene, initial_patch(scene));
  const long steps = std::lround(orbits / scene.time.step);
  for (long k = 0; k < steps; ++k)
    simulation.advance();
  const simulation::TimeSplit& split = simulation.time_split();
  const double passes = 1e-9 * static_cast<double>(steps * static_cast<long>(scene.particles.count));
  return Made{simulation.patch(),
              fmt::format("{} particles, {} orbits with self-gravity from a uniform start (wall time per particle and "
                          "step: gravity {:.0f} ns, drift {:.0f} ns)",
                          scene.particles.count, orbits, split.force("gravity") / passes, split.drift / passes)};
}

Made settle(const Scene& scene, const std::function<void(const std::string&)>& say) {
  double next = 0.0;
  const auto progress = [&](const initial_conditions::ClumpingProgress& p) {
    if (p.orbits < next)
      return;
    say(fmt::format("clumping: {:.2f} orbits, contrast {:.3f}", p.orbits, p.contrast));
    next = p.orbits + 0.5;
  };
  const initial_conditions::ClumpedState state = initial_conditions::clumped_state(scene, {}, progress);
  const initial_conditions::Settling& s = state.clumping.settling;
  return Made{state.patch,
              fmt::format("{} particles, {:.3g} orbits with self-gravity, until the viscosity from the loss of energy "
                          "and the wake lengths settled (over {} orbits they change by {:.0f}, {:.0f} and {:.0f} %)",
                          scene.particles.count, state.clumping.orbits, s.window_orbits, 100.0 * s.viscosity.change(),
                          100.0 * s.wavelength.change(), 100.0 * s.radial_wavelength.change())};
}

Made make(const Scene& scene, bool clumped, const std::function<void(const std::string&)>& say) {
  const double wavelength = critical_wavelength(scene.surface_density(), scene.planet);
  if (clumped && scene.size_x >= 4.0 * wavelength)
    return settle(scene, say);
  return evolve(scene, clumped ? clumped_orbits : early_orbits);
}

} // namespace

Scene StudyState::timed(double step_orbits, const std::string& finder) const {
  assert(step_orbits > 0.0 && !finder.empty());
  Scene timed_scene = scene;
  timed_scene.gravity.reset();
  timed_scene.time.step = step_orbits;
  timed_scene.collisions.finder = finder;
  return timed_scene;
}

std::vector<StudyState> study_states(const std::filesystem::path& folder, std::size_t count,
                                     const std::function<void(const std::string&)>& say) {
  std::filesystem::create_directories(folder);
  std::vector<StudyState> states;
  for (const Recipe& recipe : recipes)
    for (const bool clumped : {false, true}) {
      StudyState state;
      state.name = fmt::format("{}-{}", recipe.name, clumped ? "clumped" : "early");
      state.scene = scene_of(recipe, recipe.sizes.smallest == recipe.sizes.largest ? count : count / 2);
      const std::filesystem::path file = folder / (state.name + ".hdf"), note = folder / (state.name + ".txt");
      if (!std::filesystem::exists(note) || !std::filesystem::exists(file)) {
        say(fmt::format("making the state {}", state.name));
        const Made made = make(state.scene, clumped, say);
        io::write_snapshot(file, made.patch, {state.scene.resolved, io::collect_provenance({}), {}});
        files::write_text(note, made.how); // written last: it marks the state as complete
      }
      state.patch = io::read_snapshot(file).patch;
      state.made = files::read_text(note);
      states.push_back(std::move(state));
    }
  return states;
}

} // namespace keeler::study
