// Frames against a plain reading of the particles, one by one.
#include "encoder.hpp"

#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace encoder_test {

using namespace keeler;
using namespace keeler::live_view;
using render::ColourField;

namespace {

const char* const small = R"(
planet.preset = "saturn-a-ring"
box.size = [60.0, 45.0]
particles = { count = 301, density = 450.0, sizes = { law = "power", min = 0.5, max = 2.0, exponent = 3.0 } }
collisions = { restitution = { law = "constant", value = 0.5 }, friction = { tangential_restitution = 0.2 } }
time = { step = 2e-3, end = 1.0 }
)";

struct Shown {
  Vec3 place;
  double radius;
  int tone;
};

// Reads a frame as the page does.
std::vector<Shown> decoded(const Frame& frame) {
  const auto count = frame.about["count"].get<std::size_t>();
  const std::vector<double> low = frame.about["low_m"], unit = frame.about["unit_m"];
  REQUIRE(frame.data->size() == 9 * count);
  std::vector<Shown> all;
  for (std::size_t k = 0; k < count; ++k) {
    std::uint16_t numbers[4];
    std::memcpy(numbers, frame.data->data() + 8 * k, sizeof numbers);
    all.push_back({Vec3(low[0] + unit[0] * numbers[0], low[1] + unit[1] * numbers[1], low[2] + unit[2] * numbers[2]),
                   unit[3] * numbers[3], static_cast<unsigned char>((*frame.data)[8 * count + k])});
  }
  return all;
}

// Compares a frame with the particles of a patch that it shows, whose order is that of `ids`.
void check_frame(const Frame& frame, const Patch& patch, const std::vector<std::uint64_t>& ids,
                 const std::vector<double>& values, bool logarithmic) {
  const std::vector<double> unit = frame.about["unit_m"];
  const std::vector<double> ends = frame.about["range"];
  const std::vector<Shown> shown = decoded(frame);
  REQUIRE(shown.size() == ids.size());
  const render::ColourRange range{ends[0], ends[1], logarithmic};
  double worst = 0.0, worst_tone = 0.0;
  for (std::size_t j = 0; j < ids.size(); ++j) {
    const auto k =
        static_cast<std::size_t>(std::lower_bound(patch.ids.begin(), patch.ids.end(), ids[j]) - patch.ids.begin());
    for (int axis = 0; axis < 3; ++axis)
      worst = std::max(worst, std::abs(shown[j].place[axis] - patch.positions[k][axis]) /
                                  unit[static_cast<std::size_t>(axis)]);
    worst = std::max(worst, std::abs(shown[j].radius - patch.radii[k]) / unit[3]);
    worst_tone = std::max(worst_tone, std::abs(shown[j].tone - 255.0 * range.position(values[k])));
  }
  CHECK(worst < 0.6);      // half a unit, and the rounding of single precision
  CHECK(worst_tone < 1.6); // half a unit, and one of the table where its parts are coarse
}

} // namespace

TEST_CASE("a frame of a simulation shows its particles, their sizes and colours, at each step") {
  const Scene scene = parse_scene(small, "small");
  Simulation simulation(scene, initial_patch(scene));
  for (const ColourField field : {ColourField::height, ColourField::size, ColourField::speed, ColourField::spin,
                                  ColourField::cluster, ColourField::density}) {
    Encoder encoder(field);
    for (int step = 0; step < 5; ++step) {
      CAPTURE(static_cast<int>(field));
      CAPTURE(step);
      for (int k = 0; k < 20; ++k)
        simulation.advance();
      const Frame frame = encoder.encode(simulation, scene);
      const Patch patch = simulation.patch();
      const std::vector<double> values =
          field == ColourField::density ? render::particle_densities(patch) : field_values(patch, field);
      const bool whole = field == ColourField::size || field == ColourField::cluster;
      const bool in_order = field == ColourField::cluster || field == ColourField::density;
      check_frame(frame, patch, in_order ? patch.ids : simulation.state().particles.ids, values, whole);
      CHECK(frame.about["of"] == 301);
      CHECK(frame.about["orbits"] == simulation.orbits());
    }
  }
}

TEST_CASE("a frame that was given away does not change while the next ones are made") {
  const Scene scene = parse_scene(small, "small");
  Simulation simulation(scene, initial_patch(scene));
  Encoder encoder(ColourField::speed);
  std::vector<Frame> frames;
  std::vector<std::string> bytes;
  for (int k = 0; k < 6; ++k) {
    simulation.advance();
    frames.push_back(encoder.encode(simulation, scene));
    bytes.push_back(*frames.back().data);
  }
  for (std::size_t k = 0; k < frames.size(); ++k)
    CHECK(*frames[k].data == bytes[k]);
  CHECK(bytes[0] != bytes[5]);
  frames.clear();
  const std::string* const reused = encoder.encode(simulation, scene).data.get();
  CHECK(reused == encoder.encode(simulation, scene).data.get());
}

TEST_CASE("of many particles a frame shows the same part, evenly by id") {
  Patch patch;
  patch.box = ShearingBox{100.0, 100.0, 1.5, 0.0};
  patch.orbital_frequency = 1e-4;
  for (std::size_t k = 0; k < 2 * max_shown + 1; ++k) {
    patch.ids.push_back(k);
    patch.positions.emplace_back(1e-3 * static_cast<double>(k % 1000), 0.0, 0.0);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(1.0);
    patch.masses.push_back(1.0);
  }
  const Frame frame = Encoder(ColourField::height).encode(patch);
  CHECK(frame.about["of"] == 2 * max_shown + 1);
  std::vector<std::uint64_t> ids;
  for (std::uint64_t id = 0; id < patch.size(); id += 3)
    ids.push_back(id);
  check_frame(frame, patch, ids, std::vector<double>(patch.size(), 0.0), false);
}

TEST_CASE("a single particle, and particles in a plane, have frames") {
  Patch patch;
  patch.box = ShearingBox{100.0, 100.0, 1.5, 0.0};
  patch.orbital_frequency = 1e-4;
  for (std::uint64_t id : {7U, 9U}) { // ids of another tool
    patch.ids.push_back(id);
    patch.positions.emplace_back(5.0, -3.0 + 0.5 * static_cast<double>(id), 0.0);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(1.5);
    patch.masses.push_back(1.0);
    for (const ColourField field : {ColourField::height, ColourField::size, ColourField::speed})
      check_frame(Encoder(field).encode(patch), patch, patch.ids, field_values(patch, field),
                  field == ColourField::size);
  }
}

} // namespace encoder_test
