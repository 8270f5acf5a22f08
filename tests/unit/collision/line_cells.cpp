// The cell list of straight lines against the test of all pairs of lines: the pairs of a rebuild, and the search of a
// single line, before and after lines have been replaced.
#include "neighbours/line_cells.hpp"

#include "draws.hpp"

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace line_cells_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

// Random lines of one size or many, in a wide box or in one so narrow that it has few columns or rows.
struct Sorted {
  RandomStream random;
  bool sheared; // long span and lines fast across the box, where the shear moves their partners along
  double half;  // of the span, rad
  ShearingBox box;
  std::vector<Line> lines;
  LineCells cells;
  std::uint64_t tested = 0;

  explicit Sorted(std::uint64_t seed, std::size_t count = 900)
      : random(seed, RandomPurpose::position, 0), sheared(seed % 5 == 0), half(sheared ? 0.5 : 0.01) {
    box = {seed % 3 == 0 ? 30.0 : 190.0, seed % 3 == 1 ? 35.0 : 190.0, 1.5, 0.0};
    const double largest = seed % 2 ? 1.0 : 40.0;
    for (std::size_t k = 0; k < count; ++k) {
      lines.push_back(anywhere(std::min(std::pow(random.uniform(), -0.7), largest) / largest));
      lines.back().tag = static_cast<std::uint32_t>(k);
    }
    cells.build(lines, box, box.size_y * (random.uniform() - 0.5), half, 1.0 / largest,
                {seed % 4 == 0 ? 3u : 1u, seed % 4 < 2 ? 2u : 1u}); // lines of several copies in a cell, too
  }

  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  }

  // Returns a random line; a few are fast.
  Line anywhere(double size, double fast = 2.0) {
    const auto fraction = [&] {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(random.uniform() * 4294967296.0));
    };
    const double speed = (below(sheared ? 3 : 20) ? 0.1 : sheared ? 4.0 : fast) / half;
    const auto component = [&](double width) { return static_cast<float>(width * (random.uniform() - 0.5)); };
    return {fraction(),
            fraction(),
            component(4.0),
            component(speed),
            component(sheared ? 0.01 * speed : speed),
            component(speed),
            static_cast<float>(size),
            0};
  }

  LineSpan span() const { return {static_cast<float>(-half), static_cast<float>(half)}; }
  LineSpan rest() const { return {static_cast<float>(0.3 * half), static_cast<float>(half)}; }

  // Return the lines that `line` may touch, in order: by testing all, and by the cells.
  std::vector<std::uint32_t> plainly(const Line& line, const LineSpan& when) const {
    std::vector<Line> all = lines;
    all.resize(lines.size() + kernel_padding);
    std::vector<std::uint32_t> found(all.size());
    std::iota(found.begin(), found.end(), 0u);
    found.resize(kernels(InstructionSet::portable)
                     .sweep(line, all.data(), cells.frame(), when, found.data(), lines.size(), found.data()));
    return found;
  }
  std::vector<std::uint32_t> by_cells(const Line& line, const LineSpan& when) {
    std::vector<std::uint32_t> found;
    found.resize(cells.find_near(line, when, found, tested));
    for (std::uint32_t& slot : found)
      slot = cells.particle(slot);
    std::sort(found.begin(), found.end());
    return found;
  }

  Pairs pairs_of_all(std::size_t block) {
    std::vector<LinePair> buffer;
    Pairs found;
    for (std::size_t begin = 0; begin < cells.size(); begin += block)
      tested += cells.sweep_pairs(begin, std::min(begin + block, cells.size()), span(), buffer,
                                  [&](std::size_t i, std::size_t j) {
                                    found.push_back(std::minmax<std::size_t>(cells.particle(i), cells.particle(j)));
                                  });
    std::sort(found.begin(), found.end());
    return found;
  }
};

} // namespace

