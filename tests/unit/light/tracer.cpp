#include "tracer.hpp"

#include "states.hpp"

#include <keeler/core/random.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <limits>

namespace light_tracer_test {

using namespace keeler;
using namespace keeler::light;

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct Met {
  double path = none;    // to the first sphere
  double nearest = none; // smallest |distance of a sphere's centre from the ray − its radius| ahead
  std::size_t particle = std::size_t(-1);
};

// Brute force in double precision: all spheres and all images that the ray can reach within the layer.
Met met_by_all(const Patch& patch, const Vec3& origin, const Vec3& d, int most) {
  Met met;
  for (int nx = -most; nx <= most; ++nx)
    for (int ny = -most; ny <= most; ++ny) {
      const Vec3 image = patch.box.displacement({nx, ny}, patch.offset) - origin;
      for (std::size_t k = 0; k < patch.size(); ++k) {
        const Vec3& p = patch.positions[k];
        const double x = p.x() + image.x(), y = p.y() + image.y(), z = p.z() + image.z(), r = patch.radii[k];
        const double closest = x * d.x() + y * d.y() + z * d.z();
        if (closest <= -r)
          continue;
        const double u = x - closest * d.x(), v = y - closest * d.y(), w = z - closest * d.z();
        const double across = std::sqrt(u * u + v * v + w * w);
        met.nearest = std::min(met.nearest, std::fabs(across - r));
        if (across >= r)
          continue;
        const double path = closest - std::sqrt(r * r - across * across);
        if (path >= 0.0 && path < met.path)
          met.path = path, met.particle = k;
      }
    }
  return met;
}

Vec3 random_direction(RandomStream& random) {
  const double z = 2.0 * random.uniform() - 1.0, phi = two_pi * random.uniform(), s = std::sqrt(1.0 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

} // namespace

TEST_CASE("a ray meets what it meets among all spheres and images in space") {
  const double sizes[][2] = {{24.0, 17.0}, {9.0, 31.0}, {5.0, 5.0}};
  for (const auto& size : sizes)
    for (const double offset : {0.0, 4.3, 0.93 * size[1]}) {
      CAPTURE(size[0]);
      CAPTURE(offset);
      Patch patch = test::dense_layer(size[0], size[1], 6.0, 12, 3, offset);
      patch.positions[3] += patch.box.displacement({1, -1}, offset); // outside the cell by its eccentricity
      const Tracer tracer(patch);
      RandomStream random(5, RandomPurpose::sample, 0);
      std::size_t wrong = 0, hits = 0, tested = 0;
      while (tested < 800) {
        const Vec3 origin((random.uniform() - 0.5) * size[0], (random.uniform() - 0.5) * size[1],
                          tracer.cell().bottom() + random.uniform() * (tracer.cell().top() - tracer.cell().bottom()));
        const Vec3 d = random_direction(random);
        if (std::fabs(d.z()) < 0.12) // the reach of the brute force
          continue;
        bool inside = false;
        for (const CellSphere& sphere : tracer.cell().spheres())
          inside = inside || (sphere.centre - origin).norm() < sphere.radius + 1e-4;
        const Met met = met_by_all(patch, origin, d, 14);
        if (inside || met.nearest < 1e-5)
          continue;
        ++tested;
        const std::optional<Hit> hit = tracer.first_hit(origin, d);
        wrong += hit.has_value() != (met.particle != std::size_t(-1)) ? 1 : 0;
        wrong += tracer.blocked(origin, d) != hit.has_value() ? 1 : 0;
        if (!hit)
          continue;
        ++hits;
        wrong += hit->particle != met.particle ? 1 : 0;
        wrong += std::fabs(hit->normal.norm() - 1.0) > 1e-12 ? 1 : 0;
        wrong += hit->normal.dot(d) > 1e-6 ? 1 : 0;
        const Vec3 exact = tracer.cell().inside(origin + met.path * d);
        // the same point, or an image of it across a face
        double apart = none;
        for (int nx = -1; nx <= 1; ++nx)
          for (int ny = -2; ny <= 2; ++ny)
            apart = std::min(apart, (exact + patch.box.displacement({nx, ny}, offset) - hit->point).norm());
        wrong += apart > 1e-9 ? 1 : 0;
      }
      CHECK(wrong == 0);
      CHECK(hits > 20);
    }
}

TEST_CASE("Embree's own queries count the rays that are blocked, where no ray crosses a face") {
  const Patch patch = test::dense_layer(24.0, 17.0, 6.0, 12, 3, 4.3);
  const Tracer tracer(patch);
  RandomStream random(5, RandomPurpose::sample, 0);
  std::vector<Vec3> origins;
  std::size_t blocked = 0;
  for (int k = 0; k < 1003; ++k) { // no multiple of 16
    origins.emplace_back((random.uniform() - 0.5) * 24.0, (random.uniform() - 0.5) * 17.0, tracer.cell().top());
    blocked += tracer.blocked(origins.back(), -Vec3::UnitZ()) ? 1 : 0;
  }
  CHECK(blocked > 20);
  CHECK(tracer.count_blocked_in_cell(origins, -Vec3::UnitZ(), false) == blocked);
  CHECK(tracer.count_blocked_in_cell(origins, -Vec3::UnitZ(), true) == blocked);
}

TEST_CASE("single precision errs only for rays that graze a sphere, within a bound by the size of the cell") {
  // A cell of 20 km with spheres of 1 m, and long rays that pass their limbs at distances about the rounding.
  const double side = 20000.0;
  Patch patch = test::random_layer(1.0, 1e-3, 300, 8);
  RandomStream random(6, RandomPurpose::sample, 0);
  patch.box.size_x = patch.box.size_y = side;
  for (Vec3& p : patch.positions)
    p = Vec3((random.uniform() - 0.5) * side, (random.uniform() - 0.5) * side, (random.uniform() - 0.5) * 2000.0);
  const Tracer tracer(patch);
  const double bound = single_precision_bound(tracer.cell());
  CHECK(bound < 0.006);
  std::size_t wrong_within = 0, wrong_beyond = 0, tested = 0;
  double worst = 0.0;
  while (tested < 6000) {
    const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(patch.size()));
    const Vec3 d = random_direction(random), across = d.cross(random_direction(random)).normalized();
    const double from_limb = (2.0 * random.uniform() - 1.0) * 2.0 * bound;
    const Vec3 target = patch.positions[k] + (patch.radii[k] + from_limb) * across;
    const Vec3 origin = target - (100.0 + 12000.0 * random.uniform()) * d;
    if (std::fabs(d.z()) < 0.1 || tracer.cell().inside(origin) != origin || origin.z() < tracer.cell().bottom() ||
        origin.z() > tracer.cell().top())
      continue;
    ++tested;
    const Met met = met_by_all(patch, origin, d, 2);
    if (tracer.blocked(origin, d) == (met.particle != std::size_t(-1)))
      continue;
    ++(met.nearest <= bound ? wrong_within : wrong_beyond);
    worst = std::max(worst, met.nearest);
  }
  CAPTURE(worst);
  CAPTURE(bound);
  CHECK(wrong_beyond == 0);
  CHECK(wrong_within > 0); // rounding shows
  CHECK(worst > 0.05 * bound);
}

TEST_CASE("a ray that leaves a sphere does not meet it again") {
  const Patch patch = test::dense_layer(300.0, 40.0, 6.0, 1, 3, 7.0);
  const Tracer tracer(patch);
  RandomStream random(7, RandomPurpose::sample, 0);
  const Vec3 centre = tracer.cell().spheres().front().centre;
  const double radius = patch.radii[0];
  int tested = 0;
  while (tested < 20000) {
    const Vec3 normal = random_direction(random), d = random_direction(random);
    if (std::fabs(d.z()) < 0.2 || d.dot(normal) < 0.0)
      continue;
    ++tested;
    const Vec3 start = tracer.leaving({centre + radius * normal, normal, radius, 0});
    CHECK(!tracer.blocked(start, d));
    CHECK((start - centre).norm() == doctest::Approx(radius).epsilon(1e-3));
  }
}

} // namespace light_tracer_test
