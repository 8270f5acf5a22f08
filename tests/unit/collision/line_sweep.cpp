// The sweep of straight lines in single precision, in every instruction set, against the same in double precision; and
// the pairs of a whole mirror against what each of its lines finds by itself.
#include "line_sweep.hpp"

#include "mirror.hpp"
#include "unit/collision/spheres.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

using namespace keeler;

namespace {

constexpr double full_turn = 4294967296.0; // 2³², the box
constexpr double single = 4e-6;            // of a path: what sizes allow for single precision, as the mirror's do
constexpr std::size_t number = 61;         // lines, no multiple of any vector's length

std::int32_t wrapped(double fraction) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(fraction)));
}

// One line, and a row of others: half of them anywhere, half so that they pass the one at about the contact's distance
// some time in the span, many through an edge of the box. All reach less than 0.45 of the box, as the sweep asks.
struct Row {
  test::RandomVectors random;
  double size_x, size_y, shear, offset, speed, half; // m, m, -, m, m/rad, rad
  LineFrame frame;
  Line one;
  std::vector<double> radii; // of the others
  std::vector<Line> others;
  static constexpr double radius = 1.0; // of the one, and the largest

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
    if (random.uniform() < 0.6) // about an edge
      one.x = static_cast<std::int32_t>((random.uniform() < 0.5 ? -1.0 : 1.0) *
                                        (0.5 * full_turn - 1.0 - random.uniform() * radius / size_x * full_turn));
    for (std::size_t k = 0; k < number; ++k) {
      radii.push_back(radius * decades(-2.0, 0.0));
      others.push_back(line(k % 2 ? passing(radii.back()) : anywhere(), radii.back()));
    }
    others.resize(number + sweep_padding);
  }

  double decades(double least, double most) { return std::pow(10.0, least + (most - least) * random.uniform()); }

  // Fields of a line without its size.
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

  // At a distance of about the contact at some time. An image n boxes outward stands behind by n offsets.
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

  // The smallest distance in the span, of all images beside the box.
  double nearest(const Line& other) const {
    double least = HUGE_VAL;
    for (const int n : {-1, 0, 1}) {
      const double x = (static_cast<double>(other.x) - one.x) / full_turn * size_x + n * size_x;
      const double y = std::remainder((static_cast<double>(other.y) - one.y) / full_turn * size_y - n * offset, size_y);
      const Vec3 d(x, y, static_cast<double>(other.z) - one.z);
      const Vec3 v(static_cast<double>(other.u) - one.u, static_cast<double>(other.v) - one.v - shear * x,
                   static_cast<double>(other.w) - one.w);
      const double time = std::clamp(-d.dot(v) / (v.squaredNorm() + 1e-300), -half, half);
      least = std::min(least, (d + time * v).norm());
    }
    return least;
  }

  LineSpan span() const { return {static_cast<float>(-half * (1.0 + 1e-6)), static_cast<float>(half * (1.0 + 1e-6))}; }

  std::vector<std::uint32_t> sweep(InstructionSet set, std::size_t begin, std::size_t end) const {
    std::vector<std::uint32_t> found(end - begin + sweep_padding);
    std::iota(found.begin(), found.end(), static_cast<std::uint32_t>(begin));
    found.resize(line_sweeps(set).one(one, others.data(), frame, span(), found.data(), end - begin));
    return found;
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>>
  sweep_group(InstructionSet set, std::size_t first, std::size_t last, std::size_t begin, std::size_t end) const {
    std::vector<LinePair> found((last - first) * (end - begin));
    found.resize(line_sweeps(set).group(others.data(), first, last, frame, span(), begin, end, found.data()));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const LinePair& pair : found)
      pairs.emplace_back(pair.first, pair.second);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
};

} // namespace

