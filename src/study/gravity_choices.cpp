#include <keeler/study/gravity_choices.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace keeler {
namespace {

GravityChoice tree(double opening_angle) {
  GravitySettings settings;
  settings.solver = GravitySettings::Solver::tree;
  settings.opening_angle = opening_angle;
  return {"tree", fmt::format("opening_angle {:.3g}", opening_angle), "opening angle", opening_angle, settings};
}

GravityChoice direct() {
  GravitySettings settings;
  settings.solver = GravitySettings::Solver::direct;
  return {"direct", "all pairs", "", 0.0, settings};
}

} // namespace

std::vector<GravityChoice> gravity_choices(bool dense) {
  std::vector<GravityChoice> choices = {direct()};
  for (const int twentieths :
       dense ? std::vector{4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 18, 20} : std::vector{6, 8, 10, 12, 14, 16})
    choices.push_back(tree(0.05 * twentieths));
  return choices;
}

std::vector<std::string> gravity_solver_names() {
  std::vector<std::string> names;
  for (const GravityChoice& choice : gravity_choices(false))
    if (std::find(names.begin(), names.end(), choice.solver) == names.end())
      names.push_back(choice.solver);
  return names;
}

GravityChoice default_gravity_choice(const std::string& solver) {
  if (solver == "tree")
    return tree(GravitySettings{}.opening_angle);
  if (solver == "direct")
    return direct();
  throw std::invalid_argument("no gravity solver '" + solver + "'");
}

} // namespace keeler
