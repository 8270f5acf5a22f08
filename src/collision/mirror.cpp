#include <keeler/collision/mirror.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>

namespace keeler {
namespace {

constexpr std::size_t block_size = 4096;   // particles
constexpr double nearest_share = 0.45;     // of the box: what reaches less far has one image in reach
constexpr double cells_per_particle = 2.0; // no more
constexpr double single = 4e-6;            // of a path: what single precision may do to a line
constexpr double full_turn = 4294967296.0; // 2³², the box

// The nearest fraction of the box to a place, the box taken round.
std::int32_t fraction(double value, double per_metre) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llrint(value * per_metre)));
}

// The same for a place inside the cell, never taken round: beyond the edge in x the image would be another one.
std::int32_t inside_fraction(double value, double per_metre) {
  constexpr long long edge = 2147483647; // 2³¹ − 1
  return static_cast<std::int32_t>(std::clamp(std::llrint(value * per_metre), -edge, edge));
}

template<class T> std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

} // namespace

struct Mirror::Measured {
  double eccentricities = 0.0, radii = 0.0, least_radius = HUGE_VAL;
  std::array<std::uint64_t, most_levels> counts{};
  std::array<double, most_levels> reach_x{}, reach_y{};
  std::size_t broken = ~std::size_t{0};
};

Line Mirror::line_of(const Body& body, const Rotation& rotation) const {
  const Elements& el = body.elements;
  const State s = state_at(el, frequencies_, rotation);
  const double kappa = frequencies_.kappa, nu2 = frequencies_.nu * frequencies_.nu;
  const double e2 = el.e_cos * el.e_cos + el.e_sin * el.e_sin, i2 = el.i_sin * el.i_sin + el.i_cos * el.i_cos;
  const double acceleration = std::sqrt(4.0 * kappa * kappa * e2 + nu2 * nu2 * i2);
  const double t = window_.half_length;
  const Vec3 home = box_.displacement(box_.image_into_cell(s.position.x(), s.position.y(), offset_), offset_);
  const double x = s.position.x() + home.x(), y = s.position.y() + home.y();
  const double beyond_shear = s.velocity.y() + box_.shear * s.position.x();
  const double path = t * (std::fabs(s.velocity.x()) + std::fabs(beyond_shear) + std::fabs(s.velocity.z()));
  const double grain = 4.0 / full_turn * (box_.size_x + box_.size_y);
  const double size = body.radius + 0.5 * acceleration * t * t + window_.skin;
  return {inside_fraction(x, per_metre_x_),
          fraction(y, per_metre_y_),
          static_cast<float>(s.position.z()),
          static_cast<float>(s.velocity.x()),
          static_cast<float>(beyond_shear),
          static_cast<float>(s.velocity.z()),
          static_cast<float>(size + single * (size + path + std::fabs(s.position.z())) + grain),
          0};
}

int Mirror::level_of(const Line& line) const {
  const double reach = std::max(reach_x(line), reach_y(line));
  return reach < 2.0 * least_radius_ ? 0 : std::min(std::ilogb(reach / least_radius_), most_levels - 1);
}

std::size_t Mirror::cell_of(const Line& line, const Level& level) const {
  const auto part = [](std::int32_t value, std::int64_t parts) {
    return (static_cast<std::int64_t>(value) + (std::int64_t{1} << 31)) * parts >> 32;
  };
  return level.first_cell +
         static_cast<std::size_t>(part(line.x, level.columns) * level.rows + part(line.y, level.rows));
}

void Mirror::build(const Particles& particles, const ShearingBox& box, double offset, const Frequencies& frequencies,
                   const MirrorWindow& window) {
  box_ = box;
  frequencies_ = frequencies;
  window_ = window;
  to_middle_ = Rotation(frequencies, window.middle);
  offset_ = std::fmod(offset + box.shear * box.size_x * window.middle, box.size_y);
  per_metre_x_ = full_turn / box.size_x;
  per_metre_y_ = full_turn / box.size_y;
  frame_ = {static_cast<float>(box.size_x / full_turn), static_cast<float>(box.size_y / full_turn),
            static_cast<float>(box.shear), fraction(offset_, per_metre_y_)};
  take_lines(particles);
  lay_out_cells();
  if (threads() > 1)
    sort<true>();
  else
    sort<false>();
}

