#include "mesh.hpp"

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace keeler {
namespace {

typedef float Four __attribute__((vector_size(16)));
typedef float FourInRow __attribute__((vector_size(16), aligned(4), may_alias)); // anywhere in a row

// Shares of a particle at t in [0, 1] of its cell in the four nodes around it: the cubic B-spline.
Four shares(float t) {
  const Four constant = {1.0f / 6, 4.0f / 6, 1.0f / 6, 0.0f}, linear = {-0.5f, 0.0f, 0.5f, 0.0f};
  const Four square = {0.5f, -1.0f, 0.5f, 0.0f}, cube = {-1.0f / 6, 0.5f, -0.5f, 1.0f / 6};
  return constant + t * (linear + t * (square + t * cube));
}

// Their slopes, a spacing.
Four slopes(float t) {
  const Four linear = {-0.5f, 0.0f, 0.5f, 0.0f}, square = {1.0f, -2.0f, 1.0f, 0.0f};
  const Four cube = {-0.5f, 1.5f, -1.5f, 0.5f};
  return linear + t * (square + t * cube);
}

// A coordinate's cell, and where in it.
struct Cell {
  Cell(double coordinate, double low, double per_metre, std::size_t cells) {
    number = cell_of(coordinate, low, per_metre, cells);
    part = static_cast<float>((coordinate - low) * per_metre - static_cast<double>(number));
  }
  std::size_t number;
  float part;
};

// first sin 2πt + second sin 4πt for t in [0, 1], by polynomials in v = 2t − 1: sin πv within 2e-5, cos πv within 0.01
// (it makes 8 % of the sum).
Four harmonics(const Four& t, const SelfForce& self) {
  const Four v = 2.0f * t - 1.0f, v2 = v * v;
  const Four sine = v * (1.0f - v2) * (3.1415451f - v2 * (2.0245943f - v2 * (0.5163292f - 0.0625282f * v2)));
  const Four cosine = (1.0f - 4.0f * v2) * (1.0f - v2 * (0.9348f - 0.2681f * v2));
  const Four first = {self.first[0], self.first[1], self.first[2], 0.0f};
  const Four second = {self.second[0], self.second[1], self.second[2], 0.0f};
  return sine * (2.0f * second * cosine - first);
}

// 2^a 3^b 5^c, even; a multiple of 8 once that costs little.
bool transforms_fast(std::size_t n) {
  if (n % (n >= 96 ? 8 : 2) != 0)
    return false;
  for (const std::size_t prime : {2u, 3u, 5u})
    while (n % prime == 0)
      n /= prime;
  return n == 1;
}

std::size_t fast_size(double length, double spacing) {
  auto n = std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(length / spacing)));
  while (!transforms_fast(n))
    ++n;
  return n;
}

} // namespace

MeshShape mesh_shape(const ShearingBox& box, double spacing, double plane_spacing, double low, double high) {
  MeshShape shape;
  shape.columns = fast_size(box.size_x, spacing);
  shape.rows = fast_size(box.size_y, spacing);
  shape.step_x = box.size_x / static_cast<double>(shape.columns);
  shape.step_y = box.size_y / static_cast<double>(shape.rows);
  shape.step_z = plane_spacing;
  shape.per_x = static_cast<double>(shape.columns) / box.size_x; // as the tiles have it, to the bit (places.hpp)
  shape.per_y = static_cast<double>(shape.rows) / box.size_y;
  shape.left = -0.5 * box.size_x;
  shape.bottom = -0.5 * box.size_y;
  const double first = std::floor(low / plane_spacing), last = std::floor(high / plane_spacing);
  shape.base = first * plane_spacing;
  shape.planes = static_cast<std::size_t>(last - first) + 1 + MeshShape::ghosts;
  return shape;
}

