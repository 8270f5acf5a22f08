#include "sheared_transform.hpp"

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

fftwf_complex* fftw(std::complex<float>* numbers) {
  return reinterpret_cast<fftwf_complex*>(numbers); // the layout that FFTW and the C++ standard both promise
}

} // namespace

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
  planned_columns_ = shape_.columns;
  planned_rows_ = shape_.rows;
}

void ShearedTransform::prepare(const MeshShape& shape, double offset_part) {
  shape_ = shape;
  if (shape.columns != planned_columns_ || shape.rows != planned_rows_)
    make_plans();
  spectrum_.resize_at_least(waves() * shape.planes * row_length());
  turns_.resize_at_least(waves() * row_length());
  offset_part_ = offset_part;
  parallel_for(
      waves(),
      [&](std::size_t m) {
        // e^{−i k_y d x / L_x} at each column, by powers of that of one spacing
        const double angle = -2.0 * pi * offset_part * static_cast<double>(m) / static_cast<double>(shape.columns);
        const std::complex<double> step(std::cos(angle), std::sin(angle));
        std::complex<double> turn = 1.0;
        for (std::size_t i = 0; i < row_length(); ++i) {
          turns_.data()[m * row_length() + i] = Complex(turn);
          turn = {turn.real() * step.real() - turn.imag() * step.imag(),
                  turn.real() * step.imag() + turn.imag() * step.real()};
        }
      },
      16);
}

double ShearedTransform::turns_x(std::size_t m, std::size_t n) const {
  const auto columns = static_cast<double>(shape_.columns);
  const double turns = static_cast<double>(n) + static_cast<double>(m) * offset_part_;
  return turns - columns * std::nearbyint(turns / columns);
}

void ShearedTransform::forward_y(Mesh& mesh) {
  const std::size_t columns = shape_.columns + MeshShape::ghosts, planes = shape_.planes, rows = shape_.rows;
  parallel_for(
      (columns + block - 1) / block,
      [&](std::size_t b) {
        const std::size_t begin = b * block, count = std::min(block, columns - begin);
        AlignedArray<Complex> spectra;
        spectra.resize_at_least(block * planes * spectrum_row());
        for (std::size_t c = 0; c < count; ++c)
          for (std::size_t k = 0; k < planes; ++k) {
            float* const row = mesh.column(begin + c) + k * shape_.row_length();
            for (std::size_t ghost = rows; ghost < rows + MeshShape::ghosts; ++ghost)
              row[ghost % rows] += row[ghost];
            fftwf_execute_dft_r2c(forward_y_, row, fftw(spectra.data() + (c * planes + k) * spectrum_row()));
          }
        for (std::size_t m = 0; m < waves(); ++m)
          for (std::size_t k = 0; k < planes; ++k) {
            const Complex* const turn = turns(m) + begin;
            Complex* const to = wave(m) + k * row_length() + begin;
            for (std::size_t c = 0; c < count; ++c) {
              const Complex from = spectra.data()[(c * planes + k) * spectrum_row() + m];
              to[c] = {from.real() * turn[c].real() - from.imag() * turn[c].imag(),
                       from.real() * turn[c].imag() + from.imag() * turn[c].real()};
            }
          }
      },
      1);
}

void ShearedTransform::forward_x(std::size_t m, Complex* to) {
  const std::size_t columns = shape_.columns;
  for (std::size_t k = 0; k < shape_.planes; ++k) {
    Complex* const row = wave(m) + k * row_length();
    for (std::size_t ghost = columns; ghost < columns + MeshShape::ghosts; ++ghost)
      row[ghost % columns] += row[ghost];
    fftwf_execute_dft(forward_x_, fftw(row), fftw(to + k * row_length()));
  }
}

void ShearedTransform::backward_x(std::size_t m, Complex* scratch) {
  const std::size_t columns = shape_.columns;
  for (std::size_t k = 0; k < shape_.planes; ++k) {
    Complex* const from = wave(m) + k * row_length();
    Complex* const row = scratch + k * row_length();
    fftwf_execute_dft(backward_x_, fftw(from), fftw(row));
    const Complex* const turn = turns(m);
    for (std::size_t i = 0; i < columns + MeshShape::ghosts; ++i) { // and back by the same turn
      const Complex value = row[i < columns ? i : i % columns];
      from[i] = {value.real() * turn[i].real() + value.imag() * turn[i].imag(),
                 value.imag() * turn[i].real() - value.real() * turn[i].imag()};
    }
  }
}

void ShearedTransform::backward_y(Mesh& mesh) {
  const std::size_t columns = shape_.columns + MeshShape::ghosts, planes = shape_.planes, rows = shape_.rows;
  parallel_for(
      (columns + block - 1) / block,
      [&](std::size_t b) {
        const std::size_t begin = b * block, count = std::min(block, columns - begin);
        AlignedArray<Complex> spectra;
        spectra.resize_at_least(block * planes * spectrum_row());
        for (std::size_t m = 0; m < waves(); ++m)
          for (std::size_t k = 0; k < planes; ++k) {
            const Complex* const from = wave(m) + k * row_length() + begin;
            for (std::size_t c = 0; c < count; ++c)
              spectra.data()[(c * planes + k) * spectrum_row() + m] = from[c];
          }
        for (std::size_t c = 0; c < count; ++c)
          for (std::size_t k = 0; k < planes; ++k) {
            Complex* const spectrum = spectra.data() + (c * planes + k) * spectrum_row();
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

} // namespace keeler
