#include "far_images.hpp"

#include "lattice.hpp"

#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/gravity/near_image_count.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>

namespace keeler::gravity {
namespace {

constexpr int degree = 14;
constexpr int node_count = degree + 2; // even: half of them mirror the others
constexpr double tolerance = 1e-8;

// Returns the rings along the side of length `across` of a box with the other side `along`: more if the box is long.
int rings_for(int rings, double along, double across) {
  return rings * std::max(1, static_cast<int>(std::ceil(along / across / 1.3)));
}

// Returns the degree in z. The field varies over the distance of the far images: heights small against it need few
// powers. With one ring the error in the plane is 1e-6 and more; with two or more it is smaller, and so must be the one
// along z.
int height_degree(int rings, double relative_height) {
  const double height = rings == 1 ? relative_height : 4.0 * relative_height;
  return height < 0.05 ? 2 : height < 0.2 ? 4 : 8;
}

PolynomialShape shape_for(int height_degree) {
  PolynomialShape shape{degree, height_degree, 0};
  for (int c = 0; c <= height_degree; ++c)
    shape.size += static_cast<std::size_t>((degree - c + 1) * (degree - c + 2) / 2);
  return shape;
}

// Calls visit(a, b, c) for each monomial, in order.
template<class Visit> void for_each_monomial(const PolynomialShape& shape, const Visit& visit) {
  for (int c = 0; c <= shape.height_degree; ++c)
    for (int b = 0; b <= shape.degree - c; ++b)
      for (int a = 0; a <= shape.degree - c - b; ++a)
        visit(a, b, c);
}

// The index of each monomial x^a y^b z^c at [c][b][a].
using TermIndices = std::array<std::array<std::array<std::size_t, degree + 1>, degree + 1>, degree + 1>;

TermIndices indices_of(const PolynomialShape& shape) {
  TermIndices indices{};
  std::size_t next = 0;
  for_each_monomial(shape, [&](int a, int b, int c) { indices[c][b][a] = next++; });
  return indices;
}

double chebyshev_node(int k, int count) {
  return std::cos(pi * (k + 0.5) / count);
}

// Returns the matrix from values at the nodes to coefficients of T_0 … T_highest.
Eigen::MatrixXd to_chebyshev(int highest, int count) {
  Eigen::MatrixXd matrix(highest + 1, count);
  for (int i = 0; i <= highest; ++i)
    for (int k = 0; k < count; ++k)
      matrix(i, k) = (i == 0 ? 1.0 : 2.0) / count * std::cos(pi * i * (k + 0.5) / count);
  return matrix;
}

// Returns a matrix; row k has the coefficients of T_k in powers.
Eigen::MatrixXd chebyshev_in_powers(int highest) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(highest + 1, highest + 1);
  rows(0, 0) = 1.0;
  rows(1, 1) = 1.0;
  for (int k = 2; k <= highest; ++k) {
    rows.row(k).tail(highest) = 2.0 * rows.row(k - 1).head(highest);
    rows.row(k) -= rows.row(k - 2);
  }
  return rows;
}

// The far images' potential on the nodes of one height: all images by Ewald's sums, minus the near ones.
class FarPotential {
public:
  FarPotential(const ShearingBox& box, double offset, int rings)
      : box_(box), lattice_(box, offset, tolerance, 0.14), near_(near_images(box, offset, {rings, true})) {
    const double across = lattice_.reach() + std::hypot(box.size_x, box.size_y);
    for (const Vec3& shift : lattice_.shifts_within(across))
      if (std::none_of(near_.begin(), near_.end(),
                       [&](const Vec3& n) { return (n - shift).norm() < 0.5 * shortest(); }))
        others_.push_back(shift);
    for (int n = 0; n < node_count; ++n) {
      const double at = chebyshev_node(n, node_count);
      for (const LatticeWave& wave : lattice_.waves()) {
        along_x_[n].push_back(std::polar(1.0, wave.kx * at * box.size_x));
        along_y_[n].push_back(std::polar(1.0, wave.ky * at * box.size_y));
      }
    }
  }

  // Returns the values; rows are nodes along x, columns nodes along y.
  Eigen::MatrixXd at_height(double z) const {
    std::vector<double> amplitudes;
    for (const LatticeWave& wave : lattice_.waves())
      amplitudes.push_back(lattice_.wave_potential(wave, z));
    Eigen::MatrixXd values(node_count, node_count);
    parallel_for(
        node_count / 2,
        [&](std::size_t i) {
          const auto row = static_cast<int>(i);
          for (int j = 0; j < node_count; ++j) {
            const Vec3 position(chebyshev_node(row, node_count) * box_.size_x,
                                chebyshev_node(j, node_count) * box_.size_y, z);
            double sum = lattice_.sheet_potential(z) + images_at(position);
            for (std::size_t k = 0; k < amplitudes.size(); ++k) {
              const std::complex<double>&u = along_x_[i][k], &v = along_y_[j][k];
              sum += amplitudes[k] * (u.real() * v.real() - u.imag() * v.imag()); // cos(kx x + ky y)
            }
            values(row, j) = values(node_count - 1 - row, node_count - 1 - j) = sum;
          }
        },
        1);
    return values;
  }

private:
  double shortest() const { return std::min(box_.size_x, box_.size_y); }

  // Returns the part of Ewald's sum over images, minus the near images.
  double images_at(const Vec3& position) const {
    double sum = 0.0;
    const double per_split = 0.5 / lattice_.split_length(), reach = lattice_.reach();
    for (const Vec3& shift : others_)
      if (const double d = (position - shift).norm(); d < reach)
        sum -= std::erfc(per_split * d) / d;
    for (const Vec3& shift : near_) {
      const double d = (position - shift).norm();
      sum += d > reach ? 1.0 / d : d > 0.0 ? std::erf(per_split * d) / d : 2.0 * per_split / std::sqrt(pi);
    }
    return sum;
  }

