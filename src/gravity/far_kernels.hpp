// Inner loops of the far images: moments of bodies, and gradients of a polynomial at bodies, compiled once per
// instruction set. The number of partial sums does not depend on the width of the registers, so all sets give the same
// bits.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler::gravity {

/// Monomials x^a y^b z^c with c <= height_degree and a + b + c <= degree; a runs fastest, then b, then c.
struct PolynomialShape {
  int degree = 0, height_degree = 0;
  std::size_t size = 0; ///< monomials
};

/// A block of bodies, in units of the polynomial; Real is float or double.
template<class Real> struct FarBlock {
  static constexpr std::size_t capacity = 512;
  alignas(64) Real x[capacity], y[capacity], z[capacity], mass[capacity];
  std::size_t count = 0;
};

template<class Real> struct FarKernels {
  /// Writes Σ mass x^a y^b z^c for every monomial. May overwrite the block behind its last body.
  void (*gather)(FarBlock<Real>& block, const PolynomialShape& shape, double* moments);

  /// Replaces x, y and z of each body by the polynomial's derivatives along x, y and z.
  void (*slopes)(FarBlock<Real>& block, const PolynomialShape& shape, const Real* coefficients);
};

/// Precondition: the processor supports the set.
template<class Real> FarKernels<Real> far_kernels(InstructionSet set);
template<> FarKernels<float> far_kernels(InstructionSet set);
template<> FarKernels<double> far_kernels(InstructionSet set);

} // namespace keeler::gravity
