// The division of the box in a parallel step: each round of domains cuts it into strips across the orbit, the second
// round through the middles of the strips of the first; the domain of the last round is the whole box.
//
// Invariants: edges are sorted, two for each strip; in each round every position belongs to exactly one domain.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

/// Positions across the box are fractions of it, in units of 2⁻³².
class DomainCut {
public:
  static constexpr std::size_t rounds = 3;
  /// Largest number of domains per round: all rounds together are numbered in one byte.
  static constexpr std::size_t max_domains = 127;

  struct Strip {
    std::uint32_t begin = 0;
    std::uint64_t width = 0;
  };

  /// Cuts the box into `domains` strips with equal numbers of these sample positions. Precondition: 0 < domains <=
  /// max_domains.
  void cut(std::vector<std::uint32_t> samples, std::size_t domains) {
    assert(domains > 0 && domains <= max_domains);
    per_round_ = domains;
    std::sort(samples.begin(), samples.end());
    edges_.clear();
    for (std::size_t half = 0; half < 2 * domains; ++half)
      edges_.push_back(samples.empty() ? 0 : samples[half * samples.size() / (2 * domains)]);
    assert(std::is_sorted(edges_.begin(), edges_.end()));
  }

  /// Returns the number of domains of all rounds, which are numbered round by round: [begin_of(r), end_of(r)).
  std::size_t domains() const { return 2 * per_round_ + 1; }
  std::size_t begin_of(std::size_t round) const { return round * per_round_; }
  std::size_t end_of(std::size_t round) const { return std::min((round + 1) * per_round_, domains()); }

  /// Returns the strip of a domain that is not of the last round.
  Strip strip(std::size_t domain) const {
    assert(domain < 2 * per_round_);
    const std::size_t halves = edges_.size(), half = 2 * (domain % per_round_) + domain / per_round_;
    return {edges_[half % halves], edges_[(half + 2) % halves] - edges_[half % halves]};
  }

  /// Returns the number, within its round, of the domain that owns a position.
  std::size_t owner(std::size_t round, std::uint32_t position) const {
    if (round + 1 == rounds)
      return 0;
    const auto after = std::upper_bound(edges_.begin(), edges_.end(), position) - edges_.begin();
    const std::size_t halves = edges_.size(), half = static_cast<std::size_t>(after) + halves - 1 - round;
    return half % halves / 2;
  }

private:
  std::size_t per_round_ = 0;        // domains of the first and of the second round
  std::vector<std::uint32_t> edges_; // of half strips
};

} // namespace keeler::collision
