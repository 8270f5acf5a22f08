// The kernels that find the lines in contact, in single precision and in every instruction set, against double
// precision.
#include "neighbours/kernels.hpp"

#include "draws.hpp"
#include "unit/collision/spheres.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace kernels_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

constexpr double full_turn = 4294967296.0; // 2³², the box
constexpr double single = 4e-6;            // relative bound on rounding in line sizes, as in the lists
constexpr std::size_t number = 61;         // lines, no multiple of any vector's length
constexpr InstructionSet all_sets[] = {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512};

std::int32_t wrapped(double fraction) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(fraction)));
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// One line and a row of others. Half of these are anywhere; the others pass the one at about the contact distance
// within the span, many through an edge of the box. All reach less than 0.45 of the box, as the sweep requires.
struct Row {
  test::RandomVectors random;
  double size_x, size_y, shear, offset, speed, half; // m, m, -, m, m/rad, rad
  LineFrame frame;
  Line one;
  std::vector<double> radii;            // of the others
  std::vector<Line> others;             // and padding that touches the one line but must not be kept
  static constexpr double radius = 1.0; // of the one line, and the largest

  explicit Row(std::uint64_t seed) : random(seed) {
    shear = 1.0 + random.uniform();
    half = decades(-5.0, 0.5);
    speed = decades(-3.0, 1.0) / half;
    const double reach = (2.0 * radius + 4.0 * half * speed) * (1.0 + shear * half) / 0.45;
    size_x = reach * (1.0 + 1e-3 + decades(-3.0, 4.0));
    size_y = reach * (1.0 + 1e-3 + decades(-3.0, 4.0));
    offset = size_y * (random.uniform() - 0.5);
    frame = {static_cast<float>(size_x / full_turn), static_cast<float>(size_y / full_turn), static_cast<float>(shear),
             wrapped(offset / size_y * full_turn)};
    one = line(anywhere(), radius);
    if (random.uniform() < 0.6) // near an edge
      one.x = static_cast<std::int32_t>((random.uniform() < 0.5 ? -1.0 : 1.0) *
                                        (0.5 * full_turn - 1.0 - random.uniform() * radius / size_x * full_turn));
    for (std::size_t k = 0; k < number; ++k) {
      radii.push_back(radius * decades(-2.0, 0.0));
      others.push_back(line(k % 2 ? passing(radii.back()) : anywhere(), radii.back()));
    }
    others.resize(number + kernel_padding, one);
  }

  double decades(double low, double high) { return std::pow(10.0, low + (high - low) * random.uniform()); }
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  }

  // Returns a random line without a size.
  Line anywhere() {
    const Vec3 v = speed * random.uniform() * random.direction();
    return {wrapped(full_turn * (random.uniform() - 0.5)),
            wrapped(full_turn * (random.uniform() - 0.5)),
            static_cast<float>(4.0 * radius * (random.uniform() - 0.5)),
            static_cast<float>(v.x()),
            static_cast<float>(v.y()),
            static_cast<float>(v.z()),
            0.0f,
            0};
  }

  // Returns a line at about the contact distance at some time. An image n boxes outward is behind by n offsets.
  Line passing(double r) {
    Line line = anywhere();
    const double off = (random.uniform() < 0.5 ? -1.0 : 1.0) * decades(-8.0, -1.0),
                 time = half * (2.2 * random.uniform() - 1.1);
    const Vec3 near = (radius + r) * (1.0 + off) * random.direction();
    const Vec3 v(line.u - one.u, line.v - one.v, line.w - one.w);
    const double x = near.x() - time * v.x(), y = near.y() - time * (v.y() - shear * x), z = near.z() - time * v.z();
    const double fraction = one.x + x / size_x * full_turn, box = std::floor(fraction / full_turn + 0.5);
    line.x = wrapped(fraction - box * full_turn);
    line.y = wrapped(one.y + (y + box * offset) / size_y * full_turn);
    line.z = static_cast<float>(one.z + z);
    return line;
  }

  Line line(const Line& without_size, double r) const {
    Line line = without_size;
    const double path = half * (std::fabs(line.u) + std::fabs(line.v) + std::fabs(line.w));
    const double grain = 4.0 / full_turn * (size_x + size_y);
    line.size = static_cast<float>(r + single * (r + path + std::fabs(line.z)) + grain);
    return line;
  }

  // Returns the smallest distance in the span, through all images next to the box.
  double nearest(const Line& a, const Line& b) const {
    double least = HUGE_VAL;
    for (const int n : {-1, 0, 1}) {
      const double x = (static_cast<double>(b.x) - a.x) / full_turn * size_x + n * size_x;
      const double y = std::remainder((static_cast<double>(b.y) - a.y) / full_turn * size_y - n * offset, size_y);
      const Vec3 d(x, y, static_cast<double>(b.z) - a.z);
      const Vec3 v(static_cast<double>(b.u) - a.u, static_cast<double>(b.v) - a.v - shear * x,
                   static_cast<double>(b.w) - a.w);
      const double time = std::clamp(-d.dot(v) / (v.squaredNorm() + 1e-300), -half, half);
      least = std::min(least, (d + time * v).norm());
    }
    return least;
  }

  LineSpan span() const { return {static_cast<float>(-half * (1.0 + 1e-6)), static_cast<float>(half * (1.0 + 1e-6))}; }

  std::vector<std::uint32_t> sweep(InstructionSet set, std::size_t begin, std::size_t end) const {
    std::vector<std::uint32_t> found(end - begin + kernel_padding);
    std::iota(found.begin(), found.end(), static_cast<std::uint32_t>(begin));
    found.resize(kernels(set).sweep(one, others.data(), frame, span(), found.data(), end - begin, found.data()));
    return found;
  }

  Pairs sweep_group(InstructionSet set, std::size_t first, std::size_t last, std::size_t begin, std::size_t end) const {
    std::vector<LinePair> found((last - first) * (end - begin));
    found.resize(kernels(set).sweep_group(others.data(), first, last, frame, span(), begin, end, found.data()));
    Pairs pairs;
    for (const LinePair& pair : found)
      pairs.emplace_back(pair.first, pair.second);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  Pairs filter(InstructionSet set, const Pairs& pairs) const {
    std::vector<LinePair> given, kept(pairs.size());
    for (const auto& [first, second] : pairs)
      given.push_back({first, second});
    given.resize(pairs.size() + kernel_padding, LinePair{number, number}); // which touch but are not among the pairs
    kept.resize(kernels(set).filter(others.data(), frame, span(), given.data(), pairs.size(), kept.data()));
    Pairs found;
    for (const LinePair& pair : kept)
      found.emplace_back(pair.first, pair.second);
    return found;
  }
};

} // namespace