// All lines, levels and how far each reaches, and means.
void Mirror::take_lines(const Particles& particles) {
  const std::vector<Body>& bodies = particles.bodies;
  least_radius_ = next_least_radius_;
  unsorted_.resize(bodies.size());
  std::vector<Measured> measured((bodies.size() + block_size - 1) / block_size);
  parallel_for(
      measured.size(),
      [&](std::size_t b) {
        Measured& m = measured[b];
        for (std::size_t k = b * block_size; k < std::min(bodies.size(), (b + 1) * block_size); ++k) {
          const Elements& el = bodies[k].elements;
          if (!std::isfinite(el.guiding_x + el.guiding_y + el.e_cos + el.e_sin + el.i_sin + el.i_cos)) {
            m.broken = std::min(m.broken, k);
            continue;
          }
          Line& line = unsorted_[k];
          line = line_of(bodies[k], to_middle_);
          line.place = static_cast<std::uint32_t>(k);
          const int level = level_of(line);
          ++m.counts[level];
          m.reach_x[level] = std::max(m.reach_x[level], reach_x(line));
          m.reach_y[level] = std::max(m.reach_y[level], reach_y(line));
          m.eccentricities += el.eccentricity();
          m.radii += bodies[k].radius;
          m.least_radius = std::min(m.least_radius, bodies[k].radius);
        }
      },
      1);
  Measured all;
  for (const Measured& m : measured) {
    all.broken = std::min(all.broken, m.broken);
    all.eccentricities += m.eccentricities;
    all.radii += m.radii;
    all.least_radius = std::min(all.least_radius, m.least_radius);
    for (int l = 0; l < most_levels; ++l) {
      all.counts[l] += m.counts[l];
      all.reach_x[l] = std::max(all.reach_x[l], m.reach_x[l]);
      all.reach_y[l] = std::max(all.reach_y[l], m.reach_y[l]);
    }
  }
  if (all.broken < bodies.size())
    throw InvariantError(fmt::format("particle {} has elements that are not finite", particles.ids[all.broken]));
  const double count = static_cast<double>(bodies.size()) + 1e-9;
  means_ = {all.eccentricities / count, all.radii / count};
  next_least_radius_ = bodies.empty() ? 1.0 : all.least_radius;
  levels_.clear();
  for (int l = 0; l < most_levels; ++l) {
    level_index_[l] = static_cast<int>(levels_.size());
    if (all.counts[l]) {
      levels_.emplace_back();
      levels_.back().count = all.counts[l];
      levels_.back().reach_x = all.reach_x[l];
      levels_.back().reach_y = all.reach_y[l];
    }
  }
}

// Columns as wide as two particles of the level reach together, rows of half of that: ranges end close to what is in
// reach.
void Mirror::lay_out_cells() {
  std::size_t cells = 0;
  double two_farthest[2] = {0.0, 0.0};
  for (Level& level : levels_) {
    const double number = static_cast<double>(level.count);
    double columns = box_.size_x / (2.0 * level.reach_x), rows = box_.size_y / level.reach_y;
    const double too_many = std::sqrt(std::max(1.0, columns * rows / (cells_per_particle * number)));
    columns = std::max(1.0, columns / too_many), rows = std::max(1.0, rows / too_many);
    level.columns = static_cast<std::int64_t>(std::min(columns, 2.0 * number));
    level.rows = static_cast<std::int64_t>(std::min(rows, 2.0 * number));
    level.first_cell = cells;
    cells += static_cast<std::size_t>(level.columns * level.rows);
    const double reach = std::max(level.reach_x, level.reach_y);
    two_farthest[0] = level.count > 1 ? reach : two_farthest[1];
    two_farthest[1] = reach;
  }
  starts_.assign(cells + 2, 0);
  const double sheared = 1.0 + box_.shear * window_.half_length;
  one_image_ = (two_farthest[0] + two_farthest[1]) * sheared < nearest_share * std::min(box_.size_x, box_.size_y);
}

bool Mirror::one_image(const Line& line) const {
  const double own = std::max(reach_x(line), reach_y(line));
  double farthest = own; // another that was hit may reach as far
  for (const Level& level : levels_)
    farthest = std::max({farthest, level.reach_x + level.stray_x, level.reach_y + level.stray_y});
  const double reach = own + farthest;
  const double sheared = 1.0 + box_.shear * window_.half_length;
  return reach * sheared < nearest_share * std::min(box_.size_x, box_.size_y);
}

