// The order of the contacts of a step that was carried out in domains: by (time, ids), and within a domain as it
// carried them out, also at one instant.
#pragma once

#include "optimistic_domain.hpp"
#include "step_context.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace keeler::collision {

/// A contact of a domain, by their numbers.
struct ContactTurn {
  double time;
  std::uint32_t domain, contact;
};

class ContactOrder {
public:
  /// Orders the contacts that were not rolled back. Returns false if contacts at one instant include one of a domain of
  /// a later round, which begin with `first_late`: the order of these depends on when they were predicted.
  bool sort(std::span<const OptimisticDomain> domains, std::size_t first_late, const StepContext& step);

  std::size_t size() const { return all_.size(); }
  const ContactTurn& operator[](std::size_t k) const { return all_[k]; }
  std::size_t bytes() const;

private:
  using Turns = std::vector<ContactTurn>;

  void collect(std::span<const OptimisticDomain> domains);

  std::vector<Turns> of_domain_; // in the order of time
  Turns all_;
};

} // namespace keeler::collision