TEST_CASE("no line in contact is rejected, and few others are kept") {
  std::size_t contacts = 0, across = 0, kept = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(4000); ++seed) {
    const Row row(seed);
    const std::vector<std::uint32_t> found = row.sweep(InstructionSet::portable, 0, number);
    for (std::uint32_t k = 0; k < number; ++k) {
      const double distance = row.nearest(row.one, row.others[k]), contact = Row::radius + row.radii[k];
      const bool listed = std::binary_search(found.begin(), found.end(), k);
      contacts += distance <= contact;
      across += distance <= contact && std::fabs(static_cast<double>(row.others[k].x) - row.one.x) > 0.5 * full_turn;
      kept += listed;
      if (distance <= contact && !listed) {
        CAPTURE(seed);
        CAPTURE(k);
        CHECK(distance > contact);
      }
    }
  }
  CHECK(contacts > test::draws(100000));
  CHECK(across > test::draws(15000));
  CHECK(static_cast<double>(kept) < 1.01 * static_cast<double>(contacts));
}

TEST_CASE("all instruction sets reject the same lines, in any part of a row") {
  for (std::uint64_t seed = 1; seed <= test::draws(2000); ++seed) {
    Row row(seed);
    const std::size_t begin = row.below(number), some = begin + row.below(number + 1 - begin);
    const std::size_t end = seed % 3 ? std::min(begin + seed % 20, number) : some;
    const std::vector<std::uint32_t> expected = row.sweep(InstructionSet::portable, begin, end);
    for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512})
      if (supports(set)) {
        CAPTURE(seed);
        CAPTURE(instruction_set_name(set));
        CHECK((row.sweep(set, begin, end) == expected));
      }
  }
}

TEST_CASE("a group of lines finds what each of them finds, and each pair within it once") {
  std::size_t pairs = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(2000); ++seed) {
    Row row(seed);
    for (Line& line : row.others)
      line.size *= 20.0f; // they are around the one line, and few would touch each other
    const std::size_t first = row.below(number), last = first + 1 + row.below(std::min<std::size_t>(8, number - first));
    const bool before = seed % 2 == 0;
    const std::size_t begin = before ? row.below(first + 1) : first + 1,
                      end = before ? begin + row.below(first + 1 - begin) : begin + row.below(number + 1 - begin);
    Pairs expected;
    for (std::size_t m = first; m < last; ++m) {
      row.one = row.others[m];
      for (const std::uint32_t k : row.sweep(InstructionSet::portable, begin, end))
        if (before || k > m)
          expected.emplace_back(static_cast<std::uint32_t>(m), k);
    }
    pairs += expected.size();
    for (const InstructionSet set : all_sets)
      if (supports(set)) {
        CAPTURE(seed);
        CAPTURE(instruction_set_name(set));
        CHECK((row.sweep_group(set, first, last, begin, end) == expected));
      }
  }
  CHECK(pairs > test::draws(10000));
}

TEST_CASE("the filter keeps, in order, the pairs of which one line finds the other") {
  std::size_t contacts = 0, kept = 0, given = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(2000); ++seed) {
    CAPTURE(seed);
    Row row(seed);
    row.others[0] = row.one;
    row.radii[0] = Row::radius;
    Pairs pairs, expected;
    for (std::size_t k = row.below(70); k > 0; --k) {
      const auto a = static_cast<std::uint32_t>(row.below(number)),
                 b = static_cast<std::uint32_t>(row.below(3) ? 0 : row.below(number));
      pairs.push_back(k % 2 ? std::pair(a, b) : std::pair(b, a));
    }
    for (const auto& [a, b] : pairs) {
      row.one = row.others[a];
      if (!row.sweep(InstructionSet::portable, b, b + 1).empty())
        expected.emplace_back(a, b);
      else
        CHECK(row.nearest(row.one, row.others[b]) > row.radii[a] + row.radii[b]);
      contacts += row.nearest(row.one, row.others[b]) <= row.radii[a] + row.radii[b];
    }
    given += pairs.size();
    kept += expected.size();
    for (const InstructionSet set : all_sets)
      if (supports(set)) {
        CAPTURE(instruction_set_name(set));
        CHECK((row.filter(set, pairs) == expected));
      }
  }
  CHECK(contacts > test::draws(5000));
  CHECK(given > 2 * kept);
}

} // namespace kernels_test
