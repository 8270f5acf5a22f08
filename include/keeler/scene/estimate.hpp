// What a run will cost, before it runs: processor seconds by part, from the scene and the speed of this machine. The
// rates of contacts and the times behind it were measured; docs/dev/estimate.md has them and how far it is off.
#pragma once

#include <keeler/scene/scene.hpp>

#include <array>
#include <string>
#include <vector>

namespace keeler {

/// Contacts a particle and orbit, each counted for both of its particles as in a run's summary.
struct ContactRates {
  double fast = 0.0; ///< above v_cut
  double slow = 0.0; ///< below it
  double all() const { return fast + slow; }
};

/// How crowded a particle's neighbourhood is: τ^1.8 for a layer without structure; what self-gravity adds by pressing
/// the layer together, and what wakes add. In units of what equal spheres have at τ = 1.
double layer_crowding(double optical_depth);
double pressed_crowding(double optical_depth, double hill_parameter);
double wake_crowding(double optical_depth, double hill_parameter);

/// In a patch of that optical depth, for a coefficient of restitution that holds for all impacts and sizes of that
/// ⟨r²⟩/⟨r⟩². `vertical_ratio`, ν/Ω, adds its own crowding: a layer that is pulled to its mid-plane is flatter, and its
/// particles cross it more often.
ContactRates contact_rates(double optical_depth, double restitution, double crowding, double spread = 1.0,
                           double vertical_ratio = 1.0);

/// Contacts of a scene near its equilibrium: before wakes stand, and when they do. Equal without self-gravity, and in a
/// box that is too small for wakes.
struct SceneContacts {
  ContactRates smooth, wakes;
};
SceneContacts scene_contacts(const Scene& scene);

/// Processor time, s.
struct RunEstimate {
  double start = 0.0;   ///< making the initial state
  double drift = 0.0;   ///< moving, finding and carrying out contacts
  double gravity = 0.0; ///< solves and kicks
  double output = 0.0;  ///< files, rows of the series, checks, and the summary

  double total() const { return start + drift + gravity + output; }

  struct Part {
    const char* name;
    double seconds;
  };
  std::array<Part, 4> parts() const;
  const char* dominating() const; ///< the name of the largest part
};

/// The machine that the times were measured on: bench's `pair_ns` there.
inline constexpr double reference_pair_ns = 6.55;

/// For a scene whose particles are known (no start file), on a machine whose pair yardstick gives `pair_ns`.
RunEstimate estimate_run(const Scene& scene, double pair_ns = reference_pair_ns);

/// What makes a scene several times as dear as its like, which differs in that alone: a line each, with what to do;
/// none where nothing does. For a scene whose particles are known.
std::vector<std::string> expensive_settings(const Scene& scene);

} // namespace keeler
