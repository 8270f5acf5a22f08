// How much of the normal speed two particles keep when they bounce.
#pragma once

#include <keeler/core/key.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler {

/// Two particles that are about to bounce.
struct Impact {
  double speed = 0.0;                         ///< normal approach speed, m/s
  double radius_low = 0.0, radius_high = 0.0; ///< m, of the particle with the lower id and of the other
};

/// The coefficient of normal restitution, in [0, 1], of an impact. Called from several threads at once.
using RestitutionLaw = std::function<double(const Impact&)>;

/// The same coefficient for every impact.
RestitutionLaw constant_restitution(double coefficient);

/// min(1, c (v / 1 cm s⁻¹)^−0.234): frosty ice (Bridges et al. 1984; c is 0.34 there and 0.32 in other codes).
RestitutionLaw bridges_restitution(double scale);

/// Elastic up to the critical speed v* (m/s), and above it ε² = −⅔u² + √(10/3 u² − 5/9 u⁴), u = v*/v: spheres that
/// yield plastically where they touch (Borderies, Goldreich & Tremaine 1984, after Andrews 1930).
RestitutionLaw borderies_restitution(double critical_speed);

/// min(1, 0.90 e^(−0.22 v) + 0.01 v^−0.6), v in cm/s: spheres of 20 cm with compacted frost at 123 K (Hatzes, Bridges &
/// Lin 1988). The law that keeps a ring at Quaoar's (Morgado et al. 2023, Extended Data Fig. 4, model 4).
RestitutionLaw hatzes_restitution();

/// Viscoelastic spheres, whose coefficient depends on their sizes (Ramírez, Pöschel, Brilliantov & Schwager 1999):
///   ε = (1 + 2.583 x)/(1 + 3.583 x + 2.983 x² + 1.148 x³ + 0.326 x⁴),  x = (v/v₀)^(1/5) (k/k₀)^(2/5),
/// with k = √R_eff / m_eff of the pair, of one material, and k₀ that of two spheres of `radius` (m). `speed` is v₀
/// (m/s), where two such spheres have ε = 0.396. At one speed larger spheres are more elastic: x goes as 1/r.
RestitutionLaw viscoelastic_restitution(double speed, double radius);

/// Rows of a speed (m/s) and its coefficient, speeds rising from above 0: linear in the logarithm of the speed between
/// two rows, and constant beyond the first and the last. Throws UsageError "row n: …".
RestitutionLaw tabulated_restitution(NumberRows table);

/// A law that the program brings itself, known to scenes by this name from now on (law = "own", name = NAME), and so to
/// the state hash and to checkpoints: a program that has no law of that name refuses them. Throws UsageError when the
/// name is empty or known, or when the coefficient of an impact of 1 µm/s to 100 m/s is not in [0, 1]; a step in which
/// the law gives another one throws it too.
void add_own_restitution(const std::string& name, const RestitutionLaw& law);

/// A law that a scene can choose: its name, its keys, and how it is made from their values.
struct RestitutionEntry {
  const char* name;
  std::vector<Key> keys;
  RestitutionLaw (*make)(const Parameters& parameters);
};

/// All laws. A new one is one more entry here.
const std::vector<RestitutionEntry>& restitution_laws();

} // namespace keeler
