#include "audit.hpp"

#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

constexpr double noticeable = 1e-6; // of the radius sum: two hundred times the published convergence, 1e-8 in d²

// Returns the overlap of a query's two spheres at a time, in radius sums R; negative when they are apart.
double depth(const finders::Query& query, const finders::DriftStep& step, double time) {
  assert(query.low < step.bodies.size() && query.high < step.bodies.size());
  const finders::Pair pair = pair_of(query, step);
  return 1.0 - finders::RelativeMotion(pair, step).at(time).d.norm() / pair.radius_sum;
}

// Returns the largest overlap between two times, so that a contact that the search stepped over counts although the
// spheres have parted again. It samples 64 times: an overlap between two samples is a graze.
double deepest(const finders::Query& query, const finders::DriftStep& step, double from, double to) {
  assert(std::isfinite(from) && std::isfinite(to));
  constexpr int samples = 64;
  double depth_so_far = depth(query, step, to);
  for (int k = 0; k < samples && from < to; ++k)
    depth_so_far = std::max(depth_so_far, depth(query, step, from + (to - from) * k / samples));
  return depth_so_far;
}

bool same(const finders::Query& a, const finders::Query& b) {
  return a.low == b.low && a.high == b.high && a.shift_x == b.shift_x && a.shift_y == b.shift_y;
}

} // namespace

FinderAudit::FinderAudit() : certified_(finders::make_finder("certified")) {}

void FinderAudit::begins(const finders::DriftStep& step) {
  count_misordered();
  step_ = &step;
  certified_->begin(step);
  found_.assign(step.bodies.size(), {});
  true_.assign(step.bodies.size(), {});
}

void FinderAudit::searched(const finders::Query& query, const finders::FinderResult& result) {
  assert(step_ && "begins() was called");
  verdict_.counts.add(result);
  const finders::FinderResult truth = certified_->find(query);
  verdict_.true_hits += truth.contact();
  if (truth.contact() && !result.contact())
    ++verdict_.missed;
  if (!result.contact())
    return;
  const double inside = depth(query, *step_, result.time);
  if (!truth.contact() || inside < -noticeable) {
    ++verdict_.false_hits;
    return;
  }
  const double sunk = deepest(query, *step_, truth.time, result.time);
  verdict_.late += sunk > std::max(depth(query, *step_, truth.time), 0.0) + noticeable;
  verdict_.deepest = std::max(verdict_.deepest, sunk);
  if (query.start == step_->begin) {
    note_first(found_, query, result.time);
    note_first(true_, query, truth.time);
  }
}

void FinderAudit::note_first(std::vector<First>& firsts, const finders::Query& query, double time) {
  for (const std::uint32_t particle : {query.low, query.high})
    if (time < firsts[particle].time)
      firsts[particle] = {time, query};
}

void FinderAudit::count_misordered() {
  for (std::size_t k = 0; k < found_.size(); ++k)
    verdict_.misordered += found_[k].time < HUGE_VAL && !same(found_[k].with, true_[k].with);
  found_.clear();
  true_.clear();
}

FinderVerdict FinderAudit::verdict() {
  count_misordered();
  return verdict_;
}

} // namespace keeler::study
