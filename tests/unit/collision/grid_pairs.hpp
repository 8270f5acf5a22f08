// All pairs that the grid offers in a dense, equilibrium-like patch, put to several finders at once while the certified
// one drives: the calls that the paper counted.
#pragma once

#include "unit/collision/ring.hpp"

#include <keeler/core/units.hpp>
#include <keeler/finders/counts.hpp>
#include <keeler/initial_conditions/uniform.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace keeler::test {

/// Equal spheres of radius 1 at τ = 0.5, with the dispersions of ε = 0.5 in equilibrium (c_x = 2.175, c_z = 1.45 r Ω).
inline Patch equilibrium_patch(std::size_t count, std::uint64_t seed) {
  initial_conditions::UniformRequest request;
  request.radii.assign(count, 1.0);
  const double side = std::sqrt(static_cast<double>(count) * pi / 0.5);
  request.box = {side, side, request.frequencies.shear(), 0.0};
  request.dispersion_x = 2.175;
  request.dispersion_z = 1.45;
  request.seed = seed;
  return uniform_patch(request);
}

/// Asks each finder what the driving one is asked, and compares.
class AskAll final : public collision::DriftObserver {
public:
  explicit AskAll(bool every_candidate = false) : every_candidate_(every_candidate) {
    for (const finders::FinderEntry& entry : finders::finder_table())
      asked.push_back({entry.name, entry.make(), {}});
  }
  bool wants_every_candidate() const override { return every_candidate_; }

  struct Asked {
    std::string name;
    std::unique_ptr<finders::Finder> finder;
    finders::FinderCounts counts;
    std::uint64_t lost = 0;     ///< contacts that the driving finder found and this one did not
    std::uint64_t invented = 0; ///< the reverse
  };
  std::vector<Asked> asked;
  bool in_span = true; ///< every contact's time so far

  const Asked& of(const std::string& name) const {
    return *std::find_if(asked.begin(), asked.end(), [&](const Asked& a) { return a.name == name; });
  }

  void begins(const finders::DriftStep& step) override {
    end_ = step.end;
    for (Asked& a : asked)
      a.finder->begin(step);
  }
  void changed(std::size_t particle) override {
    for (Asked& a : asked)
      a.finder->changed(particle);
  }
  void searched(const finders::Query& query, const finders::FinderResult& truth) override {
    for (Asked& a : asked) {
      const finders::FinderResult result = a.finder->find(query);
      a.counts.add(result);
      in_span &= !result.contact() || (result.time >= query.start && result.time < end_);
      a.lost += truth.contact() && !result.contact();
      a.invented += !truth.contact() && result.contact();
    }
  }

private:
  bool every_candidate_;
  double end_ = 0.0;
};

} // namespace keeler::test
