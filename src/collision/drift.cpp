#include <keeler/collision/drift.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
namespace {

constexpr std::uint32_t most_collisions = 100000; // of one particle in one step: an event storm, not physics

} // namespace

void CollisionTally::list_fields(FieldTable& table) {
  table.scalar("collisions_fast", fast, "1", "collisions faster than v_cut");
  table.scalar("collisions_slow", slow, "1", "contacts slower than v_cut, bounced elastically");
  table.scalar("finder_gave_up", gave_up, "1", "searches abandoned by the finder");
  table.scalar("collision_energy_lost", energy_lost, "kg m^2 rad^-2", "energy dissipated in collisions");
  table.scalar("collision_edge_work", edge_work, "kg m^2 rad^-2", "energy gained by collisions across sheared edges");
  table.scalar("collision_momentum_flux", momentum_flux, "kg m^2 rad^-1", "sum of (x_j - x_i) p_y gained by j");
}

DriftPhase::DriftPhase(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                       double step)
    : settings_(settings), frequencies_(frequencies), orbital_frequency_(orbital_frequency), step_(step),
      finder_(make_finder(settings.finder)), at_hand_(frequencies, -0.5 * step, 0.5 * step, 0.0),
      neighbours_(frequencies, step) {
  if (!finder_)
    throw UsageError(fmt::format("unknown collision finder '{}'", settings.finder));
}

void DriftPhase::collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally) {
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  gave_up_ = 0;
  prepare();
  predict_all();
  while (!events_.empty()) {
    const Event event = events_.take_first();
    if (event.low_stamp == stamps_[event.low] && event.high_stamp == stamps_[event.high])
      carry_out(event, tally);
  }
  tally.gave_up += gave_up_;
}

void DriftPhase::prepare() {
  if (stamps_.size() != particles_->size()) {
    last_change_.assign(particles_->size(), -0.5 * step_);
    stamps_.assign(particles_->size(), 0);
  } else {
    for (const std::uint32_t k : touched_) {
      last_change_[k] = -0.5 * step_;
      stamps_[k] = 0;
    }
  }
  touched_.clear();
  neighbours_.every_candidate = every_candidate;
  neighbours_.begin(*particles_, box_, offset_);
  at_hand_ = DriftStep(frequencies_, -0.5 * step_, 0.5 * step_, box_.size_x + box_.size_y);
  at_hand_.bodies = particles_->bodies;
  finder_->begin(at_hand_);
  if (watch)
    watch->begins(at_hand_);
}

// The lower id first; `image` is that of particle j.
Query DriftPhase::query_of(std::size_t i, std::size_t j, const Image& image) const {
  const bool ordered = particles_->ids[i] < particles_->ids[j];
  const Vec3 shift = box_.displacement(ordered ? image : -image, offset_);
  return {static_cast<std::uint32_t>(ordered ? i : j), static_cast<std::uint32_t>(ordered ? j : i), shift.x(),
          shift.y(), std::max(last_change_[i], last_change_[j])};
}

// `image` is that of the partner of particle i.
Event DriftPhase::event_of(const Query& query, double time, std::size_t i, const Image& image) const {
  return {
      time,       particles_->ids[query.low], particles_->ids[query.high], query.low == i ? image : -image, query.low,
      query.high, stamps_[query.low],         stamps_[query.high]};
}

