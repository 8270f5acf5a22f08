#include <keeler/diagnostics/autocorrelation.hpp>

#include "density_mesh.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace keeler::diagnostics {

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
  assert(columns > 0 && columns % 2 == 0 && rows > 0 && rows % 2 == 0);
  sum_.reach = 3 * columns / 4;
  sum_.rows = rows;
  sum_.spacing_x = box.size_x / columns;
  sum_.spacing_y = box.size_y / rows;
  sum_.values.assign(static_cast<std::size_t>(2 * sum_.reach + 1) * static_cast<std::size_t>(rows), 0.0);
}

void Autocorrelation::add(const Patch& patch) {
  if (patch.box.size_x != box_.size_x || patch.box.size_y != box_.size_y)
    throw UsageError(
        fmt::format("snapshots of boxes {} x {} m and {} x {} m cannot be averaged; analyze each run separately",
                    box_.size_x, box_.size_y, patch.box.size_x, patch.box.size_y));
  MeshTransform mesh(columns_, rows_);
  const SelfPairs self = density_waves(patch, mesh);
  const double turns = patch.offset / (box_.size_y * columns_);
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
  // Poisson noise of a value at a lag: (variance of Σ/⟨Σ⟩ in a cell) / √cells.
  const double squares = shot_power(patch);
  noise_squares_ += cells * squares * squares;
  ++count_;
}

AutocorrelationMap Autocorrelation::map() const {
  assert(count_ > 0);
  AutocorrelationMap mean = sum_;
  for (double& value : mean.values)
    value /= count_;
  mean.noise = std::sqrt(noise_squares_) / count_;
  return mean;
}

AutocorrelationMap mean_autocorrelation(std::span<const Patch> patches) {
  assert(!patches.empty());
  const MeshSize size = mesh_size(patches.front());
  Autocorrelation sum(patches.front().box, size.columns, size.rows);
  for (const Patch& patch : patches)
    sum.add(patch);
  return sum.map();
}

} // namespace keeler::diagnostics
