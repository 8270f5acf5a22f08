// The heart of a drift: take the earliest contact, give both particles their new orbits, search again around both (the
// pair itself included), and so on until the step ends. A particle may put off a part of its search: a look, an event
// too.
//
// Orbits is where the particles' present orbits are kept; a loop does not know whether it is the only one of a step. It
// has
//   const Body& body(place)      std::uint32_t stamp(place)      double last_change(place)      as they are now
//   bool is_due(event)           whether it still holds, and is for this loop to carry out
//   std::span<const std::uint32_t> to_search_again()       who has got back an earlier orbit because of that
//   void change(place, elements, time)                                     a new orbit from that time on
//   void set_spin(place, spin)                                             of a rough particle, after its change
//   bool keeps(event)                      after both changes: false has undone it all, for somebody else to carry out
//   void visit_partners(place, from, until, visit)         visit(place, image) for all that its orbit may bring into
//                                     contact between these times, and more
//   bool may_look_again(place)        whether there are so many around it that it is worth while to look less far
//   void find_all(queries, results)
//   void prefetch_partner(place)          it will be asked about soon
//   void prefetch(place, stage)           a contact is to come: stages 0, 1 and 2, some contacts apart
//   void happened(const Contact&)     right before the changes
//   void record(const CollisionRecord&)     after it, where the step is recorded
#pragma once

