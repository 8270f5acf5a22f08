// A checked scene: what a user asked for, in SI and orbits as in the file, with everything derived that the file leaves
// open. A Scene that exists is valid: load_scene reports every fault with file, line and column.
#pragma once

#include <keeler/collision/settings.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/forces/force.hpp>
#include <keeler/gravity/solver.hpp>
#include <keeler/hill/elements.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/scene/density_pattern.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

struct PlanetSettings {
  std::string preset;             ///< empty when the frequencies are given
  double orbital_frequency = 0.0; ///< rad/s
  Frequencies frequencies;        ///< κ/Ω, ν/Ω
};

/// The mean motion at the start: circles, unless the scene patterns the eccentricity vectors in x.
struct StreamlineSettings {
  int waves = 1;            ///< n of the phases 2π n X / L_x
  double bunching = 0.0;    ///< q
  double inclination = 0.0; ///< ⟨r⟩
};

/// A radial mode at the start, one term of the mean motion: an epicyclic wave with a whole number of crests in the box.
struct ModeSettings {
  enum class Direction { outward, inward, standing };
  Direction direction = Direction::outward; ///< in which its crests travel
  int waves = 1;                            ///< n of k = 2π n / L_x
  double amplitude = 0.0;                   ///< of Σ/⟨Σ⟩ − 1; of a standing wave the largest
  double phase_degrees = 0.0;               ///< of Σ/⟨Σ⟩ − 1 = amplitude cos(kx + phase) at the start
};

/// A ball of the scene's own particles at the start. Aggregates have the last ids of the particles, in the order of the
/// scene.
struct AggregateSettings {
  std::size_t first = 0, count = 0; ///< ids first … first + count − 1
  double filling = 0.0;             ///< volume of these over that of the ball
  Vec3 place = Vec3::Zero();        ///< of the middle of the ball, m
  double spin = 1.0;                ///< about the vertical against the stars, Ω
  double radius = 0.0, mass = 0.0;  ///< of the ball, m; kg
};

struct ParticleSettings {
  std::size_t count = 0; ///< N, derived when the file gives τ or Σ
  double density = 0.0;  ///< kg/m³; of populations the mean by volume
  SizeLaw sizes;
  double velocity_dispersion = 2.0; ///< c_x in ⟨r⟩ Ω
  std::uint64_t seed = 1;
  StreamlineSettings streamlines;
  std::vector<ModeSettings> modes; ///< none beside patterned streamlines
  DensityPattern pattern;
  std::vector<AggregateSettings> aggregates;

  /// Particles in no aggregate.
  std::size_t free_count() const { return aggregates.empty() ? count : aggregates.front().first; }
  /// The largest that 1 − spacing of streamlines may come to be, in their mean spacing: q, or the sum of the
  /// amplitudes.
  double bunching() const;
};

/// A body beside the particles. Moonlet k of n has the id N + k, N the number of particles: the last ids of a run.
struct MoonletSettings {
  double radius = 0.0, mass = 0.0; ///< m, kg
  Vec3 place = Vec3::Zero();       ///< at the start, m
  Vec3 velocity = Vec3::Zero();    ///< at the start, beyond a circular orbit's at its place, m/s
};

/// Time is a whole number of ticks: of steps, or of the shortest step that an automatic one may be. `end` and the
/// schedules are rounded to whole kick intervals.
struct TimeSettings {
  static constexpr std::int64_t ticks_per_orbit = 4096, longest = 64; ///< of an automatic step: longest in ticks

  double step = 1e-3;        ///< a tick, orbits
  bool automatic = false;    ///< step and kick interval follow the state (simulation/step_control.hpp)
  std::int64_t end_step = 0; ///< ticks
};

/// Which contacts are logged.
struct ContactLogSettings {
  double min_speed = 0.0;      ///< normal speed, m/s
  double min_radius_sum = 0.0; ///< m
  double share = 1.0;          ///< of these, drawn by a hash
};

