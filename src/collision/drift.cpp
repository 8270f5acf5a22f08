#include <keeler/collision/drift.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
namespace {

constexpr std::uint32_t most_collisions = 100000; // of one particle in one step: an event storm, not physics
constexpr double wider = 1.0 + 1e-9;              // windows and tests must hold after their own rounding

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
      find_(finder_named(settings.finder)) {
  if (!find_)
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

DriftPhase::Middle DriftPhase::middle_of(const Body& body) const {
  static const Rotation at_epoch;
  const State s = state_at(body.elements, frequencies_, at_epoch);
  const double e = body.elements.eccentricity(), i = body.elements.inclination();
  const double nu2 = frequencies_.nu * frequencies_.nu;
  return {s.position, s.velocity, e, wider * std::hypot(2.0 * frequencies_.kappa * e, nu2 * i)};
}

void DriftPhase::prepare() {
  const std::size_t count = particles_->size();
  middles_.resize(count);
  binned_.resize(count);
  last_change_.assign(count, -0.5 * step_);
  stamps_.assign(count, 0);
  parallel_for(count, [&](std::size_t k) {
    middles_[k] = middle_of(particles_->bodies[k]);
    binned_[k] = middles_[k].position;
  });
  largest_radius_ = largest_eccentricity_ = largest_stray_ = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(std::isfinite(middles_[k].acceleration) && binned_[k].allFinite()))
      throw InvariantError(fmt::format("particle {} has elements that are not finite", particles_->ids[k]));
    largest_radius_ = std::max(largest_radius_, particles_->bodies[k].radius);
    largest_eccentricity_ = std::max(largest_eccentricity_, middles_[k].eccentricity);
  }
  const double cell = 2.0 * largest_radius_ + step_ * 2.0 * largest_eccentricity_;
  grid_.build(binned_, box_, offset_, cell);
}

// Calls visit(j, image) for every particle image that particle i could meet in this step.
template<class Visit> void DriftPhase::visit_candidates(std::size_t i, const Visit& visit) const {
  const double half = 0.5 * step_;
  const double e = middles_[i].eccentricity + largest_eccentricity_;
  const double contact = particles_->bodies[i].radius + largest_radius_;
  const double reach_x = contact + half * frequencies_.kappa * e;
  const double reach_y = contact + half * (frequencies_.shear() * (reach_x + e) + 2.0 * e);
  const double stray = largest_stray_ + 1e-12 * (box_.size_x + box_.size_y);
  grid_.visit_near(middles_[i].position, wider * reach_x + stray, wider * reach_y + stray,
                   [&](std::size_t j, const Image& image) {
                     if (j != i)
                       visit(j, image);
                   });
}

// False only when the straight-line closest approach over [start, h/2], with all that curvature and rounding can add,
// stays outside contact: a certified miss.
bool DriftPhase::may_touch(std::size_t i, std::size_t j, const Image& image, double start) const {
  const Middle &a = middles_[i], &b = middles_[j];
  const Vec3 d = b.position + box_.displacement(image, offset_) - a.position;
  Vec3 v = b.velocity - a.velocity;
  v.y() -= image.nx * box_.shear * box_.size_x;
  const double v2 = v.squaredNorm();
  const double closest = v2 > 0.0 ? std::clamp(-d.dot(v) / v2, start, 0.5 * step_) : start;
  const double reach = particles_->bodies[i].radius + particles_->bodies[j].radius +
                       (a.acceleration + b.acceleration) * step_ * step_ * 0.125 + 1e-13 * (box_.size_x + box_.size_y);
  return !((d + closest * v).squaredNorm() > reach * reach * wider);
}

FinderResult DriftPhase::search(std::size_t i, std::size_t j, const Image& image, Event& event) const {
  const auto& ids = particles_->ids;
  const bool ordered = ids[i] < ids[j];
  const std::size_t low = ordered ? i : j, high = ordered ? j : i;
  const Image shift = ordered ? image : -image;
  const Body &a = particles_->bodies[low], &b = particles_->bodies[high];
  Pair pair;
  pair.lo = a.elements;
  pair.hi = box_.image_of(b.elements, shift, offset_);
  pair.reach = a.radius + b.radius;
  pair.start = std::max(last_change_[i], last_change_[j]);
  pair.end = 0.5 * step_;
  pair.step = step_;
  const FinderResult result = find_(pair, frequencies_);
  event = {
      result.time,  ids[low],     ids[high], shift, static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high),
      stamps_[low], stamps_[high]};
  return result;
}

void DriftPhase::predict_all() {
  struct Found {
    std::vector<Event> events;
    std::uint64_t gave_up = 0;
    bool broken = false;
  };
  constexpr std::size_t block = 512; // of particles; blocks are joined in order, so threads do not matter
  const std::size_t count = particles_->size();
  std::vector<Found> found((count + block - 1) / block);
  parallel_for(
      found.size(),
      [&](std::size_t b) {
        for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
          visit_candidates(i, [&](std::size_t j, const Image& image) {
            if (particles_->ids[j] < particles_->ids[i] || !may_touch(i, j, image, -0.5 * step_))
              return;
            Event event;
            const FinderResult result = search(i, j, image, event);
            if (result.contact())
              found[b].events.push_back(event);
            found[b].gave_up += result.exit == FinderExit::gave_up;
            found[b].broken |= result.exit == FinderExit::not_a_number;
          });
      },
      1);
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
  if (!may_touch(i, j, image, std::max(last_change_[i], last_change_[j])))
    return;
  Event event;
  const FinderResult result = search(i, j, image, event);
  if (result.exit == FinderExit::not_a_number)
    throw InvariantError(fmt::format("the collision search of particles {} and {} met numbers that are not finite",
                                     event.low_id, event.high_id));
  if (result.contact())
    events_.add(event);
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
  if (observer)
    observer({event.time, event.low_id, event.high_id, event.image, speed, after.fast});

  changed(event.low, event.time);
  changed(event.high, event.time);
  search_again(event.low, event.high);
}

// A new orbit: stale events die by the stamp, and the windows of later searches cover where the orbit now leads.
void DriftPhase::changed(std::size_t i, double time) {
  last_change_[i] = time;
  if (++stamps_[i] > most_collisions)
    throw InvariantError(fmt::format(
        "particle {} collided more than {} times in one step (an event storm); raise collisions.elastic_below",
        particles_->ids[i], most_collisions));
  middles_[i] = middle_of(particles_->bodies[i]);
  largest_eccentricity_ = std::max(largest_eccentricity_, middles_[i].eccentricity);
  largest_stray_ = std::max(largest_stray_, (middles_[i].position - binned_[i]).cwiseAbs().maxCoeff());
}

void DriftPhase::search_again(std::size_t i, std::size_t j) {
  visit_candidates(i, [&](std::size_t k, const Image& image) { predict(i, k, image); });
  visit_candidates(j, [&](std::size_t k, const Image& image) {
    if (k != i) // the pair itself, in all its images, has been searched
      predict(j, k, image);
  });
}

} // namespace keeler
