// How much of the normal speed two particles keep when they bounce.
#pragma once

#include <keeler/core/key.hpp>

#include <functional>
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

/// Rows of a speed (m/s) and its coefficient, speeds rising from above 0: linear in the logarithm of the speed between
/// two rows, and constant beyond the first and the last. Throws UsageError "row n: …".
RestitutionLaw tabulated_restitution(NumberRows table);

/// A law that a scene can choose: its name, its keys, and how it is made from their values.
struct RestitutionEntry {
  const char* name;
  std::vector<Key> keys;
  RestitutionLaw (*make)(const Parameters& parameters);
};

/// All laws. A new one is one more entry here.
const std::vector<RestitutionEntry>& restitution_laws();

} // namespace keeler