struct OutputSettings {
  std::int64_t series_every = 0;                ///< ticks between rows of the series; 0: only at the start
  std::int64_t stress_every = 0;                ///< ticks between rows with gravity's energy and stress; 0: none
  std::int64_t snapshot_every = 0;              ///< ticks; 0: only at start and end
  std::int64_t checkpoint_every = 0;            ///< ticks; 0: none by these
  double checkpoint_every_minutes = 0.0;        ///< of wall time; 0: none by the clock
  std::optional<ContactLogSettings> collisions; ///< none: no log
};

/// An external force that the scene asks for.
struct ForceSettings {
  const ForceEntry* entry = nullptr;
  Parameters parameters;
};

struct Scene {
  std::string title;
  PlanetSettings planet;
  double size_x = 0.0, size_y = 0.0; ///< m
  ParticleSettings particles;
  std::vector<MoonletSettings> moonlets;
  CollisionSettings collisions;
  std::optional<GravitySettings> gravity; ///< none: no gravity code runs
  std::vector<ForceSettings> external_forces;
  std::optional<std::string> start_from; ///< a snapshot to start from
  double start_keep = 1.0;               ///< share of its particles
  std::uint64_t start_keep_seed = 1;
  TimeSettings time;
  OutputSettings output;

  std::string resolved;             ///< the scene as TOML, every key present, frequencies and counts filled in
  std::string motion;               ///< of these the keys that have a say in how a state moves on, a line each
  std::vector<std::string> notices; ///< what was rounded or derived and a user should know, a line each

  /// Length of a tick in internal time (rad).
  double step_length() const;
  /// Ticks from one kick to the next, of an automatic step the longest: only there does a state stand with both halves
  /// of its kicks.
  std::int64_t kick_interval() const {
    return time.automatic ? TimeSettings::longest : gravity ? gravity->kick_every : 1;
  }
  /// Surface density that the particles make, kg/m².
  double surface_density() const;
  /// Optical depth Σ π r² / area.
  double optical_depth() const;
  /// The same of the particles in no aggregate, where streamlines are closest at the start, 1/(1 − q) of it, and the
  /// pattern is densest.
  double bunched_optical_depth() const;
};

/// Reads and checks a scene file; overrides are "a.b=value" with TOML values (bare words are taken as strings). `from`
/// takes the place of start.from, messages call it --from. Throws UsageError "file:line:column: problem; what to do"
/// for the first fault.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides = {},
                 const std::optional<std::string>& from = {});

/// A key given another value by another file than the scene: TOML, or a bare word. The places are for messages.
struct Override {
  std::string key, value;
  std::string key_place, value_place;
};

/// The same with such overrides, later ones on top of earlier ones.
Scene load_varied_scene(const std::string& path, const std::vector<Override>& overrides);

/// The same from text; `name` stands for the file in messages.
Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides = {},
                  const std::optional<std::string>& from = {});

/// Longest side over shortest that a box may have: gravity sums as many images one by one.
inline constexpr double most_oblong = 1000.0;

/// A scene whose particles a table gives; what it says of them itself does not matter, and may be missing, but for the
/// density of the material.
struct TableScene {
  Scene scene;                   ///< its particles mean nothing
  std::optional<double> density; ///< kg/m³, where the scene has it
};

/// As load_scene(); the scene has box.size, and no start.from.
TableScene load_table_scene(const std::string& path, const std::vector<std::string>& overrides);
/// The same from text; `name` stands for the file in messages.
TableScene parse_table_scene(const std::string& text, const std::string& name,
                             const std::vector<std::string>& overrides = {});

/// The scene in a snapshot or checkpoint, for what exists already: the box, the sizes and whatever else only the start
/// needed are not read (their ranges alone are checked), so a file of radii or a start file may be gone.
Scene parse_stored_scene(const std::string& text, const std::string& name);
/// The same of a run's scene.toml. Throws IoError, also where it is none any more.
Scene load_stored_scene(const std::filesystem::path& file);

/// Every key with default, unit and meaning, as a table (text) or as the manual's Markdown table.
std::string describe_keys(bool markdown);

} // namespace keeler
