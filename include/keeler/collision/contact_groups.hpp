// The contacts of one step on several threads, with the bits of the sequential order.
//
// The first contacts of a step fall into groups that share no particle. Each group is carried out on its own, as if
// nobody else were hit: a pure function of the orbits at the step's start and of the group's first contacts, which
// keeps the new orbits to itself. That is speculation. A particle of another group that a group has hit is a conflict.
// Beyond that, every two particles that were hit in different groups are searched against each other, all new pieces of
// their paths that overlap in time, exactly as the sequential order would have: a contact before both pieces end is a
// conflict, too. (A new piece against the path of a particle before it was hit has been searched by the group itself.)
// Groups in conflict become one, which is carried out anew from the step's start, until none is left.
// What remains is then the history that the sequential order gives: by induction over its events, no pending contact is
// missing and none is made up. Groups may merge without need, never be apart that touch, so ties count as conflicts.
//
// A step whose contacts hang together in one large group, or whose repairs do not come to an end soon, is left to the
// sequential loop; nothing has happened by then.
#pragma once

#include <keeler/collision/contact_loop.hpp>
#include <keeler/collision/neighbours.hpp>

#include <utility>
#include <vector>

namespace keeler {

class ContactGroups {
public:
  /// A particle that was hit.
  struct Member {
    std::uint32_t place = 0;
    std::uint32_t stamp = 0; ///< contacts
    Body body;               ///< with its last orbit
    double last_change = 0.0;
    std::int32_t piece = -1; ///< its newest; −1: that of the step's start
    double off = 0.0;        ///< how far it got off the path it had at the step's start, m
  };

  /// Carries out everything that follows from the first contacts of a step. The store is only read. Returns false when
  /// that should be done in sequence instead: also when a loop has failed, so that it fails in its order.
  bool carry_out(const StepAtHand& step, const Finder& finder, const Neighbours& neighbours,
                 const std::vector<Event>& first);

  /// All contacts in the order of events.
  std::vector<const Contact*> contacts() const;

  /// Calls visit(member) for every particle that was hit.
  template<class Visit> void visit_members(const Visit& visit) const {
    for (std::size_t g = 0; g < used_; ++g)
      for (const Member& member : groups_[g].members)
        visit(member);
  }

  /// Of one particle in one search of this step.
  std::uint64_t most_partners() const;
  /// Gives back what unusually large groups have needed.
  void trim();

  /// Gives all these particles their last orbits.
  void write(std::vector<Body>& bodies) const;

  std::uint64_t conflicts = 0, repairs = 0; ///< so far
  std::size_t bytes() const;

private:
  // of a group, and rounds of repair: beyond, the sequence is the better way
  static constexpr std::size_t most_members = 256, most_contacts = 1024;
  static constexpr int most_rounds = 12;

  /// An orbit from a time on.
  struct Piece {
    double begin;
    Elements elements;
    std::int32_t earlier; // −1: that of the step's start
  };
  struct Group {
    std::vector<Event> first;
    std::vector<Member> members;
    std::vector<Piece> pieces;
    std::vector<Contact> contacts;
    double farthest = 0.0; // that a member got off its path, m
    bool fresh = false, too_large = false;
    bool failed = false;
    std::uint64_t most_partners = 0;
    std::size_t bytes() const;
  };
  struct Orbits;
  struct Scratch;
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  bool form(const std::vector<Event>& first);
  void run(Group& group) const;
  void prefetch(const Group& group, int stage) const;
  bool run_fresh();
  void claim(Pairs& conflicting);
  void look_around(std::uint32_t group, double farthest, bool all_fresh, Pairs& conflicting) const;
  bool meet(const Group& a, const Member& i, const Group& b, const Member& k) const;
  void merge(const Pairs& conflicting);
  std::uint32_t root(std::uint32_t group);

  const StepAtHand* step_ = nullptr;
  const Finder* finder_ = nullptr;
  const Neighbours* neighbours_ = nullptr;
  std::size_t used_ = 0;
  std::vector<Group> groups_;            // of which `used_` are of this step; the others keep their memory
  std::vector<std::uint32_t> merged_in_; // the group that each has become part of, or itself
  std::vector<std::uint32_t> claims_;    // by slot of the mirror: 1 + the group that a particle belongs to; or 0
  std::vector<std::uint32_t> claimed_;   // slots that are not 0
};

} // namespace keeler
