#include "bounded_impulses.hpp"

#include <keeler/core/interrupt.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler::contact_solver {
namespace {

constexpr std::size_t max_iterations = 100'000;

} // namespace

BoundedImpulses::BoundedImpulses(std::span<const Joint> joints, std::span<const double> inverse_masses)
    : joints_(joints), inverse_masses_(inverse_masses), changes_(inverse_masses.size()) {
  std::vector<double> weight(inverse_masses.size()); // of a body: number of its joints / mass
  for (const Joint& j : joints_) {
    weight[j.low] += inverse_masses_[j.low];
    weight[j.high] += inverse_masses_[j.high];
  }
  double largest = 1.0; // bound on the eigenvalues, by the Cauchy-Schwarz inequality at each body
  for (const Joint& j : joints_) {
    assert(j.low != j.high && j.low < inverse_masses_.size() && j.high < inverse_masses_.size());
    const double both = inverse_masses_[j.low] + inverse_masses_[j.high], scale = 1.0 / std::sqrt(both);
    assert(both > 0.0);
    scales_.push_back(scale);
    rows_.push_back({j.low, j.high, scale * std::sqrt(inverse_masses_[j.low]),
                     scale * std::sqrt(inverse_masses_[j.high]), j.normal});
    largest = std::max(largest, (weight[j.low] + weight[j.high]) / both);
  }
  step_length_ = 1.9 / largest;
}

void BoundedImpulses::apply(std::span<const double> impulses, std::span<Vec3> changes) const {
  assert(impulses.size() == joints_.size() && changes.size() == inverse_masses_.size());
  std::fill(changes.begin(), changes.end(), Vec3::Zero());
  for (std::size_t c = 0; c < joints_.size(); ++c) {
    const Joint& j = joints_[c];
    changes[j.low] -= (impulses[c] * inverse_masses_[j.low]) * j.normal;
    changes[j.high] += (impulses[c] * inverse_masses_[j.high]) * j.normal;
  }
}

// Computes velocity changes by the impulses x.
void BoundedImpulses::apply_scaled(const std::vector<double>& x) {
  std::fill(changes_.begin(), changes_.end(), Vec3::Zero());
  for (std::size_t c = 0; c < rows_.size();) {
    const std::uint32_t low = rows_[c].low; // consecutive joints of one body: summed in registers
    Vec3 change = changes_[low];
    for (; c < rows_.size() && rows_[c].low == low; ++c) {
      const Row& row = rows_[c];
      change -= (row.at_low * x[c]) * row.normal;
      changes_[row.high] += (row.at_high * x[c]) * row.normal;
    }
    changes_[low] = change;
  }
}

// Returns the speed at which changes_ opens the joint.
double BoundedImpulses::opening(const Row& row) const {
  return row.normal.dot(row.at_high * changes_[row.high] - row.at_low * changes_[row.low]);
}

void BoundedImpulses::start(std::span<const double> required, std::span<const double> tolerances,
                            std::span<const double> impulses) {
  const std::size_t count = joints_.size();
  assert(required.size() == count && tolerances.size() == count && impulses.size() == count);
  for (std::vector<double>* array : {&x_, &required_, &tolerances_, &gradient_, &direction_, &applied_})
    array->resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    x_[c] = std::max(0.0, impulses[c] / scales_[c]);
    required_[c] = scales_[c] * required[c];
    tolerances_[c] = scales_[c] * tolerances[c];
  }
  recompute_gradient();
}

// Recomputes the gradient from x; the direction becomes the gradient on the free set.
void BoundedImpulses::recompute_gradient() {
  apply_scaled(x_);
  for (std::size_t c = 0; c < x_.size(); ++c) {
    gradient_[c] = opening(rows_[c]) - required_[c];
    direction_[c] = x_[c] > 0.0 ? gradient_[c] : 0.0;
  }
}