  ShearingBox box_;
  Lattice lattice_;
  std::vector<Vec3> near_, others_;
  std::array<std::vector<std::complex<double>>, node_count> along_x_, along_y_; // e^{ikx} of each wave at each node
};

} // namespace

ImageSettings rings_for_height(ImageSettings images, const ShearingBox& box, double height) {
  assert(height >= 0.0);
  const double halves = std::ceil(2.0 * height / std::min(box.size_x, box.size_y));
  if (images.far)
    images.rings = std::max({1, images.rings, static_cast<int>(std::min<double>(halves, max_rings))});
  return images;
}

std::vector<Vec3> near_images(const ShearingBox& box, double offset, const ImageSettings& images) {
  if (!images.far)
    return image_shifts(box, offset, images.rings, images.rings);
  const int rings = images.rings;
  return image_shifts(box, offset, rings_for(rings, box.size_y, box.size_x), rings_for(rings, box.size_x, box.size_y));
}

std::size_t near_image_count(const ShearingBox& box, const ImageSettings& images) {
  return near_images(box, 0.0, images).size();
}

Vec3 far_pull(const Lattice& lattice, const std::vector<Vec3>& near, const Vec3& displacement) {
  Vec3 sum = lattice.acceleration(displacement);
  for (const Vec3& shift : near)
    if (const Vec3 d = displacement - shift; d.squaredNorm() > 0.0)
      sum += d / (d.squaredNorm() * d.norm());
  return sum;
}

FarImages::FarImages(const ShearingBox& box, double offset, int rings, double height) {
  assert(rings >= 1 && height >= 0.0);
  const double highest = 0.5 * rings * std::min(box.size_x, box.size_y);
  max_height_ = std::min(height, highest);
  scale_ = {box.size_x, box.size_y, std::max(2.0 * max_height_, 0.01 * highest)};
  shape_ = shape_for(height_degree(rings, 0.5 * scale_.z() / highest));
  const int heights = shape_.height_degree + 2; // even, as along x
  const FarPotential potential(box, offset, rings);
  const Eigen::MatrixXd in_plane = to_chebyshev(degree, node_count),
                        upward = to_chebyshev(shape_.height_degree, heights);
  const Eigen::MatrixXd powers = chebyshev_in_powers(degree);
  std::vector<Eigen::MatrixXd> planes; // coefficients of T_a T_b for each height above the plane
  for (int h = 0; h < heights / 2; ++h)
    planes.push_back(in_plane * potential.at_height(chebyshev_node(h, heights) * scale_.z()) * in_plane.transpose());

  std::vector<Eigen::MatrixXd> in_powers(shape_.height_degree + 1, Eigen::MatrixXd::Zero(degree + 1, degree + 1));
  for (int c = 0; c <= shape_.height_degree; c += 2) {
    Eigen::MatrixXd level = Eigen::MatrixXd::Zero(degree + 1, degree + 1); // coefficients of T_a T_b T_c
    for (int h = 0; h < heights / 2; ++h)
      level += 2.0 * upward(c, h) * planes[h];
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; b <= degree; ++b)
        if (a + b + c > degree || (a + b) % 2 != 0) // the potential is even
          level(a, b) = 0.0;
    level = powers.transpose() * level * powers;
    for (int p = 0; p <= c; p += 2)
      in_powers[p] += powers(c, p) * level;
  }
  for_each_monomial(shape_, [&](int a, int b, int c) { lattice_.push_back(in_powers[c](a, b)); });
  assert(lattice_.size() == shape_.size);
}

double FarImages::potential(const Vec3& displacement) const {
  const Vec3 at = displacement.cwiseQuotient(scale_);
  double sum = 0.0;
  std::size_t next = 0;
  for_each_monomial(shape_, [&](int a, int b, int c) {
    sum += lattice_[next++] * std::pow(at.x(), a) * std::pow(at.y(), b) * std::pow(at.z(), c);
  });
  return sum;
}

// Expands the powers of differences by the binomial theorem: (x − x′)^i = Σ_a C(i, a) x^a (−x′)^(i−a).
FarImages::Coefficients FarImages::potential_of(const Coefficients& moments) const {
  assert(moments.size() == shape_.size);
  const TermIndices indices = indices_of(shape_);
  std::array<std::array<double, degree + 1>, degree + 1> choose{};
  for (int i = 0; i <= degree; ++i) {
    choose[i][0] = 1.0;
    for (int a = 1; a <= i; ++a)
      choose[i][a] = choose[i - 1][a - 1] + choose[i - 1][a];
  }
  Coefficients result(shape_.size, 0.0);
  std::size_t next = 0;
  for_each_monomial(shape_, [&](int i, int j, int k) {
    const double weight = lattice_[next++];
    if ((i + j) % 2 != 0 || k % 2 != 0)
      return;
    for (int c = 0; c <= k; ++c)
      for (int b = 0; b <= j; ++b)
        for (int a = 0; a <= i; ++a) {
          const double sign = (a + b + c) % 2 != 0 ? -1.0 : 1.0; // of the source's powers, as i + j + k is even
          result[indices[c][b][a]] +=
              sign * weight * choose[i][a] * choose[j][b] * choose[k][c] * moments[indices[k - c][j - b][i - a]];
        }
  });
  return result;
}

} // namespace keeler::gravity
