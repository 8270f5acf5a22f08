// A checked scene: what a user asked for, in SI and orbits as in the file, with everything derived that the file leaves
// open. Every Scene is valid: load_scene() (scene/load.hpp) refuses all others.
#pragma once

#include <keeler/collision/settings.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/forces/force.hpp>
#include <keeler/gravity/solver.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/particles/start.hpp>
#include <keeler/scene/planet.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace keeler::scene {

struct LayerSizes;

/// A non-uniform surface density, with a step in x and a wave that may be inclined to the orbit like self-gravity
/// wakes. Density of the guiding centres of a fresh patch at zero shear offset: the product of the step and of the
/// wave.
struct DensityPattern {
  double size_x = 1.0; ///< of the box, m
  double size_y = 1.0; ///< of the box, m

  double low = 0.0;    ///< m: for low ≤ x < high the density is `factor` times that outside
  double high = 0.0;   ///< m
  double factor = 1.0; ///< of the step; 1: no step

  double contrast = 0.0; ///< A of 1 + A cos(k·r)
  int waves_x = 0;       ///< number of waves in the box: k = 2π (waves_x / L_x, waves_y / L_y)
  int waves_y = 0;       ///< likewise, along the orbit

  bool uniform() const { return factor == 1.0 && contrast == 0.0; } ///< neither a step nor a wave

  /// Returns Σ/⟨Σ⟩ at a position; its mean over the box is 1.
  double relative(double x, double y) const;

  /// Returns the maximum of relative().
  double peak() const;

  /// Returns 2π/|k| of the wave, m. Precondition: there is a wave.
  double wavelength() const;
  /// Returns the angle of its crests to the orbit, degrees, above 0 if they trail. Precondition: there is a wave.
  double pitch() const;

private:
  double mean() const;
};

/// The mean motion at the start: circular, unless the scene gives the eccentricity vectors a pattern in x.
struct StreamlineSettings {
  int waves = 1;            ///< n of the phases 2π n X / L_x
  double bunching = 0.0;    ///< q
  double inclination = 0.0; ///< ⟨r⟩
};

/// A radial mode at the start, one term of the mean motion: an epicyclic wave with a whole number of crests in the box.
struct ModeSettings {
  /// Ways in which crests travel.
  enum class Direction { outward, inward, standing };
  Direction direction = Direction::outward; ///< in which its crests travel
  int waves = 1;                            ///< n of k = 2π n / L_x
  double amplitude = 0.0;                   ///< of Σ/⟨Σ⟩ − 1; the maximum for a standing wave
  double phase_degrees = 0.0;               ///< of Σ/⟨Σ⟩ − 1 = amplitude cos(kx + phase) at the start
};

/// A ball of the scene's particles at the start. Aggregates have the last particle ids, in the order of the scene.
struct AggregateSettings {
  std::size_t first = 0;        ///< its lowest id
  std::size_t count = 0;        ///< number of particles; ids first … first + count − 1
  double filling = 0.0;         ///< volume of these particles over that of the ball
  Vec3 position = Vec3::Zero(); ///< centre of the ball, m
  double spin = 1.0;            ///< about the vertical in the inertial frame, Ω
  double radius = 0.0;          ///< of the ball, m
  double mass = 0.0;            ///< of the ball, kg
};

/// A start that the calling program has added.
struct StartSettings {
  const particles::StartEntry* entry = nullptr; ///< its place among start_laws()
  Parameters parameters;                        ///< the values of its keys
};

/// The particles at the start, moonlets not included.
struct ParticleSettings {
  std::size_t count = 0;                     ///< N, derived if the file gives τ or Σ
  double density = 0.0;                      ///< kg/m³; for populations the mean by volume
  particles::SizeLaw sizes;                  ///< distribution of radii
  double velocity_dispersion = 2.0;          ///< c_x in ⟨r⟩ Ω
  std::uint64_t seed = 1;                    ///< of all random numbers
  StreamlineSettings streamlines;            ///< the mean motion
  std::vector<ModeSettings> modes;           ///< empty if streamlines are patterned
  DensityPattern pattern;                    ///< of the surface density
  std::vector<AggregateSettings> aggregates; ///< balls of these particles
  std::optional<StartSettings> start; ///< none: a uniform layer, with these streamlines, modes, pattern and aggregates

  /// Returns the number of particles outside aggregates.
  std::size_t free_count() const { return aggregates.empty() ? count : aggregates.front().first; }
  /// Returns the upper limit of 1 − spacing of streamlines over their mean spacing: q, or the sum of the amplitudes.
  double bunching() const;
  /// Returns the mean sizes of the particles (layer.hpp).
  LayerSizes layer_sizes() const;
};

