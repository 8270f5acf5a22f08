// Fourier transforms over the sheared box, plane by plane, and back.
//
// A wave of the box has k_y = 2π m / L_y and k_x = 2π n / L_x + k_y d / L_x with the shear offset d: it has equal
// phases at (x, y) and (x + L_x, y − d). So: transform along y; multiply wave m at column x by e^{−i k_y d x / L_x},
// after which columns are periodic in x and the ghosts behind the last column, with their phases, are added to the
// first ones; transform along x. The mesh stays rectangular at any offset, and forces are continuous where the offset
// wraps.
//
// With an even number of rows the wave m = rows / 2 has no direction and is omitted (the cloud leaves almost none of
// it).
//
// Plans are made by FFTW_ESTIMATE alone, without wisdom, for one row each, and executed by this program's threads: bits
// depend only on the sizes and on the code that FFTW selects for the processor.
#pragma once

#include "aligned_array.hpp"
#include "mesh.hpp"

#include <keeler/comm/communicator.hpp>
#include <keeler/core/parallel.hpp>

#include <fftw3.h>

#include <cassert>
#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace keeler::gravity {

/// The spectrum between the transforms along y and x: waves m along y of ranges of columns (ghosts included), all
/// planes. Layout: blocks of columns; in a block wave by wave; in a wave plane by plane, one cache line of eight
/// columns each. Each range begins a block. Its memory is its own, or that of a mesh whose columns it replaces.
class HalfSpectrum {
public:
  using Complex = std::complex<float>;

  /// Columns that are transposed together.
  static constexpr std::size_t block = 8;

  HalfSpectrum() = default;
  /// All waves of a range of a mesh's columns, in the mesh's memory: each block where its columns are. Valid until the
  /// mesh is reset or released.
  HalfSpectrum(Mesh& mesh, const IndexRange& columns, std::size_t waves);

  /// Sets the layout; values are lost. Precondition: ranges are ascending. Where they overlap the later one counts.
  void reset(std::span<const IndexRange> columns, const IndexRange& waves, std::size_t planes);

  const IndexRange& waves() const { return waves_; }
  std::size_t blocks() const { return columns_.size(); }
  /// The columns of block b.
  const IndexRange& columns(std::size_t b) const { return columns_[b]; }

  /// Returns wave m of block b, plane by plane. Values behind the block's last column are undefined.
  Complex* wave(std::size_t b, std::size_t m) { return values_ + position(b, m); }

  /// Returns a range of waves of a range of blocks, to be sent or received in place.
  comm::Blocks part(const IndexRange& blocks, const IndexRange& waves) {
    const std::size_t size = sizeof(Complex);
    if (blocks.size() == 0 || waves.size() == 0)
      return {};
    assert(blocks.end <= columns_.size() && waves.begin >= waves_.begin && waves.end <= waves_.end);
    return {reinterpret_cast<std::byte*>(values_ + position(blocks.begin, waves.begin)), blocks.size(),
            size * waves.size() * planes_ * block, size * block_length_};
  }

private:
  void divide(std::span<const IndexRange> columns);
  std::size_t position(std::size_t b, std::size_t m) const {
    return b * block_length_ + (m - waves_.begin) * planes_ * block;
  }

  std::vector<IndexRange> columns_;
  IndexRange waves_;
  std::size_t planes_ = 0, block_length_ = 0; // complex numbers from one block to the next
  Complex* values_ = nullptr;
  AlignedArray<Complex> memory_;
};

class ShearedTransform {
public:
  ShearedTransform() = default;
  ShearedTransform(const ShearedTransform&) = delete;
  ShearedTransform& operator=(const ShearedTransform&) = delete;
  ~ShearedTransform();

  /// Waves m = 0 … waves() − 1 along y.
  std::size_t waves() const { return waves(shape_); }
  static std::size_t waves(const MeshShape& shape) { return (shape.rows + 1) / 2; }

  /// Prepares transforms of a mesh at an offset in units of L_y, along x of all waves or of a range. Precondition:
  /// |offset_fraction| ≤ ½.
  void prepare(const MeshShape& shape, double offset_fraction) { prepare(shape, offset_fraction, {0, waves(shape)}); }
  void prepare(const MeshShape& shape, double offset_fraction, const IndexRange& waves);

