#include "bounded_impulses.hpp"

#include <keeler/core/interrupt.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler {
namespace {

constexpr std::size_t max_iterations = 100'000;

} // namespace

BoundedImpulses::BoundedImpulses(std::span<const Joint> joints, std::span<const double> inverse_masses)
    : joints_(joints), inverse_masses_(inverse_masses), changes_(inverse_masses.size()) {
  std::vector<double> weight(inverse_masses.size()); // of a body: its joints, over its mass
  for (const Joint& j : joints_) {
    weight[j.low] += inverse_masses_[j.low];
    weight[j.high] += inverse_masses_[j.high];
  }
  double largest = 1.0; // bound on the eigenvalues, by the inequality of Cauchy and Schwarz at each body
  for (const Joint& j : joints_) {
    assert(j.low != j.high);
    const double both = inverse_masses_[j.low] + inverse_masses_[j.high], scale = 1.0 / std::sqrt(both);
    scales_.push_back(scale);
    rows_.push_back({j.low, j.high, scale * std::sqrt(inverse_masses_[j.low]),
                     scale * std::sqrt(inverse_masses_[j.high]), j.normal});
    largest = std::max(largest, (weight[j.low] + weight[j.high]) / both);
  }
  length_ = 1.9 / largest;
}

void BoundedImpulses::push(std::span<const double> impulses, std::span<Vec3> changes) const {
  std::fill(changes.begin(), changes.end(), Vec3::Zero());
  for (std::size_t c = 0; c < joints_.size(); ++c) {
    const Joint& j = joints_[c];
    changes[j.low] -= (impulses[c] * inverse_masses_[j.low]) * j.normal;
    changes[j.high] += (impulses[c] * inverse_masses_[j.high]) * j.normal;
  }
}

// Velocity changes by impulses x.
void BoundedImpulses::push_along(const std::vector<double>& x) {
  std::fill(changes_.begin(), changes_.end(), Vec3::Zero());
  for (std::size_t c = 0; c < rows_.size();) {
    const std::uint32_t low = rows_[c].low; // of several joints in a row, which do not wait for each other's stores
    Vec3 change = changes_[low];
    for (; c < rows_.size() && rows_[c].low == low; ++c) {
      const Row& row = rows_[c];
      change -= (row.at_low * x[c]) * row.normal;
      changes_[row.high] += (row.at_high * x[c]) * row.normal;
    }
    changes_[low] = change;
  }
}

// By these changes.
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
  renew_gradient();
}

// From scratch; the direction is then the gradient of the joints that push.
void BoundedImpulses::renew_gradient() {
  push_along(x_);
  for (std::size_t c = 0; c < x_.size(); ++c) {
    gradient_[c] = opening(rows_[c]) - required_[c];
    direction_[c] = x_[c] > 0.0 ? gradient_[c] : 0.0;
  }
}

BoundedImpulses::Rest BoundedImpulses::rest() const {
  const double per_length = 1.0 / length_;
  Rest rest;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double slope = gradient_[c];
    const bool pushes = x_[c] > 0.0;
    const double closing = std::min(0.0, slope);
    rest.pushing += pushes ? std::min(x_[c] * per_length, slope) * slope : 0.0;
    rest.closing += pushes ? 0.0 : closing * closing;
    rest.settled &= std::abs(pushes ? slope : closing) <= tolerances_[c];
  }
  return rest;
}

BoundedImpulses::Along BoundedImpulses::look_along() {
  push_along(direction_);
  double curvature = 0.0, fall = 0.0;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    applied_[c] = opening(rows_[c]);
    curvature += direction_[c] * applied_[c];
    fall += direction_[c] * gradient_[c];
  }
  return {curvature, fall / curvature};
}

// Whether all impulses still push so far along the direction; not if it leads on for ever.
bool BoundedImpulses::keeps_pushing(double length) const {
  bool keeps = std::isfinite(length);
  for (std::size_t c = 0; c < x_.size(); ++c)
    keeps &= length * direction_[c] <= x_[c];
  return keeps;
}

// How far along the direction all impulses push.
double BoundedImpulses::feasible() const {
  double length = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < x_.size(); ++c)
    if (direction_[c] > 0.0)
      length = std::min(length, x_[c] / direction_[c]);
  return length;
}

// All the way, and on in the next conjugate direction.
void BoundedImpulses::conjugate(const Along& along) {
  double overlap = 0.0;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    x_[c] = x_[c] > 0.0 ? std::max(0.0, x_[c] - along.best * direction_[c]) : 0.0;
    gradient_[c] -= along.best * applied_[c];
    overlap += x_[c] > 0.0 ? gradient_[c] * applied_[c] : 0.0;
  }
  const double turn = overlap / along.curvature;
  for (std::size_t c = 0; c < x_.size(); ++c)
    direction_[c] = x_[c] > 0.0 ? gradient_[c] - turn * direction_[c] : 0.0;
}

// So far along the direction, then a projected gradient step: joints may stop pushing.
void BoundedImpulses::expand(double length) {
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double there = std::max(0.0, x_[c] - length * direction_[c]);
    const double slope = gradient_[c] - length * applied_[c];
    x_[c] = there > 0.0 ? std::max(0.0, there - length_ * slope) : 0.0;
  }
  renew_gradient();
}

// Joints that close and do not push begin to push.
void BoundedImpulses::proportion() {
  for (std::size_t c = 0; c < x_.size(); ++c)
    direction_[c] = x_[c] > 0.0 ? 0.0 : std::min(0.0, gradient_[c]);
  const Along along = look_along();
  for (std::size_t c = 0; c < x_.size(); ++c) {
    x_[c] -= along.best * direction_[c];
    gradient_[c] -= along.best * applied_[c];
    direction_[c] = x_[c] > 0.0 ? gradient_[c] : 0.0;
  }
}

bool BoundedImpulses::solve(std::span<const double> required, std::span<const double> tolerances,
                            std::span<double> impulses) {
  start(required, tolerances, impulses);
  for (std::size_t k = 0;; ++k) {
    const Rest rest = this->rest();
    if (rest.settled)
      break;
    if (k == max_iterations)
      return false;
    throw_if_interrupted();
    ++iterations_;
    if (rest.closing > rest.pushing) {
      proportion();
      continue;
    }
    const Along along = look_along();
    if (keeps_pushing(along.best)) {
      conjugate(along);
      continue;
    }
    const double length = feasible();
    if (!std::isfinite(length))
      return false; // jammed: no impulses open it
    expand(length);
  }
  for (std::size_t c = 0; c < x_.size(); ++c)
    impulses[c] = scales_[c] * x_[c];
  return true;
}

} // namespace keeler
