#include "density_mesh.hpp"

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>

namespace keeler::diagnostics {
namespace {

// Cloud-in-cell weights along one axis: of two neighbouring nodes, with sum 1.
struct CloudWeights {
  int node;
  double here, next;

  CloudWeights(double position, double half_size, double spacing, int nodes) {
    const double u = (position + half_size) / spacing;
    const double floor = std::floor(u);
    node = ((static_cast<int>(floor) % nodes) + nodes) % nodes;
    next = u - floor;
    here = 1.0 - next;
  }
};

void add(SelfPairs& sum, const CloudWeights& x, const CloudWeights& y, double weight) {
  const double x0 = x.here * x.here + x.next * x.next, x1 = x.here * x.next;
  const double y0 = y.here * y.here + y.next * y.next, y1 = y.here * y.next;
  sum.centre += weight * x0 * y0;
  sum.along_x += weight * x1 * y0;
  sum.along_y += weight * x0 * y1;
  sum.diagonal += weight * x1 * y1;
}

// Deposits Σ/⟨Σ⟩ on the mesh, node (i, j) at (−L_x/2 + i Δx, −L_y/2 + j Δy). The column after the last is the first one
// of the next box, which lags by the shear offset.
SelfPairs deposit(const Patch& patch, MeshTransform& mesh) {
  const ShearingBox& box = patch.box;
  const int columns = mesh.columns(), rows = mesh.rows();
  const double dx = box.size_x / columns, dy = box.size_y / rows;
  const double cells = static_cast<double>(columns) * rows;
  const double cell_mass = total_mass(patch) / cells;
  std::fill_n(mesh.real(), static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0);
  SelfPairs self;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3& p = patch.positions[k];
    const Image image = box.image_into_cell(p.x(), p.y(), patch.offset);
    const Vec3 inside = p + box.displacement(image, patch.offset);
    const CloudWeights x(inside.x(), 0.5 * box.size_x, dx, columns);
    const double q = patch.masses[k] / cell_mass;
    for (const int side : {0, 1}) {
      const bool crosses = x.node + side == columns;
      const CloudWeights y(inside.y() + (crosses ? patch.offset : 0.0), 0.5 * box.size_y, dy, rows);
      const double part = q * (side == 0 ? x.here : x.next);
      double* column = mesh.real() + static_cast<std::ptrdiff_t>(crosses ? 0 : x.node + side) * rows;
      column[y.node] += part * y.here;
      column[(y.node + 1) % rows] += part * y.next;
      if (side == 0)
        add(self, x, y, q * q / cells);
    }
  }
  return self;
}

// Multiplies column i, wave number j along y by exp(i 2π j turns_per_column i).
void shear_columns(MeshTransform& mesh, double turns_per_column) {
  for (int i = 0; i < mesh.columns(); ++i)
    for (int j = 0; j < mesh.waves(); ++j)
      mesh.waves_of(i)[j] *= std::polar(1.0, two_pi * j * turns_per_column * i);
}

} // namespace

MeshSize mesh_size(const Patch& patch) {
  assert(patch.size() > 0);
  const double between = std::sqrt(patch.box.area() / static_cast<double>(patch.size()));
  const double spacing = std::max(critical_wavelength(patch) / 32.0, between);
  const auto nodes = [&](double size) { return 2 * static_cast<int>(std::clamp(size / (2.0 * spacing), 4.0, 512.0)); };
  return {nodes(patch.box.size_x), nodes(patch.box.size_y)};
}

double SelfPairs::wave(double turn_x, double turn_y) const {
  const double x = 2.0 * std::cos(turn_x), y = 2.0 * std::cos(turn_y);
  return centre + along_x * x + along_y * y + diagonal * x * y;
}

SelfPairs density_waves(const Patch& patch, MeshTransform& mesh) {
  const SelfPairs self = deposit(patch, mesh);
  mesh.forward_y();
  shear_columns(mesh, -patch.offset / (patch.box.size_y * mesh.columns()));
  mesh.forward_x();
  return self;
}

double shot_power(const Patch& patch) {
  return mass_mean(patch, [&](std::size_t k) { return patch.masses[k]; }) / total_mass(patch);
}

} // namespace keeler::diagnostics
