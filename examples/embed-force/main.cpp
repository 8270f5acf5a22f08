// A force, a start and a column of series.csv that Keeler does not have: a particle in gas, held against the exact
// solution. Its epicycle decays as e^(−γt).
#include <keeler/forces/force.hpp>
#include <keeler/particles/start.hpp>
#include <keeler/runs/own_numbers.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/scene/load.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>

// Gas on circular orbits slows the motion beyond the shear: a = −γ c.
class GasDrag : public keeler::forces::Force {
public:
  explicit GasDrag(double rate) : rate_(rate) {}

  void accelerate(const keeler::forces::Boundary& at, std::span<keeler::Vec3> accelerations) override {
    const keeler::Rotation rotation = at.rotation();
    for (std::size_t k = 0; k < accelerations.size(); ++k)
      accelerations[k] =
          -rate_ * keeler::hill::peculiar_velocity(at.particles.bodies[k].elements, at.frequencies, rotation);
  }

private:
  double rate_; // γ, rad⁻¹
};

keeler::Key number(const char* name, const char* fallback, const char* unit, const char* meaning) {
  return {.path = name,
          .type = keeler::KeyType::number,
          .fallback = fallback,
          .unit = unit,
          .meaning = meaning,
          .range = {.low = 0, .high = 100}};
}

std::unique_ptr<keeler::forces::Force> make_drag(const keeler::Parameters& keys, const keeler::forces::ForceContext&) {
  return std::make_unique<GasDrag>(keys.number("rate") / (2.0 * std::numbers::pi));
}

std::vector<keeler::State> place_on_epicycle(const keeler::Parameters& keys,
                                             const keeler::particles::StartRequest& request) {
  keeler::Elements orbit; // about the middle of the box
  orbit.e_cos = keys.number("eccentricity");
  const keeler::Rotation at_start(request.frequencies, 0.0);
  return std::vector(request.radii.size(), keeler::hill::state_at(orbit, request.frequencies, at_start));
}

double eccentricity(const keeler::Simulation& simulation, const keeler::Scene&) {
  return simulation.boundary().particles.bodies[0].elements.eccentricity();
}

int main() {
  keeler::forces::add_force({"gas_drag", {number("rate", "0.1", "1/orbit", "gamma of the drag -gamma c")}, make_drag});
  keeler::particles::add_start(
      {"epicycle", {number("eccentricity", "1.0", "m", "radius of the epicycle")}, place_on_epicycle});
  keeler::runs::add_series_column({"eccentricity_m", "m", "Epicycle: e", "radius of the epicycle", eccentricity});

  const keeler::Scene scene = keeler::parse_scene(R"(
    planet.preset = "saturn-b-ring"
    box.size = [500.0, 500.0]
    particles.count = 1
    particles.density = 600.0
    particles.sizes = { law = "equal", radius = 1.0 }
    particles.start = { law = "epicycle", eccentricity = 20.0 }
    gas_drag.rate = 0.5
    time = { step = 1e-3, end = 2.0 }
  )",
                                                  "embed-force");
  keeler::runs::RunRequests requests;
  keeler::runs::start_run(scene, {.folder = "gas-drag", .force = true}, requests);

  std::string line, last;
  for (std::ifstream series("gas-drag/series.csv"); std::getline(series, line);)
    last = line;
  const double measured = std::stod(last.substr(last.rfind(',') + 1)), exact = 20.0 * std::exp(-0.5 * 2.0);
  std::printf("eccentricity after two orbits: %.4f m, exactly %.4f m\n", measured, exact);
  return std::fabs(measured / exact - 1.0) < 1e-3 ? 0 : 1;
}
