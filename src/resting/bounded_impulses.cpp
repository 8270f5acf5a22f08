#include "bounded_impulses.hpp"

#include <keeler/core/interrupt.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler {
namespace {

constexpr std::size_t most_iterations = 100'000;

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
    const double both = inverse_masses_[j.low] + inverse_masses_[j.high];
    scales_.push_back(1.0 / std::sqrt(both));
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

// Velocity changes by scaled impulses.
void BoundedImpulses::push_along(const std::vector<double>& x) {
  std::fill(changes_.begin(), changes_.end(), Vec3::Zero());
  for (std::size_t c = 0; c < joints_.size(); ++c) {
    if (x[c] == 0.0)
      continue;
    const Joint& j = joints_[c];
    const Vec3 impulse = (scales_[c] * x[c]) * j.normal;
    changes_[j.low] -= inverse_masses_[j.low] * impulse;
    changes_[j.high] += inverse_masses_[j.high] * impulse;
  }
}

// By these changes, scaled.
double BoundedImpulses::opening(std::size_t joint) const {
  const Joint& j = joints_[joint];
  return scales_[joint] * j.normal.dot(changes_[j.high] - changes_[j.low]);
}

void BoundedImpulses::start(std::span<const double> required, std::span<const double> impulses) {
  const std::size_t count = joints_.size();
  assert(required.size() == count && impulses.size() == count);
  for (std::vector<double>* array : {&x_, &required_, &gradient_, &direction_, &applied_})
    array->resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    x_[c] = std::max(0.0, impulses[c] / scales_[c]);
    required_[c] = scales_[c] * required[c];
  }
  renew_gradient();
}

// From scratch; the direction is then the gradient of the joints that push.
void BoundedImpulses::renew_gradient() {
  push_along(x_);
  for (std::size_t c = 0; c < x_.size(); ++c) {
    gradient_[c] = opening(c) - required_[c];
    direction_[c] = x_[c] > 0.0 ? gradient_[c] : 0.0;
  }
}

BoundedImpulses::Rest BoundedImpulses::rest(std::span<const double> tolerances) const {
  Rest rest;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double slope = gradient_[c], tolerance = scales_[c] * tolerances[c];
    if (x_[c] > 0.0) {
      rest.pushing += std::min(x_[c] / length_, slope) * slope;
      rest.settled &= std::abs(slope) <= tolerance;
    } else if (slope < 0.0) {
      rest.closing += slope * slope;
      rest.settled &= -slope <= tolerance;
    }
  }
  return rest;
}

BoundedImpulses::Along BoundedImpulses::look_along() {
  push_along(direction_);
  Along along{0.0, 0.0, std::numeric_limits<double>::infinity()};
  double fall = 0.0;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    applied_[c] = opening(c);
    along.curvature += direction_[c] * applied_[c];
    fall += direction_[c] * gradient_[c];
    if (direction_[c] > 0.0)
      along.feasible = std::min(along.feasible, x_[c] / direction_[c]);
  }
  along.best = fall / along.curvature;
  return along;
}

// All the way, and on in the next conjugate direction.
void BoundedImpulses::conjugate(const Along& along) {
  double overlap = 0.0;
  for (std::size_t c = 0; c < x_.size(); ++c) {
    x_[c] = x_[c] > 0.0 ? std::max(0.0, x_[c] - along.best * direction_[c]) : 0.0;
    gradient_[c] -= along.best * applied_[c];
    if (x_[c] > 0.0)
      overlap += gradient_[c] * applied_[c];
  }
  const double turn = overlap / along.curvature;
  for (std::size_t c = 0; c < x_.size(); ++c)
    direction_[c] = x_[c] > 0.0 ? gradient_[c] - turn * direction_[c] : 0.0;
}

// As far along the direction as all impulses push, then a projected gradient step: joints may stop pushing.
void BoundedImpulses::expand(const Along& along) {
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double there = std::max(0.0, x_[c] - along.feasible * direction_[c]);
    const double slope = gradient_[c] - along.feasible * applied_[c];
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
  start(required, impulses);
  for (std::size_t k = 0;; ++k) {
    const Rest rest = this->rest(tolerances);
    if (rest.settled)
      break;
    if (k == most_iterations)
      return false;
    throw_if_interrupted();
    ++iterations_;
    if (rest.closing > rest.pushing) {
      proportion();
      continue;
    }
    const Along along = look_along();
    if (along.best <= along.feasible)
      conjugate(along);
    else if (std::isfinite(along.feasible))
      expand(along);
    else
      return false; // jammed: no impulses open it
  }
  for (std::size_t c = 0; c < x_.size(); ++c)
    impulses[c] = scales_[c] * x_[c];
  return true;
}

} // namespace keeler
