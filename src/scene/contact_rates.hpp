// Contact rates near the equilibrium of a patch: fits to counted contacts (docs/dev/estimate.md). They set the step of
// a quality and the estimated cost of a run.
#pragma once

#include <keeler/scene/scene.hpp>

namespace keeler::scene {

/// Contacts per particle and orbit; each counts for both of its particles, as in a run's summary.
struct ContactRates {
  double fast = 0.0; ///< above v_cut
  double slow = 0.0; ///< below it
  double all() const { return fast + slow; }
};

/// Crowding: density of a particle's neighbourhood relative to equal spheres at τ = 1. τ^1.8 for a layer without
/// structure; what self-gravity adds by compressing the layer, and what wakes add.
double layer_crowding(double optical_depth);
double compressed_crowding(double optical_depth, double hill_parameter);
double wake_crowding(double optical_depth, double hill_parameter);

/// Returns ⟨r²⟩/⟨r⟩².
double size_spread(const particles::SizeLaw& sizes);

/// Returns the rate (per particle and orbit) of a layer without crowding.
double dilute_rate(double optical_depth, double vertical_ratio);

/// Returns the rates at an optical depth, for a coefficient of restitution that holds for all impacts and sizes of this
/// `spread`, ⟨r²⟩/⟨r⟩². `vertical_ratio`, ν/Ω, adds to the crowding: a layer that is pulled to its mid-plane is
/// flatter, and its particles cross it more often.
ContactRates contact_rates(double optical_depth, double restitution, double crowding, double spread = 1.0,
                           double vertical_ratio = 1.0);

/// Rates of a scene near its equilibrium, before and after wakes form. They are equal without self-gravity, and in a
/// box that is too small for wakes. Precondition of all functions below: the scene has no start file.
struct SceneContacts {
  ContactRates smooth, wakes;
};
SceneContacts scene_contacts(const Scene& scene);

/// Returns the optical depth that a particle meets: a pair's cross-section is π (r_i + r_j)².
double encountered_optical_depth(const Scene& scene);

/// Returns the coefficient of restitution of a typical impact, at about three times the speed R Ω.
double typical_restitution(const Scene& scene);

} // namespace keeler::scene
