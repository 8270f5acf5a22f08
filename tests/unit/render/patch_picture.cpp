#include <keeler/render/patch_picture.hpp>

#include "picture.hpp"

#include <keeler/core/error.hpp>

#include <algorithm>
#include <cmath>

namespace patch_picture_test {

using namespace keeler;
using namespace keeler::render;
using keeler::test::Picture;
using keeler::test::TemporaryPng;

namespace {

// Spheres of radius 2 m at rest in a box of 100 × 60 m whose columns are 20 m behind each other.
Patch spheres(const std::vector<Vec3>& places) {
  Patch patch;
  patch.box = {100.0, 60.0, 1.5, 0.0};
  patch.offset = 20.0;
  patch.orbital_frequency = 1.3175e-4;
  for (const Vec3& place : places) {
    patch.ids.push_back(patch.size());
    patch.positions.push_back(place);
    patch.velocities.emplace_back(0.0, -1.5 * place.x(), 0.0);
    patch.radii.push_back(2.0);
    patch.masses.push_back(2e4);
  }
  return patch;
}

PictureOptions named(const std::string& title, int width) {
  PictureOptions options;
  options.title = title;
  options.width = width;
  return options;
}

constexpr double bright = 90.0, dark = 10.0;

// Returns the brightness at (x, y) of the top view or (x, z) of the edge view.
double shown(const Picture& picture, const PixelFrame& f, const PictureLayout& layout, double x, double up) {
  const int column = f.left + static_cast<int>(0.5 * f.width + layout.pixels_per_metre * x);
  const int row = f.top + static_cast<int>(0.5 * f.height - layout.pixels_per_metre * up);
  return picture.brightness(column, row);
}

} // namespace

TEST_CASE("a picture shows the particles where they are, before a dark sky") {
  const TemporaryPng file("patch");
  const Patch patch = spheres({{-20.0, 12.0, 1.0}, {30.0, -10.0, -3.0}});
  const PictureOptions options = named("Two spheres", 800);
  render_patch(patch, file.path(), options);
  const Picture picture(file.path());
  const PictureLayout layout = layout_of(patch, options);
  CHECK(picture.width() == 800);
  CHECK(picture.height() == layout.height);
  CHECK(layout.top_view.width == std::lround(100.0 * layout.pixels_per_metre));
  CHECK(layout.top_view.height == std::lround(60.0 * layout.pixels_per_metre));
  CHECK(layout.edge_view.left == layout.top_view.left);
  CHECK(layout.edge_view.width == layout.top_view.width);

  CHECK(shown(picture, layout.top_view, layout, -20.0, 12.0) > bright);
  CHECK(shown(picture, layout.top_view, layout, -21.7, 12.0) > 20.0); // still inside the sphere
  CHECK(shown(picture, layout.top_view, layout, 30.0, -10.0) > 40.0); // low ones are darker
  for (const Vec3& empty : {Vec3(0, 0, 0), Vec3(-17.0, 12.0, 0), Vec3(30.0, 10.0, 0), Vec3(-49.0, -29.0, 0)})
    CHECK(shown(picture, layout.top_view, layout, empty.x(), empty.y()) < dark);
  CHECK(shown(picture, layout.edge_view, layout, -20.0, 1.0) > 40.0);
  CHECK(shown(picture, layout.edge_view, layout, 30.0, -3.0) > 40.0);
  CHECK(shown(picture, layout.edge_view, layout, 0.0, 0.0) < dark);
}

TEST_CASE("axes have marks at round lengths from the middle") {
  const TemporaryPng file("axes");
  const Patch patch = spheres({{0.0, 0.0, 0.0}});
  const PictureOptions options = named("Axes", 1600);
  render_patch(patch, file.path(), options);
  const Picture picture(file.path());
  const PictureLayout layout = layout_of(patch, options);
  const PixelFrame& f = layout.top_view;
  // The brightest of three pixels: a tick is 1.5 pixels wide, at a fractional position.
  const auto brightest = [&](double x, double y, int aside, int up) {
    double most = 0.0;
    for (const int k : {-1, 0, 1})
      most = std::max(most, picture.brightness(static_cast<int>(x) + k * aside, static_cast<int>(y) + k * up));
    return most;
  };
  const auto below = [&](double metres) {
    return brightest(f.left + 0.5 * f.width + metres * layout.pixels_per_metre, f.top + f.height + 5, 1, 0);
  };
  const auto beside = [&](double metres) {
    return brightest(f.left - 5, f.top + 0.5 * f.height - metres * layout.pixels_per_metre, 0, 1);
  };
  for (const double metres : {-40.0, -10.0, 0.0, 20.0, 40.0})
    CHECK(below(metres) > 50.0);
  for (const double metres : {-25.0, 0.0, 10.0, 25.0}) // 5 m apart
    CHECK(beside(metres) > 50.0);
  for (const double metres : {-35.0, 5.0, 12.0})
    CHECK(below(metres) < 30.0);
  for (const double metres : {-12.0, 2.5})
    CHECK(beside(metres) < 30.0);
}

TEST_CASE("images fill the edges, across the shear as well") {
  const TemporaryPng file("images");
  // The first reaches over the outer edge, 20 m farther back there; the second over the upper edge; the third is
  // outside the box because of its eccentricity, and is visible as the image inside.
  const Patch patch = spheres({{49.5, -5.0, 0.0}, {10.0, 29.5, 0.0}, {-60.0, 0.0, 0.0}});
  const PictureOptions options = named("Images", 1600);
  render_patch(patch, file.path(), options);
  const Picture picture(file.path());
  const PictureLayout layout = layout_of(patch, options);
  const auto seen = [&](double x, double y) { return shown(picture, layout.top_view, layout, x, y); };
  CHECK(seen(49.5, -5.0) > bright);
  CHECK(seen(-49.5, 15.0) > 40.0); // its image: x − 100, y + 20
  CHECK(seen(-49.5, -5.0) < dark); // where it would be without the shear
  CHECK(seen(10.0, 29.5) > bright);
  CHECK(seen(10.0, -29.5) > 40.0);
  CHECK(seen(40.0, -20.0) > bright); // x + 100, y − 20
}

TEST_CASE("the higher particle lies in front, whatever the order in memory") {
  const TemporaryPng one("front"), two("back");
  Patch patch = spheres({{0.0, 0.0, 5.0}, {1.0, 0.0, -5.0}});
  const PictureOptions options = named("Order", 800);
  render_patch(patch, one.path(), options);
  std::swap(patch.positions[0], patch.positions[1]);
  std::swap(patch.ids[0], patch.ids[1]);
  render_patch(patch, two.path(), options);
  CHECK(test::bytes_of(one.path()) == test::bytes_of(two.path()));
  const Picture picture(one.path());
  const PictureLayout layout = layout_of(patch, options);
  CHECK(shown(picture, layout.top_view, layout, 0.7, 0.0) > bright); // both are here: the high one is bright
}

TEST_CASE("many particles smaller than a pixel keep their light") {
  const TemporaryPng file("small");
  Patch patch = spheres({});
  for (int k = 0; k < 20'000; ++k) { // on a lattice, covering 10 % of the sky
    patch.ids.push_back(patch.size());
    const int column = k % 200, row = k / 200;
    patch.positions.emplace_back(-50.0 + 0.5 * column + 0.25, -30.0 + 0.6 * row + 0.3, 0.0);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(0.098);
    patch.masses.push_back(2.0);
  }
  const PictureOptions options = named("Dust", 400);
  render_patch(patch, file.path(), options);
  const Picture picture(file.path());
  const PixelFrame f = layout_of(patch, options).top_view;
  double sum = 0.0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      sum += picture.brightness(f.left + x, f.top + y);
  const double mean = sum / (f.width * f.height);
  CHECK(mean > 8.0);  // a tenth of a lit sphere's mean of about 130, less shadows
  CHECK(mean < 25.0); // a radius rounded up to a pixel would cover ten times as much
}

TEST_CASE("a picture that cannot be written is an input/output error, an empty patch a usage error") {
  const Patch patch = spheres({{0.0, 0.0, 0.0}});
  for (const char* path : {"/nowhere/at/all.png", "/dev/full"}) {
    CAPTURE(path);
    CHECK_THROWS_AS(render_patch(patch, path, named("No room", 400)), IoError);
  }
  CHECK_THROWS_AS(render_patch(spheres({}), "never.png"), UsageError);
}

} // namespace patch_picture_test
