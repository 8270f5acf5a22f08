// All images beyond the near ones, so that near and far images together give the exact periodic field (lattice.hpp).
//
// Inside the cell, the potential of a unit mass's far images is a smooth function of the displacement from it. Each
// solve fits that function by a polynomial in Δx, Δy and Δz (Chebyshev nodes, Ewald's sums). A polynomial of a
// difference factorises: moments of the bodies, and a polynomial at each target. The cost is independent of the number
// of images, and forces are equal and opposite to rounding because the function is even.
//
// Errors (`test far_images`): some 1e-3 G Σ rms, worst at a shear offset of L_y/2, and far smaller in long boxes.
// Heights are clamped to half the cell's shorter side per ring; a body beyond feels the far images as from there.
#pragma once

#include "far_kernels.hpp"
#include "lattice.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/gravity/solver.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

namespace keeler::gravity {

/// Returns the settings with enough rings for bodies at heights up to `height` (m): one per half of the shorter side,
/// at least 1 and at most max_rings. Settings without far images are returned unchanged.
ImageSettings rings_for_height(ImageSettings images, const ShearingBox& box, double height);
inline constexpr int max_rings = 6;

/// Returns the largest distance of a body from the mid-plane, m.
template<class Body> double height_of(const std::vector<Body>& bodies) {
  double height = 0.0;
  for (const Body& body : bodies)
    height = std::max(height, std::fabs(static_cast<double>(body.z)));
  return height;
}

/// Returns the shifts (m) of the images to be summed one by one: the rings of the settings; with far images more along
/// the shorter side of a long box, so that all others are far from every point of the cell. Precondition: the offset is
/// folded (images.hpp).
std::vector<Vec3> near_images(const ShearingBox& box, double offset, const ImageSettings& images);

/// Some bodies; not deduced, so that a vector converts to it.
template<class Body> using BodySpan = std::type_identity_t<std::span<const Body>>;

class FarImages {
public:
  /// Fits all images beyond near_images(box, offset, {rings, true}), for bodies at heights up to `height` (m).
  FarImages(const ShearingBox& box, double offset, int rings, double height);

  /// Returns the fitted polynomial: the potential (1/m, G = 1, up to a constant) of the far images of a unit mass at a
  /// displacement inside (±L_x, ±L_y, ±2 height).
  double potential(const Vec3& displacement) const;

  /// Returns the attraction per G (kg/m²) of the far images of all bodies on each target, computed in float or double.
  /// Bodies have x, y, z inside the cell and a mass; targets are some or all of them.
  template<class Real, class Body>
  std::vector<Vec3> attractions(const std::vector<Body>& bodies, BodySpan<Body> targets, InstructionSet set) const;

  using Coefficients = std::vector<double>; ///< of the monomials of the polynomial, in order

  /// The two steps of attractions(). The first adds the moments of bodies block by block, in their order: before the
  /// last bodies only whole blocks may be added.
  template<class Real, class Body>
  void add_moments(const std::vector<Body>& bodies, InstructionSet set, Coefficients& moments) const;
  template<class Real, class Body>
  std::vector<Vec3> attractions_by(const Coefficients& moments, BodySpan<Body> targets, InstructionSet set) const;
  Coefficients no_moments() const { return Coefficients(shape_.size, 0.0); }

private:
  Coefficients potential_of(const Coefficients& moments) const;
  template<class Real, class Body>
  void load(FarBlock<Real>& block, std::span<const Body> bodies, std::size_t begin) const;

