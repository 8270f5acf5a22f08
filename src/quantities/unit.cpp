#include <keeler/quantities/quantity.hpp>

#include <cassert>
#include <utility>

namespace keeler::quantities {

double PatchUnits::speed(UnitSystem system) const {
  assert(frequency > 0.0);
  return system == UnitSystem::radius ? radius * frequency : system == UnitSystem::gravity ? pull / frequency : 1.0;
}

double PatchUnits::viscosity(UnitSystem system) const {
  assert(frequency > 0.0);
  return system == UnitSystem::radius    ? radius * radius * frequency
         : system == UnitSystem::gravity ? pull * pull / (frequency * frequency * frequency)
                                         : 1.0;
}

Unit unit_in(const Unit& si, UnitSystem system) {
  if (si == unit::metres_per_second && system != UnitSystem::si)
    return system == UnitSystem::radius ? unit::per_radius_speed : unit::per_gravity_speed;
  if (si == unit::viscosity && system != UnitSystem::si)
    return system == UnitSystem::radius ? unit::per_radius_viscosity : unit::per_gravity_viscosity;
  return si;
}

double size_of_unit(const Unit& si, UnitSystem system, const PatchUnits& units) {
  return si == unit::metres_per_second ? units.speed(system) : si == unit::viscosity ? units.viscosity(system) : 1.0;
}

std::string ascii(std::string_view text) {
  std::string plain(text);
  for (const auto& [sign, letters] : {std::pair{"Ω", "Omega"},
                                      {"Σ", "Sigma"},
                                      {"²", "^2"},
                                      {"³", "^3"},
                                      {"λ", "lambda"},
                                      {"τ", "tau"},
                                      {"±", "+-"},
                                      {"⟨", "<"},
                                      {"⟩", ">"},
                                      {"√", "sqrt"},
                                      {"κ", "kappa"},
                                      {"–", "-"},
                                      {"·", "*"}})
    for (std::size_t at = plain.find(sign); at != std::string::npos; at = plain.find(sign, at))
      plain.replace(at, std::string_view(sign).size(), letters);
  return plain;
}

} // namespace keeler::quantities
