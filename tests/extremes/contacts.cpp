// Contacts that hardly are, that come together, that run along a row, and states that must stay symmetric: tests of
// tests/unit show each of them, in the plain algorithm's bits.
#include "rows.hpp"

namespace keeler::extremes {
namespace {

std::vector<Row> contacts_shown() {
  const std::string extremes = "collision/extremes.cpp", plain = "to the bit as the plain algorithm has it; ";
  return {
      shown_by("grazing contacts, to 1e-13 of a radius", extremes,
               "grazing pairs: a contact when the paths come nearer than two radii, none when they do not",
               plain + "from 2e-11 radii on the side is known"),
      shown_by("simultaneous and triple contacts", extremes, "simultaneous and triple contacts", plain + "ε 0, 0.5, 1"),
      shown_by("Newton's cradles of 5 and 300 spheres", extremes,
               "Newton's cradle: what hits a row of spheres at rest flies on from its other end",
               plain + "the last one takes all the speed, to 1e-4"),
      shown_by("point-symmetric states", extremes, "point-symmetric states stay symmetric to the bit",
               "each element the other's negative"),
      shown_by("hits at one instant on several threads", "collision/any_way.cpp",
               "the same bits any way: rows of touching spheres, each hit at its end at the same instant",
               "the same bits on 1 to 8 threads"),
      shown_by("boxes of up to 10⁶ radii, steps of 0.3 orbit", "collision/far_and_fast.cpp",
               "long steps in boxes of up to 10^6 radii: no contact comes a step late", "every contact comes in time"),
      shown_by("everything at random at once", "collision/far_and_fast.cpp",
               "the same bits as the plain twin: everything drawn at random", "180 states over decades")};
}

} // namespace

std::vector<Subject> contact_subjects() {
  return {{"contacts", "Contacts", rows::Length::quick, contacts_shown}};
}

} // namespace keeler::extremes
