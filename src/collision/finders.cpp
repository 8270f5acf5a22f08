#include <keeler/collision/finders.hpp>

#include <keeler/collision/motion/full.hpp>
#include <keeler/collision/motion/relative.hpp>
#include <keeler/collision/search/certified.hpp>
#include <keeler/collision/search/linear.hpp>

namespace keeler {
namespace {

FinderResult certified(const Pair& pair, const Frequencies& f) {
  return certified_search(RelativeMotion(pair, f), pair);
}

FinderResult linear_full(const Pair& pair, const Frequencies& f) {
  return linear_search(FullMotion(pair, f), pair);
}

constexpr FinderEntry table[] = {
    {"certified", "relative epicycle, guaranteed first root", certified},
    {"linear-full", "own epicycles, straight-line guesses (the paper's fastest; can miss)", linear_full},
};

} // namespace

std::span<const FinderEntry> finder_table() {
  return table;
}

Finder finder_named(const std::string& name) {
  for (const FinderEntry& entry : table)
    if (name == entry.name)
      return entry.find;
  return nullptr;
}

} // namespace keeler
