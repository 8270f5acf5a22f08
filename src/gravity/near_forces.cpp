#include "near_forces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace keeler {
namespace {

// Bounds of some places, m.
struct Bounds {
  Bounds(const double* values, std::size_t count) : low(values[0]), high(values[0]) {
    for (std::size_t k = 1; k < count; ++k) {
      low = std::min(low, values[k]);
      high = std::max(high, values[k]);
    }
  }
  double low, high;
};

// What std::floor gives, without a call.
double floor_of(double value) {
  const auto whole = static_cast<double>(static_cast<std::int64_t>(value));
  return whole > value ? whole - 1.0 : whole;
}

// The boxes along one axis, each of so many tiles.
struct Axis {
  Axis(double box_size, std::size_t cells, std::size_t side, std::size_t tile_count)
      : low(-0.5 * box_size), per_box(1.0 / box_size),
        tile_width(box_size * static_cast<double>(side) / static_cast<double>(cells)), per_tile(1.0 / tile_width),
        tiles(tile_count) {}

  double box(double coordinate) const { return floor_of((coordinate - low) * per_box); }

  // The first tile for what lies below the cell, the last for what lies above.
  std::size_t tile(double coordinate) const { return cell_of(coordinate, low, per_tile, tiles); }

  double low, per_box, tile_width, per_tile;
  std::size_t tiles;
};

// The group of these particles, and they as its targets, with nothing gathered yet.
NearGroup around(const ParticleRange& own, float scale, NearTargets& targets) {
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
}

void NearForces::attract(const Places& places, const ShearingBox& box, double offset, double radius, std::size_t begin,
                         std::size_t count, NearTargets& targets) const {
  const ParticleRange own = places.range(begin, count);
  const Bounds x(own.x, count), y(own.y, count);
  NearGroup group = around(own, static_cast<float>(1.0 / radius), targets);
  const double origin_x = group.origin_x, origin_y = group.origin_y;

  const Tiling& tiling = places.tiling();
  const Axis along_x(box.size_x, tiling.columns, tiling.side, tiling.tile_columns());
  const Axis along_y(box.size_y, tiling.rows, tiling.side, tiling.tile_rows());
  NearSources sources;
  const auto flush = [&] {
    kernels_.attract(targets, count, sources, inside_.data());
    sources.count = 0;
  };
  const auto gather = [&](std::size_t first, std::size_t end) {
    while (first < end) {
      if (NearSources::capacity - sources.count < NearSources::capacity / 4)
        flush();
      const std::size_t part = std::min(end - first, NearSources::capacity / 4);
      kernels_.gather(sources, places.range(first, part), group);
      first += part;
    }
  };
  const double last_a = along_x.box(x.high + radius);
  for (double a = along_x.box(x.low - radius); a <= last_a; ++a) {
    const double shift_x = a * box.size_x; // of the sources
    group.origin_x = origin_x - shift_x;
    const std::size_t last_column = along_x.tile(x.high + radius - shift_x);
    for (std::size_t column = along_x.tile(x.low - radius - shift_x); column <= last_column; ++column) {
      const double from = along_x.low + static_cast<double>(column) * along_x.tile_width + shift_x;
      const double gap = std::max({0.0, from - x.high, x.low - from - along_x.tile_width});
      const double reach = std::sqrt(std::max(0.0, radius * radius - gap * gap));
      const double low = y.low - reach + a * offset, high = y.high + reach + a * offset; // in the sources' column
      const double last_b = along_y.box(high);
      for (double b = along_y.box(low); b <= last_b; ++b) {
        const double shift_y = b * box.size_y;
        group.origin_y = origin_y + a * offset - shift_y;
        const std::size_t tile = column * along_y.tiles;
        gather(places.first(tile + along_y.tile(low - shift_y)), places.first(tile + along_y.tile(high - shift_y) + 1));
      }
    }
  }
  flush();
}

} // namespace keeler