// A counting sort. While it runs, starts_[c + 1] is where the next particle of cell c goes; in the end, where cell
// c + 1 begins.
template<bool shared> void Mirror::sort() {
  const std::size_t count = unsorted_.size(), blocks = (count + block_size - 1) / block_size;
  cells_.resize(count);
  slots_.resize(count);
  lines_.resize(count + sweep_padding);
  const auto next = [&](std::size_t entry) {
    if constexpr (shared)
      return std::atomic_ref(starts_[entry]).fetch_add(1, std::memory_order_relaxed);
    else
      return starts_[entry]++;
  };
  const auto for_all = [&](const auto& body) {
    const auto block = [&](std::size_t b) {
      for (std::size_t k = b * block_size; k < std::min(count, (b + 1) * block_size); ++k)
        body(k);
    };
    if constexpr (shared)
      parallel_for(blocks, block, 1);
    else
      for (std::size_t b = 0; b < blocks; ++b)
        block(b);
  };
  for_all([&](std::size_t k) {
    const Line& line = unsorted_[k];
    cells_[k] = static_cast<std::uint32_t>(cell_of(line, levels_[level_index_[level_of(line)]]));
    next(cells_[k] + 2);
  });
  for (std::size_t c = 2; c < starts_.size(); ++c)
    starts_[c] += starts_[c - 1];
  for_all([&](std::size_t k) {
    const std::uint32_t slot = next(cells_[k] + 1);
    slots_[k] = slot;
    lines_[slot] = unsorted_[k];
  });
  for (Level& level : levels_) {
    level.begin = starts_[level.first_cell];
    level.end = starts_[level.first_cell + static_cast<std::size_t>(level.columns * level.rows)];
  }
}

Mirror::Outgrown Mirror::replace(std::size_t place, const Line& line) {
  const std::size_t slot = slots_[place], cell = cells_[place];
  lines_[slot] = line;
  lines_[slot].place = static_cast<std::uint32_t>(place);
  auto level = levels_.begin();
  while (slot >= level->end)
    ++level;
  // how far outside of its cell; the image that stands nearest to it
  const auto from_middle = [](std::int32_t value, std::size_t part, std::int64_t parts) {
    const double size = full_turn / static_cast<double>(parts);
    return static_cast<double>(value) + 0.5 * full_turn - (static_cast<double>(part) + 0.5) * size;
  };
  const auto rows = static_cast<std::size_t>(level->rows);
  const double off_x = from_middle(line.x, (cell - level->first_cell) / rows, level->columns);
  const double outward = -std::round(off_x / full_turn);
  const double off_y = from_middle(line.y, (cell - level->first_cell) % rows, level->rows) - outward * frame_.offset_y;
  const auto outside = [](double off, std::int64_t parts) {
    return std::max(0.0, std::fabs(std::remainder(off, full_turn)) - 0.5 * full_turn / static_cast<double>(parts));
  };
  return {static_cast<std::size_t>(level - levels_.begin()), reach_x(line), reach_y(line),
          outside(off_x, level->columns) / per_metre_x_, outside(off_y, level->rows) / per_metre_y_};
}

void Mirror::grow(const Outgrown& outgrown) {
  Level& level = levels_[outgrown.level];
  level.reach_x = std::max(level.reach_x, outgrown.reach_x);
  level.reach_y = std::max(level.reach_y, outgrown.reach_y);
  level.stray_x = std::max(level.stray_x, outgrown.stray_x);
  level.stray_y = std::max(level.stray_y, outgrown.stray_y);
}

std::size_t Mirror::near(const Line& line, const LineSpan& span, std::vector<std::uint32_t>& buffer) const {
  std::size_t count = 0;
  for (const Level& level : levels_)
    ranges_in(level, line, 0, [&](std::uint32_t begin, std::uint32_t end) {
      const std::size_t room = count + (end - begin) + sweep_padding;
      if (buffer.size() < room)
        buffer.resize(2 * room);
      count += sweep_(line, lines_.data(), frame_, span, begin, end, buffer.data() + count);
    });
  return count;
}

void Mirror::prefetch(std::size_t place, int stage) const {
  if (stage == 0) {
    __builtin_prefetch(&slots_[place]);
    __builtin_prefetch(&cells_[place]);
    return;
  }
  const std::size_t slot = slots_[place], cell = cells_[place];
  auto level = levels_.begin();
  while (slot >= level->end)
    ++level;
  const auto rows = static_cast<std::size_t>(level->rows);
  for (const std::size_t column : {cell - rows, cell, cell + rows}) { // the first may wrap around
    const std::size_t near = std::min(column, starts_.size() - 1);
    if (stage == 1)
      __builtin_prefetch(&starts_[near]);
    else
      for (std::size_t k = 0; k < 4; k += 2)
        __builtin_prefetch(&lines_[std::min<std::size_t>(starts_[near] + k, lines_.size() - 1)]);
  }
}

double Mirror::stray() const {
  double most = 0.0;
  for (const Level& level : levels_)
    most = std::max({most, level.stray_x / level.reach_x, level.stray_y / level.reach_y});
  return most;
}

std::size_t Mirror::bytes() const {
  return bytes_of(starts_) + bytes_of(cells_) + bytes_of(slots_) + bytes_of(unsorted_) + bytes_of(lines_);
}

} // namespace keeler
