#include <keeler/initial_conditions/tiled.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {
namespace {

void require_possible(const Patch& patch, std::size_t nx, std::size_t ny) {
  const double size_x = static_cast<double>(nx) * patch.box.size_x, size_y = static_cast<double>(ny) * patch.box.size_y;
  const double copies = static_cast<double>(nx) * static_cast<double>(ny);
  const KeyRange &sizes = scene::find_key("box.size")->range, &counts = scene::find_key("particles.count")->range;
  if (!sizes.contains(size_x) || !sizes.contains(size_y))
    throw UsageError(fmt::format("{} x {} copies make a box of {} m x {} m (a patch has sizes {}); use fewer", nx, ny,
                                 format_number(size_x, 4), format_number(size_y, 4), sizes.words()));
  if (!(std::max(size_x, size_y) <= scene::max_aspect_ratio * std::min(size_x, size_y)))
    throw UsageError(fmt::format("{} x {} copies make a box of {} m x {} m, more than {:g} times as long as wide; make "
                                 "it less oblong",
                                 nx, ny, format_number(size_x, 4), format_number(size_y, 4), scene::max_aspect_ratio));
  const double count = copies * static_cast<double>(patch.size());
  if (!(count <= counts.high))
    throw UsageError(fmt::format("{} x {} copies make {} particles (the limit is {}); use fewer", nx, ny,
                                 format_number(count, 3), format_number(counts.high, 3)));
  if (patch.size() > 0 && !(copies * (static_cast<double>(patch.ids.back()) + 1.0) < 0x1p63))
    throw UsageError(fmt::format("{} x {} copies leave no ids for the copies (the largest id is already {}); number "
                                 "the particles from 0",
                                 nx, ny, patch.ids.back()));
}

// Images of a particle in the columns and rows, independent of its position.
struct Tiles {
  ShearingBox patch, whole;
  double offset; // of the patch
  std::int64_t first_column;
  double shift_x; // of the origin, which lies between two columns if their number is even

  Tiles(const Patch& p, std::size_t nx, std::size_t ny)
      : patch(p.box), whole(p.box), offset(p.offset), first_column(-static_cast<std::int64_t>(nx / 2)),
        shift_x(nx % 2 == 0 ? 0.5 * p.box.size_x : 0.0) {
    whole.size_x *= static_cast<double>(nx);
    whole.size_y *= static_cast<double>(ny);
    whole.first_offset = std::fmod(static_cast<double>(nx) * offset, whole.size_y);
  }

  // Returns the image in this column with the lowest guiding centre in the new cell. A centre outside the patch's cell,
  // by the drift of half a step, counts as on its edge: it keeps its row.
  Image first_in(std::size_t column, double guiding_y) const {
    const auto nx = static_cast<std::int32_t>(first_column + static_cast<std::int64_t>(column));
    const double edge = 0.5 * patch.size_y,
                 last = edge * (1.0 - 0x1p-50); // nextafter() would round to a whole box below
    const double inside = std::clamp(guiding_y, -edge, last);
    const double low = -0.5 * whole.size_y - (inside - nx * offset);
    return {nx, static_cast<std::int32_t>(std::ceil(low / patch.size_y))};
  }
};

} // namespace

// The images (n, m) of all particles form one infinite ring, periodic under (L_x, −d) and (0, L_y). So it is periodic
// under (N_x L_x, −N_x d) and (0, N_y L_y): a shearing box with the offset N_x d, at the rate S N_x L_x of the larger
// box. Its cell holds N_x N_y images of each particle. If the origin moves outward by s, as between two columns,
// all velocities change by −S s: Hill's equations are invariant under shifts of x.
Patch TiledPatch::some(std::size_t first, std::size_t count) const {
  assert(first + count <= size());
  const Patch& patch = patch_;
  const Tiles tiles(patch, nx_, ny_);
  Patch tiled;
  tiled.box = tiles.whole;
  tiled.offset = tiles.whole.first_offset;
  tiled.frequencies = patch.frequencies;
  tiled.orbital_frequency = patch.orbital_frequency;
  tiled.positions.resize(count);
  tiled.velocities.resize(count);
  tiled.radii.resize(count);
  tiled.masses.resize(count);
  tiled.ids.resize(count);
  tiled.spins.resize(patch.spins.empty() ? 0 : count);
  const std::uint64_t stride = patch.ids.empty() ? 0 : patch.ids.back() + 1;
  const double kappa = patch.frequencies.kappa, shear = patch.box.shear;
  parallel_for(count, [&](std::size_t k) {
    const std::size_t copy = (first + k) / patch.size(), particle = (first + k) % patch.size();
    const Vec3 &position = patch.positions[particle], &velocity = patch.velocities[particle];
    const double guiding_y = position.y() - 2.0 / (kappa * kappa) * velocity.x();
    Image image = tiles.first_in(copy / ny_, guiding_y);
    image.ny += static_cast<std::int32_t>(copy % ny_);
    Vec3 shift = patch.box.displacement(image, patch.offset);
    shift.x() += tiles.shift_x;
    tiled.positions[k] = position + shift;
    tiled.velocities[k] = velocity - Vec3(0.0, shear * shift.x(), 0.0);
    tiled.radii[k] = patch.radii[particle];
    tiled.masses[k] = patch.masses[particle];
    if (!patch.spins.empty())
      tiled.spins[k] = patch.spins[particle];
    tiled.ids[k] = patch.ids[particle] + copy * stride;
  });
  return tiled;
}

TiledPatch::TiledPatch(const Patch& patch, std::size_t nx, std::size_t ny) : patch_(patch), nx_(nx), ny_(ny) {
  assert(std::is_sorted(patch.ids.begin(), patch.ids.end()));
  require_possible(patch, nx, ny);
}

Patch tiled_patch(const Patch& patch, std::size_t nx, std::size_t ny) {
  const TiledPatch tiled(patch, nx, ny);
  constexpr std::size_t smooth = 2 * sizeof(Vec3) + 2 * sizeof(double) + sizeof(std::uint64_t);
  const auto bytes = static_cast<double>(patch.spins.empty() ? smooth : smooth + sizeof(Vec3));
  const auto count = static_cast<double>(tiled.size());
  require_memory(bytes * count, fmt::format("a patch of {} particles", format_number(count, 4)), "take fewer copies");
  return tiled.some(0, tiled.size());
}

} // namespace keeler::initial_conditions
