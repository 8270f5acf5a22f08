#include <keeler/initial_conditions/initial.hpp>

#include <keeler/advice/warnings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

namespace start_file_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

Scene scene(const std::vector<std::string>& overrides = {}, const std::optional<std::string>& from = {}) {
  return parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [50, 40]
[particles]
count = 34
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
[time]
end = 1.0
)",
                     "test scene", overrides, from);
}

// Returns the message of a start from the scene's patch after a change.
std::string fault(const std::function<void(Patch&)>& change) {
  const std::string file = (std::filesystem::temp_directory_path() / "keeler-test-start.hdf").string();
  Patch patch = initial_patch(scene());
  change(patch);
  io::write_snapshot(file, patch, {scene().resolved, {}});
  std::string message;
  try {
    initial_patch(scene({}, file));
  } catch (const Error& error) {
    message = error.what();
  }
  std::filesystem::remove(file);
  return message;
}

} // namespace

TEST_CASE("a start file's particles must be possible; the first that is not is named") {
  CHECK(fault([](Patch&) {}).empty());
  const auto says = [](const std::function<void(Patch&)>& change, const std::string& words) {
    const std::string message = fault(change);
    CAPTURE(message);
    CHECK(message.find("particle 7 of '") == 0);
    CHECK(message.find(words) != std::string::npos);
  };
  says([](Patch& p) { p.positions[7].x() = 1e9; }, "a coordinate (m) of 1e9 (possible is at most 1e7)");
  says([](Patch& p) { p.positions[7].z() = -1e9; }, "a coordinate (m) of 1e9");
  says([](Patch& p) { p.masses[7] = 1e18; }, "a density (kg/m^3, by its mass and radius) of 2.39e17");
  says([](Patch& p) { p.radii[7] = 1e-9; }, "a radius (m) of 1e-9 (possible is from 1e-6 to 1000000)");
  says([](Patch& p) { p.velocities[7].x() = 2000.0 / p.orbital_frequency; }, "a speed (m/s, beyond the shear) of 2000");
  CHECK(fault([](Patch& p) { p.positions[7].x() = NAN; }).find("particle 7 has a position") != std::string::npos);
  CHECK(fault([](Patch& p) { p.box.size_y = 1e12; }).find("50 m x 1e12 m") != std::string::npos);
  CHECK(fault([](Patch& p) {
          p.offset = NAN;
        }).find("a shear_offset of nan m, modulo L_y (possible is from 0 to 40)") != std::string::npos);
  CHECK(fault([](Patch& p) { p.box.first_offset = -1.0; }).find("a shear_offset_at_start of -1") != std::string::npos);
  CHECK(fault([](Patch& p) { p.box.shear = 0.0; }).find("a shear_over_Omega of 0") != std::string::npos);
  CHECK(fault([](Patch& p) { p.time_orbits = NAN; }).find("time_s nan") != std::string::npos);
  CHECK(fault([](Patch& p) { p.frequencies.nu = NAN; }).find("a nu_over_Omega of nan") != std::string::npos);
  CHECK(fault([](Patch& p) { p.box.size_y = 6e4; }).find("more than 1000 times as long as wide") != std::string::npos);
}

TEST_CASE("rough particles that start.keep_fraction keeps have their spins") {
  const std::string file = (std::filesystem::temp_directory_path() / "keeler-test-kept-spins.hdf").string();
  const std::string rough = "collisions.friction.tangential_restitution=0.5";
  Patch patch = initial_patch(scene({rough}));
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.spins.emplace_back(0.1 * static_cast<double>(k), 1.0, -0.2 * static_cast<double>(k));
  io::write_snapshot(file, patch, {scene().resolved, {}});
  const Patch kept = initial_patch(scene({rough, "start.keep_fraction=0.4"}, file));
  std::filesystem::remove(file);
  REQUIRE(kept.size() > 5);
  REQUIRE(kept.size() < 25);
  REQUIRE(kept.spins.size() == kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k)
    CHECK((kept.spins[k] - patch.spins[kept.ids[k]]).norm() < 1e-14 * patch.spins.back().norm()); // in rad/s and back
}

