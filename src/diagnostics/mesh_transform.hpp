// Fourier transforms of a real mesh, along y first and then along x, with access to the intermediate stage, where the
// shear of the box is a phase. Plans are made by FFTW_ESTIMATE, so the bits do not depend on earlier plans.
#pragma once

#include <complex>

namespace keeler::diagnostics {

class MeshTransform {
public:
  MeshTransform(int columns, int rows);
  ~MeshTransform();
  MeshTransform(const MeshTransform&) = delete;
  MeshTransform& operator=(const MeshTransform&) = delete;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int waves() const { return rows_ / 2 + 1; } ///< wave numbers kept along y

  double* real() { return real_; } ///< node (i, j) at i × rows + j
  std::complex<double>* waves_of(int column) { return spectrum_ + static_cast<std::ptrdiff_t>(column) * waves(); }

  void forward_y();  ///< real() → waves
  void forward_x();  ///< waves → waves, in place
  void backward_x(); ///< inverse, times columns

  /// Transforms one column back: waves() numbers → rows() numbers, times rows.
  void column_backward_y(const std::complex<double>* from, double* to);

private:
  int columns_, rows_;
  double* real_;
  std::complex<double>* spectrum_;
};

} // namespace keeler::diagnostics
