#include "lit_view.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/light/path.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::render {
namespace {

constexpr double display_gamma = 2.2;

struct Camera {
  Vec3 to_observer, right, up;

  explicit Camera(const light::Sight& sight) : to_observer(sight.observer.direction()) {
    const double b = sight.observer.elevation, phi = sight.observer.azimuth;
    up = Vec3(-std::sin(b) * std::cos(phi), -std::sin(b) * std::sin(phi), std::cos(b));
    right = up.cross(to_observer);
  }
};

} // namespace

LitLook usual_lit_look() {
  constexpr double degree = pi / 180.0;
  return {light::sight_at_phase({20.0 * degree, -60.0 * degree}, 20.0 * degree, 60.0 * degree), light::lambert_law(0.5),
          "lambert, albedo 0.5"};
}

double white_level(const LitLook& look) {
  const Vec3 observer = look.sight.observer.direction(), sun = look.sight.sun.direction();
  const Vec3 between = observer + sun;
  double highest = look.law->brightness(sun, observer, sun);
  if (between.norm() > 1e-6)
    highest = std::max(highest, look.law->brightness(between.normalized(), observer, sun));
  return 1.1 * highest;
}

std::array<double, 2> seen_direction(const Vec3& direction, const light::Sight& sight) {
  const Camera camera(sight);
  return {direction.dot(camera.right), direction.dot(camera.up)};
}

Raster lit_view(const Patch& patch, const LitLook& look, int width, int height, double pixels_per_metre) {
  assert(look.law && look.samples > 0 && pixels_per_metre > 0.0);
  const light::Tracer tracer(patch);
  const Camera camera(look.sight);
  const Vec3 sun = look.sight.sun.direction();
  const double face = camera.to_observer.z() > 0.0 ? tracer.cell().top() : tracer.cell().bottom();
  const double white = white_level(look);
  Raster view(width, height, {0.0, 0.0, 0.0});
  parallel_for(
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
      [&](std::size_t pixel) {
        const int i = static_cast<int>(pixel % static_cast<std::size_t>(width));
        const int j = static_cast<int>(pixel / static_cast<std::size_t>(width));
        RandomStream random(0, RandomPurpose::light, pixel);
        double sum = 0.0;
        for (int sample = 0; sample < look.samples; ++sample) {
          const double a = (i + random.uniform() - 0.5 * width) / pixels_per_metre;
          const double b = (0.5 * height - j - random.uniform()) / pixels_per_metre;
          const Vec3 on_screen = a * camera.right + b * camera.up;
          const Vec3 start = on_screen + (face - on_screen.z()) / camera.to_observer.z() * camera.to_observer;
          const light::PathLight path = follow_path(tracer, *look.law, sun, start, -camera.to_observer, random);
          sum += path.single + path.multiple;
        }
        const double shown = std::pow(std::clamp(sum / look.samples / white, 0.0, 1.0), 1.0 / display_gamma);
        view.pixel(i, j) = {shown, shown, shown};
      },
      64);
  return view;
}

} // namespace keeler::render