TEST_CASE("doubts about a patch have numbers, and a large one none") {
  const std::vector<std::string> small = advice::warnings(scene());
  REQUIRE(small.size() == 2);
  CHECK(small[0].find("34 particles are few: one measurement of the velocity dispersion scatters by 12 %") == 0);
  CHECK(small[1].find("the box is 6.1 lambda_cr long along the orbit") == 0);
  CHECK(advice::warnings(scene(), scale_of(initial_patch(scene()))) == small);
  const std::vector<std::string> wakes = {"box.size_in_wavelengths=[4,4]", "particles.optical_depth=0.5",
                                          "particles.velocity_dispersion=3.5"};
  REQUIRE(advice::warnings(scene(wakes)).size() == 1);
  CHECK(advice::warnings(scene(wakes)).front() ==
        "the box is 4 lambda_cr long along the orbit: the viscosity of wakes goes with this length, whatever the "
        "width: at 4 it is some 15 % lower than at 8; a box of 4 x 8 will do");
  CHECK(advice::warnings(scene({"box.size_in_wavelengths=[4,8]", "particles.optical_depth=0.5",
                                "particles.velocity_dispersion=3.5"}))
            .empty());
  CHECK(advice::warnings(scene({"box.size_in_wavelengths=[8,8]", "particles.optical_depth=0.5",
                                "particles.velocity_dispersion=3.5"}))
            .empty());
}

// ε_cr of Goldreich & Tremaine (1978), sqrt(1 - 0.61/(1 + τ²)): 0.625 at τ 0, 0.834 at 1.
TEST_CASE("a restitution without an equilibrium is doubted, in a scene and of a start from a file") {
  CHECK(advice::critical_restitution(0.0) == doctest::Approx(std::sqrt(0.39)));
  CHECK(advice::critical_restitution(1.0) == doctest::Approx(0.8337).epsilon(1e-4));
  const std::string file = (std::filesystem::temp_directory_path() / "keeler-test-elastic.hdf").string();
  const std::vector<std::string> many = {"box.size=[100,100]", "particles.count=1600"}; // τ 0.5, ε_cr 0.7155
  io::write_snapshot(file, initial_patch(scene(many)), {scene(many).resolved, {}});
  const auto said = [&](std::vector<std::string> overrides) {
    const Scene from = scene(overrides, file);
    overrides.insert(overrides.end(), many.begin(), many.end());
    const auto of = [](const std::vector<std::string>& lines) {
      return std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
        return line.find(
                   "above 0.716 at an optical depth of 0.503 collisions lose less energy than the shear supplies") !=
               std::string::npos;
      });
    };
    const auto fresh = of(advice::warnings(scene(overrides)));
    CHECK(of(advice::warnings(from, scale_of(initial_patch(from)))) == fresh);
    return fresh;
  };
  const std::string constant = "collisions.restitution={{ law = \"constant\", value = {} }}";
  CHECK(said({fmt::format(fmt::runtime(constant), 0.71)}) == 0);
  CHECK(said({fmt::format(fmt::runtime(constant), 0.72)}) == 1);
  CHECK(said({fmt::format(fmt::runtime(constant), 1)}) == 1);
  CHECK(said({fmt::format(fmt::runtime(constant), 1), "collisions.restitution.max_coefficient=0.7"}) == 0);
  CHECK(said({fmt::format(fmt::runtime(constant), 1), "collisions.friction.tangential_restitution=0.5"}) == 0);
  CHECK(said({"collisions.restitution={ law = \"table\", table = [[1e-3, 0.2], [1e-2, 0.8]] }"}) == 1);
  CHECK(said({}) == 0); // frosty ice loses more, the faster it collides
  std::filesystem::remove(file);
}

TEST_CASE("a box of a few diameters is doubted, a moonlet's included") {
  const auto first = [](const std::vector<std::string>& overrides) {
    for (const std::string& line : advice::warnings(scene(overrides)))
      if (line.find("diameters") != std::string::npos)
        return line.substr(0, line.find(':'));
    return std::string();
  };
  CHECK(first({}).empty());
  CHECK(first({"box.size=[19, 40]", "particles.count=9"}) == "the box spans 9.5 diameters of its largest body");
  CHECK(first({"moonlet=[{ radius = 5.0, density = 600.0 }]", "box.size=[100, 100]"}).empty());
  CHECK(first({"moonlet=[{ radius = 5.0, density = 600.0 }]", "box.size=[100, 80]"}) ==
        "the box spans 8 diameters of its largest body");
}

