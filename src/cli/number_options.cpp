#include "number_options.hpp"

#include "common_options.hpp"

namespace keeler::cli {

void UnitsOption::add_to(CLI::App& command) {
  one_of(command.add_option("--units", system_,
                            "units of velocities and viscosities: si; radius (r Omega, r^2 Omega); gravity (G "
                            "Sigma/Omega, G^2 Sigma^2/Omega^3)"),
         {"si", "radius", "gravity"});
}

void NumberOptions::add_to(CLI::App& command) {
  command
      .add_option("--only", names_,
                  "print only these numbers, separated by commas (\"keeler help numbers\" lists them)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  units_.add_to(command);
}

std::optional<quantities::UnitSystem> UnitsOption::system() const {
  if (system_.empty())
    return std::nullopt;
  return system_ == "si"       ? quantities::UnitSystem::si
         : system_ == "radius" ? quantities::UnitSystem::radius
                               : quantities::UnitSystem::gravity;
}

} // namespace keeler::cli
