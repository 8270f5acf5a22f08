// The event loop of a drift: take the earliest contact, give both particles their new orbits, and predict the contacts
// of both again (the pair itself included), until the step ends. A particle that is hit often may predict only a part
// of the step; a re-prediction event then continues.
//
// The loop does not know whether it is the only one of the step: an OrbitStore holds the present orbits and decides
// which events are the loop's to carry out.
#pragma once

#include "ablation.hpp"
#include "contact.hpp"
#include "contact_law.hpp"
#include "step_context.hpp"

#include <keeler/collision/events.hpp>
#include <keeler/collision/friction.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <concepts>
#include <span>
#include <vector>

namespace keeler::collision {

/// A visitor for the concept's check of visit_partners().
struct PartnerVisitor {
  void operator()(std::size_t, const Image&) const {}
};

/// The present orbits of the particles, by index, and what one loop may do to them.
template<class Store>
concept OrbitStore = requires(Store& orbits, std::uint32_t i, double time, const Event& event, const Elements& elements,
                              const Vec3& spin, const Contact& contact, const CollisionRecord& record,
                              std::span<const finders::Query> queries, std::span<finders::FinderResult> results,
                              const PartnerVisitor& visit) {
  // the present orbit, the number of changes in the step that led to it, and the time of the last
  { orbits.body(i) } -> std::same_as<const Body&>;
  { orbits.event_count(i) } -> std::same_as<std::uint32_t>;
  { orbits.last_change(i) } -> std::same_as<double>;

  // returns true if the event is valid and this loop's to carry out
  { orbits.is_due(event) } -> std::same_as<bool>;
  // note a contact before its changes; a record only if StepContext::recorded()
  { orbits.add(contact) } -> std::same_as<void>;
  { orbits.add(record) } -> std::same_as<void>;
  // gives i a new orbit from `time` on; set_spin() follows for a rough particle
  { orbits.change(i, elements, time) } -> std::same_as<void>;
  { orbits.set_spin(i, spin) } -> std::same_as<void>;
  // after both changes: returns false if they were undone, for another loop to carry out
  { orbits.commit(event) } -> std::same_as<bool>;
  // returns the particles that commit() gave an earlier orbit back
  { orbits.reinstated() } -> std::convertible_to<std::span<const std::uint32_t>>;

  // calls visit(j, image of j) for all that i may touch between two times, and possibly more
  { orbits.visit_partners(i, time, time, visit) } -> std::same_as<void>;
  // returns true if i has so many neighbours that a shorter prediction pays
  { orbits.may_repredict(i) } -> std::same_as<bool>;
  // asks the finder
  { orbits.find_all(queries, results) } -> std::same_as<void>;
};

template<OrbitStore Orbits> class ContactLoop {
public:
  ContactLoop(const StepContext& step, Orbits& orbits, EventQueue& events)
      : step_(step), orbits_(orbits), events_(events) {}

  /// Carries out events until none is pending. Throws InvariantError when a search meets numbers that are not finite or
  /// a particle collides more than 100,000 times; and Interrupted.
  void run() {
    while (!events_.empty()) {
      throw_if_interrupted();
      const Event event = events_.take_first();
      if (!orbits_.is_due(event))
        continue;
      assert(event.time >= step_.begin && event.time < step_.end());
      if (event.is_reprediction()) {
        find_partners(event.low, event.time, no_particle);
        search();
      } else {
        carry_out(event);
      }
    }
  }

  /// Predicts the contacts of particles that have got an earlier orbit back.
  void predict_again(std::span<const std::uint32_t> particles) {
    for (const std::uint32_t i : particles)
      find_partners(i, orbits_.last_change(i), no_particle);
    if (!particles.empty())
      search();
  }

  /// Returns the largest number of partners that one particle had in one search so far.
  std::uint64_t max_partners() const { return max_partners_; }

private:
  static constexpr std::size_t no_particle = ~std::size_t{0};
  static constexpr std::uint32_t max_collisions = 100000; // of one particle in one step: an event storm, not physics

  /// Particle i may touch this image of j.
  struct Partner {
    std::uint32_t i, j;
    Image image;
  };

  // Returns the question to the finder, the lower id first; `image` is that of particle j.
  finders::Query query_of(std::size_t i, std::size_t j, const Image& image) const {
    const bool ordered = step_.particles.ids[i] < step_.particles.ids[j];
    const Vec3 shift = step_.box.displacement(ordered ? image : -image, step_.offset);
    return {static_cast<std::uint32_t>(ordered ? i : j), static_cast<std::uint32_t>(ordered ? j : i), shift.x(),
            shift.y(), std::max(orbits_.last_change(i), orbits_.last_change(j))};
  }

  Event event_of(const finders::Query& query, double time, const Partner& p) const {
    assert(time >= query.start && time < step_.end());
    const std::vector<std::uint64_t>& ids = step_.particles.ids;
    return {time,
            ids[query.low],
            ids[query.high],
            query.low == p.i ? p.image : -p.image,
            query.low,
            query.high,
            orbits_.event_count(query.low),
            orbits_.event_count(query.high)};
  }

  // Carries out a contact: the impulse along the line of centres turns the normal approach speed into the rebound's
  // (contact_law.hpp).
  void carry_out(const Event& event) {
    assert(step_.particles.ids[event.low] < step_.particles.ids[event.high]);
    const Frequencies& f = step_.frequencies;
    Body a = orbits_.body(event.low), b = orbits_.body(event.high);
    const Rotation rotation(f, event.time);
    const State relative =
        state_at(step_.box.image_of(b.elements, event.image, step_.offset) - a.elements, f, rotation);
    const Vec3 normal = relative.position.normalized();
    Contact contact;
    contact.time = event.time;
    const ContactLaw law =
        contact_law(step_.settings, step_.gravity, step_.orbital_frequency, {event.low, event.high, a.radius, b.radius},
                    relative.velocity, normal, event.time);
    if (!law.acts())
      return;
    const double speed = law.approach, speed_after = law.rebound.speed;
    const Vec3 point = step_.recorded() ? contact_point(a, normal, rotation) : Vec3::Zero();
    const double reduced_mass = a.mass * b.mass / (a.mass + b.mass);
    const double normal_impulse = reduced_mass * (speed + speed_after);
    Vec3 impulse = normal_impulse * normal; // on b; a gets the opposite
    Spins spins;
    if (step_.settings.friction) {
      const Sliding sliding = apply_friction(event, {a, b, normal, law.velocity, {}, {}}, normal_impulse, spins);
      impulse += sliding.impulse;
      contact.energy_lost = sliding.energy_lost;
    }
    const Vec3 change_a = -impulse / a.mass, change_b = impulse / b.mass; // of the velocities
    contact.azimuthal_gain = azimuthal_gain(a, change_a, f, rotation);
    contact.azimuthal_gain += azimuthal_gain(b, change_b, f, rotation);
    kick(a.elements, change_a, f, rotation);
    kick(b.elements, change_b, f, rotation);

    const double distance = a.radius + b.radius;
    contact.fast = law.rebound.fast;
    contact.unresolved = speed * distance * distance < step_.kick_pull * (a.mass + b.mass);
    if (speed * distance * distance < step_.rest_pull * (a.mass + b.mass))
      contact.slow = static_cast<float>(speed * distance * distance / (step_.kick_pull * (a.mass + b.mass)));
    contact.low = event.low;
    contact.high = event.high;
    contact.recontact = orbits_.last_change(event.low) > step_.begin &&
                        orbits_.last_change(event.low) == orbits_.last_change(event.high);
    contact.kick_work = -impulse.dot(law.lag);
    contact.energy_lost += 0.5 * reduced_mass * (speed * speed - speed_after * speed_after);
    if (!law.resolved) // the loss of the drift's energy, and the part of it that the kicks have put there
      contact.energy_lost += contact.kick_work;
    contact.momentum_flux = relative.position.x() * impulse.y();
    orbits_.add(contact);
    if (step_.recorded())
      orbits_.add(CollisionRecord{.time = event.time,
                                  .low_id = event.low_id,
                                  .high_id = event.high_id,
                                  .image = event.image,
                                  .normal_speed = speed,
                                  .fast = contact.fast,
                                  .tangential_speed = (law.velocity + speed * normal).norm(),
                                  .energy_lost = contact.energy_lost,
                                  .radius_sum = distance,
                                  .contact_point = point,
                                  .normal = normal,
                                  .impulse = impulse});

    change(event.low, a.elements, event.time);
    change(event.high, b.elements, event.time);
    if (step_.settings.friction) {
      orbits_.set_spin(event.low, spins.low);
      orbits_.set_spin(event.high, spins.high);
    }
    if (!orbits_.commit(event))
      return;
    find_partners(event.low, event.time, no_particle);
    find_partners(event.high, event.time, event.low); // the first call has found the pair itself, in all its images
    search();
    predict_again(orbits_.reinstated());
  }

  /// The spins of the two particles of a contact, at the epoch.
  struct Spins {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  };

  // Completes `touch` with the spins before the contact, and sets `spins` to the values after it.
  Sliding apply_friction(const Event& event, Touch touch, double normal_impulse, Spins& spins) const {
    const particles::SpinTurn turn(event.time);
    spins = {step_.particles.spins[event.low], step_.particles.spins[event.high]};
    touch.spin_a = turn.from_epoch(spins.low);
    touch.spin_b = turn.from_epoch(spins.high);
    const Sliding sliding = slide(*step_.settings.friction, touch, normal_impulse);
    spins.low += turn.to_epoch(spin_change(touch.a, touch.normal, sliding.impulse));
    spins.high += turn.to_epoch(spin_change(touch.b, touch.normal, sliding.impulse));
    return sliding;
  }

  // Returns the point where a touches b; the normal points from a to b.
  Vec3 contact_point(const Body& a, const Vec3& normal, const Rotation& rotation) const {
    return state_at(a.elements, step_.frequencies, rotation).position + a.radius * normal;
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (orbits_.event_count(i) == max_collisions)
      throw InvariantError(fmt::format(
          "particle {} collided more than {} times in one step (an event storm); raise collisions.elastic_below_speed",
          step_.particles.ids[i], max_collisions));
    const State then = state_at(elements, step_.frequencies, Rotation());
    if (!(then.position.allFinite() && then.velocity.allFinite()))
      throw InvariantError(
          fmt::format("a collision left particle {} with elements that are not finite", step_.particles.ids[i]));
    orbits_.change(i, elements, time);
  }

  // Collects the partners that i may touch after `from`, without `except`, for the next search().
  void find_partners(std::uint32_t i, double from, std::size_t except) {
    std::uint64_t partners = 0;
    const double until = prediction_end(i, from);
    orbits_.visit_partners(i, from, until, [&](std::size_t j, const Image& image) {
      ++partners;
      if (j != except)
        partners_.push_back({i, static_cast<std::uint32_t>(j), image});
    });
    max_partners_ = std::max(max_partners_, partners);
    if (until < step_.end()) {
      const std::uint64_t id = step_.particles.ids[i];
      events_.add({until, id, id, {}, i, i, orbits_.event_count(i), orbits_.event_count(i)});
    }
  }

  // Returns how far ahead to predict. A large body is hit so often that most of a prediction to the end of the step
  // would be in vain: it predicts about two of its mean intervals between hits, and then again.
  double prediction_end(std::uint32_t i, double from) const {
    constexpr double hits_ahead = 2.0, min_fraction = 1.0 / 256.0; // of the step
    const double begin = step_.begin, end = step_.end();
    if (orbits_.event_count(i) < 2 || without(Acceleration::repredictions) || !orbits_.may_repredict(i))
      return end;
    const double ahead = hits_ahead * (from - begin) / orbits_.event_count(i);
    return std::min(end, from + std::max(ahead, min_fraction * (end - begin)));
  }

  // Asks the finder about all collected partners at once, and queues the contacts found.
  void search() {
    queries_.clear();
    for (const Partner& p : partners_)
      queries_.push_back(query_of(p.i, p.j, p.image));
    results_.resize(queries_.size());
    orbits_.find_all(queries_, results_);
    for (std::size_t k = 0; k < queries_.size(); ++k) {
      if (results_[k].exit == finders::FinderExit::not_a_number)
        throw InvariantError(fmt::format("the collision search of particles {} and {} met numbers that are not finite",
                                         step_.particles.ids[queries_[k].low], step_.particles.ids[queries_[k].high]));
      if (results_[k].contact())
        events_.add(event_of(queries_[k], results_[k].time, partners_[k]));
    }
    partners_.clear();
  }

  const StepContext& step_;
  Orbits& orbits_;
  EventQueue& events_;
  std::uint64_t max_partners_ = 0;

  // the next search: partners, the query of each, and its answer
  std::vector<Partner> partners_;
  std::vector<finders::Query> queries_;
  std::vector<finders::FinderResult> results_;
};

} // namespace keeler::collision