TEST_CASE("starts far from any ring are doubted, and others are not, however they move") {
  const auto said = [](const Patch& patch) { return advice::warnings(scale_of(patch).start); };
  const auto of = [](const std::vector<std::string>& overrides) { return initial_patch(scene(overrides)); };
  const std::string many = "particles.optical_depth=0.1", wide = "box.size=[400,100]";
  // Streamlines that nearly cross, in a box many times wider than the particles; and a ball in synchronous rotation.
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {},
           {many, wide},
           {many, wide, "particles.streamlines.bunching=0.8", "particles.streamlines.waves=1"},
           {many, wide, "particles.streamlines.bunching=0.8", "particles.streamlines.waves=7"},
           {many, "particles.velocity_dispersion=20"}}) {
    const std::vector<std::string> lines = said(of(overrides));
    CAPTURE(overrides.size());
    CAPTURE((lines.empty() ? "" : lines.front()));
    CHECK(lines.empty());
  }
  const Patch ring = of({many, wide});
  const auto changed = [&](const std::function<void(Patch&, std::size_t)>& change) {
    Patch patch = ring;
    for (std::size_t k = 0; k < patch.size(); ++k)
      change(patch, k);
    const std::vector<std::string> lines = said(patch);
    REQUIRE(lines.size() == 1);
    return lines.front();
  };
  CHECK(changed([](Patch& p, std::size_t k) {
          p.velocities[k].y() += 1.5 * p.positions[k].x();
        }).find("the velocities lack the shear: dv_y/dx is ") == 0);
  CHECK(changed([](Patch& p, std::size_t k) {
          p.velocities[k].y() += 3.0 * p.positions[k].x();
        }).find("the shear of the velocities has the wrong sign") == 0);
  CHECK(changed([](Patch& p, std::size_t k) { p.velocities[k].x() *= 100.0; }).find("the velocity dispersion is") == 0);
  CHECK(changed([](Patch& p, std::size_t k) { p.positions[k].z() *= 200.0; }).find("the layer is") == 0);
  CHECK(changed([](Patch& p, std::size_t k) { p.radii[k] *= 1e-3; }).find("the optical depth is") == 0);
  CHECK(changed([](Patch& p, std::size_t k) {
          p.positions[k] *= 1e-3;
          p.velocities[k] *= 1e-3;
          p.radii[k] *= 1e-3;
        }).find("all particles are in the central 0.") == 0);
}

TEST_CASE("of a start from a file the kick interval is judged by the file's own density") {
  const std::string file = (std::filesystem::temp_directory_path() / "keeler-test-dense.hdf").string();
  const auto said_of = [&](double density) {
    io::write_snapshot(file, initial_patch(scene({fmt::format("particles.density={}", density)})),
                       {scene().resolved, {}});
    const Scene from = scene({"time.step=1e-3", "gravity.kick_every=20"}, file);
    const scene::PatchScale scale = scale_of(initial_patch(from));
    std::filesystem::remove(file);
    CHECK(scale.density == doctest::Approx(density).epsilon(1e-12));
    const std::vector<std::string> lines = advice::warnings(from, scale);
    return std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
      return line.find("kicks are 0.02 orbits apart: aggregates form at r_h 1.3, cannot rest") == 0;
    });
  };
  CHECK(said_of(1500.0) == 1);
  CHECK(said_of(600.0) == 0);
}

TEST_CASE("a share of a start file's particles is kept, the same ones of any state") {
  const std::string file = (std::filesystem::temp_directory_path() / "keeler-test-keep.hdf").string();
  const Scene whole = scene({"particles.count=3000", "box.size=[400, 400]"});
  const Patch patch = initial_patch(whole);
  io::write_snapshot(file, patch, {whole.resolved, {}});
  const auto kept = [&](const std::string& share, const std::string& seed) {
    return initial_patch(scene({"start.keep_fraction=" + share, "start.keep_seed=" + seed}, file));
  };
  CHECK(initial_patch(scene({}, file)).ids == patch.ids);
  CHECK(kept("1.0", "1").positions == patch.positions);
  const Patch third = kept("0.3", "1"), half = kept("0.5", "1");
  CHECK(std::fabs(static_cast<double>(third.size()) - 900.0) < 3.0 * std::sqrt(3000.0 * 0.3 * 0.7)); // binomial
  CHECK(std::includes(half.ids.begin(), half.ids.end(), third.ids.begin(), third.ids.end()));
  CHECK(kept("0.3", "2").ids != third.ids);
  for (std::size_t k = 0; k < third.size(); ++k) {
    const auto id = static_cast<std::size_t>(third.ids[k]); // its row in the whole patch
    CHECK(third.positions[k] == patch.positions[id]);
    CHECK(third.masses[k] == patch.masses[id]);
  }
  CHECK_THROWS_WITH_AS(kept("1e-9", "1"),
                       ("start.keep_fraction = 1e-9 keeps none of the 3000 particles of '" + file +
                        "'; raise it, or try another start.keep_seed")
                           .c_str(),
                       UsageError);
  std::filesystem::remove(file);
}

} // namespace start_file_test
