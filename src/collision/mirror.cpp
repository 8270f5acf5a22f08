#include "mirror.hpp"

#include <keeler/core/counting_sort.hpp>
#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace keeler {
namespace {

constexpr std::size_t block_size = 4096;   // particles
constexpr double nearest_share = 0.45;     // of the box: what reaches less far has one image in reach
constexpr double cells_per_particle = 2.0; // no more,
constexpr double fewest_cells = 64.0;      // unless these are: columns, so that strips find edges
constexpr double easy_stray = 0.5;         // of a level's reach: how far its lines may always stand from their cells
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

// Those that reach less than 2 of the least radius, then up to 8, 32, ...: each level that there is costs a look-up.
int Mirror::level_of(const Line& line) const {
  const double reach = std::max(reach_x(line), reach_y(line));
  return reach < 2.0 * least_radius_ ? 0 : (std::min(std::ilogb(reach / least_radius_), 2 * most_levels - 3) + 1) / 2;
}

std::size_t Mirror::cell_of(const Line& line, const MirrorLevel& level) const {
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
  sort(lay_out_cells());
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
          particles.prefetch_after(k);
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
  whole_ = {};
  for (int l = 0; l < most_levels; ++l) {
    level_index_[l] = static_cast<int>(whole_.levels.size());
    if (all.counts[l]) {
      whole_.levels.emplace_back();
      whole_.levels.back().count = all.counts[l];
      whole_.widen(whole_.levels.back(), all.reach_x[l], all.reach_y[l], 0.0, 0.0);
    }
  }
}

// Columns as wide as two particles of the level reach together, rows of half of that: ranges end close to what is in
// reach. Where that makes too many cells, they are larger; where particles are few, longer. Returns how many cells
// there are.
std::size_t Mirror::lay_out_cells() {
  std::size_t cells = 0;
  double two_farthest[2] = {0.0, 0.0};
  for (MirrorLevel& level : whole_.levels) {
    const double most = std::max(cells_per_particle * static_cast<double>(level.count), fewest_cells);
    double columns = box_.size_x / (2.0 * level.reach_x), rows = box_.size_y / level.reach_y;
    columns = std::min(columns, std::max(fewest_cells, columns / std::sqrt(std::max(1.0, columns * rows / most))));
    level.columns = static_cast<std::int64_t>(std::max(1.0, columns));
    level.rows = static_cast<std::int64_t>(std::max(1.0, std::min(rows, most / static_cast<double>(level.columns))));
    level.first_cell = cells;
    cells += static_cast<std::size_t>(level.columns * level.rows);
    const double reach = std::max(level.reach_x, level.reach_y);
    two_farthest[0] = level.count > 1 ? reach : two_farthest[1];
    two_farthest[1] = reach;
  }
  const double sheared = 1.0 + box_.shear * window_.half_length;
  one_image_ = (two_farthest[0] + two_farthest[1]) * sheared < nearest_share * std::min(box_.size_x, box_.size_y);
  return cells;
}

bool Mirror::one_image(const Line& line, const MirrorPart& part) const {
  const double own = std::max(reach_x(line), reach_y(line));
  const double reach = own + std::max(own, part.farthest); // another that was hit may reach as far
  const double sheared = 1.0 + box_.shear * window_.half_length;
  return reach * sheared < nearest_share * std::min(box_.size_x, box_.size_y);
}

void Mirror::sort(std::size_t cells) {
  const std::size_t count = unsorted_.size();
  cells_.resize(count);
  slots_.resize(count);
  lay_out_tiles(count);
  lines_.resize(count + guests_.room + sweep_padding);
  parallel_for(
      count,
      [&](std::size_t k) {
        const Line& line = unsorted_[k];
        cells_[k] = static_cast<std::uint32_t>(cell_of(line, whole_.levels[level_index_[level_of(line)]]));
      },
      block_size);
  counting_sort(cells_, cells, starts_, [&](std::size_t k, std::size_t slot) {
    slots_[k] = static_cast<std::uint32_t>(slot);
    lines_[slot] = unsorted_[k];
  });
  for (MirrorLevel& level : whole_.levels) {
    level.begin = starts_[level.first_cell];
    level.end = starts_[level.first_cell + static_cast<std::size_t>(level.columns * level.rows)];
  }
}

// How far outside of a cell of a level a line stands; the image that stands nearest to it.
Mirror::Outside Mirror::outside(const Line& line, const MirrorLevel& level, std::size_t cell) const {
  const auto from_middle = [](std::int32_t value, std::size_t cell_number, std::int64_t cells) {
    const double size = full_turn / static_cast<double>(cells);
    return static_cast<double>(value) + 0.5 * full_turn - (static_cast<double>(cell_number) + 0.5) * size;
  };
  const auto rows = static_cast<std::size_t>(level.rows);
  const double off_x = from_middle(line.x, (cell - level.first_cell) / rows, level.columns);
  const double outward = -std::rint(off_x / full_turn);
  const double off_y = from_middle(line.y, (cell - level.first_cell) % rows, level.rows) - outward * frame_.offset_y;
  const auto beyond = [](double off, std::int64_t cells) {
    const double nearest = off - full_turn * std::rint(off / full_turn);
    return std::max(0.0, std::fabs(nearest) - 0.5 * full_turn / static_cast<double>(cells));
  };
  return {beyond(off_x, level.columns) / per_metre_x_, beyond(off_y, level.rows) / per_metre_y_};
}

const MirrorLevel& Mirror::level_at(const std::vector<MirrorLevel>& levels, std::size_t cell) {
  auto level = levels.begin();
  while (level + 1 != levels.end() && cell >= (level + 1)->first_cell)
    ++level;
  return *level;
}

void Mirror::replace(MirrorPart& part, std::size_t place, const Line& line) {
  const auto number = &level_at(part.levels, cells_[place]) - part.levels.data();
  MirrorLevel* level = &part.levels[static_cast<std::size_t>(number)];
  Outside off = outside(line, *level, cells_[place]);
  if (&part == &whole_) {
    const bool fits = slots_[place] < size() && level_index_[level_of(line)] <= number &&
                      off.x <= std::max(level->stray_x, easy_stray * level->reach_x) &&
                      off.y <= std::max(level->stray_y, easy_stray * level->reach_y);
    if (!fits && make_guest(place, line)) {
      level = &guests_.tiles;
      off = outside(line, *level, guests_.tile[slots_[place] - size()]);
    }
  }
  Line& own = lines_[slots_[place]];
  own = line;
  own.place = static_cast<std::uint32_t>(place);
  part.widen(*level, reach_x(line), reach_y(line), off.x, off.y);
}

// Tiles that a usual guest reaches few of.
void Mirror::lay_out_tiles(std::size_t particles) {
  constexpr double reaches = 8.0; // of the finest level: a tile's size
  constexpr double most = 64.0;   // tiles a side
  MirrorLevel& tiles = guests_.tiles = {};
  if (!whole_.levels.empty()) {
    const double size = reaches * std::max(whole_.levels[0].reach_x, whole_.levels[0].reach_y);
    tiles.columns = static_cast<std::int64_t>(std::clamp(box_.size_x / size, 1.0, most));
    tiles.rows = static_cast<std::int64_t>(std::clamp(box_.size_y / size, 1.0, most));
  }
  guests_.last.assign(static_cast<std::size_t>(tiles.columns * tiles.rows), 0);
  guests_.before.clear();
  guests_.tile.clear();
  guests_.room = particles / 16;
}

// Gives it a slot and a tile, unless it has them: a guest that is hit again keeps its tile. False when there is no
// room.
bool Mirror::make_guest(std::size_t place, const Line& line) {
  if (slots_[place] >= size())
    return true;
  if (guests_.tile.size() == guests_.room)
    return false;
  constexpr float nowhere = 1e18f; // nobody's line comes near
  lines_[slots_[place]].z = nowhere;
  slots_[place] = static_cast<std::uint32_t>(size() + guests_.tile.size());
  const std::size_t tile = cell_of(line, guests_.tiles);
  guests_.tile.push_back(static_cast<std::uint32_t>(tile));
  guests_.before.push_back(guests_.last[tile]);
  guests_.last[tile] = static_cast<std::uint32_t>(guests_.tile.size());
  return true;
}

void Mirror::join(const MirrorPart& part) {
  for (std::size_t l = 0; l < part.levels.size(); ++l) {
    const MirrorLevel& level = part.levels[l];
    whole_.widen(whole_.levels[l], level.reach_x, level.reach_y, level.stray_x, level.stray_y);
  }
}

MirrorPart Mirror::part(std::uint32_t begin, std::uint64_t width) const {
  MirrorPart part{whole_.levels, whole_.farthest, width};
  for (MirrorLevel& level : part.levels) {
    const auto columns = static_cast<std::uint64_t>(level.columns);
    level.first_column = ((std::int64_t{begin} - 1) * level.columns >> 32) + 1; // the first with no place before begin
    level.last_column = static_cast<std::int64_t>((begin + width) * columns >> 32) - 1;
    const auto slot = [&](std::int64_t column) {
      return starts_[level.first_cell + static_cast<std::size_t>(std::min(column, level.columns) * level.rows)];
    };
    level.own_begin = slot(level.first_column);
    level.own_end = slot(level.last_column + 1);
    level.own_end_beyond = slot(std::max<std::int64_t>(0, level.last_column + 1 - level.columns));
  }
  return part;
}

std::uint32_t Mirror::column_edge(std::uint32_t across) const {
  const auto columns = static_cast<std::uint64_t>(whole_.levels.front().columns);
  const std::uint64_t column = across * columns >> 32;
  return static_cast<std::uint32_t>(((column << 32) + columns - 1) / columns);
}

bool Mirror::encloses(const MirrorPart& part, const Line& line) const {
  if (part.whole())
    return true;
  return std::all_of(part.levels.begin(), part.levels.end(), [&](const MirrorLevel& level) {
    const auto [first, last] = columns_near(level, line);
    const std::int64_t turn = first < level.first_column ? level.columns : 0;
    return first + turn >= level.first_column && last + turn <= level.last_column;
  });
}

double Mirror::stray() const {
  double most = 0.0;
  for (const MirrorLevel& level : whole_.levels)
    most = std::max({most, level.stray_x / level.reach_x, level.stray_y / level.reach_y});
  return most;
}

std::size_t Mirror::bytes() const {
  return bytes_of(starts_) + bytes_of(cells_) + bytes_of(slots_) + bytes_of(unsorted_) + bytes_of(lines_) +
         bytes_of(guests_.last) + bytes_of(guests_.before) + bytes_of(guests_.tile);
}

} // namespace keeler