TEST_CASE("the pairs of a rebuild are those that each line finds by itself and those of testing all pairs") {
  std::size_t pairs = 0, boxes = 0;
  std::uint64_t tested = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(60); ++seed) {
    Sorted sorted(seed);
    if (!sorted.cells.one_image())
      continue;
    CAPTURE(seed);
    ++boxes;
    Pairs expected;
    for (std::uint32_t k = 0; k < sorted.lines.size(); ++k) {
      const Line& line = sorted.lines[k];
      const std::vector<std::uint32_t> near = sorted.plainly(line, sorted.span());
      CHECK((sorted.by_cells(line, sorted.span()) == near));
      CHECK((sorted.by_cells(line, sorted.rest()) == sorted.plainly(line, sorted.rest())));
      for (const std::uint32_t j : near)
        if (k < j)
          expected.emplace_back(k, j);
    }
    sorted.tested = 0;
    CHECK((sorted.pairs_of_all(97) == expected));
    tested += sorted.tested;
    CHECK((sorted.pairs_of_all(sorted.lines.size()) == expected));
    pairs += expected.size();
    all += sorted.lines.size() * (sorted.lines.size() - 1) / 2;
  }
  MESSAGE(pairs << " pairs of " << tested << " tested of " << all << " in " << boxes << " boxes");
  CHECK(boxes > test::draws(30));
  CHECK(pairs > test::draws(10000));
  CHECK(tested < all / 3);
}

TEST_CASE("a replaced line is found where it is, slow or fast, near its old position or not") {
  std::size_t found = 0, boxes = 0, slow = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(60); ++seed) {
    Sorted sorted(seed, 500);
    if (!sorted.cells.one_image())
      continue;
    CAPTURE(seed);
    ++boxes;
    for (std::size_t change = 0; change < 1 + 40 * (seed % 4); ++change) {
      const std::size_t place = sorted.below(change % 2 ? 20 : sorted.lines.size()); // some repeatedly
      Line line = sorted.anywhere(sorted.lines[place].size * (0.5 + sorted.random.uniform()), 10.0);
      if (seed % 8 == 1) { // in its old position, faster or larger
        line.x = sorted.lines[place].x;
        line.y = sorted.lines[place].y;
      } else if (change % 4 > 0) { // close to where it was, or through an edge
        const Line& before = sorted.lines[place];
        line.x = static_cast<std::int32_t>(static_cast<std::uint32_t>(before.x) + sorted.below(1 << 26) - (1u << 25));
        line.y = static_cast<std::int32_t>(static_cast<std::uint32_t>(before.y) + sorted.below(1 << 26) - (1u << 25));
      }
      if (!sorted.cells.one_image(line))
        continue;
      line.tag = static_cast<std::uint32_t>(place);
      sorted.cells.replace(place, line);
      sorted.lines[place] = line;
      slow += std::fabs(line.u) < 0.1 / sorted.half;
    }
    for (const Line& line : sorted.lines)
      for (const LineSpan& when : {sorted.span(), sorted.rest()}) {
        const std::vector<std::uint32_t> expected = sorted.plainly(line, when);
        CAPTURE(line.tag);
        CHECK((sorted.by_cells(line, when) == expected));
        found += expected.size();
      }
  }
  MESSAGE(found << " found in " << boxes << " boxes; " << slow << " slow lines replaced");
  CHECK(boxes > test::draws(30));
  CHECK(found > test::draws(50000));
  CHECK(slow > test::draws(1000));
}

TEST_CASE("a line that would reach around the box is reported, when cells are built and when it is new") {
  Sorted sorted(2);
  CHECK(sorted.cells.one_image());
  Line line = sorted.lines[0];
  line.size = static_cast<float>(0.5 * sorted.box.size_x);
  CHECK_FALSE(sorted.cells.one_image(line));
  sorted.lines[0] = line;
  sorted.cells.build(sorted.lines, sorted.box, 0.0, sorted.half, 0.025);
  CHECK_FALSE(sorted.cells.one_image());
}

} // namespace line_cells_test