BoundedImpulses::Residual BoundedImpulses::residual() const {
  const double per_length = 1.0 / step_length_;
  Residual residual;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double slope = gradient_[c];
    const bool pushes = x_[c] > 0.0;
    const double bound = std::min(0.0, slope);
    residual.free += pushes ? std::min(x_[c] * per_length, slope) * slope : 0.0;
    residual.bound += pushes ? 0.0 : bound * bound;
    residual.converged &= std::abs(pushes ? slope : bound) <= tolerances_[c];
  }
  return residual;
}

BoundedImpulses::LineSearch BoundedImpulses::line_search() {
  apply_scaled(direction_);
  double curvature = 0.0, fall = 0.0;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    applied_[c] = opening(rows_[c]);
    curvature += direction_[c] * applied_[c];
    fall += direction_[c] * gradient_[c];
  }
  return {curvature, fall / curvature};
}

// True if all impulses stay positive over this length; false for an infinite one.
bool BoundedImpulses::stays_feasible(double length) const {
  bool keeps = std::isfinite(length);
  for (std::size_t c = 0; c < x_.size(); ++c)
    keeps &= length * direction_[c] <= x_[c];
  return keeps;
}

// Returns the largest length along the direction at which no impulse is negative.
double BoundedImpulses::max_feasible_length() const {
  double length = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < x_.size(); ++c)
    if (direction_[c] > 0.0)
      length = std::min(length, x_[c] / direction_[c]);
  return length;
}

// Takes the full conjugate gradient step.
void BoundedImpulses::conjugate_step(const LineSearch& line) {
  double overlap = 0.0;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    x_[c] = x_[c] > 0.0 ? std::max(0.0, x_[c] - line.best * direction_[c]) : 0.0;
    gradient_[c] -= line.best * applied_[c];
    overlap += x_[c] > 0.0 ? gradient_[c] * applied_[c] : 0.0;
  }
  const double turn = overlap / line.curvature;
  for (std::size_t c = 0; c < x_.size(); ++c)
    direction_[c] = x_[c] > 0.0 ? gradient_[c] - turn * direction_[c] : 0.0;
}

// Goes this far along the direction, then takes a projected gradient step: joints may leave the free set.
void BoundedImpulses::expansion_step(double length) {
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double there = std::max(0.0, x_[c] - length * direction_[c]);
    const double slope = gradient_[c] - length * applied_[c];
    x_[c] = there > 0.0 ? std::max(0.0, there - step_length_ * slope) : 0.0;
  }
  recompute_gradient();
}

// Lets joints that close without an impulse enter the free set.
void BoundedImpulses::proportioning_step() {
  for (std::size_t c = 0; c < x_.size(); ++c)
    direction_[c] = x_[c] > 0.0 ? 0.0 : std::min(0.0, gradient_[c]);
  const LineSearch line = line_search();
  for (std::size_t c = 0; c < x_.size(); ++c) {
    x_[c] -= line.best * direction_[c];
    gradient_[c] -= line.best * applied_[c];
    direction_[c] = x_[c] > 0.0 ? gradient_[c] : 0.0;
  }
}

bool BoundedImpulses::solve(std::span<const double> required, std::span<const double> tolerances,
                            std::span<double> impulses) {
  start(required, tolerances, impulses);
  for (std::size_t k = 0;; ++k) {
    const Residual residual = this->residual();
    if (residual.converged)
      break;
    if (k == max_iterations)
      return false;
    throw_if_interrupted();
    if (residual.bound > residual.free) {
      proportioning_step();
      continue;
    }
    const LineSearch line = line_search();
    if (stays_feasible(line.best)) {
      conjugate_step(line);
      continue;
    }
    const double length = max_feasible_length();
    if (!std::isfinite(length))
      return false; // jammed: no impulses open it
    expansion_step(length);
  }
  for (std::size_t c = 0; c < x_.size(); ++c)
    impulses[c] = scales_[c] * x_[c];
  return true;
}

} // namespace keeler::contact_solver
