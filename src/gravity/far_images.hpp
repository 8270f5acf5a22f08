// All images beyond the near ones, so that near images and far ones together make the exact periodic field
// (lattice.hpp).
//
// Seen from inside the cell, the potential of a unit mass's far images is a smooth function of the displacement from
// it. Each solve fits that function by a polynomial in Δx, Δy and Δz (Chebyshev nodes, Ewald's sums), and the
// polynomial of a difference splits: moments of the bodies, and a polynomial at each target. The cost is the same for
// any number of images, and forces are equal and opposite to rounding because the function is even.
//
// Errors (`test far_images`): some 1e-3 G Σ rms, worst at a shear offset of L_y/2, and much below in long boxes.
// Heights count up to half the cell's shorter side a ring; a body farther out feels the far images as from there.
#pragma once

#include "far_kernels.hpp"
#include "lattice.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/gravity/solver.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <algorithm>
#include <vector>

namespace keeler {

/// The settings with at least one ring, and with more where bodies stand as high as `height` (m) above a plane that is
/// not much wider: one for each half of the shorter side, up to `most_rings`. Without far images they stay as they are.
ImageSettings rings_for_height(ImageSettings images, const ShearingBox& box, double height);
inline constexpr int max_rings = 6;

/// The greatest distance of a body from the plane, m.
template<class Body> double height_of(const std::vector<Body>& bodies) {
  double height = 0.0;
  for (const Body& body : bodies)
    height = std::max(height, std::fabs(static_cast<double>(body.z)));
  return height;
}

/// Shifts (m) of the images to be summed one by one: the rings asked for; with far images more along the shorter side
/// of a long box, so that what lies beyond is far from every place in the cell. The offset must be folded (images.hpp).
std::vector<Vec3> near_images(const ShearingBox& box, double offset, const ImageSettings& images);

class FarImages {
public:
  /// What lies beyond near_images(box, offset, {rings, true}), for bodies no farther than `height` from the plane.
  FarImages(const ShearingBox& box, double offset, int rings, double height);

  /// The potential of the far images of a unit mass at a displacement inside (±L_x, ±L_y, ±2 height), G = 1, 1/m, up
  /// to a constant: the fitted polynomial.
  double potential(const Vec3& displacement) const;

  /// What the far images of all bodies do to each of them, per G, kg/m², worked out in float or double. Bodies have
  /// x, y, z inside the cell and a mass.
  template<class Real, class Body>
  std::vector<Vec3> attractions(const std::vector<Body>& bodies, InstructionSet set) const;

private:
  using Coefficients = std::vector<double>; // of the monomials of shape_, in its order

  Coefficients potential_of(const Coefficients& moments) const;
  template<class Real, class Body>
  void load(FarBlock<Real>& block, const std::vector<Body>& bodies, std::size_t begin) const;

  PolynomialShape shape_;
  Vec3 scale_;           // the bounds of a displacement, m
  double ceiling_ = 0.0; // heights are clamped to ± this, m
  Coefficients lattice_; // potential of a unit mass's far images
};

template<class Real, class Body>
void FarImages::load(FarBlock<Real>& block, const std::vector<Body>& bodies, std::size_t begin) const {
  block.count = std::min(block.capacity, bodies.size() - begin);
  for (std::size_t k = 0; k < block.count; ++k) {
    const Body& body = bodies[begin + k];
    block.x[k] = static_cast<Real>(body.x / scale_.x());
    block.y[k] = static_cast<Real>(body.y / scale_.y());
    block.z[k] = static_cast<Real>(std::clamp(body.z, -ceiling_, ceiling_) / scale_.z());
    block.mass[k] = static_cast<Real>(body.mass);
  }
}

template<class Real, class Body>
std::vector<Vec3> FarImages::attractions(const std::vector<Body>& bodies, InstructionSet set) const {
  constexpr std::size_t capacity = FarBlock<Real>::capacity;
  const FarKernels<Real> kernels = far_kernels<Real>(set);
  const std::size_t blocks = (bodies.size() + capacity - 1) / capacity;
  std::vector<Coefficients> parts(blocks, Coefficients(shape_.size));
  parallel_for(
      blocks,
      [&](std::size_t b) {
        FarBlock<Real> block;
        load(block, bodies, b * capacity);
        kernels.gather(block, shape_, parts[b].data());
      },
      1);
  Coefficients moments(shape_.size, 0.0);
  for (const Coefficients& part : parts)
    for (std::size_t k = 0; k < moments.size(); ++k)
      moments[k] += part[k];
  const Coefficients exact = potential_of(moments);
  const std::vector<Real> potential(exact.begin(), exact.end());
  std::vector<Vec3> result(bodies.size());
  parallel_for(
      blocks,
      [&](std::size_t b) {
        FarBlock<Real> block;
        load(block, bodies, b * capacity);
        kernels.slopes(block, shape_, potential.data());
        for (std::size_t k = 0; k < block.count; ++k)
          result[b * capacity + k] = -Vec3(block.x[k] / scale_.x(), block.y[k] / scale_.y(), block.z[k] / scale_.z());
      },
      1);
  return result;
}

/// So few are dealt with pair by pair: a fit costs as much as some hundred exact pulls.
inline constexpr std::size_t few_bodies = 10;

/// Pull of the far images of a unit mass at a displacement from it, exactly, G = 1, 1/m².
Vec3 far_pull(const Lattice& lattice, const std::vector<Vec3>& near, const Vec3& displacement);

/// What the far images add to the acceleration of each body, m rad^-2; nothing where they do not count. Bodies stand in
/// an order that depends on the problem alone.
template<class Real, class Body>
std::vector<Vec3> far_accelerations(const GravityProblem& problem, double offset, const ImageSettings& images,
                                    const std::vector<Body>& bodies, InstructionSet set) {
  if (!images.far)
    return std::vector<Vec3>(bodies.size(), Vec3::Zero());
  std::vector<Vec3> result;
  if (bodies.size() <= few_bodies) {
    const Lattice lattice(problem.box, offset);
    const std::vector<Vec3> near = near_images(problem.box, offset, images);
    for (const Body& a : bodies) {
      result.push_back(Vec3::Zero());
      for (const Body& b : bodies)
        result.back() += problem.newton_g * b.mass * far_pull(lattice, near, {a.x - b.x, a.y - b.y, a.z - b.z});
    }
    return result;
  }
  const FarImages far(problem.box, offset, images.rings, height_of(bodies));
  result = far.attractions<Real>(bodies, set);
  for (Vec3& a : result)
    a *= problem.newton_g;
  return result;
}

} // namespace keeler
