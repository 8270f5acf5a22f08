#include "mesh_transform.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <new>

namespace keeler::diagnostics {
namespace {

// A plan for one use.
struct Plan {
  explicit Plan(fftw_plan made) : plan(made) {
    if (plan == nullptr)
      throw std::bad_alloc();
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  ~Plan() { fftw_destroy_plan(plan); }
  fftw_plan plan;
};

fftw_complex* fftw(std::complex<double>* numbers) {
  return reinterpret_cast<fftw_complex*>(numbers); // FFTW and the C++ standard both guarantee this layout
}

void transform_x(std::complex<double>* spectrum, int columns, int waves, int sign) {
  const Plan plan(fftw_plan_many_dft(1, &columns, waves, fftw(spectrum), nullptr, waves, 1, fftw(spectrum), nullptr,
                                     waves, 1, sign, FFTW_ESTIMATE));
  fftw_execute(plan.plan);
}

} // namespace

MeshTransform::MeshTransform(int columns, int rows) : columns_(columns), rows_(rows) {
  assert(columns > 0 && rows > 0 && rows % 2 == 0);
  const auto nodes = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const auto numbers = static_cast<std::size_t>(columns) * static_cast<std::size_t>(waves());
  real_ = fftw_alloc_real(nodes);
  spectrum_ = reinterpret_cast<std::complex<double>*>(fftw_alloc_complex(numbers));
  if (real_ == nullptr || spectrum_ == nullptr) {
    fftw_free(real_);
    fftw_free(spectrum_);
    throw std::bad_alloc();
  }
}

MeshTransform::~MeshTransform() {
  fftw_free(real_);
  fftw_free(spectrum_);
}

void MeshTransform::forward_y() {
  const Plan plan(fftw_plan_many_dft_r2c(1, &rows_, columns_, real_, nullptr, 1, rows_, fftw(spectrum_), nullptr, 1,
                                         waves(), FFTW_ESTIMATE));
  fftw_execute(plan.plan);
}

void MeshTransform::forward_x() {
  transform_x(spectrum_, columns_, waves(), FFTW_FORWARD);
}

void MeshTransform::backward_x() {
  transform_x(spectrum_, columns_, waves(), FFTW_BACKWARD);
}

void MeshTransform::column_backward_y(const std::complex<double>* from, double* to) {
  const std::unique_ptr<fftw_complex, decltype(&fftw_free)> copy(fftw_alloc_complex(static_cast<std::size_t>(waves())),
                                                                 &fftw_free);
  if (!copy)
    throw std::bad_alloc();
  auto* numbers = reinterpret_cast<std::complex<double>*>(copy.get());
  const Plan plan(fftw_plan_dft_c2r_1d(rows_, copy.get(), real_, FFTW_ESTIMATE));
  std::copy(from, from + waves(), numbers);
  fftw_execute(plan.plan);
  std::copy(real_, real_ + rows_, to);
}

} // namespace keeler::diagnostics
