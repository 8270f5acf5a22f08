#include <keeler/render/colour_field.hpp>
#include <keeler/render/patch_picture.hpp>

#include "picture.hpp"
#include "unit/diagnostics/states.hpp"

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <cmath>
#include <numeric>

namespace colour_field_test {

using namespace keeler;
using namespace keeler::render;

namespace {

const ShearingBox box{100.0, 60.0, 1.5, 0.0};

Patch three() { // two of them touch
  Patch patch;
  patch.box = box;
  patch.offset = 13.7;
  patch.orbital_frequency = 2e-4;
  for (const Vec3& place : {Vec3(-20.0, 0.0, 0.0), Vec3(10.0, 5.0, 0.0), Vec3(13.0, 5.0, 0.0)}) {
    patch.ids.push_back(patch.size());
    patch.positions.push_back(place);
    patch.velocities.emplace_back(0.0, -1.5 * place.x(), 0.0);
    patch.radii.push_back(patch.size() == 1 ? 2.0 : 1.5);
    patch.masses.push_back(2e4);
  }
  patch.velocities[1] += Vec3(3.0, 4.0, 0.0);
  return patch;
}

} // namespace

TEST_CASE("a particle has the density of the map where it, or its image in the box, is") {
  Patch patch = three();
  for (int k = 0; k < 400; ++k) { // an even background
    patch.ids.push_back(patch.size());
    patch.positions.emplace_back(-47.5 + 5.0 * (k % 20), -28.5 + 3.0 * (k / 20), 0.0);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(1.0);
    patch.masses.push_back(15.0);
  }
  const std::vector<double> inside = particle_densities(patch);
  for (const double value : inside)
    CHECK(value >= 0.0);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(inside[k] > 5.0 * inside[3]); // the heavy ones, and one of the background far away
  for (const int n : {-1, 1})
    for (const int m : {-1, 0, 2}) {
      Patch moved = patch;
      for (std::size_t k = 0; k < moved.size(); k += 3)
        moved.positions[k] += Vec3(n * box.size_x, m * box.size_y - n * patch.offset, 0.0);
      const std::vector<double> values = particle_densities(moved);
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(values[k] == doctest::Approx(inside[k]).epsilon(1e-9));
    }
}

TEST_CASE("the fields of a picture have their values and units") {
  Patch patch = three();
  CHECK(field_values(patch, ColourField::size) == patch.radii);
  const std::vector<double> speeds = field_values(patch, ColourField::speed);
  CHECK(speeds[0] == doctest::Approx(0.0)); // it moves with the shear
  CHECK(speeds[1] == doctest::Approx(1.0)); // |(3, 4)| m per radian × 2e-4 /s = 1 mm/s
  CHECK(field_values(patch, ColourField::cluster) == std::vector<double>{1.0, 2.0, 2.0});
  CHECK_THROWS_WITH_AS(field_values(patch, ColourField::spin), doctest::Contains("smooth"), UsageError);
  patch.spins = {Vec3(1, 0, 0.5), Vec3(0, 0, -1), Vec3(0, 0, 0)};
  CHECK(field_values(patch, ColourField::spin) == std::vector<double>{0.5, -1.0, 0.0});
  CHECK(colour_field_named("density") == ColourField::density);
  CHECK_THROWS_WITH_AS(colour_field_named("mass"), doctest::Contains("size, speed, spin"), UsageError);
}

TEST_CASE("a colour bar spans nearly all values") {
  std::vector<double> values(1001);
  std::iota(values.begin(), values.end(), 0.0);
  const ColourRange linear = colour_range(values, ColourField::speed);
  CHECK(linear.low == 10.0);
  CHECK(linear.high == 990.0);
  CHECK(linear.position(500.0) == 0.5);
  CHECK(linear.position(-5.0) == 0.0);
  CHECK(linear.position(1e6) == 1.0);
  const ColourRange logarithmic = colour_range({1.0, 10.0, 100.0}, ColourField::cluster);
  CHECK(logarithmic.position(10.0) == doctest::Approx(0.5));
  CHECK(logarithmic.middle() == doctest::Approx(10.0));
  CHECK(colour_range({2.0, 2.0}, ColourField::size).position(2.0) == 0.5); // particles of one size
}

TEST_CASE("the map of surface density holds the mass of the patch at any shear offset") {
  for (const double offset : {0.0, 13.7, 59.0}) {
    Patch patch = test::uniform(box, offset, 5000, 3);
    const std::vector<double> values = field_values(patch, ColourField::density);
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    CHECK(
        mean ==
        doctest::Approx(diagnostics::surface_density(patch)).epsilon(1e-12)); // the cloud-in-cell weights conserve mass
  }
}

TEST_CASE("the map of surface density goes on across the sheared edge") {
  Patch patch = test::uniform(box, 13.7, 5000, 3);
  patch.positions[0] = {49.9, 2.0, 0.0};
  patch.masses[0] *= 1000.0;
  const test::TemporaryPng file("density");
  PictureOptions options;
  options.width = 800;
  options.colour = ColourField::density;
  render_patch(patch, file.path(), options);
  const test::Picture picture(file.path());
  const PictureLayout layout = layout_of(patch, options);
  const PixelFrame& f = layout.top_view;
  const auto warmth = [&](int column, double y) {
    return picture.warmth(column, f.top + static_cast<int>(0.5 * f.height - layout.pixels_per_metre * y));
  };
  CHECK(warmth(f.left + f.width - 1, 2.0) > 100.0);
  CHECK(warmth(f.left, 15.7) > 100.0); // x − 100, y + 13.7
  CHECK(warmth(f.left, 2.0) < 50.0);   // where it would be without the shear
}

TEST_CASE("colours show the field; the bar lies below the views") {
  const Patch patch = three();
  PictureOptions options;
  options.width = 800;
  const PictureLayout plain = layout_of(patch, options);
  options.colour = ColourField::size;
  const PictureLayout layout = layout_of(patch, options);
  CHECK(layout.height == plain.height + 27);
  CHECK(layout.top_view.height == plain.top_view.height);
  const test::TemporaryPng file("field");
  render_patch(patch, file.path(), options);
  const test::Picture picture(file.path());
  const auto warmth = [&](const Vec3& p) {
    const PixelFrame& f = layout.top_view;
    return picture.warmth(f.left + static_cast<int>(0.5 * f.width + layout.pixels_per_metre * p.x()),
                          f.top + static_cast<int>(0.5 * f.height - layout.pixels_per_metre * p.y()));
  };
  CHECK(warmth(patch.positions[0]) > 100.0); // the largest: yellow
  CHECK(warmth(patch.positions[2]) < -30.0); // the smallest: violet
  const int bar = layout.foot + 40;          // 72/2 + half of 16/2
  CHECK(picture.warmth(layout.edge_view.left + 3, bar) < -30.0);
  CHECK(picture.warmth(layout.edge_view.left + 206, bar) > 100.0);
}

TEST_CASE("an oblique view shortens lengths along the orbit and lifts what is high") {
  Patch patch = three();
  patch.positions[0].z() = 12.0;
  patch.positions[1] = {40.0, 29.5, 11.0}; // above the frame, so its image at y − L_y is visible below
  PictureOptions options;
  options.width = 800;
  options.oblique = true;
  const PictureLayout layout = layout_of(patch, options);
  const double sine = std::sin(layout.elevation), cosine = std::cos(layout.elevation);
  CHECK(layout.elevation == doctest::Approx(35.0 / 180.0 * M_PI));
  CHECK(layout.top_view.height == doctest::Approx(layout.pixels_per_metre * box.size_y * sine).epsilon(0.01));
  const test::TemporaryPng file("oblique");
  render_patch(patch, file.path(), options);
  const test::Picture picture(file.path());
  const auto brightness = [&](double x, double y, double z) {
    const PixelFrame& f = layout.top_view;
    return picture.brightness(f.left + static_cast<int>(0.5 * f.width + layout.pixels_per_metre * x),
                              f.top +
                                  static_cast<int>(0.5 * f.height - layout.pixels_per_metre * (y * sine + z * cosine)));
  };
  CHECK(brightness(-20.0, 0.0, 12.0) > 60.0);
  CHECK(brightness(-20.0, 0.0, 0.0) < 20.0);
  CHECK(brightness(13.0, 5.0, 0.0) > 60.0);
  CHECK(brightness(40.0, 29.5 - box.size_y, 11.0) > 60.0);
  options.colour = ColourField::density;
  CHECK_THROWS_WITH_AS(render_patch(patch, file.path(), options), doctest::Contains("seen from above"), UsageError);
}

TEST_CASE("a light page is white around views whose particles look the same") {
  const Patch patch = three();
  const test::TemporaryPng dark_file("dark"), light_file("light");
  PictureOptions options;
  options.width = 400;
  render_patch(patch, dark_file.path(), options);
  options.theme = PictureTheme::light;
  render_patch(patch, light_file.path(), options);
  const test::Picture dark(dark_file.path()), light(light_file.path());
  CHECK(dark.brightness(2, 2) < 20.0);
  CHECK(light.brightness(2, 2) == 255.0);
  const PixelFrame f = layout_of(patch, options).top_view;
  for (int y = f.top; y < f.top + f.height; y += 7)
    for (int x = f.left; x < f.left + f.width; x += 7)
      REQUIRE(dark.brightness(x, y) == light.brightness(x, y));
}

TEST_CASE("pictures with one scale have one frame") {
  Patch low = three(), high = three();
  high.positions[0].z() = 15.0;
  PictureOptions options;
  options.colour = ColourField::speed;
  PictureScale scale = picture_scale(low, options.colour);
  scale.include(picture_scale(high, options.colour));
  CHECK(scale.half_height >= picture_scale(low, options.colour).half_height);
  options.scale = scale;
  CHECK(layout_of(low, options).height == layout_of(high, options).height);
  CHECK(layout_of(low, options).half_height == layout_of(high, options).half_height);
}

} // namespace colour_field_test