TEST_CASE("no line that comes into contact is left out, and few others are kept") {
  std::size_t contacts = 0, across = 0, kept = 0;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    const Row row(seed);
    const std::vector<std::uint32_t> found = row.sweep(InstructionSet::portable, 0, number);
    for (std::uint32_t k = 0; k < number; ++k) {
      const double distance = row.nearest(row.others[k]), contact = Row::radius + row.radii[k];
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
  CHECK(contacts > 100000);
  CHECK(across > 15000);
  CHECK(static_cast<double>(kept) < 1.01 * static_cast<double>(contacts));
}

TEST_CASE("all instruction sets leave out the same lines, of any stretch of a row") {
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Row row(seed);
    const auto begin = static_cast<std::size_t>(row.random.uniform() * number);
    const auto some = begin + static_cast<std::size_t>(row.random.uniform() * static_cast<double>(number + 1 - begin));
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
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Row row(seed);
    for (Line& line : row.others)
      line.size *= 20.0f; // they stand about the one line, and few would touch each other
    const auto below = [&](std::size_t count) {
      return static_cast<std::size_t>(row.random.uniform() * static_cast<double>(count));
    };
    const std::size_t first = below(number), last = first + 1 + below(std::min<std::size_t>(8, number - first));
    const bool before = seed % 2 == 0;
    const std::size_t begin = before ? below(first + 1) : first + 1,
                      end = before ? begin + below(first + 1 - begin) : begin + below(number + 1 - begin);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::size_t m = first; m < last; ++m) {
      row.one = row.others[m];
      for (const std::uint32_t k : row.sweep(InstructionSet::portable, begin, end))
        if (before || k > m)
          expected.emplace_back(static_cast<std::uint32_t>(m), k);
    }
    pairs += expected.size();
    for (const InstructionSet set : {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512})
      if (supports(set)) {
        CAPTURE(seed);
        CAPTURE(instruction_set_name(set));
        CHECK((row.sweep_group(set, first, last, begin, end) == expected));
      }
  }
  CHECK(pairs > 10000);
}

namespace {

// Particles in a box and their mirror.
struct Reflected {
  RandomStream random;
  ShearingBox box;
  double half; // of the window
  Particles particles;
  Mirror mirror;

  explicit Reflected(std::uint64_t seed)
      : random(seed, RandomPurpose::position, 0), half(seed % 5 == 0 ? 0.05 : 0.003) {
    const Frequencies frequencies;
    box.size_x = seed % 3 == 0 ? 14.0 : 90.0; // a few columns, or many
    box.size_y = seed % 3 == 1 ? 20.0 : 90.0;
    box.shear = frequencies.shear();
    const double largest = seed % 2 ? 1.0 : 4.0;
    for (std::size_t k = 0; k < 1500; ++k) {
      Body body;
      body.radius = std::min(std::pow(random.uniform(), -0.5), largest) / largest;
      body.elements = anywhere(1.0);
      body.mass = 1.0;
      particles.bodies.push_back(body);
      particles.ids.push_back(k);
    }
    for (int again = 0; again < 2; ++again) // levels begin where the last build found the least radius
      mirror.build(particles, box, centred(box.size_y), frequencies, {0.0, half, 0.0});
  }

  double centred(double width) { return width * (random.uniform() - 0.5); }
  Elements anywhere(double heat) { // times what is usual along the plane
    Elements el;
    el.guiding_x = centred(box.size_x);
    el.guiding_y = centred(box.size_y);
    el.e_cos = 2.0 * heat * random.normal();
    el.e_sin = 2.0 * heat * random.normal();
    el.i_sin = random.normal();
    el.i_cos = random.normal();
    return el;
  }
  LineSpan span() const { return {static_cast<float>(-half), static_cast<float>(half)}; }
};

} // namespace

TEST_CASE("a window begins with the pairs that each line finds by itself, each once") {
  std::size_t pairs = 0, mirrors = 0, with_levels = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Reflected reflected(seed);
    const Mirror& mirror = reflected.mirror;
    if (!mirror.one_image())
      continue;
    ++mirrors;
    with_levels += mirror.whole().levels.size() > 1;
    const LineSpan span = reflected.span();
    std::vector<std::pair<std::size_t, std::size_t>> found, expected;
    std::vector<std::uint32_t> buffer;
    std::vector<LinePair> pair_buffer;
    constexpr std::size_t block = 97;
    for (std::size_t begin = 0; begin < mirror.size(); begin += block)
      mirror.sweep_pairs(begin, std::min(begin + block, mirror.size()), span, pair_buffer,
                         [&](std::size_t i, std::size_t j) { found.push_back(std::minmax(i, j)); });
    for (std::size_t slot = 0; slot < mirror.size(); ++slot) {
      const std::size_t count = mirror.near(mirror.whole(), mirror.line(mirror.place(slot)), span, buffer);
      for (std::size_t k = 0; k < count; ++k)
        if (slot < buffer[k])
          expected.emplace_back(slot, buffer[k]);
    }
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    CAPTURE(seed);
    CHECK((found == expected));
    pairs += expected.size();
  }
  MESSAGE(pairs << " pairs in " << mirrors << " mirrors, of which " << with_levels << " have several levels");
  CHECK(pairs > 10000);
  CHECK(mirrors > 30);
  CHECK(with_levels > 10);
}

