#include "drift_audit.hpp"

#include "plain_search.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>

#include <algorithm>
#include <vector>

namespace keeler::collision {
namespace {

// Notes the first expected partner of particle i that was not offered.
void compare(NeighbourAudit& audit, std::uint32_t i, const std::vector<PlainPartner>& expected,
             const std::vector<PlainPartner>& offered, const StepContext& step, bool after_hit) {
  audit.pairs += expected.size();
  for (const PlainPartner& partner : expected) {
    if (audit.missed || std::find(offered.begin(), offered.end(), partner) != offered.end())
      continue;
    const Particles& particles = step.particles;
    const Body &body = particles.bodies[i], &other = particles.bodies[partner.index];
    const Elements el = step.box.image_of(other.elements, partner.image, step.offset) - body.elements;
    const double distance = state_at(el, step.frequencies, Rotation()).position.norm();
    audit.missed = {particles.ids[i], particles.ids[partner.index], partner.image,
                    distance / (body.radius + other.radius), after_hit};
  }
}

} // namespace

void audit_begin(NeighbourAudit& audit, const StepContext& step, const finders::StraightLineTest& test,
                 const CandidateBlocks& candidates) {
  const std::size_t count = step.particles.size();
  RandomStream random(++audit.steps, RandomPurpose::sample, 0);
  std::vector<std::uint32_t> drawn;
  for (std::size_t k = 0; k < std::min(audit.particles, count); ++k)
    drawn.push_back(static_cast<std::uint32_t>(random.uniform() * static_cast<double>(count)));
  std::vector<std::vector<PlainPartner>> expected(drawn.size()), offered(drawn.size());
  parallel_for(
      drawn.size(),
      [&](std::size_t k) {
        const std::uint32_t i = drawn[k];
        expected[k] =
            plain_search(step.particles, step.box, step.offset, test, i, [&](std::uint32_t) { return step.begin; });
        for (const std::vector<Candidate>& block : candidates)
          for (const Candidate& c : block)
            if (c.low == i)
              offered[k].push_back({c.high, c.image});
            else if (c.high == i)
              offered[k].push_back({c.low, -c.image});
      },
      1);
  for (std::size_t k = 0; k < drawn.size(); ++k)
    compare(audit, drawn[k], expected[k], offered[k], step, false);
}

void audit_end(NeighbourAudit& audit, const StepContext& step, const finders::StraightLineTest& test,
               const BroadPhase& broad_phase, const StepHistory& history, std::span<const std::uint32_t> dirty) {
  if (broad_phase.tries_all()) // then it is the plain search itself
    return;
  const auto start = [&](std::uint32_t i) { return history.last_change(i); };
  const std::size_t stride = dirty.size() / std::max<std::size_t>(1, audit.particles) + 1;
  std::vector<std::uint32_t> buffer;
  for (std::size_t k = 0; k < dirty.size(); k += stride) {
    const std::uint32_t i = dirty[k];
    std::vector<PlainPartner> offered;
    broad_phase.visit_partners(i, start(i), step.end(), buffer, [&](std::size_t j, const Image& image) {
      offered.push_back({static_cast<std::uint32_t>(j), image});
    });
    compare(audit, i, plain_search(step.particles, step.box, step.offset, test, i, start), offered, step, true);
  }
}

} // namespace keeler::collision
