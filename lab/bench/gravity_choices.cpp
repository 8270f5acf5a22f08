#include <keeler/bench/gravity_choices.hpp>

#include <keeler/core/format.hpp>
#include <keeler/gravity/fft.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace keeler::bench {
namespace {

GravityChoice tree(double opening_angle) {
  GravitySettings settings;
  settings.solver = GravitySettings::Solver::tree;
  settings.opening_angle = opening_angle;
  return {"tree", fmt::format("opening_angle {:.3g}", opening_angle), settings};
}

GravityChoice direct() {
  GravitySettings settings;
  settings.solver = GravitySettings::Solver::direct;
  return {"direct", "all pairs", settings};
}

GravityChoice fft(double cut) {
  GravitySettings settings;
  settings.solver = GravitySettings::Solver::fft;
  settings.mesh_cut = cut;
  return {"fft", fmt::format("cut {:.3g}", cut), settings};
}

GravityChoice mesh(double spacing) {
  GravitySettings settings;
  settings.solver = GravitySettings::Solver::mesh;
  settings.mesh_spacing = spacing;
  return {"mesh", fmt::format("mesh_spacing {:.3g}", spacing), settings};
}

} // namespace

std::vector<GravityChoice> gravity_choices() {
  std::vector<GravityChoice> choices = {direct()};
  for (const int twentieths : {6, 8, 10, 12, 14, 16})
    choices.push_back(tree(0.05 * twentieths));
  for (const double cut : {2.0, 2.5, 3.0, 4.0, 5.0})
    choices.push_back(fft(cut));
  choices.push_back(mesh(0.2 * 8));
  return choices;
}

std::vector<std::string> gravity_solver_names() {
  std::vector<std::string> names;
  for (const GravityChoice& choice : gravity_choices())
    if (std::find(names.begin(), names.end(), choice.solver) == names.end())
      names.push_back(choice.solver);
  return names;
}

std::vector<std::string> gravity_state_names() {
  return {"settled", "clumped", "uniform"};
}

GravityChoice default_gravity_choice(const std::string& solver) {
  if (solver == "tree")
    return tree(GravitySettings{}.opening_angle);
  if (solver == "direct")
    return direct();
  if (solver == "fft")
    return fft(gravity::cut_for(GravitySettings{}.force_error, 1.0)); // 1: the benches' spheres have equal masses
  if (solver == "mesh")
    return mesh(GravitySettings{}.mesh_spacing);
  throw std::invalid_argument("no gravity solver '" + solver + "'");
}

GravityChoice choice_of(const GravitySettings& settings, std::size_t count) {
  using Solver = GravitySettings::Solver;
  const GravitySettings chosen = chosen_for(count, settings);
  GravityChoice choice = {"fft", fmt::format("force_error {:.3g}", chosen.force_error), {}};
  if (chosen.solver == Solver::tree)
    choice = tree(chosen.opening_angle);
  if (chosen.solver == Solver::direct)
    choice = direct();
  if (chosen.solver == Solver::mesh)
    choice = mesh(chosen.mesh_spacing);
  if (chosen.solver == Solver::axisymmetric)
    choice = {"axisymmetric", fmt::format("waves from {:g} m up", chosen.shortest_wavelength), {}};
  if ((chosen.solver == Solver::tree || chosen.solver == Solver::direct) && !chosen.images.far)
    choice.text += fmt::format(", {} of images alone", pluralize(chosen.images.rings, "ring"));
  choice.settings = chosen;
  return choice;
}

} // namespace keeler::bench
