// The order of the contacts of all domains against a merge that always takes the least next contact.
#include "contact_order.hpp"

#include <keeler/core/random.hpp>
#include <keeler/finders/finders.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace contact_order_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

constexpr double step_length = 0.01;

struct Case {
  Particles particles;
  std::vector<OptimisticDomain> domains;
};

// Contacts at times of which each occurs `ties` times on average; one in ten is rolled back.
Case random_case(std::uint64_t seed, std::size_t domains, std::size_t per_domain, std::size_t ties) {
  RandomStream random(seed, RandomPurpose::sample, 0);
  const auto below = [&](std::size_t limit) {
    return static_cast<std::uint32_t>(random.uniform() * static_cast<double>(limit));
  };
  Case made;
  made.particles.ids.resize(100);
  for (std::size_t i = 0; i < 100; ++i)
    made.particles.ids[i] = 7919 * i % 100;
  made.domains.resize(domains);
  const std::size_t times = 1 + domains * per_domain / ties;
  for (OptimisticDomain& domain : made.domains) {
    std::vector<std::size_t> when(below(2 * per_domain + 1));
    for (std::size_t& time : when)
      time = below(times);
    std::sort(when.begin(), when.end());
    for (const std::size_t time : when) {
      Contact contact;
      contact.time = step_length * (static_cast<double>(time) / static_cast<double>(times) - 0.5);
      contact.low = below(100);
      contact.high = below(100);
      domain.contacts.add(contact);
      if (below(10) == 0)
        domain.contacts.roll_back(domain.contacts.size() - 1);
    }
  }
  return made;
}

std::vector<std::pair<std::size_t, std::size_t>> merged(const Case& of) {
  std::vector<std::pair<std::size_t, std::size_t>> order;
  std::vector<std::size_t> next(of.domains.size(), 0);
  const auto key = [&](std::size_t d) {
    const Contact& c = of.domains[d].contacts[next[d]];
    return std::tuple(c.time, of.particles.ids[c.low], of.particles.ids[c.high]);
  };
  for (;;) {
    std::size_t least = next.size();
    for (std::size_t d = 0; d < next.size(); ++d) {
      next[d] = of.domains[d].contacts.next_valid(next[d]);
      if (next[d] < of.domains[d].contacts.size() && (least == next.size() || key(d) < key(least)))
        least = d;
    }
    if (least == next.size())
      return order;
    order.emplace_back(least, next[least]++);
  }
}

} // namespace

TEST_CASE("contacts of domains are merged by time and ids, and in a domain stay as they were") {
  const std::unique_ptr<finders::Finder> finder = finders::make_finder("certified");
  const CollisionSettings settings;
  ContactOrder order;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Case made = random_case(seed, 1 + seed % 7, seed % 5 == 0 ? 900 : 20, seed % 3 + 1);
    const ShearingBox box{1.0, 1.0, 1.5};
    const StepContext step{.particles = made.particles,
                           .settings = settings,
                           .finder = *finder,
                           .frequencies = {},
                           .orbital_frequency = 1.0,
                           .box = box,
                           .offset = 0.0,
                           .begin = -0.5 * step_length,
                           .kick_pull = 0.0,
                           .rest_pull = 0.0,
                           .gravity = {},
                           .watcher = nullptr,
                           .record_taker = nullptr};
    REQUIRE(order.sort(made.domains, made.domains.size(), step));
    const auto expected = merged(made);
    REQUIRE(order.size() == expected.size());
    bool is_tied = false; // with a contact of the last domain
    for (std::size_t k = 0; k < expected.size(); ++k) {
      REQUIRE(order[k].domain == expected[k].first);
      REQUIRE(order[k].contact == expected[k].second);
      is_tied |= k > 0 && order[k].time == order[k - 1].time &&
                 std::max(order[k].domain, order[k - 1].domain) + 1 == made.domains.size();
    }
    CHECK(order.sort(made.domains, made.domains.size() - 1, step) != is_tied);
  }
}

} // namespace contact_order_test
