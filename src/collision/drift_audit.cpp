// How a step's neighbours are held against the plain search.
#include "drift_engine.hpp"
#include "plain_search.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>

#include <algorithm>

namespace keeler {
namespace {

// The first partner that was not offered.
void compare(NeighbourAudit& audit, std::uint32_t place, const std::vector<PlainPartner>& expected,
             const std::vector<PlainPartner>& offered, const StepAtHand& step, bool after_hit) {
  audit.pairs += expected.size();
  for (const PlainPartner& partner : expected) {
    if (audit.missed || std::find(offered.begin(), offered.end(), partner) != offered.end())
      continue;
    const Particles& particles = *step.particles;
    const Body &body = particles.bodies[place], &other = particles.bodies[partner.index];
    const Elements el = step.box.image_of(other.elements, partner.image, step.offset) - body.elements;
    const double distance = state_at(el, step.frequencies, Rotation()).position.norm();
    audit.missed = {particles.ids[place], particles.ids[partner.index], partner.image,
                    distance / (body.radius + other.radius), after_hit};
  }
}

} // namespace

void DriftEngine::audit_beginning() {
  const std::size_t count = particles_->size();
  RandomStream random(++audit_->steps, RandomPurpose::sample, 0);
  std::vector<std::uint32_t> drawn;
  for (std::size_t k = 0; k < std::min(audit_->particles, count); ++k)
    drawn.push_back(static_cast<std::uint32_t>(random.uniform() * static_cast<double>(count)));
  std::vector<std::vector<PlainPartner>> expected(drawn.size()), offered(drawn.size());
  parallel_for(
      drawn.size(),
      [&](std::size_t k) {
        const std::uint32_t i = drawn[k];
        expected[k] = plain_search(*particles_, step_at_hand_.box, step_at_hand_.offset, finder_step_.straight_line, i,
                                   [&](std::uint32_t) { return step_at_hand_.begin; });
        for (const std::vector<Candidate>& block : candidates_)
          for (const Candidate& c : block)
            if (c.low == i)
              offered[k].push_back({c.high, c.image});
            else if (c.high == i)
              offered[k].push_back({c.low, -c.image});
      },
      1);
  for (std::size_t k = 0; k < drawn.size(); ++k)
    compare(*audit_, drawn[k], expected[k], offered[k], step_at_hand_, false);
}

// Where all are looked through in all images, that is the plain search itself.
void DriftEngine::audit_end() {
  if (lists_.reaches_far() && !through_grid_)
    return;
  const auto start = [&](std::uint32_t i) { return so_far_.last_change(i); };
  const std::size_t stride = touched_.size() / std::max<std::size_t>(1, audit_->particles) + 1;
  std::vector<std::uint32_t> buffer;
  for (std::size_t k = 0; k < touched_.size(); k += stride) {
    const std::uint32_t i = touched_[k];
    std::vector<PlainPartner> offered;
    const auto take = [&](std::size_t j, const Image& image) {
      offered.push_back({static_cast<std::uint32_t>(j), image});
    };
    if (through_grid_)
      grid_.visit_partners(i, start(i), take);
    else
      lists_.visit_partners(i, start(i), -step_at_hand_.begin, buffer, take);
    compare(*audit_, i,
            plain_search(*particles_, step_at_hand_.box, step_at_hand_.offset, finder_step_.straight_line, i, start),
            offered, step_at_hand_, true);
  }
}

double DriftEngine::reached() const {
  double latest = -0.5 * step_;
  for (const std::uint32_t i : touched_)
    latest = std::max(latest, so_far_.last_change(i));
  return latest;
}

} // namespace keeler
