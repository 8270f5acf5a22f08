#include <keeler/diagnostics/autocorrelation.hpp>

#include "mesh_transform.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace keeler {
namespace {

// Cloud-in-cell along one axis: two neighbouring nodes share a unit.
struct Share {
  int node;
  double here, next;

  Share(double position, double half_size, double spacing, int nodes) {
    const double u = (position + half_size) / spacing;
    const double floor = std::floor(u);
    node = ((static_cast<int>(floor) % nodes) + nodes) % nodes;
    next = u - floor;
    here = 1.0 - next;
  }
};

// A particle's correlation with itself, summed over particles: at lags (0, 0), (±1, 0), (0, ±1) and (±1, ±1) of the
// mesh.
struct SelfPairs {
  double centre = 0, along_x = 0, along_y = 0, diagonal = 0;

  void add(const Share& x, const Share& y, double weight) {
    const double x0 = x.here * x.here + x.next * x.next, x1 = x.here * x.next;
    const double y0 = y.here * y.here + y.next * y.next, y1 = y.here * y.next;
    centre += weight * x0 * y0;
    along_x += weight * x1 * y0;
    along_y += weight * x0 * y1;
    diagonal += weight * x1 * y1;
  }

  double at(int i, int j) const {
    if (std::abs(i) > 1 || std::abs(j) > 1)
      return 0.0;
    return i == 0 ? (j == 0 ? centre : along_y) : (j == 0 ? along_x : diagonal);
  }
};

// Lays Σ/⟨Σ⟩ on the mesh, node (i, j) at (−L_x/2 + i Δx, −L_y/2 + j Δy). The column after the last is the first one of
// the next box, which lags by the shear offset.
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
    const Share x(inside.x(), 0.5 * box.size_x, dx, columns);
    const double q = patch.masses[k] / cell_mass;
    for (const int side : {0, 1}) {
      const bool crosses = x.node + side == columns;
      const Share y(inside.y() + (crosses ? patch.offset : 0.0), 0.5 * box.size_y, dy, rows);
      const double part = q * (side == 0 ? x.here : x.next);
      double* column = mesh.real() + static_cast<std::ptrdiff_t>(crosses ? 0 : x.node + side) * rows;
      column[y.node] += part * y.here;
      column[(y.node + 1) % rows] += part * y.next;
      if (side == 0)
        self.add(x, y, q * q / cells);
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

double AutocorrelationMap::at(double dx, double dy) const {
  const double u = std::clamp(dx / spacing_x, -static_cast<double>(reach), static_cast<double>(reach));
  const int i = std::min(static_cast<int>(std::floor(u)), reach - 1);
  const double v = dy / spacing_y, floor = std::floor(v);
  const int half = rows / 2;
  const auto row = [&](double j) { // into −half … rows − half − 1
    return static_cast<int>(j - rows * std::floor((j + half) / rows));
  };
  const int j = row(floor), above = row(floor + 1.0);
  const double fx = u - i, fy = v - floor;
  return (1.0 - fx) * ((1.0 - fy) * value(i, j) + fy * value(i, above)) +
         fx * ((1.0 - fy) * value(i + 1, j) + fy * value(i + 1, above));
}

Autocorrelation::Autocorrelation(const ShearingBox& box, int columns, int rows)
    : box_(box), columns_(columns), rows_(rows) {
  sum_.reach = 3 * columns / 4;
  sum_.rows = rows;
  sum_.spacing_x = box.size_x / columns;
  sum_.spacing_y = box.size_y / rows;
  sum_.values.assign(static_cast<std::size_t>(2 * sum_.reach + 1) * static_cast<std::size_t>(rows), 0.0);
}

void Autocorrelation::add(const Patch& patch) {
  if (patch.box.size_x != box_.size_x || patch.box.size_y != box_.size_y)
    throw UsageError(
        fmt::format("snapshots of boxes {} x {} m and {} x {} m cannot be averaged; analyze each run alone",
                    box_.size_x, box_.size_y, patch.box.size_x, patch.box.size_y));
  MeshTransform mesh(columns_, rows_);
  const SelfPairs self = deposit(patch, mesh);
  const double turns = patch.offset / (box_.size_y * columns_);
  mesh.forward_y();
  shear_columns(mesh, -turns);
  mesh.forward_x();
  for (int i = 0; i < columns_; ++i)
    for (int j = 0; j < mesh.waves(); ++j)
      mesh.waves_of(i)[j] = std::norm(mesh.waves_of(i)[j]);
  mesh.backward_x();

  // Unshear with the lag itself, not with the lag modulo the box: column i and column i − columns differ by the offset.
  const double cells = static_cast<double>(columns_) * rows_;
  std::vector<std::complex<double>> waves(static_cast<std::size_t>(mesh.waves()));
  std::vector<double> column(static_cast<std::size_t>(rows_));
  for (int i = -sum_.reach; i <= sum_.reach; ++i) {
    const std::complex<double>* periodic = mesh.waves_of((i + columns_) % columns_);
    for (int j = 0; j < mesh.waves(); ++j)
      waves[static_cast<std::size_t>(j)] = periodic[j] * std::polar(1.0, two_pi * j * turns * i);
    mesh.column_backward_y(waves.data(), column.data());
    for (int j = -rows_ / 2; j < rows_ / 2; ++j) {
      const double pairs = column[static_cast<std::size_t>((j + rows_) % rows_)] / (cells * cells);
      sum_.values[static_cast<std::size_t>((i + sum_.reach) * rows_ + j + rows_ / 2)] += pairs - self.at(i, j) - 1.0;
    }
  }
  // Poisson noise of a value at a lag: (variance of Σ/⟨Σ⟩ in a cell) / √cells, with Σm²/(Σm)² as 1/N.
  const double mass = total_mass(patch);
  const double squares = mass_mean(patch, [&](std::size_t k) { return patch.masses[k]; }) / mass;
  noise_squares_ += cells * squares * squares;
  ++count_;
}

AutocorrelationMap Autocorrelation::map() const {
  AutocorrelationMap mean = sum_;
  for (double& value : mean.values)
    value /= count_;
  mean.noise = std::sqrt(noise_squares_) / count_;
  return mean;
}

AutocorrelationMap mean_autocorrelation(std::span<const Patch> patches) {
  const Patch& first = patches.front();
  const double between = std::sqrt(first.box.area() / static_cast<double>(first.size()));
  const double spacing = std::max(critical_wavelength(first) / 32.0, between);
  const auto nodes = [&](double size) { return 2 * std::clamp(static_cast<int>(size / (2.0 * spacing)), 4, 512); };
  Autocorrelation sum(first.box, nodes(first.box.size_x), nodes(first.box.size_y));
  for (const Patch& patch : patches)
    sum.add(patch);
  return sum.map();
}

} // namespace keeler
