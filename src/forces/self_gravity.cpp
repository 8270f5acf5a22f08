#include <keeler/forces/self_gravity.hpp>

#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <cassert>
#include <map>

namespace keeler::forces {
namespace {

class SelfGravity : public Force {
public:
  SelfGravity(const GravitySettings& settings, const ForceContext& context)
      : settings_(settings), orbital_frequency_(context.orbital_frequency), seed_(context.seed),
        solver_(make_gravity_solver(settings, context.masses, context.box.area(), context.ranks)) {}

  std::int64_t kick_every() const override { return settings_.kick_every; }

  void accelerate(const Boundary& boundary, std::span<Vec3> accelerations) override {
    assert(accelerations.size() == boundary.particles.size());
    std::vector<Vec3> positions;
    std::vector<double> masses;
    const gravity::GravityProblem problem = gravity_problem(boundary, orbital_frequency_, positions, masses);
    if (settings_.images.far) {
      const Vec3 origin = random_origin(boundary);
      parallel_for(positions.size(), [&](std::size_t k) { positions[k] -= origin; });
    }
    solver_->accelerate(problem, accelerations);
  }

  std::optional<gravity::GravityEnergy> energy(const Boundary& boundary) override {
    if (!has_energy_meter(settings_))
      return std::nullopt;
    std::vector<Vec3> positions;
    std::vector<double> masses;
    const gravity::GravityProblem problem = gravity_problem(boundary, orbital_frequency_, positions, masses);
    if (auto* const solver = dynamic_cast<gravity::EnergyMeter*>(solver_.get())) // one mesh for both
      return solver->energy(problem);
    if (!meter_)
      meter_ = make_energy_meter(settings_, masses, problem.box.area(), problem.ranks);
    return meter_->energy(problem);
  }

private:
  Vec3 random_origin(const Boundary& boundary) const {
    RandomStream random(seed_, RandomPurpose::gravity_origin, static_cast<std::uint64_t>(boundary.step));
    const double x = random.uniform() - 0.5, y = random.uniform() - 0.5;
    return {x * boundary.box.size_x, y * boundary.box.size_y, 0.0};
  }

  GravitySettings settings_;
  double orbital_frequency_;
  std::uint64_t seed_;
  std::unique_ptr<gravity::GravitySolver> solver_;
  std::unique_ptr<gravity::EnergyMeter> meter_; // made when needed, if the solver is none
};

} // namespace

gravity::GravityProblem gravity_problem(const Boundary& boundary, double orbital_frequency,
                                        std::vector<Vec3>& positions, std::vector<double>& masses) {
  assert(orbital_frequency > 0.0);
  const Particles& particles = boundary.particles;
  const Rotation rotation = boundary.rotation();
  positions.resize(particles.size());
  masses.resize(particles.size());
  parallel_for(particles.size(), [&](std::size_t k) {
    particles.prefetch_after(k);
    const Body& body = particles.bodies[k];
    positions[k] = state_at(body.elements, boundary.frequencies, rotation).position;
    masses[k] = body.mass;
  });
  return {positions, masses, particles.ids, boundary.box, boundary.offset, newton_g(orbital_frequency), boundary.ranks};
}

std::unique_ptr<Force> make_self_gravity(const GravitySettings& settings, const ForceContext& context) {
  return std::make_unique<SelfGravity>(settings, context);
}

std::vector<Key> gravity_keys() {
  using enum KeyType;
  return {
      {.path = "solver",
       .type = choice,
       .fallback = "\"tree\"",
       .meaning = "how accelerations are computed",
       .choices = {"direct", "tree", "fft", "mesh", "axisymmetric", "auto"}},
      {.path = "force_error",
       .type = number,
       .fallback = "2e-3",
       .unit = "rms force",
       .meaning = "target rms error of the force",
       .range = {.low = 1e-5, .high = 0.1},
       .only_with = {"solver", {"fft", "auto"}}},
      {.path = "mesh_spacing",
       .type = number,
       .fallback = "1.6",
       .unit = "mean distance",
       .meaning = "spacing of the mesh, in (particles per area)^-1/2",
       .range = {.low = 0.1, .high = 100},
       .only_with = {"solver", {"mesh"}}},
      {.path = "shortest_wavelength",
       .type = number,
       .example = "50.0",
       .unit = "m",
       .meaning = "radial waves of the surface density pull down to this wavelength",
       .range = {.low = 0, .high = 1e7, .low_open = true},
       .only_with = {"solver", {"axisymmetric"}}},
      {.path = "opening_angle",
       .type = number,
       .fallback = "0.6",
       .unit = "1",
       .meaning = "a cell is opened when its size exceeds this times its distance",
       .range = {.low = 0.01, .high = 1}, // below, it equals the sum over all pairs, at a higher cost
       .only_with = {"solver", {"tree"}}},
      {.path = "images",
       .type = choice,
       .fallback = "\"periodic\"",
       .meaning = "periodic: all images, to infinity; rings: exactly image_rings rings, to compare with other codes",
       .choices = {"periodic", "rings"},
       .only_with = {"solver", {"direct", "tree"}}},
      {.path = "image_rings",
       .type = integer,
       .fallback = "1",
       .unit = "1",
       .meaning =
           "rings of boxes around the patch that are summed one by one (1 is 9 boxes, 2 is 25); at least 1 if periodic",
       .range = {.low = 0, .high = 10},
       .only_with = {"solver", {"direct", "tree"}}},
      {.path = "kick_every",
       .type = integer,
       .fallback = "1",
       .unit = "steps",
       .meaning = "drifts per kick",
       .range = {.low = 1, .high = 1000}},
      {.path = "resting_contacts",
       .type = choice,
       .fallback = "\"auto\"",
       .meaning =
           "contacts that a kick does not resolve: carried, by impulses that act with it, or bounced as all others; "
           "auto: carried where aggregates last (r_h of 1 or more), where grains stay on a moonlet, and where many "
           "spheres rest on each other (from r_h 0.79 on; from 0.79/τ^(1/4) on where the optical depth τ is below 1)",
       .choices = {"auto", "carried", "bounced"},
       .only_with = {"solver", {"direct", "tree", "fft", "mesh", "auto"}},
       .unhashed = "\"bounced\""},
  };
}

GravitySettings gravity_settings(const Parameters& p) {
  using Solver = GravitySettings::Solver;
  static const std::map<std::string, Solver> solvers = {{"direct", Solver::direct},
                                                        {"tree", Solver::tree},
                                                        {"fft", Solver::fft},
                                                        {"mesh", Solver::mesh},
                                                        {"axisymmetric", Solver::axisymmetric},
                                                        {"auto", Solver::automatic}};
  GravitySettings gravity;
  gravity.solver = solvers.at(p.text("solver"));
  if (p.has("opening_angle"))
    gravity.opening_angle = p.number("opening_angle");
  if (p.has("force_error"))
    gravity.force_error = p.number("force_error");
  if (p.has("mesh_spacing"))
    gravity.mesh_spacing = p.number("mesh_spacing");
  if (p.has("shortest_wavelength"))
    gravity.shortest_wavelength = p.number("shortest_wavelength");
  if (p.has("images")) {
    gravity.images.rings = static_cast<int>(p.integer("image_rings"));
    gravity.images.far = p.text("images") == "periodic";
  }
  gravity.kick_every = static_cast<int>(p.integer("kick_every"));
  if (p.has("resting_contacts"))
    gravity.resting_contacts = p.text("resting_contacts") != "bounced";
  return gravity;
}

} // namespace keeler::forces