  PolynomialShape shape_;
  Vec3 scale_;              // largest displacement along each axis, m
  double max_height_ = 0.0; // heights are clamped to ± this, m
  Coefficients lattice_;    // potential of a unit mass's far images
};

template<class Real, class Body>
void FarImages::load(FarBlock<Real>& block, std::span<const Body> bodies, std::size_t begin) const {
  assert(begin < bodies.size());
  block.count = std::min(block.capacity, bodies.size() - begin);
  for (std::size_t k = 0; k < block.count; ++k) {
    const Body& body = bodies[begin + k];
    block.x[k] = static_cast<Real>(body.x / scale_.x());
    block.y[k] = static_cast<Real>(body.y / scale_.y());
    block.z[k] = static_cast<Real>(std::clamp(body.z, -max_height_, max_height_) / scale_.z());
    block.mass[k] = static_cast<Real>(body.mass);
  }
}

template<class Real, class Body>
void FarImages::add_moments(const std::vector<Body>& bodies, InstructionSet set, Coefficients& moments) const {
  assert(moments.size() == shape_.size);
  constexpr std::size_t capacity = FarBlock<Real>::capacity;
  const FarKernels<Real> kernels = far_kernels<Real>(set);
  const std::size_t blocks = (bodies.size() + capacity - 1) / capacity;
  std::vector<Coefficients> parts(blocks, Coefficients(shape_.size));
  parallel_for(
      blocks,
      [&](std::size_t b) {
        FarBlock<Real> block;
        load<Real, Body>(block, bodies, b * capacity);
        kernels.gather(block, shape_, parts[b].data());
      },
      1);
  for (const Coefficients& part : parts)
    for (std::size_t k = 0; k < moments.size(); ++k)
      moments[k] += part[k];
}

template<class Real, class Body>
std::vector<Vec3> FarImages::attractions_by(const Coefficients& moments, BodySpan<Body> targets,
                                            InstructionSet set) const {
  constexpr std::size_t capacity = FarBlock<Real>::capacity;
  const FarKernels<Real> kernels = far_kernels<Real>(set);
  const Coefficients exact = potential_of(moments);
  const std::vector<Real> potential(exact.begin(), exact.end());
  std::vector<Vec3> result(targets.size());
  parallel_for((targets.size() + capacity - 1) / capacity,
               [&](std::size_t b) {
                 FarBlock<Real> block;
                 load<Real, Body>(block, targets, b * capacity);
                 kernels.slopes(block, shape_, potential.data());
                 for (std::size_t k = 0; k < block.count; ++k)
                   result[b * capacity + k] =
                       -Vec3(block.x[k] / scale_.x(), block.y[k] / scale_.y(), block.z[k] / scale_.z());
               },
               1);
  return result;
}

template<class Real, class Body>
std::vector<Vec3> FarImages::attractions(const std::vector<Body>& bodies, BodySpan<Body> targets,
                                         InstructionSet set) const {
  Coefficients moments = no_moments();
  add_moments<Real>(bodies, set, moments);
  return attractions_by<Real, Body>(moments, targets, set);
}

/// Up to this number bodies are treated pair by pair: a fit costs as much as some hundred exact pairs.
inline constexpr std::size_t few_bodies = 10;

/// Returns the exact attraction (1/m², G = 1) of the far images of a unit mass at a displacement from it.
Vec3 far_pull(const Lattice& lattice, const std::vector<Vec3>& near, const Vec3& displacement);

/// Returns the acceleration (m rad^-2) of each target, which is one of the bodies, by the far images of all; zero if
/// the settings exclude them. Precondition: the order of the bodies depends on the problem alone.
template<class Real, class Body>
std::vector<Vec3> far_accelerations(const GravityProblem& problem, double offset, const ImageSettings& images,
                                    const std::vector<Body>& bodies, BodySpan<Body> targets, InstructionSet set) {
  if (!images.far)
    return std::vector<Vec3>(targets.size(), Vec3::Zero());
  std::vector<Vec3> result;
  if (bodies.size() <= few_bodies) {
    const Lattice lattice(problem.box, offset);
    const std::vector<Vec3> near = near_images(problem.box, offset, images);
    for (const Body& a : targets) {
      result.push_back(Vec3::Zero());
      for (const Body& b : bodies)
        result.back() += problem.newton_g * b.mass * far_pull(lattice, near, {a.x - b.x, a.y - b.y, a.z - b.z});
    }
    return result;
  }
  const FarImages far(problem.box, offset, images.rings, height_of(bodies));
  result = far.attractions<Real>(bodies, targets, set);
  for (Vec3& a : result)
    a *= problem.newton_g;
  return result;
}

} // namespace keeler::gravity
