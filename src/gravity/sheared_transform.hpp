// Fourier transforms over the sheared box, plane by plane, and back.
//
// A wave of the box has k_y = 2π m / L_y and k_x = 2π n / L_x + k_y d / L_x, d the shear offset: k_x from the condition
// that it is the same at (x + L_x, y − d). So: transform along y; turn each column of wave m by −k_y d x / L_x, after
// which columns are periodic in x and the ghosts behind the last column, turned on, add to the first ones; transform
// along x. Nothing is deposited askew: the mesh stays square at any offset, and forces pass over a wrap of the offset
// without a step.
//
// Of an even number of rows the wave m = rows / 2 has no direction; it is left out (the cloud leaves it next to
// nothing).
//
// Plans are made by FFTW_ESTIMATE alone, without wisdom, for one row each, and run by our own threads: bits depend on
// the sizes and on the processor's code inside FFTW only.
#pragma once

#include "aligned_array.hpp"
#include "mesh.hpp"

#include <keeler/core/threads.hpp>

#include <fftw3.h>

#include <complex>
#include <vector>

namespace keeler {

class ShearedTransform {
public:
  ShearedTransform() = default;
  ShearedTransform(const ShearedTransform&) = delete;
  ShearedTransform& operator=(const ShearedTransform&) = delete;
  ~ShearedTransform();

  /// For a mesh of that shape at an offset of that part of L_y, in [−½, ½].
  void prepare(const MeshShape& shape, double offset_part);

  /// Waves m = 0 … waves() − 1 along y.
  std::size_t waves() const { return (shape_.rows + 1) / 2; }

  /// n + m d / L_y, which times 2π / L_x is k_x, of entry n of the transform along x: the alias nearest to 0.
  double turns_x(std::size_t m, std::size_t n) const;

  /// Numbers of one wave m: planes × row_length().
  std::size_t row_length() const { return (shape_.columns + MeshShape::ghosts + 7) / 8 * 8; }

  /// Replaces the mesh by the transform back of what change(m, from, to) makes of its waves. Both hold one wave m of
  /// every plane, with n along a row. Unscaled: without a change the mesh returns columns × rows times as large.
  template<class Change> void apply(Mesh& mesh, const Change& change) {
    visit(mesh, [&](std::size_t m, Complex* spectra, Complex* rows) {
      change(m, static_cast<const Complex*>(spectra), rows);
      backward_x(m, rows, spectra);
    });
    backward_y(mesh);
  }

  /// Calls look(m, spectra, scratch) with the waves of the mesh; scratch has room for as many. The mesh is left as it
  /// is but for its ghosts.
  template<class Look> void visit(Mesh& mesh, const Look& look) {
    forward_y(mesh);
    parallel_for(
        waves(),
        [&](std::size_t m) {
          Complex* const rows = own_scratch();
          Complex* const spectra = rows + shape_.planes * row_length();
          forward_x(m, rows, spectra);
          look(m, spectra, rows);
        },
        1);
  }

private:
  using Complex = std::complex<float>;

  /// Columns that are turned over together. Between the transforms along y and x they lie block by block, in a block
  /// wave by wave, in a wave plane by plane: a cache line of eight columns each.
  static constexpr std::size_t block = 8;

  std::size_t blocks() const { return (shape_.columns + MeshShape::ghosts + block - 1) / block; }
  Complex* wave(std::size_t b, std::size_t m) { return spectrum_.data() + (b * waves() + m) * shape_.planes * block; }
  /// Of the turn of each column: (cosine, cosine) and (−sine, sine).
  Complex* cosines(std::size_t m) { return turns_.data() + 2 * m * row_length(); }
  Complex* sines(std::size_t m) { return cosines(m) + row_length(); }
  std::size_t spectrum_row() const { return (shape_.rows / 2 + 1 + 7) / 8 * 8; }
  Complex* own_scratch();

  void forward_y(Mesh& mesh);
  void forward_x(std::size_t m, Complex* rows, Complex* spectra);
  void backward_x(std::size_t m, Complex* spectra, Complex* rows);
  void backward_y(Mesh& mesh);
  void make_plans();
  void destroy_plans();

  MeshShape shape_;
  double offset_part_ = 0.0;
  AlignedArray<Complex> spectrum_, turns_;
  std::vector<AlignedArray<Complex>> scratch_; // one a thread
  std::size_t planned_columns_ = 0, planned_rows_ = 0;
  fftwf_plan forward_y_ = nullptr, backward_y_ = nullptr, forward_x_ = nullptr, backward_x_ = nullptr;
};

} // namespace keeler
