#include "near_forces.hpp"

#include <algorithm>
#include <cmath>

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

// Tiles of `cells` cells that hold the coordinates from `low` to `high`; the first and last ones are kept in range.
struct TileRange {
  TileRange(double low, double high, double edge, double per_metre, std::size_t cells, std::size_t side)
      : first(cell_of(low, edge, per_metre, cells) / side), last(cell_of(high, edge, per_metre, cells) / side) {}
  std::size_t first, last;
};

} // namespace

NearForces::NearForces(const ForceSplit& split, InstructionSet set) : kernels_(mesh_kernels(set)) {
  std::transform(split.inside().begin(), split.inside().end(), inside_.begin(),
                 [](double term) { return static_cast<float>(term); });
}

void NearForces::attract(const Places& places, const ShearingBox& box, double offset, double radius,
                         std::size_t begin, std::size_t count, NearTargets& targets) const {
  const ParticleRange own = places.range(begin, count);
  const Bounds x(own.x, count), y(own.y, count), z(own.z, count);
  const double origin_x = 0.5 * (x.low + x.high), origin_y = 0.5 * (y.low + y.high), origin_z = 0.5 * (z.low + z.high);
  const auto scale = static_cast<float>(1.0 / radius);
  NearGroup group{0.0, 0.0, origin_z, scale, {}, {}};
  const auto relative = [&](double value, double origin) { return static_cast<float>(value - origin) * scale; };
  const Bounds* const bounds[] = {&x, &y, &z};
  const double origins[] = {origin_x, origin_y, origin_z};
  for (int axis = 0; axis < 3; ++axis) {
    group.low[axis] = relative(bounds[axis]->low, origins[axis]);
    group.high[axis] = relative(bounds[axis]->high, origins[axis]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    targets.x[k] = relative(own.x[k], origin_x);
    targets.y[k] = relative(own.y[k], origin_y);
    targets.z[k] = relative(own.z[k], origin_z);
    targets.ax[k] = targets.ay[k] = targets.az[k] = 0.0f;
  }

  const Tiling& tiling = places.tiling();
  const double left = -0.5 * box.size_x, bottom = -0.5 * box.size_y;
  const double per_x = static_cast<double>(tiling.columns) / box.size_x;
  const double per_y = static_cast<double>(tiling.rows) / box.size_y;
  const double tile_width = static_cast<double>(tiling.side) / per_x;
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
  const double per_box_x = 1.0 / box.size_x, per_box_y = 1.0 / box.size_y;
  const auto boxes = [](double coordinate, double low, double per_box) {
    return std::floor((coordinate - low) * per_box);
  };
  for (double a = boxes(x.low - radius, left, per_box_x); a <= boxes(x.high + radius, left, per_box_x); ++a) {
    const double shift_x = a * box.size_x; // of the sources
    group.origin_x = origin_x - shift_x;
    const TileRange columns(x.low - radius - shift_x, x.high + radius - shift_x, left, per_x, tiling.columns,
                            tiling.side);
    for (std::size_t column = columns.first; column <= columns.last; ++column) {
      const double from = left + static_cast<double>(column) * tile_width + shift_x;
      const double gap = std::max({0.0, from - x.high, x.low - from - tile_width});
      const double reach = std::sqrt(std::max(0.0, radius * radius - gap * gap));
      const double low = y.low - reach + a * offset, high = y.high + reach + a * offset; // in the sources' column
      for (double b = boxes(low, bottom, per_box_y); b <= boxes(high, bottom, per_box_y); ++b) {
        const double shift_y = b * box.size_y;
        group.origin_y = origin_y + a * offset - shift_y;
        const TileRange rows(low - shift_y, high - shift_y, bottom, per_y, tiling.rows, tiling.side);
        const std::size_t tile = column * tiling.tile_rows();
        gather(places.first(tile + rows.first), places.first(tile + rows.last + 1));
      }
    }
  }
  flush();
}

} // namespace keeler