void Mesh::reset(const MeshShape& shape) {
  shape_ = shape;
  const std::size_t columns = shape.columns + MeshShape::ghosts;
  values_.resize_at_least(columns * shape.column_length());
  parallel_for(
      columns, [&](std::size_t i) { std::memset(column(i), 0, shape.column_length() * sizeof(float)); }, 4);
}

void Mesh::spread(const Places& places) {
  const MeshShape& s = shape_;
  const Tiling& tiling = places.tiling();
  const std::size_t row = s.row_length(), plane_cells = s.planes - MeshShape::ghosts;
  const auto spread_one = [&](std::size_t k) {
    const Cell cx(places.x()[k], s.left, s.per_x, s.columns), cy(places.y()[k], s.bottom, s.per_y, s.rows);
    const Cell cz(places.z()[k], s.base, 1.0 / s.step_z, plane_cells);
    const Four x = places.mass()[k] * shares(cx.part), y = shares(cy.part), z = shares(cz.part);
    float* corner = column(cx.number) + cz.number * row + cy.number;
    for (int a = 0; a < 4; ++a, corner += s.column_length())
      for (int c = 0; c < 4; ++c) {
        FourInRow& nodes = *reinterpret_cast<FourInRow*>(corner + static_cast<std::size_t>(c) * row); // auto would align
        nodes = nodes + x[a] * z[c] * y;
      }
  };
  // a slab must be as wide as what its neighbour spreads into it
  const std::size_t slab = (MeshShape::ghosts + tiling.side - 1) / tiling.side;
  const std::size_t tile_columns = tiling.tile_columns(), slabs = (tile_columns + slab - 1) / slab;
  for (const std::size_t parity : {0u, 1u})
    parallel_for(
        (slabs + 1 - parity) / 2,
        [&](std::size_t half) {
          const std::size_t begin = (2 * half + parity) * slab, end = std::min(begin + slab, tile_columns);
          for (std::size_t k = places.first(begin * tiling.tile_rows()); k < places.first(end * tiling.tile_rows()); ++k)
            spread_one(k);
        },
        1);
}

Vec3 Mesh::gradient(double x, double y, double z, float mass, const SelfForce& self) const {
  const MeshShape& s = shape_;
  const Cell cx(x, s.left, s.per_x, s.columns), cy(y, s.bottom, s.per_y, s.rows);
  const Cell cz(z, s.base, 1.0 / s.step_z, s.planes - MeshShape::ghosts);
  const Four wx = shares(cx.part), wz = shares(cz.part), dx = slopes(cx.part), dz = slopes(cz.part);
  const std::size_t row = s.row_length();
  const float* corner = values_.data() + cx.number * s.column_length() + cz.number * row + cy.number;
  Four along_x = {}, flat = {}, along_z = {};
  for (int a = 0; a < 4; ++a, corner += s.column_length()) {
    Four sum = {}, slope = {};
    for (int c = 0; c < 4; ++c) {
      const Four nodes = *reinterpret_cast<const FourInRow*>(corner + static_cast<std::size_t>(c) * row);
      sum += wz[c] * nodes;
      slope += dz[c] * nodes;
    }
    along_x += dx[a] * sum;
    flat += wx[a] * sum;
    along_z += wx[a] * slope;
  }
  const Four wy = shares(cy.part), gx = along_x * wy, gy = flat * slopes(cy.part), gz = along_z * wy;
  const Four per_spacing = {gx[0] + gx[1] + (gx[2] + gx[3]), gy[0] + gy[1] + (gy[2] + gy[3]),
                            gz[0] + gz[1] + (gz[2] + gz[3]), 0.0f};
  const Four per_metre = {static_cast<float>(s.per_x), static_cast<float>(s.per_y), static_cast<float>(1.0 / s.step_z), 0.0f};
  const Four parts = {cx.part, cy.part, cz.part, 0.0f};
  const Four own = harmonics(parts, self);
  const Four sum = per_spacing * per_metre - mass * own;
  return {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
}

} // namespace keeler
