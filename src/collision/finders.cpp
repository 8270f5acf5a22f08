#include <keeler/collision/finders.hpp>

#include <keeler/collision/motion/full.hpp>
#include <keeler/collision/motion/relative.hpp>
#include <keeler/collision/search/certified.hpp>
#include <keeler/collision/search/linear.hpp>

namespace keeler {
namespace {

template<class Motion, class Search> std::unique_ptr<Finder> make() {
  return std::make_unique<MotionSearch<Motion, Search>>();
}

constexpr FinderEntry table[] = {
    {"certified", "relative epicycle, guaranteed first root", make<TangentMotion, CertifiedSearch>},
    {"linear-full", "own epicycles, straight-line guesses (the paper's fastest; can miss)",
     make<FullMotion, LinearSearch>},
};

constexpr const char* exit_names[finder_exits] = {"hit",     "overlapping", "receding",    "missed",
                                                  "outside", "gave up",     "not a number"};

} // namespace

const char* name_of(FinderExit exit) {
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

} // namespace keeler