  /// Returns k_x L_x / 2π = n + m d / L_y of entry n of the transform along x: the alias nearest to 0.
  double relative_kx(std::size_t m, std::size_t n) const;

  /// Complex numbers per plane of one wave m. A whole block may begin at the last column.
  std::size_t row_length() const { return (shape_.columns + MeshShape::ghosts + block + 7) / 8 * 8; }

  /// Transforms the mesh, calls change(m, from, to) for each wave m, and replaces the mesh by the inverse transform of
  /// `to`. Both arrays have one wave m of every plane, with n along a row. Unscaled: if `to` = `from` the mesh is
  /// multiplied by columns × rows.
  template<class Change> void apply(Mesh& mesh, const Change& change) {
    HalfSpectrum whole = whole_spectrum(mesh);
    forward_y(mesh, whole);
    change_waves(whole, change);
    backward_y(whole, mesh);
  }

  /// Transforms the mesh and calls visitor(m, spectra, scratch) for each wave; scratch has the size of spectra. The
  /// mesh's values are lost.
  template<class Visitor> void visit(Mesh& mesh, const Visitor& visitor) {
    HalfSpectrum whole = whole_spectrum(mesh);
    forward_y(mesh, whole);
    visit_waves(whole, visitor);
  }

  /// The three steps of apply(), for distributed meshes. Preconditions: for forward_y() and backward_y() the half
  /// spectrum has all waves, in its own memory or the mesh's; for change_waves() and visit_waves() it has all columns.
  void forward_y(Mesh& mesh, HalfSpectrum& half);
  void backward_y(HalfSpectrum& half, Mesh& mesh);
  template<class Change> void change_waves(HalfSpectrum& half, const Change& change) {
    visit_waves(half, [&](std::size_t m, std::complex<float>* spectra, std::complex<float>* rows) {
      change(m, static_cast<const std::complex<float>*>(spectra), rows);
      backward_x(m, rows, spectra, half);
    });
  }
  /// Calls visitor(m, spectra, scratch) for each wave of the half spectrum.
  template<class Visitor> void visit_waves(HalfSpectrum& half, const Visitor& visitor) {
    parallel_for(
        half.waves().size(),
        [&](std::size_t k) {
          const std::size_t m = half.waves().begin + k;
          std::complex<float>* const rows = own_scratch();
          std::complex<float>* const spectra = rows + shape_.planes * row_length();
          forward_x(m, half, rows, spectra);
          visitor(m, spectra, rows);
        },
        1);
  }

private:
  using Complex = std::complex<float>;
  static constexpr std::size_t block = HalfSpectrum::block;

  HalfSpectrum whole_spectrum(Mesh& mesh) const { return {mesh, {0, shape_.columns + MeshShape::ghosts}, waves()}; }
  /// The phase of wave m at each column, as (cosine, cosine) and (−sine, sine).
  Complex* cosines(std::size_t m) { return phases_.data() + 2 * (m - first_wave_) * row_length(); }
  Complex* sines(std::size_t m) { return cosines(m) + row_length(); }
  std::size_t spectrum_row() const { return (shape_.rows / 2 + 1 + 7) / 8 * 8; }
  Complex* own_scratch();

  void forward_x(std::size_t m, HalfSpectrum& half, Complex* rows, Complex* spectra);
  void backward_x(std::size_t m, Complex* spectra, Complex* rows, HalfSpectrum& half);
  void make_plans();
  void destroy_plans();

  MeshShape shape_;
  double offset_fraction_ = 0.0;
  std::size_t first_wave_ = 0;
  AlignedArray<Complex> phases_;
  std::vector<AlignedArray<Complex>> scratch_; // per thread
  std::size_t planned_columns_ = 0, planned_rows_ = 0;
  fftwf_plan forward_y_ = nullptr, backward_y_ = nullptr, forward_x_ = nullptr, backward_x_ = nullptr;
};

} // namespace keeler::gravity
