#include <keeler/cells/order.hpp>

#include <keeler/core/threads.hpp>

#include <algorithm>

namespace keeler {
namespace {

constexpr double particles_per_cell = 2.0;

} // namespace

std::vector<std::uint32_t> order_by_place(const Particles& particles, const ShearingBox& box, double offset) {
  const std::size_t count = particles.size();
  const double cells = std::max(1.0, static_cast<double>(count) / particles_per_cell);
  const auto columns =
      static_cast<std::size_t>(std::ceil(std::clamp(std::sqrt(cells * box.size_x / box.size_y), 1.0, cells)));
  const auto rows = static_cast<std::size_t>(std::ceil(cells / static_cast<double>(columns)));
  const auto part = [](double place, double size, std::size_t parts) {
    const double number = (place / size + 0.5) * static_cast<double>(parts);
    return static_cast<std::size_t>(std::clamp(number, 0.0, static_cast<double>(parts) - 0.5));
  };
  std::vector<std::uint32_t> cell_of(count);
  parallel_for(count, [&](std::size_t k) {
    Vec3 place = state_at(particles.bodies[k].elements, {}, Rotation()).position;
    cell_of[k] = 0;
    if (!place.allFinite())
      return; // no matter where: whoever uses it will refuse it
    place += box.displacement(box.image_into_cell(place.x(), place.y(), offset), offset);
    cell_of[k] =
        static_cast<std::uint32_t>(part(place.x(), box.size_x, columns) * rows + part(place.y(), box.size_y, rows));
  });
  // a counting sort: starts[c + 1] is where the next particle of cell c goes
  std::vector<std::uint32_t> starts(columns * rows + 2, 0), order(count);
  for (const std::uint32_t cell : cell_of)
    ++starts[cell + 2];
  for (std::size_t c = 2; c < starts.size(); ++c)
    starts[c] += starts[c - 1];
  for (std::size_t k = 0; k < count; ++k)
    order[starts[cell_of[k] + 1]++] = static_cast<std::uint32_t>(k);
  parallel_for(columns * rows, [&](std::size_t c) {
    std::sort(order.begin() + starts[c], order.begin() + starts[c + 1],
              [&](std::uint32_t a, std::uint32_t b) { return particles.ids[a] < particles.ids[b]; });
  });
  return order;
}

} // namespace keeler
