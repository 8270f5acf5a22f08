// The contacts at rest of one kick: the members, which are the particles of pairs at rest, and these pairs. For
// resting_contacts.cpp alone.
//
// Invariants: members are sorted by id, each once; pairs are sorted by ids and hold indices of members.
#pragma once

#include <keeler/contact_solver/resting_contacts.hpp>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::contact_solver {

class Clusters;

/// A particle that may rest.
struct Member {
  std::uint64_t id = 0;
  std::uint32_t index = 0; // in the store
};

/// A pair at this boundary.
struct PairAtRest {
  RestingPair ids;
  std::uint32_t low = 0, high = 0; // indices of members
  double impulse = 0.0;            // at the last boundary
  bool is_new = false;

  Image image;                    // of the higher id, nearest to the lower one
  Elements relative;              // of the higher id to the lower one, with the kicks of the next interval
  Vec3 separation = Vec3::Zero(); // m
  Vec3 normal = Vec3::Zero();
  double radius_sum = 0.0, gap = 0.0; // m
  double speed = 0.0;                 // along the normal before the kick, positive if they separate, m rad⁻¹
  double kick = 0.0;                  // change of the speed by the kick
  double pull = 0.0;                  // kick by the pair's gravity, m rad⁻¹
  double min_gap = 0.0, target = 0.0; // gap at the next boundary, without and with room for the curvature, m
  double max_closing_speed = 0.0;     // largest closing speed before the kick of a pair at rest, m rad⁻¹
};

struct RestingContacts::Work {
  std::vector<Member> members; // sorted by id
  std::vector<double> inverse_masses;
  std::vector<Vec3> kicks_before, kicks_after; // of each member, m rad⁻¹
  std::vector<Vec3> velocity_changes;          // velocity change of each member by all impulses
  std::vector<PairAtRest> pairs;

  void find_members(const RestingState& state, const std::vector<Noted>& noted, const Particles& particles,
                    bool indices_known);
  void read_kicks(const RestingStep& step);
  void list_pairs(const RestingState& state, const std::vector<Noted>& noted);
  void update_geometry(const RestingStep& step);
  void apply_friction(const RestingStep& step, const collision::Friction& friction, CollisionTally& tally);
  void classify_pairs(const RestingStep& step);
  void solve(const RestingStep& step);
  void solve_cluster(const Clusters& clusters, std::size_t cluster, std::span<PairAtRest* const> held,
                     const RestingStep& step);
  void distribute(RestingState& state, const RestingStep& step, const std::vector<Vec3>& kicks, bool after,
                  CollisionTally& tally);

  void drop_free_members();

  const Body& body(const RestingStep& step, std::uint32_t member) const {
    return step.particles.bodies[members[member].index];
  }
  std::vector<Member>::const_iterator find(std::uint64_t id) const {
    return std::lower_bound(members.begin(), members.end(), id,
                            [](const Member& m, std::uint64_t sought) { return m.id < sought; });
  }
  bool rests(std::uint64_t id) const {
    const auto found = find(id);
    return found != members.end() && found->id == id;
  }
  std::uint32_t member(std::uint64_t id) const {
    assert(rests(id));
    return static_cast<std::uint32_t>(find(id) - members.begin());
  }
  // Returns the relative speed along the line of centres, positive if they separate, by these velocity changes.
  static double separation_speed(const PairAtRest& p, const std::vector<Vec3>& changes) {
    return p.normal.dot(changes[p.high] - changes[p.low]);
  }
  // Returns the gap at the next kick, after the velocity changes `velocity_changes`.
  double gap_at_next_kick(const PairAtRest& p, const RestingStep& step, const Rotation& now,
                          const Rotation& then) const {
    Elements relative = p.relative;
    hill::kick(relative, velocity_changes[p.high] - velocity_changes[p.low], step.frequencies, now);
    return state_at(relative, step.frequencies, then).position.norm() - p.radius_sum;
  }
};

} // namespace keeler::contact_solver
