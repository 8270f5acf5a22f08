#include <keeler/finders/certified_finder.hpp>

#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/certified.hpp>

#include "monotone_newton.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace keeler::finders {
namespace {

// The kernels read a body as eight numbers, and a query as three.
static_assert(offsetof(Body, elements) == 0 && offsetof(Body, radius) == 6 * sizeof(double));
static_assert(offsetof(Query, shift_y) == offsetof(Query, shift_x) + sizeof(double) &&
              offsetof(Query, start) == offsetof(Query, shift_x) + 2 * sizeof(double));

MonotonePair monotone_pair(const Query& q, const Body& low, const Body& high) {
  return {&low.elements.guiding_x, &high.elements.guiding_x, &q.shift_x};
}

MonotoneStep monotone_step(const DriftStep& step) {
  const Frequencies& f = step.frequencies;
  const double largest_angle = std::max(f.kappa, f.nu) * std::max(std::fabs(step.begin), std::fabs(step.end));
  return {f.kappa, f.nu, f.shear(), 2.0 / f.kappa, step.begin, step.end, largest_angle};
}

// Writes field by field: a copied result would be slow to read (store forwarding).
void write(const MonotoneAnswer& answer, FinderResult& result) {
  constexpr FinderExit exits[] = {FinderExit::gave_up, FinderExit::hit, FinderExit::overlapping, FinderExit::receding,
                                  FinderExit::missed}; // in the order of MonotoneExit
  result.exit = exits[static_cast<std::size_t>(answer.exit)];
  result.time = result.contact() ? answer.time : 0.0;
  result.iterations = answer.evaluations - 1;
  result.evaluations = answer.evaluations;
  result.halvings = 0;
}

class CertifiedFinder final : public Finder {
public:
  explicit CertifiedFinder(InstructionSet set)
      : one_(monotone_newton(InstructionSet::portable)), few_(monotone_newton(std::min(set, InstructionSet::avx2))),
        many_(monotone_newton(set)) {}

  void begin(const DriftStep& step) override {
    step_ = &step;
    monotone_step_ = monotone_step(step);
    newton_applies_ = monotone_step_.largest_angle <= monotone_angle && step.frequencies.kappa <= monotone_kappa;
    search_.begin(step);
  }

  void changed(std::size_t) override {}

  FinderResult find(const Query& query) const override {
    assert(step_ != nullptr && query.low < step_->bodies.size() && query.high < step_->bodies.size());
    return find_between(query, step_->bodies[query.low], step_->bodies[query.high]);
  }

  bool exact() const override { return true; }

  FinderResult find_between(const Query& query, const Body& low, const Body& high) const override {
    if (BoundedMotion::surely_apart(query, low, high, *step_))
      return {};
    if (!newton_applies_)
      return search_.find_between(query, low, high);
    const MonotonePair pair = monotone_pair(query, low, high);
    MonotoneAnswer answer;
    one_.find(&pair, monotone_step_, &answer);
    FinderResult result;
    finish(answer, query, low, high, result);
    return result;
  }

  void find_all(std::span<const Query> queries, std::span<FinderResult> results) const override {
    assert(results.size() == queries.size());
    if (!newton_applies_)
      return Finder::find_all(queries, results);
    Lanes lanes;
    for (std::size_t k = 0; k < queries.size(); ++k) {
      fetch_ahead(queries, k);
      const Query& q = queries[k];
      const Body &low = step_->bodies[q.low], &high = step_->bodies[q.high];
      if (BoundedMotion::surely_apart(q, low, high, *step_)) {
        results[k] = {};
        continue;
      }
      lanes.pairs[lanes.used] = monotone_pair(q, low, high);
      lanes.indices[lanes.used++] = k;
      if (lanes.used == many_.lanes)
        find_in(lanes, queries, results);
    }
    if (lanes.used > 0)
      find_in(lanes, queries, results);
  }

  std::size_t bytes_per_particle() const override { return 0; }

private:
  // Pairs waiting for a lane, with their indices among the queries.
  struct Lanes {
    std::array<MonotonePair, max_lanes> pairs;
    std::array<std::size_t, max_lanes> indices;
    std::size_t used = 0;
  };

  void fetch_ahead(std::span<const Query> queries, std::size_t k) const {
    const Query& later = queries[std::min(k + 2 * max_lanes, queries.size() - 1)];
    __builtin_prefetch(&step_->bodies[later.low]);
    __builtin_prefetch(&step_->bodies[later.high]);
  }

  void find_in(Lanes& lanes, std::span<const Query> queries, std::span<FinderResult> results) const {
    assert(lanes.used > 0 && lanes.used <= max_lanes);
    const MonotoneNewton& kernel = lanes.used == 1 ? one_ : lanes.used <= few_.lanes ? few_ : many_; // the same bits
    for (std::size_t k = lanes.used; k < kernel.lanes; ++k)
      lanes.pairs[k] = lanes.pairs[0];
    std::array<MonotoneAnswer, max_lanes> answers;
    kernel.find(lanes.pairs.data(), monotone_step_, answers.data());
    for (std::size_t k = 0; k < lanes.used; ++k) {
      const Query& q = queries[lanes.indices[k]];
      finish(answers[k], q, step_->bodies[q.low], step_->bodies[q.high], results[lanes.indices[k]]);
    }
    lanes.used = 0;
  }

  void finish(const MonotoneAnswer& answer, const Query& query, const Body& low, const Body& high,
              FinderResult& result) const {
    if (answer.exit != MonotoneExit::undecided) {
      write(answer, result);
    } else {
      result = search_.find_between(query, low, high);
      result.evaluations += answer.evaluations;
    }
  }

  const DriftStep* step_ = nullptr;
  MonotoneStep monotone_step_ = {};
  bool newton_applies_ = false;     // true if the series and bounds of Newton's method hold in this step
  MonotoneNewton one_, few_, many_; // by number of pairs
  MotionSearch<BoundedMotion, CertifiedSearch> search_;
};

} // namespace

std::unique_ptr<Finder> make_certified_finder(InstructionSet set) {
  return std::make_unique<CertifiedFinder>(set);
}

} // namespace keeler::finders
