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
      : size(box_size), low(-0.5 * box_size), per_box(1.0 / box_size),
        tile_width(box_size * static_cast<double>(side) / static_cast<double>(cells)), per_tile(1.0 / tile_width),
        tiles(tile_count) {}

  double box(double coordinate) const { return floor_of((coordinate - low) * per_box); }

  // The first tile for what lies below the cell, the last for what lies above.
  std::size_t tile(double coordinate) const { return cell_of(coordinate, low, per_tile, tiles); }

  double size, low, per_box, tile_width, per_tile;
  std::size_t tiles;
};

} // namespace

NearForces::NearForces(const ForceSplit& split, InstructionSet set) : kernels_(mesh_kernels(set)) {
  std::transform(split.inside().begin(), split.inside().end(), inside_.begin(),
                 [](double term) { return static_cast<float>(term); });
}

void NearForces::attract(const Places& places, const ShearingBox& box, double offset, double radius, std::size_t begin,
                         std::size_t count, NearTargets& targets) const {
  const ParticleRange own = places.range(begin, count);
  const Bounds x(own.x, count), y(own.y, count), z(own.z, count);
  const double origin_x = 0.5 * (x.low + x.high), origin_y = 0.5 * (y.low + y.high), origin_z = 0.5 * (z.low + z.high);
  const auto scale = static_cast<float>(1.0 / radius);
  NearGroup group{0.0, 0.0, origin_z, scale, {}};
  const auto relative = [&](double value, double origin) { return static_cast<float>(value - origin) * scale; };
  const Bounds* const bounds[] = {&x, &y, &z};
  const double origins[] = {origin_x, origin_y, origin_z};
  for (int axis = 0; axis < 3; ++axis)
    group.half[axis] =
        std::max(relative(bounds[axis]->high, origins[axis]), -relative(bounds[axis]->low, origins[axis]));
  for (std::size_t k = 0; k < count; ++k) {
    targets.x[k] = relative(own.x[k], origin_x);
    targets.y[k] = relative(own.y[k], origin_y);
    targets.z[k] = relative(own.z[k], origin_z);
    targets.ax[k] = targets.ay[k] = targets.az[k] = 0.0f;
  }

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