void DriftPhase::predict_all() {
  struct Found {
    std::vector<Event> events;
    std::uint64_t gave_up = 0;
    bool broken = false;
  };
  std::vector<Found> found(neighbours_.blocks()); // joined in order, so threads do not matter
  const auto search_block = [&](std::size_t b) {
    neighbours_.visit_block(b, [&](std::size_t i, std::size_t j, const Image& image) {
      const Query query = query_of(i, j, image);
      const FinderResult result = finder_->find(query);
      if (watch)
        watch->searched(query, result);
      if (result.contact())
        found[b].events.push_back(event_of(query, result.time, i, image));
      found[b].gave_up += result.exit == FinderExit::gave_up;
      found[b].broken |= result.exit == FinderExit::not_a_number;
    });
  };
  if (watch)
    for (std::size_t b = 0; b < found.size(); ++b)
      search_block(b);
  else
    parallel_for(found.size(), search_block, 1);
  std::vector<Event> all;
  for (const Found& f : found) {
    all.insert(all.end(), f.events.begin(), f.events.end());
    gave_up_ += f.gave_up;
    if (f.broken)
      throw InvariantError("a collision search met numbers that are not finite");
  }
  events_.assign(std::move(all));
}

void DriftPhase::predict(std::size_t i, std::size_t j, const Image& image) {
  const Query query = query_of(i, j, image);
  const FinderResult result = finder_->find(query);
  if (watch)
    watch->searched(query, result);
  if (result.exit == FinderExit::not_a_number)
    throw InvariantError(fmt::format("the collision search of particles {} and {} met numbers that are not finite",
                                     particles_->ids[query.low], particles_->ids[query.high]));
  if (result.contact())
    events_.add(event_of(query, result.time, i, image));
  gave_up_ += result.exit == FinderExit::gave_up;
}

// The impulse along the line of centres turns the normal approach speed into the rebound's.
void DriftPhase::carry_out(const Event& event, CollisionTally& tally) {
  Body &a = particles_->bodies[event.low], &b = particles_->bodies[event.high];
  const Rotation rotation(frequencies_, event.time);
  const State relative = state_at(box_.image_of(b.elements, event.image, offset_) - a.elements, frequencies_, rotation);
  const Vec3 normal = relative.position.normalized();
  const double speed = -relative.velocity.dot(normal);
  const Rebound after = rebound(settings_, speed, a.radius + b.radius, orbital_frequency_);
  if (!(speed > -after.speed))
    return; // an inexact finder may call a pair that moves apart
  const double reduced_mass = a.mass * b.mass / (a.mass + b.mass);
  const Vec3 impulse = reduced_mass * (speed + after.speed) * normal; // on b; a gets the opposite
  kick(a.elements, -impulse / a.mass, frequencies_, rotation);
  kick(b.elements, impulse / b.mass, frequencies_, rotation);

  ++(after.fast ? tally.fast : tally.slow);
  tally.energy_lost += 0.5 * reduced_mass * (speed * speed - after.speed * after.speed);
  tally.edge_work += event.image.nx * box_.shear * box_.size_x * impulse.y();
  tally.momentum_flux += relative.position.x() * impulse.y();
  if (watch)
    watch->collided({event.time, event.low_id, event.high_id, event.image, speed, after.fast});

  changed(event.low, event.time);
  changed(event.high, event.time);
  search_again(event.low, event.high);
}

// A new orbit: stale events die by the stamp.
void DriftPhase::changed(std::size_t i, double time) {
  if (stamps_[i] == 0)
    touched_.push_back(static_cast<std::uint32_t>(i));
  last_change_[i] = time;
  if (++stamps_[i] > most_collisions)
    throw InvariantError(fmt::format(
        "particle {} collided more than {} times in one step (an event storm); raise collisions.elastic_below",
        particles_->ids[i], most_collisions));
  neighbours_.changed(i);
  finder_->changed(i);
  if (watch)
    watch->changed(i);
}

void DriftPhase::search_again(std::size_t i, std::size_t j) {
  constexpr std::size_t nobody = ~std::size_t{0};
  neighbours_.visit_partners(i, nobody, last_change_[i],
                             [&](std::size_t k, const Image& image) { predict(i, k, image); });
  // the pair itself, in all its images, has been searched
  neighbours_.visit_partners(j, i, last_change_[j], [&](std::size_t k, const Image& image) { predict(j, k, image); });
}

} // namespace keeler
