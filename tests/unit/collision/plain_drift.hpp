// The plain version of the drift phase, which defines its result: the certified finder is asked about all pairs in all
// images that their orbits can bring into contact; contacts are carried out one at a time, and all pairs of the two
// particles are asked about again after each. No cells, lists, memory of earlier steps, heap or threads; equal results
// to the last bit.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/collision/friction.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/finders/finders.hpp>

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace keeler::test {

class PlainDrift {
public:
  PlainDrift(const collision::CollisionSettings& settings, const Frequencies& f, double orbital_frequency, double step)
      : settings_(settings), f_(f), omega_(orbital_frequency), step_(step), at_hand_(f, -0.5 * step, 0.5 * step, 0.0),
        finder_(finders::make_finder("certified")) {}

  std::vector<collision::CollisionRecord> collide(Particles& particles, const ShearingBox& box, double offset,
                                                  CollisionTally& tally, const collision::KickInterval& gravity = {}) {
    particles_ = &particles, box_ = box, offset_ = offset, gravity_ = gravity;
    lost_ = flux_ = gain_ = {};
    begin();
    last_.assign(particles.size(), -0.5 * step_);
    pending_.clear();
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t j = i + 1; j < particles.size(); ++j)
        look(i, j);
    std::vector<collision::CollisionRecord> records;
    while (!pending_.empty()) {
      const auto [key, places] = *pending_.begin();
      pending_.erase(pending_.begin());
      if (!bounce(key, places, tally, records))
        continue;
      const auto [i, j] = places;
      for (auto it = pending_.begin(); it != pending_.end();)
        it = involves(it->second, i) || involves(it->second, j) ? pending_.erase(it) : std::next(it);
      for (std::size_t k = 0; k < particles.size(); ++k) {
        if (k != i)
          look(i, k);
        if (k != i && k != j)
          look(j, k);
      }
    }
    tally.energy_lost += lost_.value();
    tally.momentum_flux += flux_.value();
    tally.azimuthal_gain += gain_.value();
    return records;
  }

private:
  using Key = std::tuple<double, std::uint64_t, std::uint64_t, int, int>;
  using Places = std::pair<std::size_t, std::size_t>; // the lower id first

  static bool involves(const Places& places, std::size_t k) { return places.first == k || places.second == k; }

  // These two functions alone depend on the interface of finders.
  void begin() {
    at_hand_ = finders::DriftStep(f_, -0.5 * step_, 0.5 * step_, box_.size_x + box_.size_y);
    at_hand_.bodies = particles_->bodies;
    finder_->begin(at_hand_);
  }
  finders::FinderResult ask(std::size_t low, std::size_t high, const Vec3& shift, double start) const {
    return finder_->find(
        {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high), shift.x(), shift.y(), start});
  }

  void look(std::size_t i, std::size_t j) {
    const bool ordered = particles_->ids[i] < particles_->ids[j];
    const Places places{ordered ? i : j, ordered ? j : i};
    const auto& [low, high] = places;
    const Body &a = particles_->bodies[low], &b = particles_->bodies[high];
    const Elements el = b.elements - a.elements;
    const double start = std::max(last_[i], last_[j]), reach = a.radius + b.radius, e = el.eccentricity();
    // from the positions at the epoch, no farther than the largest speed on the epicycle leads in half a step
    const double half = 0.5 * step_, x = el.guiding_x - el.e_cos, y = el.guiding_y + 2.0 / f_.kappa * el.e_sin;
    for (const int nx : within(x, box_.size_x, reach + half * f_.kappa * e)) {
      const double fastest = f_.shear() * std::fabs(el.guiding_x + nx * box_.size_x) + 2.0 * e;
      for (const int ny : within(y - nx * offset_, box_.size_y, reach + half * fastest)) {
        const Image image{nx, ny};
        const finders::FinderResult result = ask(low, high, box_.displacement(image, offset_), start);
        if (result.contact())
          pending_[{result.time, particles_->ids[low], particles_->ids[high], nx, ny}] = places;
      }
    }
  }

  // Returns all n with |place + n period| <= distance, and a little more.
  static std::vector<int> within(double place, double period, double distance) {
    const double wide = distance * (1.0 + 1e-9) + 1e-9 * period;
    std::vector<int> all;
    for (double n = std::ceil((-wide - place) / period); n <= (wide - place) / period; ++n)
      all.push_back(static_cast<int>(n));
    return all;
  }

  // Uses the arithmetic of ContactLoop, operation by operation: otherwise the bits differ.
  bool bounce(const Key& key, const Places& places, CollisionTally& tally,
              std::vector<collision::CollisionRecord>& records) {
    const auto& [time, low_id, high_id, nx, ny] = key;
    const Image image{nx, ny};
    Body &a = particles_->bodies[places.first], &b = particles_->bodies[places.second];
    const Rotation rotation(f_, time);
    const State relative = state_at(box_.image_of(b.elements, image, offset_) - a.elements, f_, rotation);
    const Vec3 normal = relative.position.normalized();
    const Vec3 lag = lag_of(places, time);
    const bool resolved = is_resolved(a, b, relative.velocity, lag, normal);
    const Vec3 velocity = resolved ? relative.velocity + lag : relative.velocity;
    const double speed = -velocity.dot(normal);
    const collision::Rebound after = rebound(settings_, speed, a.radius, b.radius, omega_);
    if (!(speed > -after.speed))
      return false;
    const double reduced_mass = a.mass * b.mass / (a.mass + b.mass);
    const double normal_impulse = reduced_mass * (speed + after.speed);
    Vec3 impulse = normal_impulse * normal;
    double rubbed = 0.0;
    if (settings_.friction) {
      Vec3 &spin_a = particles_->spins[places.first], &spin_b = particles_->spins[places.second];
      const particles::SpinTurn turn(time);
      const collision::Sliding sliding =
          slide(*settings_.friction, {a, b, normal, velocity, turn.from_epoch(spin_a), turn.from_epoch(spin_b)},
                normal_impulse);
      spin_a += turn.to_epoch(collision::spin_change(a, normal, sliding.impulse));
      spin_b += turn.to_epoch(collision::spin_change(b, normal, sliding.impulse));
      impulse += sliding.impulse;
      rubbed = sliding.energy_lost;
    }
    const double tangential_speed = (velocity + speed * normal).norm();
    const Vec3 place = state_at(a.elements, f_, rotation).position + a.radius * normal;
    double gain = azimuthal_gain(a, -impulse / a.mass, f_, rotation);
    gain += azimuthal_gain(b, impulse / b.mass, f_, rotation);
    gain_ += gain;
    kick(a.elements, -impulse / a.mass, f_, rotation);
    kick(b.elements, impulse / b.mass, f_, rotation);
    last_[places.first] = last_[places.second] = time;
    ++(after.fast ? tally.fast : tally.slow);
    double lost = rubbed + 0.5 * reduced_mass * (speed * speed - after.speed * after.speed);
    if (!resolved)
      lost -= impulse.dot(lag);
    lost_ += lost;
    flux_ += relative.position.x() * impulse.y();
    records.push_back({time, low_id, high_id, image, speed, after.fast, tangential_speed, lost, a.radius + b.radius,
                       place, normal, impulse});
    return true;
  }

  // Returns how much the true relative velocity of a pair exceeds that of the drift.
  Vec3 lag_of(const Places& places, double time) const {
    if (gravity_.accelerations.empty())
      return Vec3::Zero();
    assert(gravity_.at_rest.empty());
    return (time - gravity_.middle) * (gravity_.accelerations[places.second] - gravity_.accelerations[places.first]);
  }
  // True if a pair approaches at its true velocity, and its rebound from that separates it in the drift.
  bool is_resolved(const Body& a, const Body& b, const Vec3& velocity, const Vec3& lag, const Vec3& normal) const {
    const double speed = -(velocity + lag).dot(normal), radii = a.radius + b.radius;
    return !gravity_.accelerations.empty() && speed > 0.0 &&
           rebound(settings_, speed, a.radius, b.radius, omega_).speed - lag.dot(normal) >=
               1e-3 * settings_.cut_speed(radii);
  }

  collision::CollisionSettings settings_;
  Frequencies f_;
  double omega_, step_;
  finders::DriftStep at_hand_;
  std::unique_ptr<finders::Finder> finder_;
  Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;
  collision::KickInterval gravity_;
  std::vector<double> last_; // time of the last velocity change in this step, or its begin
  std::map<Key, Places> pending_;
  ExactSum lost_, flux_, gain_; // over the step
};

} // namespace keeler::test
