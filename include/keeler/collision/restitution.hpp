// Coefficients of normal restitution: the fraction of its normal speed that a pair keeps in a collision.
#pragma once

#include <keeler/core/key.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler::collision {

/// Two particles about to collide.
struct Impact {
  double speed = 0.0;       ///< normal approach speed, m/s
  double radius_low = 0.0;  ///< of the particle with the lower id, m
  double radius_high = 0.0; ///< of the other particle, m
};

/// Returns the coefficient of normal restitution, in [0, 1], of an impact. Called from several threads at once.
using RestitutionLaw = std::function<double(const Impact&)>;

/// A constant coefficient.
RestitutionLaw constant_restitution(double coefficient);

/// min(1, c (v / 1 cm s⁻¹)^−0.234), c > 0: frosty ice (Bridges et al. 1984; c is 0.34 there and 0.32 in other codes).
RestitutionLaw bridges_restitution(double scale);

/// Elastic up to the critical speed v* > 0 (m/s), and above it ε² = −⅔u² + √(10/3 u² − 5/9 u⁴), u = v*/v: spheres that
/// yield plastically at the contact (Borderies, Goldreich & Tremaine 1984, after Andrews 1930).
RestitutionLaw borderies_restitution(double critical_speed);

/// min(1, 0.90 e^(−0.22 v) + 0.01 v^−0.6), v in cm/s: spheres of 20 cm with compacted frost at 123 K (Hatzes, Bridges &
/// Lin 1988). With this law a ring persists at Quaoar's (Morgado et al. 2023, Extended Data Fig. 4, model 4).
RestitutionLaw hatzes_restitution();

/// Viscoelastic spheres: the coefficient depends on their sizes (Ramírez, Pöschel, Brilliantov & Schwager 1999):
///   ε = (1 + 2.583 x)/(1 + 3.583 x + 2.983 x² + 1.148 x³ + 0.326 x⁴),  x = (v/v₀)^(1/5) (k/k₀)^(2/5),
/// with k = √R_eff / m_eff of the pair, of one material, and k₀ that of two spheres of `radius` (m). `speed` is v₀
/// (m/s), at which two such spheres have ε = 0.396. At a given speed larger spheres are more elastic: x ∝ 1/r.
RestitutionLaw viscoelastic_restitution(double speed, double radius);

/// A table of rows (speed in m/s, coefficient), speeds positive and rising: linear in the logarithm of the speed
/// between two rows, and constant beyond the first and the last. Throws UsageError "row n: …".
RestitutionLaw tabulated_restitution(NumberRows table);

/// Registers a law that the calling program defines. Scenes refer to it by name (law = "own", name = NAME), and so do
/// the state hash and checkpoints: a program without a law of that name refuses them. Throws UsageError if the name is
/// empty or taken, or if the coefficient of an impact of 1 µm/s to 100 m/s is not in [0, 1]; a step in which the law
/// returns such a value throws it too.
void add_own_restitution(const std::string& name, const RestitutionLaw& law);

/// A law that a scene can choose: its name, its keys, and the function that makes it from their values.
struct RestitutionEntry {
  const char* name;                                     ///< word of the key `law`
  std::vector<Key> keys;                                ///< beside `law`
  RestitutionLaw (*make)(const Parameters& parameters); ///< makes it; throws UsageError for values that do not fit
};

/// Returns all laws. A new law is one more entry.
const std::vector<RestitutionEntry>& restitution_laws();

} // namespace keeler::collision

namespace keeler {
using collision::Impact, collision::RestitutionLaw;
} // namespace keeler
