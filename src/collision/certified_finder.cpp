#include <keeler/collision/certified_finder.hpp>

#include <keeler/collision/motion/relative.hpp>
#include <keeler/collision/search/certified.hpp>

#include "monotone_newton.hpp"

#include <array>
#include <cstddef>

namespace keeler {
namespace {

// The kernels read a body as eight numbers.
static_assert(offsetof(Body, elements) == 0 && offsetof(Body, radius) == 6 * sizeof(double));

MonotonePair monotone_pair(const Query& q, const Body& low, const Body& high) {
  return {q.shift_x, q.shift_y, q.start, &low.elements.guiding_x, &high.elements.guiding_x};
}

MonotoneStep monotone_step(const DriftStep& step) {
  const Frequencies& f = step.frequencies;
  const double largest_angle = std::max(f.kappa, f.nu) * std::max(std::fabs(step.begin), std::fabs(step.end));
  return {f.kappa, f.nu, f.shear(), 2.0 / f.kappa, step.begin, step.end, largest_angle};
}

FinderExit finder_exit(MonotoneExit exit) {
  switch (exit) {
  case MonotoneExit::hit:
    return FinderExit::hit;
  case MonotoneExit::overlapping:
    return FinderExit::overlapping;
  case MonotoneExit::receding:
    return FinderExit::receding;
  default:
    return FinderExit::missed;
  }
}

class CertifiedFinder final : public Finder {
public:
  explicit CertifiedFinder(InstructionSet set)
      : one_(monotone_newton(InstructionSet::portable)), many_(monotone_newton(set)) {}

  void begin(const DriftStep& step) override {
    step_ = &step;
    monotone_step_ = monotone_step(step);
    served_ = monotone_step_.largest_angle <= monotone_angle && step.frequencies.kappa <= monotone_kappa;
    search_.begin(step);
  }

  void changed(std::size_t) override {}

  FinderResult find(const Query& query) const override {
    return find_between(query, step_->bodies[query.low], step_->bodies[query.high]);
  }

  bool exact() const override { return true; }

  FinderResult find_between(const Query& query, const Body& low, const Body& high) const override {
    if (BoundedMotion::surely_apart(query, low, high, *step_))
      return {};
    if (!served_)
      return search_.find_between(query, low, high);
    const MonotonePair pair = monotone_pair(query, low, high);
    MonotoneAnswer answer;
    one_.find(&pair, monotone_step_, &answer);
    return result_of(answer, query, low, high);
  }

  void find_all(std::span<const Query> queries, std::span<FinderResult> results) const override {
    if (!served_)
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
      lanes.places[lanes.used++] = k;
      if (lanes.used == many_.lanes)
        find_in(lanes, queries, results);
    }
    if (lanes.used > 0)
      find_in(lanes, queries, results);
  }

  std::size_t bytes_per_particle() const override { return 0; }

private:
  // Pairs that wait for a lane each, and their places among the queries.
  struct Lanes {
    std::array<MonotonePair, most_lanes> pairs;
    std::array<std::size_t, most_lanes> places;
    std::size_t used = 0;
  };

  void fetch_ahead(std::span<const Query> queries, std::size_t k) const {
    const Query& later = queries[std::min(k + 2 * most_lanes, queries.size() - 1)];
    __builtin_prefetch(&step_->bodies[later.low]);
    __builtin_prefetch(&step_->bodies[later.high]);
  }

  void find_in(Lanes& lanes, std::span<const Query> queries, std::span<FinderResult> results) const {
    for (std::size_t k = lanes.used; k < many_.lanes; ++k)
      lanes.pairs[k] = lanes.pairs[0];
    std::array<MonotoneAnswer, most_lanes> answers;
    many_.find(lanes.pairs.data(), monotone_step_, answers.data());
    for (std::size_t k = 0; k < lanes.used; ++k) {
      const Query& q = queries[lanes.places[k]];
      results[lanes.places[k]] = result_of(answers[k], q, step_->bodies[q.low], step_->bodies[q.high]);
    }
    lanes.used = 0;
  }

  FinderResult result_of(const MonotoneAnswer& answer, const Query& query, const Body& low, const Body& high) const {
    FinderResult result;
    if (answer.exit == MonotoneExit::undecided) {
      result = search_.find_between(query, low, high);
    } else {
      result.exit = finder_exit(answer.exit);
      result.iterations = answer.evaluations - 1;
      if (result.contact())
        result.time = answer.time;
    }
    result.evaluations += answer.evaluations;
    return result;
  }

  const DriftStep* step_ = nullptr;
  MonotoneStep monotone_step_ = {};
  bool served_ = false; // by Newton's method: its series and bounds hold in this step
  MonotoneNewton one_, many_;
  MotionSearch<BoundedMotion, CertifiedSearch> search_;
};

} // namespace

std::unique_ptr<Finder> make_certified_finder(InstructionSet set) {
  return std::make_unique<CertifiedFinder>(set);
}

} // namespace keeler
