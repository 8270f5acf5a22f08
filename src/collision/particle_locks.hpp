// Locks of a parallel step: a domain locks a particle of its own when an event or a path of the particle is left
// to a later round. From then on it defers every event of that particle.
//
// Invariant: between rounds no particle is locked.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

/// The locks of all particles.
class ParticleLocks {
public:
  void resize(std::size_t particles) {
    assert(std::find(locked_.begin(), locked_.end(), 1) == locked_.end());
    locked_.resize(particles);
  }
  bool is_locked(std::size_t i) const { return locked_[i]; }
  void lock(std::size_t i) { locked_[i] = 1; }
  void unlock(std::size_t i) { locked_[i] = 0; }
  std::size_t bytes() const { return locked_.capacity(); }

private:
  std::vector<std::uint8_t> locked_;
};

/// The locks that one domain sets in a round; released when the round ends.
class DomainLocks {
public:
  explicit DomainLocks(ParticleLocks& all) : all_(all) {}
  ~DomainLocks() {
    for (const std::uint32_t i : locked_)
      all_.unlock(i);
  }
  DomainLocks(const DomainLocks&) = delete;
  DomainLocks& operator=(const DomainLocks&) = delete;

  void lock(std::uint32_t i) {
    all_.lock(i);
    locked_.push_back(i);
  }
  bool is_locked(std::uint32_t i) const { return all_.is_locked(i); }

private:
  ParticleLocks& all_;
  std::vector<std::uint32_t> locked_;
};

/// The locks that a domain will set: from a contact with a particle of another domain on, unless the own particle
/// changes before.
class LockSchedule {
public:
  void clear() {
    locks_.clear();
    next_ = 0;
  }
  void add(double time, std::uint32_t particle, std::uint32_t event_count) {
    locks_.push_back({time, particle, event_count});
  }
  /// Precedes the first visit_due().
  void sort() {
    assert(next_ == 0);
    std::sort(locks_.begin(), locks_.end(), [](const Lock& a, const Lock& b) { return a.time < b.time; });
  }
  /// Calls visit(particle, its event count at the prediction) for each lock up to that time, once each.
  template<class Visit> void visit_due(double time, const Visit& visit) {
    for (; next_ < locks_.size() && locks_[next_].time <= time; ++next_)
      visit(locks_[next_].particle, locks_[next_].event_count);
  }
  std::size_t bytes() const { return locks_.capacity() * sizeof(Lock); }

private:
  struct Lock {
    double time;
    std::uint32_t particle, event_count;
  };
  std::vector<Lock> locks_;
  std::size_t next_ = 0;
};

} // namespace keeler::collision
