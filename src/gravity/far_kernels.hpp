// Inner loops of the far images: moments of bodies, and slopes of a polynomial at bodies, compiled once for each
// instruction set. As many sums side by side whatever the registers, so that they have the same bits.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler {

/// Monomials x^a y^b z^c with c <= height_degree and a + b + c <= degree; a runs fastest, then b, then c.
struct PolynomialShape {
  int degree = 0, height_degree = 0;
  std::size_t size = 0; ///< monomials
};

/// Some bodies, in units of the polynomial; Real is float or double.
template<class Real> struct FarBlock {
  static constexpr std::size_t capacity = 512;
  alignas(64) Real x[capacity], y[capacity], z[capacity], mass[capacity];
  std::size_t count = 0;
};

template<class Real> struct FarKernels {
  /// Writes Σ mass x^a y^b z^c for every monomial. What stands behind the last body may be overwritten.
  void (*gather)(FarBlock<Real>& block, const PolynomialShape& shape, double* moments);

  /// Puts the polynomial's slopes along x, y and z at each body in the place of its x, y and z.
  void (*slopes)(FarBlock<Real>& block, const PolynomialShape& shape, const Real* coefficients);
};

/// The set must be supported.
template<class Real> FarKernels<Real> far_kernels(InstructionSet set);
template<> FarKernels<float> far_kernels(InstructionSet set);
template<> FarKernels<double> far_kernels(InstructionSet set);

} // namespace keeler
