#include <keeler/cells/order.hpp>

#include <keeler/core/counting_sort.hpp>

#include <algorithm>

namespace keeler::cells {
namespace {

constexpr double particles_per_cell = 2.0;

} // namespace

std::vector<std::uint32_t> order_by_position(const Particles& particles, const ShearingBox& box, double offset,
                                             const Folds& folds) {
  assert(particles.ids.size() == particles.size() && box.size_x > 0.0 && box.size_y > 0.0);
  const std::size_t count = particles.size();
  const double cells = std::max(1.0, static_cast<double>(count) / particles_per_cell);
  const double size_x = box.size_x / folds.x, size_y = box.size_y / folds.y;
  const auto columns = static_cast<std::size_t>(std::ceil(std::clamp(std::sqrt(cells * size_x / size_y), 1.0, cells)));
  const auto rows = static_cast<std::size_t>(std::ceil(cells / static_cast<double>(columns)));
  const auto part = [](double coordinate, double size, std::uint32_t copies, std::size_t parts) {
    const double copy = (coordinate / size + 0.5) * copies, begin = copies > 1 ? std::floor(copy) : 0.0,
                 index = (copy - begin) * static_cast<double>(parts);
    return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(parts) - 0.5));
  };
  std::vector<std::uint32_t> cell_of(count);
  parallel_for(count, [&](std::size_t k) {
    Vec3 position = state_at(particles.bodies[k].elements, {}, Rotation()).position;
    cell_of[k] = 0;
    if (!position.allFinite())
      return; // arbitrary; later checks reject the particle
    position += box.displacement(box.image_into_cell(position.x(), position.y(), offset), offset);
    cell_of[k] = static_cast<std::uint32_t>(part(position.x(), box.size_x, folds.x, columns) * rows +
                                            part(position.y(), box.size_y, folds.y, rows));
  });
  std::vector<std::uint32_t> starts, order(count);
  counting_sort(cell_of, columns * rows, starts,
                [&](std::size_t k, std::size_t position) { order[position] = static_cast<std::uint32_t>(k); });
  parallel_for(columns * rows, [&](std::size_t c) {
    std::sort(order.begin() + starts[c], order.begin() + starts[c + 1],
              [&](std::uint32_t a, std::uint32_t b) { return particles.ids[a] < particles.ids[b]; });
  });
  return order;
}

} // namespace keeler::cells