TEST_CASE("whoever has a new line is found where it is, slow or fast, near its old place or not") {
  std::size_t found = 0, with_guests = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Reflected reflected(seed);
    Mirror& mirror = reflected.mirror;
    if (!mirror.one_image())
      continue;
    MirrorPart a_part = mirror.part(0, std::uint64_t{1} << 32); // of which nobody becomes a guest
    MirrorPart& part = seed % 2 ? mirror.whole() : a_part;
    const auto below = [&](std::size_t count) {
      return static_cast<std::size_t>(reflected.random.uniform() * static_cast<double>(count));
    };
    for (std::size_t change = 0; change < 300; ++change) {
      Body& body = reflected.particles.bodies[below(change % 2 ? 40 : mirror.size())]; // some again and again
      const Body before = body;
      body.elements = reflected.anywhere(change % 3 ? 1.0 : 20.0);
      if (change % 4 > 0) { // as after a hit, close to where it was
        body.elements.guiding_x = before.elements.guiding_x + body.elements.e_cos - before.elements.e_cos;
        body.elements.guiding_y = before.elements.guiding_y - 2.0 * (body.elements.e_sin - before.elements.e_sin);
      }
      const Line line = mirror.line_of(body, Rotation());
      if (mirror.one_image(line, part))
        mirror.replace(part, static_cast<std::size_t>(&body - reflected.particles.bodies.data()), line);
      else
        body = before;
    }
    with_guests += mirror.has_guests();
    std::vector<Line> all;
    for (std::size_t place = 0; place < mirror.size(); ++place)
      all.push_back(mirror.line(place));
    const LineFrame frame = mirror.frame();
    std::vector<std::uint32_t> buffer, expected(all.size() + sweep_padding), places;
    for (std::size_t place = 0; place < mirror.size(); ++place) {
      std::iota(expected.begin(), expected.end(), 0u);
      expected.resize(line_sweeps(InstructionSet::portable)
                          .one(all[place], all.data(), frame, reflected.span(), expected.data(), all.size()));
      const std::size_t count = mirror.near(part, all[place], reflected.span(), buffer);
      places.clear();
      for (std::size_t k = 0; k < count; ++k)
        places.push_back(mirror.place(buffer[k]));
      std::sort(places.begin(), places.end());
      CAPTURE(seed);
      CAPTURE(place);
      CHECK((places == expected));
      found += count;
      expected.resize(all.size() + sweep_padding);
    }
  }
  MESSAGE(found << " found; " << with_guests << " mirrors with guests");
  CHECK(found > 100000);
  CHECK(with_guests > 20);
}

TEST_CASE("parts that are cut at columns' edges leave no column to nobody") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Reflected reflected(seed);
    const Mirror& mirror = reflected.mirror;
    const std::int64_t columns = mirror.whole().levels.front().columns;
    for (std::uint64_t place = 1; place < (std::uint64_t{1} << 32); place += 9999991 * seed) {
      const std::uint32_t edge = mirror.column_edge(static_cast<std::uint32_t>(place));
      const MirrorPart left = mirror.part(0, edge), right = mirror.part(edge, (std::uint64_t{1} << 32) - edge);
      CAPTURE(place);
      CHECK(left.levels.front().last_column + 1 == right.levels.front().first_column);
      CHECK(right.levels.front().last_column + 1 == columns);
      CHECK(edge <= place);
    }
  }
}
