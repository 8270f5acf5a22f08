#include "sheared_transform.hpp"

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>

namespace keeler::gravity {
namespace {

// Two complex numbers, aligned like one. (A deduced type would lose the alignment.)
typedef float Two __attribute__((vector_size(16), aligned(8), may_alias));
typedef double Whole __attribute__((may_alias)); // one complex number, moved at once

// Swaps real and imaginary parts.
Two swapped(Two numbers) {
  return __builtin_shufflevector(numbers, numbers, 1, 0, 3, 2);
}

fftwf_complex* fftw(std::complex<float>* numbers) {
  return reinterpret_cast<fftwf_complex*>(numbers); // the layout that FFTW and the C++ standard both promise
}

} // namespace

HalfSpectrum::HalfSpectrum(Mesh& mesh, const IndexRange& columns, std::size_t waves)
    : waves_{0, waves}, planes_(mesh.shape().planes), block_length_(block * mesh.shape().column_length() / 2),
      values_(reinterpret_cast<Complex*>(mesh.column(columns.begin))) {
  static_assert(sizeof(Complex) == 2 * sizeof(float) && block <= Mesh::spare_columns + 1);
  assert(waves * planes_ * block <= block_length_ && 2 * waves <= mesh.shape().row_length());
  divide({&columns, 1});
}

void HalfSpectrum::reset(std::span<const IndexRange> columns, const IndexRange& waves, std::size_t planes) {
  divide(columns);
  waves_ = waves;
  planes_ = planes;
  block_length_ = waves.size() * planes * block;
  memory_.resize_at_least(blocks() * block_length_);
  values_ = memory_.data();
}

void HalfSpectrum::divide(std::span<const IndexRange> columns) {
  assert(std::is_sorted(columns.begin(), columns.end(),
                        [](const IndexRange& a, const IndexRange& b) { return a.begin < b.begin; }));
  columns_.clear();
  for (const IndexRange& range : columns)
    for (std::size_t begin = range.begin; begin < range.end; begin += block)
      columns_.push_back({begin, std::min(begin + block, range.end)});
}

ShearedTransform::~ShearedTransform() {
  destroy_plans();
}

void ShearedTransform::destroy_plans() {
  for (fftwf_plan* const plan : {&forward_y_, &backward_y_, &forward_x_, &backward_x_}) {
    fftwf_destroy_plan(*plan);
    *plan = nullptr;
  }
}

void ShearedTransform::make_plans() {
  destroy_plans();
  planned_columns_ = planned_rows_ = 0; // not valid until all plans are made
  const auto columns = static_cast<int>(shape_.columns), rows = static_cast<int>(shape_.rows);
  AlignedArray<float> real;
  AlignedArray<Complex> one, other;
  real.resize_at_least(shape_.row_length());
  one.resize_at_least(std::max(spectrum_row(), row_length()));
  other.resize_at_least(std::max(spectrum_row(), row_length()));
  forward_y_ = fftwf_plan_dft_r2c_1d(rows, real.data(), fftw(one.data()), FFTW_ESTIMATE);
  backward_y_ = fftwf_plan_dft_c2r_1d(rows, fftw(one.data()), real.data(), FFTW_ESTIMATE);
  forward_x_ = fftwf_plan_dft_1d(columns, fftw(one.data()), fftw(other.data()), FFTW_FORWARD, FFTW_ESTIMATE);
  backward_x_ = fftwf_plan_dft_1d(columns, fftw(one.data()), fftw(other.data()), FFTW_BACKWARD, FFTW_ESTIMATE);
  for (const fftwf_plan plan : {forward_y_, backward_y_, forward_x_, backward_x_})
    if (plan == nullptr)
      throw std::bad_alloc();
  planned_columns_ = shape_.columns;
  planned_rows_ = shape_.rows;
}

void ShearedTransform::prepare(const MeshShape& shape, double offset_fraction, const IndexRange& waves) {
  assert(std::fabs(offset_fraction) <= 0.5 && waves.end <= ShearedTransform::waves(shape));
  shape_ = shape;
  first_wave_ = waves.begin;
  if (shape.columns != planned_columns_ || shape.rows != planned_rows_)
    make_plans();
  scratch_.resize(static_cast<std::size_t>(threads()));
  for (auto& scratch : scratch_)
    scratch.resize_at_least(shape.planes * std::max(2 * row_length(), block * spectrum_row()));
  phases_.resize_at_least(waves.size() * 2 * row_length());
  offset_fraction_ = offset_fraction;
  parallel_for(
      waves.size(),
      [&](std::size_t k) {
        const std::size_t m = waves.begin + k;
        // e^{−i k_y d x / L_x} at each column, by powers of that at the first one
        const double angle = -2.0 * pi * offset_fraction * static_cast<double>(m) / static_cast<double>(shape.columns);
        const std::complex<double> step(std::cos(angle), std::sin(angle));
        std::complex<double> phase = 1.0;
        for (std::size_t i = 0; i < row_length(); ++i) {
          const auto cosine = static_cast<float>(phase.real()), sine = static_cast<float>(phase.imag());
          cosines(m)[i] = {cosine, cosine};
          sines(m)[i] = {-sine, sine};
          phase = {phase.real() * step.real() - phase.imag() * step.imag(),
                   phase.real() * step.imag() + phase.imag() * step.real()};
        }
      },
      16);
}

double ShearedTransform::relative_kx(std::size_t m, std::size_t n) const {
  const auto columns = static_cast<double>(shape_.columns);
  const double kx = static_cast<double>(n) + static_cast<double>(m) * offset_fraction_;
  return kx - columns * std::nearbyint(kx / columns);
}

std::complex<float>* ShearedTransform::own_scratch() {
  assert(static_cast<std::size_t>(omp_get_thread_num()) < scratch_.size());
  return scratch_[static_cast<std::size_t>(omp_get_thread_num())].data();
}

void ShearedTransform::forward_y(Mesh& mesh, HalfSpectrum& half) {
  assert(half.waves().size() == waves());
  const std::size_t planes = shape_.planes, rows = shape_.rows;
  parallel_for(
      half.blocks(),
      [&](std::size_t b) {
        const std::size_t begin = half.columns(b).begin, count = half.columns(b).size();
        Complex* const spectra = own_scratch();
        for (std::size_t c = 0; c < block; ++c)
          for (std::size_t k = 0; k < planes; ++k) {
            Complex* const spectrum = spectra + (c * planes + k) * spectrum_row();
            if (c < count) {
              float* const row = mesh.column(begin + c) + k * shape_.row_length();
              for (std::size_t ghost = rows; ghost < rows + MeshShape::ghosts; ++ghost)
                row[ghost % rows] += row[ghost];
              fftwf_execute_dft_r2c(forward_y_, row, fftw(spectrum));
            } else {
              std::fill(spectrum, spectrum + waves(), Complex(0.0f));
            }
          }
        const auto* const from = reinterpret_cast<const Whole*>(spectra);
        for (std::size_t m = 0; m < waves(); ++m) {
          auto* const to = reinterpret_cast<Whole*>(half.wave(b, m));
          for (std::size_t k = 0; k < planes; ++k)
            for (std::size_t c = 0; c < block; ++c)
              to[k * block + c] = from[(c * planes + k) * spectrum_row() + m];
        }
      },
      1);
}

void ShearedTransform::forward_x(std::size_t m, HalfSpectrum& half, Complex* rows, Complex* spectra) {
  const std::size_t columns = shape_.columns, planes = shape_.planes;
  for (std::size_t b = 0; b < half.blocks(); ++b) {
    const std::size_t begin = half.columns(b).begin;
    const Two* const cosine = reinterpret_cast<const Two*>(cosines(m) + begin);
    const Two* const sine = reinterpret_cast<const Two*>(sines(m) + begin);
    const Two* const from = reinterpret_cast<const Two*>(half.wave(b, m));
    for (std::size_t k = 0; k < planes; ++k) {
      Two* const to = reinterpret_cast<Two*>(rows + k * row_length() + begin); // later blocks overwrite the rest
      for (std::size_t c = 0; c < block / 2; ++c) {
        const Two value = from[k * (block / 2) + c];
        to[c] = value * cosine[c] + swapped(value) * sine[c];
      }
    }
  }
  for (std::size_t k = 0; k < planes; ++k) {
    Complex* const row = rows + k * row_length();
    for (std::size_t ghost = columns; ghost < columns + MeshShape::ghosts; ++ghost)
      row[ghost % columns] += row[ghost];
    fftwf_execute_dft(forward_x_, fftw(row), fftw(spectra + k * row_length()));
  }
}

void ShearedTransform::backward_x(std::size_t m, Complex* spectra, Complex* rows, HalfSpectrum& half) {
  const std::size_t columns = shape_.columns, planes = shape_.planes;
  for (std::size_t k = 0; k < planes; ++k) {
    Complex* const row = rows + k * row_length();
    fftwf_execute_dft(backward_x_, fftw(spectra + k * row_length()), fftw(row));
    for (std::size_t i = columns; i < row_length(); ++i)
      row[i] = row[i % columns];
  }
  for (std::size_t b = 0; b < half.blocks(); ++b) {
    const std::size_t begin = half.columns(b).begin;
    const Two* const cosine = reinterpret_cast<const Two*>(cosines(m) + begin);
    const Two* const sine = reinterpret_cast<const Two*>(sines(m) + begin);
    Two* const to = reinterpret_cast<Two*>(half.wave(b, m));
    for (std::size_t k = 0; k < planes; ++k) {
      const Two* const from = reinterpret_cast<const Two*>(rows + k * row_length() + begin);
      for (std::size_t c = 0; c < block / 2; ++c) // the inverse phase
        to[k * (block / 2) + c] = from[c] * cosine[c] - swapped(from[c]) * sine[c];
    }
  }
}

void ShearedTransform::backward_y(HalfSpectrum& half, Mesh& mesh) {
  assert(half.waves().size() == waves());
  const std::size_t planes = shape_.planes, rows = shape_.rows;
  parallel_for(
      half.blocks(),
      [&](std::size_t b) {
        const std::size_t begin = half.columns(b).begin, count = half.columns(b).size();
        Complex* const spectra = own_scratch();
        auto* const to = reinterpret_cast<Whole*>(spectra);
        for (std::size_t m = 0; m < waves(); ++m) {
          const auto* const from = reinterpret_cast<const Whole*>(half.wave(b, m));
          for (std::size_t k = 0; k < planes; ++k)
            for (std::size_t c = 0; c < block; ++c)
              to[(c * planes + k) * spectrum_row() + m] = from[k * block + c];
        }
        for (std::size_t c = 0; c < count; ++c)
          for (std::size_t k = 0; k < planes; ++k) {
            Complex* const spectrum = spectra + (c * planes + k) * spectrum_row();
            if (rows % 2 == 0)
              spectrum[rows / 2] = 0.0f;
            float* const row = mesh.column(begin + c) + k * shape_.row_length();
            fftwf_execute_dft_c2r(backward_y_, fftw(spectrum), row);
            for (std::size_t ghost = rows; ghost < rows + MeshShape::ghosts; ++ghost)
              row[ghost] = row[ghost % rows];
          }
      },
      1);
}

} // namespace keeler::gravity
