// Fresh starts made by several ranks, each in its slab, against one process: equal bits.
#include "launched.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/uniform.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

using namespace keeler;
using keeler_test::launched;

namespace {

Scene scene_with(const std::string& box, const std::string& particles, const std::string& more = "") {
  return parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = " + box +
                         "\ntime.end = 1.0\n[particles]\ndensity = 600.0\n" + particles + more,
                     "test scene", {});
}

struct Row {
  std::uint64_t id;
  double radius, mass;
  Vec3 position, velocity, spin;
};

std::vector<Row> rows_of(const Patch& patch) {
  std::vector<Row> rows;
  for (std::size_t k = 0; k < patch.size(); ++k)
    rows.push_back({patch.ids[k], patch.radii[k], patch.masses[k], patch.positions[k], patch.velocities[k],
                    patch.spins.empty() ? Vec3(0.0, 0.0, 0.0) : patch.spins[k]});
  return rows;
}

bool same(const Row& a, const Row& b) {
  return a.id == b.id && a.radius == b.radius && a.mass == b.mass && a.position == b.position &&
         a.velocity == b.velocity && a.spin == b.spin;
}

// Returns on the root the number of particles that differ.
std::size_t differences(const Patch& whole, const Patch& part) {
  std::vector<Row> all = launched().gather(rows_of(part));
  if (!launched().is_root())
    return 0;
  std::sort(all.begin(), all.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  const std::vector<Row> expected = rows_of(whole);
  CHECK(all.size() == expected.size());
  std::size_t different = 0;
  for (std::size_t k = 0; k < std::min(all.size(), expected.size()); ++k)
    different += !same(all[k], expected[k]);
  return different;
}

std::string words_of(const Scene& scene, const Communicator& ranks) {
  try {
    initial_patch(scene, {}, ranks);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const std::string equal = "sizes = { law = \"equal\", radius = 1.0 }\n",
                  wide = "sizes = { law = \"power\", exponent = 3.0, min = 0.2, max = 6.0 }\n";

} // namespace

TEST_CASE("a fresh start has the bits of one process, and each rank has its part") {
  for (const Scene& scene :
       {scene_with("[90, 60]", "optical_depth = 0.5\n" + equal),
        scene_with("[60, 40]", "optical_depth = 1.8\nvelocity_dispersion = 2.5\n" + equal), // hundreds of sweeps
        scene_with("[150, 60]", "optical_depth = 0.8\nvelocity_dispersion = 6.0\n" + wide),
        scene_with("[150, 60]", "optical_depth = 0.4\nvelocity_dispersion = 6.0\n" + wide,
                   "[particles.wake]\nwavelength = 40.0\npitch = 20.0\ncontrast = 0.3\n"),
        scene_with("[300, 50]", "optical_depth = 0.3\n" + equal, // slabs of 2, 3 and 6 ranks have whole waves
                   "[particles.streamlines]\nwaves = 6\nbunching = 0.4\n"),
        parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [120, 60]\ntime.end = 1.0\n"
                    "[particles]\ncount = 700\n"
                    "sizes = { law = \"populations\", populations = [[1.5, 100, 900.0], [0.8, 600, 450.0]] }\n",
                    "test scene", {})}) {
    const Patch whole = initial_patch(scene), part = initial_patch(scene, {}, launched());
    CAPTURE(whole.size());
    CHECK(differences(whole, part) == 0);
    CHECK(part.size() < 1.5 * static_cast<double>(whole.size()) / static_cast<double>(launched().size()));
    CHECK(std::is_sorted(part.ids.begin(), part.ids.end()));
    CHECK(part.orbital_frequency == whole.orbital_frequency);
    CHECK(part.offset == whole.offset);
  }
}

TEST_CASE("moonlets and aggregates have the bits of one process, at bounds of slabs and inside") {
  const std::string friction = "[collisions.friction]\ntangential_restitution = 0.5\n";
  for (const char* const position : {"0.0, 3.0, 0.0", "-44.0, 20.0, 1.0", "15.0, -10.0, 0.0"}) {
    const std::string moonlet =
                          std::string("[[moonlet]]\nposition = [") + position + "]\nradius = 7.0\ndensity = 700.0\n",
                      aggregates =
                          "[[particles.aggregate]]\ncount = 80\nposition = [-20.0, -15.0, 0.0]\nspin = 0.5\n"
                          "[[particles.aggregate]]\ncount = 30\nposition = [30.0, 12.0, 0.0]\nfilling_factor = 0.35\n";
    const Scene scene = scene_with("[90, 60]", "optical_depth = 0.4\n" + equal, aggregates + moonlet + friction);
    CHECK(differences(initial_patch(scene), initial_patch(scene, {}, launched())) == 0);
  }
}

TEST_CASE("each rank may have ghosts of all particles in a small box") {
  for (const char* const box : {"[9, 9]", "[5, 22]"}) {
    const Scene scene = scene_with(box, "optical_depth = 0.6\n" + equal);
    CHECK(differences(initial_patch(scene), initial_patch(scene, {}, launched())) == 0);
  }
}

TEST_CASE("ranks may be more than particles") {
  for (const char* const count : {"1", "2"}) {
    const Scene scene = scene_with("[60, 40]", std::string("count = ") + count + "\n" + equal);
    CHECK(differences(initial_patch(scene), initial_patch(scene, {}, launched())) == 0);
  }
}

TEST_CASE("small spheres caught between large ones are moved to the positions of one process") {
  initial_conditions::UniformRequest request;
  std::vector<double> radii;
  for (int k = 0; k <= 40; ++k) // from 1 to 10⁻⁴, with growing numbers
    radii.insert(radii.end(), static_cast<std::size_t>(std::pow(10.0, 0.09 * k)), std::pow(10.0, -0.1 * k));
  const auto sum = [&](int power) {
    return std::accumulate(radii.begin(), radii.end(), 0.0,
                           [=](double all, double r) { return all + std::pow(r, power); });
  };
  const double area = pi * sum(2) / 0.8;
  request.box = {std::sqrt(area), std::sqrt(area), request.frequencies.shear(), 0.37 * std::sqrt(area)};
  request.dispersion_z = 4.0 / 3.0 * pi * sum(3) / area / (std::sqrt(two_pi) * 0.2);
  request.dispersion_x = request.dispersion_z / 0.65;
  request.seed = 5;
  initial_conditions::UniformRequest own = request;
  request.radii = radii;
  const std::size_t count = radii.size(), ranks = launched().size();
  own.first = count * launched().rank() / ranks;
  const std::size_t last = count * (launched().rank() + 1) / ranks;
  own.radii.assign(radii.begin() + static_cast<std::ptrdiff_t>(own.first),
                   radii.begin() + static_cast<std::ptrdiff_t>(last));
  CHECK(differences(uniform_patch(request), uniform_patch(own, {}, launched())) == 0);
}

TEST_CASE("a start without room ends on all ranks in the words of one process") {
  const Scene scene = scene_with("[40, 40]", "optical_depth = 0.9\nvelocity_dispersion = 4.0\n" + equal,
                                 "[[particles.aggregate]]\ncount = 120\nfilling_factor = 0.63\n");
  const std::string expected = words_of(scene, {});
  CHECK(expected.find("lower its filling") != std::string::npos);
  CHECK(words_of(scene, launched()) == expected);
}
