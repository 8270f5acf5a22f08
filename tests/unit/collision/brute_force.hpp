// The slow, obvious twin of the drift phase: every pair and every image, a dense scan of the curved paths in extended
// precision with bisection, one event at a time. It shares no code with the finders, the grid or the event queue.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace keeler::test {

class BruteForce {
public:
  BruteForce(const collision::CollisionSettings& settings, const Frequencies& f, double orbital_frequency, double step,
             int scans)
      : settings_(settings), f_(f), omega_(orbital_frequency), step_(step), scans_(scans) {}

  std::vector<collision::CollisionRecord> collide(Particles& particles, const ShearingBox& box, double offset) {
    particles_ = &particles, box_ = box, offset_ = offset;
    last_.assign(particles.size(), -0.5 * step_);
    pending_.clear();
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t j = i + 1; j < particles.size(); ++j)
        look(i, j);
    std::vector<collision::CollisionRecord> records;
    while (!pending_.empty()) {
      const Key key = pending_.begin()->first;
      const auto [i, j] = pending_.begin()->second;
      records.push_back(bounce(key, i, j));
      for (auto it = pending_.begin(); it != pending_.end();) {
        const auto [a, b] = it->second;
        it = a == i || a == j || b == i || b == j ? pending_.erase(it) : std::next(it);
      }
      for (std::size_t k = 0; k < particles.size(); ++k) {
        if (k != i)
          look(std::min(i, k), std::max(i, k));
        if (k != i && k != j)
          look(std::min(j, k), std::max(j, k));
      }
    }
    return records;
  }

private:
  using Real = long double;
  using Key = std::tuple<double, std::uint64_t, std::uint64_t, int, int>;
  struct Relative {
    Real gap, slope; // |d|² − R², 2 d·v
  };

  // Ids equal indices in these tests, so the lower index has the lower id.
  void look(std::size_t i, std::size_t j) {
    for (int nx = -2; nx <= 2; ++nx)
      for (int ny = -3; ny <= 3; ++ny)
        if (const std::optional<double> t = contact(i, j, {nx, ny}))
          pending_[{*t, i, j, nx, ny}] = {i, j};
  }

  Relative at(const Elements& el, Real radius_sum, Real t) const {
    const Real k = f_.kappa, n = f_.nu, s = (4 - k * k) / 2;
    const Real ce = std::cos(k * t), se = std::sin(k * t), ci = std::cos(n * t), si = std::sin(n * t);
    const Real ec = el.e_cos * ce - el.e_sin * se, es = el.e_sin * ce + el.e_cos * se;
    const Real is = el.i_sin * ci + el.i_cos * si, ic = el.i_cos * ci - el.i_sin * si;
    const Real x = el.guiding_x - ec, y = el.guiding_y - s * el.guiding_x * t + 2 / k * es, z = is;
    const Real vx = k * es, vy = 2 * ec - s * el.guiding_x, vz = n * ic;
    return {x * x + y * y + z * z - radius_sum * radius_sum, 2 * (x * vx + y * vy + z * vz)};
  }

  std::optional<double> contact(std::size_t i, std::size_t j, const Image& image) const {
    const Body &a = particles_->bodies[i], &b = particles_->bodies[j];
    const Elements el = box_.image_of(b.elements, image, offset_) - a.elements;
    const Real radius_sum = static_cast<Real>(a.radius) + b.radius;
    const Real start = std::max(last_[i], last_[j]), end = 0.5L * step_;
    // too far for the speeds that these elements can ever have
    const Real fastest = f_.shear() * std::fabs(el.guiding_x) + 2 * el.eccentricity() + f_.nu * el.inclination();
    if (std::sqrt(at(el, radius_sum, start).gap + radius_sum * radius_sum) >
        radius_sum + 1.001L * fastest * (end - start))
      return std::nullopt;

    const Real touching = 1e-13L * radius_sum * radius_sum; // rounding of the elements after a bounce
    Relative before = at(el, radius_sum, start);
    if (before.gap <= touching && before.slope < 0)
      return static_cast<double>(start);
    Real t_before = start;
    for (int k = 1; k <= scans_; ++k) {
      const Real t = start + (end - start) * k / scans_;
      const Relative now = at(el, radius_sum, t);
      Real inside = t; // a time at which the pair may be in contact
      if (before.slope < 0 && now.slope >= 0)
        inside = bisect(t_before, t, [&](Real at_time) { return at(el, radius_sum, at_time).slope < 0; });
      if (before.slope < 0 && at(el, radius_sum, inside).gap < 0)
        return accept(bisect(t_before, inside, [&](Real at_time) { return at(el, radius_sum, at_time).gap > 0; }), end);
      if (before.slope >= 0 && before.gap <= touching && now.slope < 0 &&
          now.gap <= touching) // sinks back while touching
        return accept(bisect(t_before, t, [&](Real at_time) { return at(el, radius_sum, at_time).slope >= 0; }), end);
      before = now;
      t_before = t;
    }
    return std::nullopt;
  }

  std::optional<double> accept(Real t, Real end) const {
    return t < end ? std::optional<double>(static_cast<double>(t)) : std::nullopt;
  }

  // Returns the time between a and b at which a condition that holds at a ends.
  template<class Condition> static Real bisect(Real a, Real b, const Condition& holds) {
    for (int k = 0; k < 90; ++k) {
      const Real middle = (a + b) / 2;
      (holds(middle) ? a : b) = middle;
    }
    return b;
  }

  collision::CollisionRecord bounce(const Key& key, std::size_t i, std::size_t j) {
    const double t = std::get<0>(key);
    const Image image{std::get<3>(key), std::get<4>(key)};
    Body &a = particles_->bodies[i], &b = particles_->bodies[j];
    const Rotation r(f_, t);
    const State sa = state_at(a.elements, f_, r), sb = state_at(box_.image_of(b.elements, image, offset_), f_, r);
    const Vec3 n = (sb.position - sa.position).normalized();
    const double speed = -(sb.velocity - sa.velocity).dot(n);
    const double cut = settings_.elastic_below * 0.5 * (a.radius + b.radius);
    const bool fast = speed >= cut;
    const double e = fast ? settings_.restitution({speed * omega_, a.radius, b.radius}) : 1.0;
    const Vec3 impulse = (speed + std::max(e * speed, 1e-3 * cut)) * a.mass * b.mass / (a.mass + b.mass) * n;
    kick(a.elements, -impulse / a.mass, f_, r);
    kick(b.elements, impulse / b.mass, f_, r);
    last_[i] = last_[j] = t;
    return {t, i, j, image, speed, fast};
  }

  collision::CollisionSettings settings_;
  Frequencies f_;
  double omega_, step_;
  int scans_;
  Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;
  std::vector<double> last_;
  std::map<Key, std::pair<std::size_t, std::size_t>> pending_;
};

} // namespace keeler::test
