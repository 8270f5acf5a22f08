#include "near_forces.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::gravity {
namespace {

// Bounds of coordinates, m.
struct Bounds {
  Bounds(const double* values, std::size_t count) : low(values[0]), high(values[0]) {
    assert(count > 0);
    for (std::size_t k = 1; k < count; ++k) {
      low = std::min(low, values[k]);
      high = std::max(high, values[k]);
    }
  }
  double low, high;
};

// Returns the frame of a group of particles and makes them its targets, with zero accelerations.
NearGroup make_group(const ParticleRange& own, float scale, NearTargets& targets) {
  const double* const coordinates[] = {own.x, own.y, own.z};
  float* const relative[] = {targets.x, targets.y, targets.z};
  float* const gathered[] = {targets.ax, targets.ay, targets.az};
  double origin[3];
  NearGroup group{0.0, 0.0, 0.0, scale, {}};
  for (int axis = 0; axis < 3; ++axis) {
    const Bounds bounds(coordinates[axis], own.count);
    origin[axis] = 0.5 * (bounds.low + bounds.high);
    for (std::size_t k = 0; k < own.count; ++k) {
      relative[axis][k] = static_cast<float>(coordinates[axis][k] - origin[axis]) * scale;
      gathered[axis][k] = 0.0f;
      group.half[axis] = std::max(group.half[axis], std::fabs(relative[axis][k]));
    }
  }
  group.origin_x = origin[0];
  group.origin_y = origin[1];
  group.origin_z = origin[2];
  return group;
}

} // namespace

NearForces::NearForces(const ForceSplit& split, InstructionSet set) : kernels_(mesh_kernels(set)) {
  std::transform(split.inside().begin(), split.inside().end(), inside_.begin(),
                 [](double term) { return static_cast<float>(term); });
  const auto potential = split.potential();
  std::transform(potential.begin(), potential.end(), potential_.begin(),
                 [](double term) { return static_cast<float>(term); });
}

// Calls flush_list(sources) until it has seen all neighbours of the targets.
template<class Flush>
void NearForces::visit(const SortedParticles& sorted, const ShearingBox& box, double offset, double radius,
                       std::size_t begin, std::size_t count, NearTargets& targets, const Flush& flush_list) const {
  assert(count > 0 && count <= NearTargets::capacity && radius > 0.0);
  const ParticleRange own = sorted.range(begin, count);
  const Bounds x(own.x, count), y(own.y, count);
  NearGroup group = make_group(own, static_cast<float>(1.0 / radius), targets);
  const double origin_x = group.origin_x, origin_y = group.origin_y;

  const Tiling& tiling = sorted.tiling();
  const auto axis = [&](double size, std::size_t cells, std::size_t tiles) {
    return cells::CellAxis(size, size * static_cast<double>(tiling.side) / static_cast<double>(cells), tiles);
  };
  const cells::ShearedCells tiles{box, offset, axis(box.size_x, tiling.columns, tiling.tile_columns()),
                                  axis(box.size_y, tiling.rows, tiling.tile_rows())};
  NearSources sources;
  const auto flush = [&] {
    flush_list(sources);
    sources.count = 0;
  };
  const auto gather = [&](std::size_t first, std::size_t end) {
    while (first < end) {
      if (NearSources::capacity - sources.count < NearSources::capacity / 4)
        flush();
      const std::size_t part = std::min(end - first, NearSources::capacity / 4);
      kernels_.gather(sources, sorted.range(first, part), group);
      first += part;
    }
  };
  const auto circle = [&](double from) { // the rows of a column within the cut-off of the group
    const double gap = std::max({0.0, from - x.high, x.low - from - tiles.x.width});
    const double reach = std::sqrt(std::max(0.0, radius * radius - gap * gap));
    return std::pair(y.low - reach, y.high + reach);
  };
  tiles.visit_window(x.low - radius, x.high + radius, circle,
                     [&](std::size_t first, std::size_t last, const Image& image) {
                       group.origin_x = origin_x - image.nx * box.size_x;
                       group.origin_y = origin_y + image.nx * offset - image.ny * box.size_y;
                       gather(sorted.first(first), sorted.end(last));
                     });
  flush();
}

void NearForces::attract(const SortedParticles& sorted, const ShearingBox& box, double offset, double radius,
                         std::size_t begin, std::size_t count, NearTargets& targets) const {
  visit(sorted, box, offset, radius, begin, count, targets,
        [&](NearSources& sources) { kernels_.attract(targets, count, sources, inside_.data()); });
}

NearForces::Energy NearForces::energy(const SortedParticles& sorted, const ShearingBox& box, double offset,
                                      double radius, std::size_t begin, std::size_t count) const {
  const ParticleRange own = sorted.range(begin, count);
  NearTargets targets;
  visit(sorted, box, offset, radius, begin, count, targets,
        [&](NearSources& sources) { kernels_.energy(targets, count, sources, inside_.data(), potential_.data()); });
  Energy sum;
  for (std::size_t i = 0; i < count; ++i) {
    sum.potential += static_cast<double>(own.mass[i]) * static_cast<double>(targets.ax[i]);
    sum.stress += static_cast<double>(own.mass[i]) * static_cast<double>(targets.ay[i]);
  }
  return sum;
}

} // namespace keeler::gravity