/// A body among the particles. Moonlet k has the id N + k, where N is the number of particles: the last ids of a run.
struct MoonletSettings {
  double radius = 0.0;          ///< m
  double mass = 0.0;            ///< kg
  Vec3 position = Vec3::Zero(); ///< at the start, m
  Vec3 velocity = Vec3::Zero(); ///< at the start, relative to a circular orbit at its position, m/s
};

/// Time is a whole number of ticks: a tick is a step, or the shortest automatic step. `end` and the schedules are
/// rounded to whole kick intervals.
struct TimeSettings {
  static constexpr std::int64_t ticks_per_orbit = 4096; ///< of automatic steps
  static constexpr std::int64_t longest = 64;           ///< longest automatic step, ticks
  static constexpr double few_oscillations = 0.5;       ///< oscillations_per_step() above this gets a warning
  static constexpr double max_oscillations = 1.5;       ///< above this a scene is refused

  double step = 1e-3;        ///< length of a tick, orbits
  bool automatic = false;    ///< step and kick interval follow the state (simulation/step_control.hpp)
  std::int64_t end_step = 0; ///< ticks
};

/// Limits of the contacts that are logged.
struct ContactLogSettings {
  double min_speed = 0.0;      ///< normal speed, m/s
  double min_radius_sum = 0.0; ///< m
  double fraction = 1.0;       ///< of these contacts, drawn by a hash
  bool at_rest = false;        ///< contacts at rest too, at each kick
};

/// When a run writes.
struct OutputSettings {
  std::int64_t series_every = 0;                ///< ticks between rows of the series; 0: only at the start
  std::int64_t stress_every = 0;                ///< ticks between rows with gravity's energy and stress; 0: none
  std::int64_t snapshot_every = 0;              ///< ticks; 0: only at start and end
  std::int64_t checkpoint_every = 0;            ///< ticks; 0: none by ticks
  double checkpoint_every_minutes = 0.0;        ///< wall time; 0: none by the clock
  std::optional<ContactLogSettings> collisions; ///< none: no log
};

/// An external force of the scene.
struct ForceSettings {
  const forces::ForceEntry* entry = nullptr; ///< in external_forces()
  Parameters parameters;                     ///< values of its keys
};

/// What a run is made from. load_scene() and parse_scene() make one.
struct Scene {
  std::string title;                          ///< a line for people
  PlanetSettings planet;                      ///< the orbit
  double size_x = 0.0;                        ///< radial size of the box, m; 0 with a start file and in stored scenes
  double size_y = 0.0;                        ///< size along the orbit, m; 0 likewise
  ParticleSettings particles;                 ///< at the start
  std::vector<MoonletSettings> moonlets;      ///< bodies among the particles
  collision::CollisionSettings collisions;    ///< finder, restitution, friction
  std::optional<GravitySettings> gravity;     ///< none: no gravity code runs
  std::vector<ForceSettings> external_forces; ///< in the order of external_forces()
  std::optional<std::string> start_from;      ///< path of a snapshot
  double start_keep = 1.0;                    ///< fraction of its particles
  std::uint64_t start_keep_seed = 1;          ///< of the draw of this fraction
  TimeSettings time;                          ///< step and end
  OutputSettings output;                      ///< schedules of files

  std::string resolved;             ///< the scene as TOML, with every key, frequencies and counts filled in
  std::string motion;               ///< the keys that affect the evolution of a state, one per line
  std::vector<std::string> notices; ///< values that were rounded or derived, for the user, one per line

  /// Returns the length of a tick in internal time (rad).
  double step_length() const;
  /// Returns the oscillations per step, radial or vertical, whichever are faster; 0 for an automatic step.
  double oscillations_per_step() const;
  /// Returns the ticks between kicks, for automatic steps the longest: only at its multiples has a state received both
  /// halves of its kicks.
  std::int64_t kick_interval() const {
    return time.automatic ? TimeSettings::longest : gravity ? gravity->kick_every : 1;
  }
  /// Returns the surface density of the particles, kg/m²; 0 with a start file.
  double surface_density() const;
  /// Returns the optical depth Σ π r² / area; 0 with a start file.
  double optical_depth() const;
  /// Returns the optical depth of the particles outside aggregates where streamlines are closest at the start (a factor
  /// 1/(1 − q)) and the pattern is densest. Precondition: there are particles.
  double bunched_optical_depth() const;
};

/// Upper limit of the box's longest side over its shortest: gravity sums as many images one by one.
inline constexpr double max_aspect_ratio = 1000.0;

} // namespace keeler::scene

namespace keeler {
using scene::Scene;
} // namespace keeler
