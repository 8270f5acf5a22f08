#include "lattice.hpp"

#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>

#include <cassert>
#include <cmath>

namespace keeler::gravity {
namespace {

// Returns e^{kz} erfc(k r_s + z / 2r_s), which is 0 long before its factors overflow or underflow.
double half_profile(double k, double z, double split) {
  const double argument = k * split + 0.5 * z / split;
  return argument > 25.0 ? 0.0 : std::exp(k * z) * std::erfc(argument);
}

// Returns x with e^{−x²} = tolerance.
double gaussian_range(double tolerance) {
  assert(tolerance > 0.0 && tolerance < 1.0);
  return std::sqrt(-std::log(tolerance));
}

} // namespace

Lattice::Lattice(const ShearingBox& box, double offset, double tolerance, double relative_split)
    : box_(box), offset_(folded_offset(box, offset)), split_(relative_split * std::sqrt(box.area())),
      reach_(2.0 * split_ * gaussian_range(tolerance)),
      near_(shifts_within(reach_ + 0.5 * std::hypot(box.size_x, box.size_y))) {
  assert(box.size_x > 0.0 && box.size_y > 0.0 && relative_split > 0.0);
  const double max_k = gaussian_range(tolerance) / split_;
  const auto rows = static_cast<int>(max_k * box.size_y / (2.0 * pi));
  for (int b = 0; b <= rows; ++b) {
    const double ky = 2.0 * pi * b / box.size_y, slant = ky * offset_ / box.size_x;
    const double per_column = 2.0 * pi / box.size_x;
    const auto first = b == 0 ? 1 : static_cast<int>(std::ceil((-max_k - slant) / per_column));
    const auto last = static_cast<int>(std::floor((max_k - slant) / per_column));
    for (int a = first; a <= last; ++a) {
      const double kx = per_column * a + slant, k = std::hypot(kx, ky);
      if (k <= max_k)
        waves_.push_back({kx, ky, k});
    }
  }
}

std::vector<Vec3> Lattice::shifts_within(double distance) const {
  std::vector<Vec3> shifts;
  const auto columns = static_cast<int>(distance / box_.size_x);
  for (int nx = -columns; nx <= columns; ++nx) {
    const double slid = nx * offset_;
    const auto first = static_cast<int>(std::ceil((slid - distance) / box_.size_y));
    const auto last = static_cast<int>(std::floor((slid + distance) / box_.size_y));
    for (int ny = first; ny <= last; ++ny)
      if (const Vec3 shift = box_.displacement({nx, ny}, offset_); shift.norm() <= distance)
        shifts.push_back(shift);
  }
  return shifts;
}

double Lattice::wave_potential(const LatticeWave& wave, double z) const {
  return -2.0 * pi / (wave.k * box_.area()) * (half_profile(wave.k, z, split_) + half_profile(wave.k, -z, split_));
}

double Lattice::sheet_potential(double z) const {
  const double u = 0.5 * z / split_;
  return 2.0 * pi / box_.area() * (z * std::erf(u) + 2.0 * split_ / std::sqrt(pi) * std::exp(-u * u));
}

double Lattice::potential(const Vec3& displacement) const {
  const Vec3 position = into_cell(box_, offset_, displacement);
  double sum = sheet_potential(position.z());
  for (const LatticeWave& wave : waves_)
    sum += wave_potential(wave, position.z()) * std::cos(wave.kx * position.x() + wave.ky * position.y());
  for (const Vec3& shift : near_) {
    const double d = (position - shift).norm();
    sum += d > 0.0 ? -std::erfc(0.5 * d / split_) / d : 1.0 / (std::sqrt(pi) * split_);
  }
  return sum;
}

Vec3 Lattice::acceleration(const Vec3& displacement) const {
  const Vec3 position = into_cell(box_, offset_, displacement);
  Vec3 sum(0.0, 0.0, -2.0 * pi / box_.area() * std::erf(0.5 * position.z() / split_));
  for (const LatticeWave& wave : waves_) {
    const double up = half_profile(wave.k, position.z(), split_), down = half_profile(wave.k, -position.z(), split_);
    const double phase = wave.kx * position.x() + wave.ky * position.y(), weight = 2.0 * pi / box_.area();
    const double along = -weight * (up + down) * std::sin(phase) / wave.k;
    sum += Vec3(along * wave.kx, along * wave.ky, weight * (up - down) * std::cos(phase));
  }
  for (const Vec3& shift : near_) {
    const Vec3 d = position - shift;
    const double distance = d.norm(), u = 0.5 * distance / split_;
    if (distance > 0.0)
      sum -= d / (distance * distance * distance) * (std::erfc(u) + 2.0 * u / std::sqrt(pi) * std::exp(-u * u));
  }
  return sum;
}

} // namespace keeler::gravity
