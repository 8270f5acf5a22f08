#include "local.hpp"

#include <keeler/cells/grid.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <algorithm>
#include <cassert>
#include <vector>

namespace keeler::diagnostics {
namespace {

// Sums over a particle and its neighbours; velocities relative to the particle, to avoid cancellation.
struct Neighbourhood {
  double mass, mass_squares;
  Vec3 momentum = Vec3::Zero(), squares = Vec3::Zero();

  explicit Neighbourhood(double own_mass) : mass(own_mass), mass_squares(own_mass * own_mass) {}

  void add(double other_mass, const Vec3& velocity) {
    mass += other_mass;
    mass_squares += other_mass * other_mass;
    momentum += other_mass * velocity;
    squares += other_mass * velocity.cwiseProduct(velocity);
  }

  bool alone() const { return mass_squares == mass * mass; }

  Vec3 variance() const {
    const Vec3 mean = momentum / mass;
    return (squares / mass - mean.cwiseProduct(mean)).cwiseMax(0.0) / (1.0 - mass_squares / (mass * mass));
  }
};

struct MotionSums {
  double mass = 0.0, with_neighbours = 0.0;
  Vec3 squares = Vec3::Zero();

  MotionSums& operator+=(const MotionSums& more) {
    mass += more.mass;
    with_neighbours += more.with_neighbours;
    squares += more.squares;
    return *this;
  }
};

struct CrowdingSums {
  double mass = 0.0, discs = 0.0, cuts = 0.0;

  CrowdingSums& operator+=(const CrowdingSums& more) {
    mass += more.mass;
    discs += more.discs;
    cuts += more.cuts;
    return *this;
  }
};

cells::PeriodicGrid grid_of(const Patch& patch, double cell_size) {
  cells::PeriodicGrid grid;
  grid.build(patch.positions, patch.box, patch.offset, cell_size);
  return grid;
}

bool itself(std::size_t i, std::size_t j, const Image& image) {
  return i == j && image == Image{};
}

// Returns the fraction of the cells, all of one size, with an optical depth below thin_optical_depth.
double thin_fraction(const Patch& patch, int columns, int rows) {
  const ShearingBox& box = patch.box;
  std::vector<double> discs(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0);
  const auto cell = [](double x, double size, int cells) {
    return std::clamp(static_cast<int>((x / size + 0.5) * cells), 0, cells - 1);
  };
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3& p = patch.positions[k];
    const Vec3 inside = p + box.displacement(box.image_into_cell(p.x(), p.y(), patch.offset), patch.offset);
    const int index = cell(inside.x(), box.size_x, columns) * rows + cell(inside.y(), box.size_y, rows);
    discs[static_cast<std::size_t>(index)] += pi * patch.radii[k] * patch.radii[k];
  }
  const double limit = thin_optical_depth * box.area() / static_cast<double>(discs.size());
  const auto thin = std::count_if(discs.begin(), discs.end(), [&](double area) { return area < limit; });
  return static_cast<double>(thin) / static_cast<double>(discs.size());
}

} // namespace

double local_radius(const Patch& patch) {
  return std::max(3.0 * mean_radius(patch), critical_wavelength(patch) / 20.0);
}

LocalMotion local_motion(const Patch& patch, double radius) {
  assert(radius > 0.0);
  const cells::PeriodicGrid grid = grid_of(patch, radius);
  const auto sums = ordered_total<MotionSums>(patch.size(), [&](MotionSums& total, std::size_t i) {
    const Vec3 &position = patch.positions[i], velocity = peculiar_velocity(patch, i);
    Neighbourhood near(patch.masses[i]);
    grid.visit_near(position, radius, radius, [&](std::size_t j, const Image& image) {
      const Vec3 d = patch.positions[j] + patch.box.displacement(image, patch.offset) - position;
      if (d.squaredNorm() <= radius * radius && !itself(i, j, image))
        near.add(patch.masses[j], peculiar_velocity(patch, j) - velocity);
    });
    total.mass += patch.masses[i];
    if (near.alone())
      return;
    total.with_neighbours += patch.masses[i];
    total.squares += patch.masses[i] * near.variance();
  });
  LocalMotion motion;
  motion.fraction = sums.with_neighbours / sums.mass;
  if (sums.with_neighbours > 0.0)
    motion.dispersion = (sums.squares / sums.with_neighbours).cwiseSqrt();
  return motion;
}

double crowding_radius(const Patch& patch) {
  return std::max(6.0 * mean_radius(patch), critical_wavelength(patch) / 10.0);
}

Crowding crowding(const Patch& patch, double radius) {
  assert(radius > 0.0);
  const cells::PeriodicGrid grid = grid_of(patch, radius);
  const auto sums = ordered_total<CrowdingSums>(patch.size(), [&](CrowdingSums& total, std::size_t i) {
    const Vec3& position = patch.positions[i];
    double discs = 0.0, cuts = 0.0;
    grid.visit_near(position, radius, radius, [&](std::size_t j, const Image& image) {
      const Vec3 d = patch.positions[j] + patch.box.displacement(image, patch.offset) - position;
      if (d.x() * d.x() + d.y() * d.y() > radius * radius || itself(i, j, image))
        return;
      const double r = patch.radii[j], z = patch.positions[j].z();
      discs += r * r;
      cuts += std::max(0.0, r * r - z * z);
    });
    total.mass += patch.masses[i];
    total.discs += patch.masses[i] * discs;
    total.cuts += patch.masses[i] * cuts;
  });
  const double side = std::sqrt(pi) * radius;
  const auto cells = [&](double size) { return static_cast<int>(std::clamp(std::round(size / side), 1.0, 0x1p14)); };
  const int columns = cells(patch.box.size_x), rows = cells(patch.box.size_y);
  Crowding result;
  result.optical_depth = sums.discs / (sums.mass * radius * radius);
  result.filling = sums.cuts / (sums.mass * radius * radius);
  result.thin_area = thin_fraction(patch, columns, rows);
  result.cell_x = patch.box.size_x / columns;
  result.cell_y = patch.box.size_y / rows;
  return result;
}

} // namespace keeler::diagnostics