#include "ablation.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/collision/events.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/finders/finder.hpp>

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace keeler {

/// The step that loops work on; the same for all.
struct StepAtHand {
  const Particles* particles = nullptr;
  const CollisionSettings* settings = nullptr;
  Frequencies frequencies;
  double orbital_frequency = 0.0; ///< rad/s
  ShearingBox box;
  double offset = 0.0;    ///< at the epoch, m
  double begin = 0.0;     ///< rad
  bool recorded = false;  ///< whether somebody wants to have each contact
  double kick_pull = 0.0; ///< G times the kick interval, m³ kg⁻¹ rad⁻¹
  double rest_pull = 0.0; ///< the same for contacts that are to be noted: DriftPhase::slow_pairs
};

/// What has happened to the particles in the step so far, by place.
class StepSoFar {
public:
  void begin_step(std::size_t particles, double begin) {
    ++step_;
    begin_ = begin;
    if (entries_.size() != particles)
      entries_.assign(particles, {});
  }

  /// Velocity changes.
  std::uint32_t stamp(std::size_t i) const { return entries_[i].step == step_ ? entries_[i].stamp : 0; }
  /// The last of them, or the begin of the step.
  double last_change(std::size_t i) const { return entries_[i].step == step_ ? entries_[i].time : begin_; }
  bool holds(const Event& event) const {
    return event.low_stamp == stamp(event.low) && event.high_stamp == stamp(event.high);
  }

  void change(std::size_t i, double time) { entries_[i] = {time, step_, stamp(i) + 1}; }
  /// The particle has an earlier path again, which began at that time.
  void renew(std::size_t i, double time) { change(i, time); }
  /// Undoes the last change, of which nobody knows; `time` is that of the one before.
  void take_back(std::size_t i, double time) { entries_[i] = {time, step_, stamp(i) - 1}; }

  void prefetch(std::size_t i) const { __builtin_prefetch(&entries_[i], 1); }
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

private:
  struct Entry {
    double time = 0.0;
    std::uint32_t step = 0; // that the rest is of
    std::uint32_t stamp = 0;
  };
  std::uint32_t step_ = 0;
  double begin_ = 0.0;
  std::vector<Entry> entries_;
};

/// What one contact did. Energies in kg m² rad⁻².
struct Contact {
  double time = 0.0;
  double normal_speed = 0.0; ///< of the approach, m rad⁻¹
  double energy_lost = 0.0;
  double momentum_flux = 0.0;      ///< kg m² rad⁻¹
  double azimuthal_gain = 0.0;     ///< of Σ m c_y², kg m² rad⁻²
  bool fast = false;               ///< faster than v_cut
  bool unresolved = false;         ///< slower than what a kick of the pair's own gravity gives
  bool again = false;              ///< the last contact of both particles was with each other, in this step
  float slow = 0.0F;               ///< of one that may come to rest: its speed in kicks of the pair's own gravity
  std::uint32_t low = 0, high = 0; ///< places of the particles, the lower id first
};

template<class Orbits> class ContactLoop {
public:
  ContactLoop(const StepAtHand& step, Orbits& orbits, EventQueue& events)
      : step_(step), orbits_(orbits), events_(events) {}

  /// Until nothing is pending. Throws InvariantError when a search meets numbers that are not finite or a particle
  /// collides more than 100,000 times; and Interrupted.
  void run() {
    for (int stage = 0; stage < stages; ++stage) // of those that come before it is their turn in the loop
      for (std::size_t soon = 0; soon <= events_ahead(stage); ++soon)
        prefetch(soon, stage);
    while (!events_.empty()) {
      throw_if_interrupted();
      for (int stage = 0; stage < stages; ++stage)
        prefetch(events_ahead(stage), stage);
      const Event event = events_.take_first();
      if (!orbits_.is_due(event))
        continue;
      if (event.is_look()) {
        look_around(event.low, event.time, nobody);
        search();
      } else {
        carry_out(event);
      }
    }
  }

  /// Those whose present orbits are earlier ones again.
  void search_again(std::span<const std::uint32_t> particles) {
    for (const std::uint32_t i : particles)
      look_around(i, orbits_.last_change(i), nobody);
    if (!particles.empty())
      search();
  }

  /// Of one particle in one search so far.
  std::uint64_t max_partners() const { return max_partners_; }

private:
  static constexpr std::size_t nobody = ~std::size_t{0};
  static constexpr std::uint32_t max_collisions = 100000; // of one particle in one step: an event storm, not physics

  /// Whom particle i may meet, through that image of it.
  struct Partner {
    std::uint32_t i, j;
    Image image;
  };

  // The lower id first; `image` is that of particle j.
  Query query_of(std::size_t i, std::size_t j, const Image& image) const {
    const bool ordered = step_.particles->ids[i] < step_.particles->ids[j];
    const Vec3 shift = step_.box.displacement(ordered ? image : -image, step_.offset);
    return {static_cast<std::uint32_t>(ordered ? i : j), static_cast<std::uint32_t>(ordered ? j : i), shift.x(),
            shift.y(), std::max(orbits_.last_change(i), orbits_.last_change(j))};
  }

  Event event_of(const Query& query, double time, const Partner& p) const {
    const std::vector<std::uint64_t>& ids = step_.particles->ids;
    return {time,      ids[query.low], ids[query.high],          query.low == p.i ? p.image : -p.image,
            query.low, query.high,     orbits_.stamp(query.low), orbits_.stamp(query.high)};
  }

  static constexpr int stages = 3; // of fetching
  static constexpr std::size_t events_ahead(int stage) { return 6 * static_cast<std::size_t>(stages - stage); }

  void prefetch(std::size_t ahead, int stage) const {
    const Event* soon = events_.ahead(ahead);
    if (!soon || without(Acceleration::prefetching))
      return;
    for (const std::uint32_t place : {soon->low, soon->high}) {
      if (stage == 0) {
        __builtin_prefetch(&step_.particles->bodies[place]);
        __builtin_prefetch(&step_.particles->ids[place]);
      }
      orbits_.prefetch(place, stage);
    }
  }

  // The impulse along the line of centres turns the normal approach speed into the rebound's.
  void carry_out(const Event& event) {
    const Frequencies& f = step_.frequencies;
    Body a = orbits_.body(event.low), b = orbits_.body(event.high);
    const Rotation rotation(f, event.time);
    const State relative =
        state_at(step_.box.image_of(b.elements, event.image, step_.offset) - a.elements, f, rotation);
    const Vec3 normal = relative.position.normalized();
    Contact contact;
    contact.time = event.time;
    const double speed = contact.normal_speed = -relative.velocity.dot(normal);
    const Rebound after = rebound(*step_.settings, speed, a.radius, b.radius, step_.orbital_frequency);
    if (!(speed > -after.speed))
      return; // an inexact finder may call a pair that moves apart
    const Vec3 place = step_.recorded ? place_of(a, normal, rotation) : Vec3::Zero();
    const double reduced_mass = a.mass * b.mass / (a.mass + b.mass);
    const double normal_impulse = reduced_mass * (speed + after.speed);
    Vec3 impulse = normal_impulse * normal; // on b; a gets the opposite
    Spins spins;
    if (step_.settings->friction) {
      const Sliding sliding = rub(event, {a, b, normal, relative.velocity, {}, {}}, normal_impulse, spins);
      impulse += sliding.impulse;
      contact.energy_lost = sliding.energy_lost;
    }
    contact.azimuthal_gain = azimuthal_gain(a, -impulse / a.mass, f, rotation);
    contact.azimuthal_gain += azimuthal_gain(b, impulse / b.mass, f, rotation);
    kick(a.elements, -impulse / a.mass, f, rotation);
    kick(b.elements, impulse / b.mass, f, rotation);

    const double distance = a.radius + b.radius;
    contact.fast = after.fast;
    contact.unresolved = speed * distance * distance < step_.kick_pull * (a.mass + b.mass);
    if (speed * distance * distance < step_.rest_pull * (a.mass + b.mass))
      contact.slow = static_cast<float>(speed * distance * distance / (step_.kick_pull * (a.mass + b.mass)));
    contact.low = event.low;
    contact.high = event.high;
    contact.again = orbits_.last_change(event.low) > step_.begin &&
                    orbits_.last_change(event.low) == orbits_.last_change(event.high);
    contact.energy_lost += 0.5 * reduced_mass * (speed * speed - after.speed * after.speed);
    contact.momentum_flux = relative.position.x() * impulse.y();
    orbits_.happened(contact);
    if (step_.recorded)
      orbits_.record({.time = event.time,
                      .low_id = event.low_id,
                      .high_id = event.high_id,
                      .image = event.image,
                      .normal_speed = speed,
                      .fast = contact.fast,
                      .tangential_speed = (relative.velocity + speed * normal).norm(),
                      .energy_lost = contact.energy_lost,
                      .radius_sum = distance,
                      .place = place});

    change(event.low, a.elements, event.time);
    change(event.high, b.elements, event.time);
    if (step_.settings->friction) {
      orbits_.set_spin(event.low, spins.low);
      orbits_.set_spin(event.high, spins.high);
    }
    if (!orbits_.keeps(event))
      return;
    look_around(event.low, event.time, nobody);
    look_around(event.high, event.time, event.low); // the pair itself, in all its images, has been looked at
    search();
    search_again(orbits_.to_search_again());
  }

  /// Of the two particles of a contact, at the epoch.
  struct Spins {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  };

  // Fills in the spins before the contact, and gives those after it.
  Sliding rub(const Event& event, Touch touch, double normal_impulse, Spins& spins) const {
    const SpinTurn turn(event.time);
    spins = {step_.particles->spins[event.low], step_.particles->spins[event.high]};
    touch.spin_a = turn.from_epoch(spins.low);
    touch.spin_b = turn.from_epoch(spins.high);
    const Sliding sliding = slide(*step_.settings->friction, touch, normal_impulse);
    spins.low += turn.to_epoch(spin_change(touch.a, touch.normal, sliding.impulse));
    spins.high += turn.to_epoch(spin_change(touch.b, touch.normal, sliding.impulse));
    return sliding;
  }

  // Where a touches b, to which the normal points.
  Vec3 place_of(const Body& a, const Vec3& normal, const Rotation& rotation) const {
    return state_at(a.elements, step_.frequencies, rotation).position + a.radius * normal;
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (orbits_.stamp(i) == max_collisions)
      throw InvariantError(fmt::format(
          "particle {} collided more than {} times in one step (an event storm); raise collisions.elastic_below",
          step_.particles->ids[i], max_collisions));
    const State then = state_at(elements, step_.frequencies, Rotation());
    if (!(then.position.allFinite() && then.velocity.allFinite()))
      throw InvariantError(
          fmt::format("a collision left particle {} with elements that are not finite", step_.particles->ids[i]));
    orbits_.change(i, elements, time);
  }

  // Whom the particle may meet from then on.
  void look_around(std::uint32_t i, double from, std::size_t except) {
    std::uint64_t partners = 0;
    const double until = look_until(i, from);
    orbits_.visit_partners(i, from, until, [&](std::size_t j, const Image& image) {
      ++partners;
      if (j == except)
        return;
      partners_.push_back({i, static_cast<std::uint32_t>(j), image});
      if (without(Acceleration::prefetching))
        return;
      __builtin_prefetch(&step_.particles->bodies[j]);
      __builtin_prefetch(&step_.particles->ids[j]);
      orbits_.prefetch_partner(j);
    });
    max_partners_ = std::max(max_partners_, partners);
    if (until < -step_.begin) {
      const std::uint64_t id = step_.particles->ids[i];
      events_.add({until, id, id, {}, i, i, orbits_.stamp(i), orbits_.stamp(i)});
    }
  }

  // A large body is hit so often that a search to the end of the step would be in vain but for its first part: it looks
  // as far as it will probably not be hit, and then again.
  double look_until(std::uint32_t i, double from) const {
    constexpr double hits_ahead = 2.0, min_share = 1.0 / 256.0; // of the step
    const double begin = step_.begin, end = -begin;
    if (orbits_.stamp(i) < 2 || without(Acceleration::looks) || !orbits_.may_look_again(i))
      return end;
    const double ahead = hits_ahead * (from - begin) / orbits_.stamp(i);
    return std::min(end, from + std::max(ahead, min_share * (end - begin)));
  }

  // Asks about all of them at once.
  void search() {
    queries_.clear();
    for (const Partner& p : partners_)
      queries_.push_back(query_of(p.i, p.j, p.image));
    results_.resize(queries_.size());
    orbits_.find_all(queries_, results_);
    for (std::size_t k = 0; k < queries_.size(); ++k) {
      if (results_[k].exit == FinderExit::not_a_number)
        throw InvariantError(fmt::format("the collision search of particles {} and {} met numbers that are not finite",
                                         step_.particles->ids[queries_[k].low],
                                         step_.particles->ids[queries_[k].high]));
      if (results_[k].contact())
        events_.add(event_of(queries_[k], results_[k].time, partners_[k]));
    }
    partners_.clear();
  }

  const StepAtHand& step_;
  Orbits& orbits_;
  EventQueue& events_;
  std::uint64_t max_partners_ = 0;

  // the search at hand
  std::vector<Partner> partners_;
  std::vector<Query> queries_; // one for each
  std::vector<FinderResult> results_;
};

} // namespace keeler
