// The velocity changes of a parallel step: the path that each one ended, so that it can be rolled back.
//
// Invariants: changes of a particle follow each other in time; newest() is the particle's last change; changes 2k and
// 2k + 1 of a domain belong to its contact k.
#pragma once

#include "domain_cut.hpp"
#include "step_history.hpp"

#include <keeler/particles/store.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

/// Numbers the changes of all domains; 0 means none.
using ChangeNumber = std::uint32_t;

/// The end of a particle's path.
struct Change {
  std::uint32_t particle;
  ChangeNumber earlier; // the particle's previous change in this step
  double begin, time;   // of the path that ended
  Elements ended;
};

class ChangeLog {
public:
  static constexpr std::uint32_t max_changes = 1u << 20; // per domain
  static_assert(DomainCut::max_in_all * std::uint64_t{max_changes} < std::uint64_t{1} << 32);

  static ChangeNumber number_of(std::size_t domain, std::size_t index) {
    return static_cast<ChangeNumber>(domain * max_changes + index + 1);
  }
  static std::size_t domain_of(ChangeNumber number) { return (number - 1) / max_changes; }
  static std::size_t index_of(ChangeNumber number) { return (number - 1) % max_changes; }
  /// Returns the number of the contact in its domain.
  static std::size_t contact_of(ChangeNumber number) { return index_of(number) / 2; }
  /// Returns the other change of that contact.
  static ChangeNumber partner_of(ChangeNumber number) { return ((number - 1) ^ 1u) + 1; }

  void resize(std::size_t particles, std::size_t domains) {
    newest_.resize(particles);
    if (logs_.size() != domains)
      logs_ = std::vector<DomainLog>(domains);
  }
  void clear(std::size_t domain) {
    logs_[domain].changes.clear();
    logs_[domain].spins.clear();
  }

  std::size_t size(std::size_t domain) const { return logs_[domain].changes.size(); }
  /// False if the domain cannot number another two contacts.
  bool has_room(std::size_t domain) const { return size(domain) + 3 <= max_changes; }
  const Change& operator[](ChangeNumber number) const {
    assert(number > 0 && index_of(number) < size(domain_of(number)));
    return logs_[domain_of(number)].changes[index_of(number)];
  }
  /// Returns the spin before a change; zero of a smooth particle.
  Vec3 spin_before(ChangeNumber number) const {
    const std::vector<Vec3>& spins = logs_[domain_of(number)].spins;
    return spins.empty() ? Vec3::Zero() : spins[index_of(number)];
  }

  /// Returns the last change of particle i in this step.
  ChangeNumber newest(const StepHistory& history, std::size_t i) const {
    return history.event_count(i) > 0 ? newest_[i] : 0;
  }

  /// Logs the present path of a particle, which ends at change.time. Precondition: change.earlier is its newest change.
  void add(std::size_t domain, const Change& change, const Particles& particles) {
    assert(change.begin <= change.time);
    newest_[change.particle] = number_of(domain, size(domain));
    logs_[domain].changes.push_back(change);
    if (particles.rough)
      logs_[domain].spins.push_back(particles.spins[change.particle]);
  }

  /// Gives a particle the orbit and spin back that this change ended; its later changes are void.
  void restore(ChangeNumber number, Particles& particles) {
    const Change& change = (*this)[number];
    particles.bodies[change.particle].elements = change.ended;
    if (particles.rough)
      particles.spins[change.particle] = spin_before(number);
    newest_[change.particle] = change.earlier;
  }

  /// Forgets the domain's last change, which has been restored.
  void remove_last(std::size_t domain) {
    DomainLog& log = logs_[domain];
    assert(!log.changes.empty());
    log.changes.pop_back();
    if (!log.spins.empty())
      log.spins.pop_back();
  }

  std::size_t bytes() const {
    std::size_t total = newest_.capacity() * sizeof(ChangeNumber) + logs_.capacity() * sizeof(DomainLog);
    for (const DomainLog& log : logs_)
      total += log.changes.capacity() * sizeof(Change) + log.spins.capacity() * sizeof(Vec3);
    return total;
  }

private:
  struct alignas(64) DomainLog { // no two threads write to one cache line
    std::vector<Change> changes;
    std::vector<Vec3> spins; // before each change; none of smooth particles
  };
  std::vector<DomainLog> logs_;
  std::vector<ChangeNumber> newest_; // valid if the particle has changed in this step
};

} // namespace keeler::collision
