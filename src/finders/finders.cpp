#include <keeler/finders/finders.hpp>

#include <keeler/finders/certified_finder.hpp>
#include <keeler/finders/motion/cubic.hpp>
#include <keeler/finders/motion/full.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/linear.hpp>
#include <keeler/finders/search/newton.hpp>

#include <cassert>

namespace keeler::finders {
namespace {

template<MotionModel Motion, SearchMethod<Motion> Search> std::unique_ptr<Finder> make() {
  return std::make_unique<MotionSearch<Motion, Search>>();
}

std::unique_ptr<Finder> make_certified() {
  return make_certified_finder(choose_instruction_set());
}

using OriginalNewton = NewtonSearch<NewtonForm::original>;
using Newton = NewtonSearch<NewtonForm::damped>;
using NewtonAsCoded = NewtonSearch<NewtonForm::as_coded>;
using Linear = LinearSearch<LinearForm::full>;
using LinearOnCubic = LinearSearch<LinearForm::cubic>;

constexpr FinderEntry table[] = {
    {"certified", "relative epicycle, guaranteed first root", make_certified},
    {"newton-relative", "relative epicycle, damped Newton", make<RelativeMotion, Newton>},
    {"linear-relative", "relative epicycle, straight-line guesses", make<RelativeMotion, Linear>},
    {"original", "own epicycles, Newton steps of half length", make<FullMotion, OriginalNewton>},
    {"newton-full", "own epicycles, damped Newton", make<FullMotion, Newton>},
    {"newton-full-as-coded", "newton-full, with trials at the old guess as published", make<FullMotion, NewtonAsCoded>},
    {"newton-cubic", "cubics fitted for each pair, damped Newton", make<CubicMotion, Newton>},
    {"newton-cubic-cached", "cubics kept for each particle, damped Newton", make<CachedCubicMotion, Newton>},
    {"linear-full", "own epicycles with the start's states kept, straight-line guesses (the paper's fastest)",
     make<StoredStartMotion, Linear>},
    {"linear-full-no-start", "linear-full without stored states", make<FullMotion, Linear>},
    {"linear-cubic", "cubics fitted for each pair that approaches, straight-line guesses",
     make<LateCubicMotion, LinearOnCubic>},
    {"linear-cubic-cached", "cubics kept for each particle, straight-line guesses",
     make<CachedCubicMotion, LinearOnCubic>},
};

constexpr const char* exit_names[finder_exits] = {"hit",     "overlapping", "receding",    "missed",
                                                  "outside", "gave up",     "not a number"};

} // namespace

const char* name_of(FinderExit exit) {
  assert(static_cast<int>(exit) >= 0 && static_cast<int>(exit) < finder_exits);
  return exit_names[static_cast<int>(exit)];
}

std::span<const FinderEntry> finder_table() {
  return table;
}

std::unique_ptr<Finder> make_finder(const std::string& name) {
  for (const FinderEntry& entry : table)
    if (name == entry.name)
      return entry.make();
  return nullptr;
}

} // namespace keeler::finders
