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

#include <keeler/comm/communicator.hpp>
#include <keeler/core/threads.hpp>

#include <fftw3.h>

#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace keeler {

/// What stands between the transforms along y and x: waves m along y of ranges of columns (ghosts too), all planes.
/// The numbers lie block by block of columns, in a block wave by wave, in a wave plane by plane: a cache line of eight
/// columns each. Each range begins a block.
class HalfSpectrum {
public:
  using Complex = std::complex<float>;

  /// Columns that are turned over together.
  static constexpr std::size_t block = 8;

  /// Forgets what there was. Ranges stand in the order of their columns; where they overlap the later one counts.
  void reset(std::span<const IndexRange> columns, const IndexRange& waves, std::size_t planes);

  /// The same, in memory that nobody else needs now.
  void reset(std::span<const IndexRange> columns, const IndexRange& waves, std::size_t planes,
             AlignedArray<Complex> memory) {
    numbers_ = std::move(memory);
    reset(columns, waves, planes);
  }
  /// Gives up all numbers, and the memory that they are in; and takes it back.
  AlignedArray<Complex> take_memory() { return std::move(numbers_); }
  void give_memory(AlignedArray<Complex> memory) { numbers_ = std::move(memory); }

  const IndexRange& waves() const { return waves_; }
  std::size_t blocks() const { return columns_.size(); }
  /// Of block b.
  const IndexRange& columns(std::size_t b) const { return columns_[b]; }

  /// Wave m of block b, plane by plane; what the block has behind its last column means nothing.
  Complex* wave(std::size_t b, std::size_t m) { return numbers_.data() + place(b, m); }

  /// All of these waves in some blocks.
  Blocks part(const IndexRange& blocks, const IndexRange& waves) {
    const std::size_t size = sizeof(Complex);
    if (blocks.size() == 0)
      return {};
    return {reinterpret_cast<std::byte*>(numbers_.data() + place(blocks.begin, waves.begin)), blocks.size(),
            size * waves.size() * planes_ * block, size * waves_.size() * planes_ * block};
  }

private:
  std::size_t place(std::size_t b, std::size_t m) const {
    return (b * waves_.size() + (m - waves_.begin)) * planes_ * block;
  }

  std::vector<IndexRange> columns_;
  IndexRange waves_;
  std::size_t planes_ = 0;
  AlignedArray<Complex> numbers_;
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

  /// For a mesh of that shape at an offset of that part of L_y, in [−½, ½]; along x all waves or these are transformed.
  void prepare(const MeshShape& shape, double offset_part) { prepare(shape, offset_part, {0, waves(shape)}); }
  void prepare(const MeshShape& shape, double offset_part, const IndexRange& waves);

  /// n + m d / L_y, which times 2π / L_x is k_x, of entry n of the transform along x: the alias nearest to 0.
  double turns_x(std::size_t m, std::size_t n) const;

  /// Numbers of one wave m: planes × row_length(). A whole block may begin at the last column.
  std::size_t row_length() const { return (shape_.columns + MeshShape::ghosts + block + 7) / 8 * 8; }

  /// Replaces the mesh by the transform back of what change(m, from, to) makes of its waves. Both hold one wave m of
  /// every plane, with n along a row. Unscaled: without a change the mesh returns columns × rows times as large.
  template<class Change> void apply(Mesh& mesh, const Change& change) {
    reset_whole();
    forward_y(mesh, whole_);
    change_waves(whole_, change);
    backward_y(whole_, mesh);
  }

  /// Calls look(m, spectra, scratch) with the waves of the mesh; scratch has room for as many. The mesh is left as it
  /// is but for its ghosts.
  template<class Look> void visit(Mesh& mesh, const Look& look) {
    reset_whole();
    forward_y(mesh, whole_);
    visit_waves(whole_, look);
  }

  /// The three steps of apply(), for those who share a mesh. The first and the last are of the columns of the half
  /// spectrum, which must have all waves; the one between is of its waves, and it must have all columns.
  void forward_y(Mesh& mesh, HalfSpectrum& half);
  void backward_y(HalfSpectrum& half, Mesh& mesh);
  template<class Change> void change_waves(HalfSpectrum& half, const Change& change) {
    visit_waves(half, [&](std::size_t m, std::complex<float>* spectra, std::complex<float>* rows) {
      change(m, static_cast<const std::complex<float>*>(spectra), rows);
      backward_x(m, rows, spectra, half);
    });
  }
  /// As visit(), of these waves.
  template<class Look> void visit_waves(HalfSpectrum& half, const Look& look) {
    parallel_for(
        half.waves().size(),
        [&](std::size_t k) {
          const std::size_t m = half.waves().begin + k;
          std::complex<float>* const rows = own_scratch();
          std::complex<float>* const spectra = rows + shape_.planes * row_length();
          forward_x(m, half, rows, spectra);
          look(m, spectra, rows);
        },
        1);
  }

private:
  using Complex = std::complex<float>;
  static constexpr std::size_t block = HalfSpectrum::block;

  void reset_whole() {
    const IndexRange all{0, shape_.columns + MeshShape::ghosts};
    whole_.reset({&all, 1}, {0, waves()}, shape_.planes);
  }
  /// Of the turn of each column: (cosine, cosine) and (−sine, sine).
  Complex* cosines(std::size_t m) { return turns_.data() + 2 * (m - first_wave_) * row_length(); }
  Complex* sines(std::size_t m) { return cosines(m) + row_length(); }
  std::size_t spectrum_row() const { return (shape_.rows / 2 + 1 + 7) / 8 * 8; }
  Complex* own_scratch();

  void forward_x(std::size_t m, HalfSpectrum& half, Complex* rows, Complex* spectra);
  void backward_x(std::size_t m, Complex* spectra, Complex* rows, HalfSpectrum& half);
  void make_plans();
  void destroy_plans();

  MeshShape shape_;
  double offset_part_ = 0.0;
  std::size_t first_wave_ = 0;
  HalfSpectrum whole_;
  AlignedArray<Complex> turns_;
  std::vector<AlignedArray<Complex>> scratch_; // one a thread
  std::size_t planned_columns_ = 0, planned_rows_ = 0;
  fftwf_plan forward_y_ = nullptr, backward_y_ = nullptr, forward_x_ = nullptr, backward_x_ = nullptr;
};

} // namespace keeler
