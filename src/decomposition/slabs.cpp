#include <keeler/decomposition/slabs.hpp>

#include <keeler/cells/order.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace keeler {
namespace {

constexpr double uneven = 1.05; // the largest part over the mean one: then bounds move
constexpr std::size_t bins = 4096;

// From −½ L to ½ L.
double folded(double x, double size) {
  const double inside = x - size * std::floor(x / size + 0.5);
  return inside < 0.5 * size ? inside : -0.5 * size;
}

std::vector<double> places_across(const Particles& particles, double size_x) {
  std::vector<double> across(particles.size());
  parallel_for(across.size(),
               [&](std::size_t k) { across[k] = folded(Borders::place_across(particles.bodies[k].elements), size_x); });
  return across;
}

// The places of those that go to another rank.
std::vector<std::uint32_t> leaving(const std::vector<std::uint32_t>& to, std::size_t own) {
  std::vector<std::uint32_t> places;
  for (std::size_t k = 0; k < to.size(); ++k)
    if (to[k] != own)
      places.push_back(static_cast<std::uint32_t>(k));
  return places;
}

// Collective: each row to its rank, those that leave a piece at a time. The others stay in their order, and those that
// come stand behind them.
template<class Row>
void route(const Communicator& ranks, std::vector<Row>& rows, const std::vector<std::uint32_t>& to,
           const std::vector<std::uint32_t>& leave) {
  constexpr std::size_t piece = (std::size_t{16} << 20) / sizeof(Row);
  std::vector<Row> come;
  for (std::size_t begin = 0; ranks.any(begin < leave.size()); begin = std::min(begin + piece, leave.size())) {
    std::vector<std::vector<Row>> sent(ranks.size());
    for (std::size_t k = begin; k < std::min(begin + piece, leave.size()); ++k)
      sent[to[leave[k]]].push_back(rows[leave[k]]);
    for (const std::vector<Row>& some : ranks.exchange(sent))
      come.insert(come.end(), some.begin(), some.end());
  }
  std::size_t stay = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (to[k] == ranks.rank())
      rows[stay++] = rows[k];
  rows.resize(stay);
  if (rows.capacity() > 2 * (stay + come.size())) // of one that had all
    rows.shrink_to_fit();
  rows.reserve(stay + come.size());
  rows.insert(rows.end(), come.begin(), come.end());
}

} // namespace

Slabs::Slabs(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies, const Reach& reach)
    : ranks_(ranks), box_(box), reach_(reach) {
  for (std::size_t rank = 0; rank <= ranks.size(); ++rank)
    bounds_.push_back(box.size_x * (static_cast<double>(rank) / static_cast<double>(ranks.size()) - 0.5));
  borders_.size_x = box.size_x;
  borders_.kappa = frequencies.kappa;
}

void Slabs::divide(Holding holding) {
  const std::vector<double> across = places_across(holding.particles, box_.size_x);
  balance(across);
  migrate(holding, across);
}

std::size_t Slabs::owner(double across) const {
  const auto inner = bounds_.begin() + 1;
  return static_cast<std::size_t>(std::upper_bound(inner, bounds_.end() - 1, across) - inner);
}

// Round the sheared edge too.
bool Slabs::is_within(double across, std::size_t rank, double reach) const {
  const double low = bounds_[rank], high = bounds_[rank + 1];
  const auto is_near = [&](double x) { return x >= low - reach && x < high + reach; };
  return is_near(across) || is_near(across - box_.size_x) || is_near(across + box_.size_x);
}

// The other ranks whose slabs are so near stand beside each other, on both sides of one's own.
template<class Visit> void Slabs::for_each_within(double across, double reach, const Visit& visit) const {
  const std::size_t count = ranks_.size(), own = ranks_.rank();
  std::size_t up = 1, down = 1;
  for (; up < count && is_within(across, (own + up) % count, reach); ++up)
    visit((own + up) % count);
  for (; up + down <= count && is_within(across, (own + count - down) % count, reach); ++down)
    visit((own + count - down) % count);
}

double Slabs::largest_way(const Particles& particles, const std::vector<double>& references, double step) const {
  constexpr std::size_t block = 4096;
  std::vector<double> largest((particles.size() + block - 1) / block);
  parallel_for(
      largest.size(),
      [&](std::size_t b) {
        for (std::size_t k = b * block; k < std::min(particles.size(), (b + 1) * block); ++k) {
          const double way = borders_.way(references[k], particles.bodies[k].elements, step);
          largest[b] = std::max(largest[b], way == way ? way : HUGE_VAL); // what is no number is the largest
        }
      },
      1);
  const double own = largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
  return ranks_.largest(std::isfinite(own) ? own : std::numeric_limits<double>::infinity());
}

bool Slabs::serve(const Particles& particles, double step) {
  if (!made_)
    return false;
  widest_ = std::max(widest_, largest_way(particles, borders_.references, step));
  return widest_ <= borders_.margin;
}

// Of the last borders: outgrown, or far too wide until memory was to be sorted.
void Slabs::learn() {
  constexpr double least = 2.0, most = 64.0;
  if (widest_ > borders_.margin)
    reach_.growth = std::min(most, 1.5 * reach_.growth);
  else if (widest_ < 0.4 * borders_.margin)
    reach_.growth = std::max(least, reach_.growth / 1.2);
  widest_ = 0.0;
}

void Slabs::make_borders(Holding holding, double offset, double step) {
  Particles& particles = holding.particles;
  learn();
  ++times_made_;
  std::vector<double> across = places_across(particles, box_.size_x);
  balance(across);
  migrate(holding, across);
  const std::vector<std::uint32_t> order = order_by_position(particles, box_, offset);
  reorder(particles.bodies, order);
  reorder(particles.ids, order);
  if (particles.rough)
    reorder(particles.spins, order);
  for (std::vector<Vec3>* rows : holding.rows)
    if (!rows->empty())
      reorder(*rows, order);
  borders_.references = places_across(particles, box_.size_x);
  lend(particles, step);
  made_ = true;
}

// To equal parts of the particles.
void Slabs::balance(const std::vector<double>& across) {
  std::vector<std::uint64_t> counts(bins + ranks_.size());
  for (const double x : across) {
    const auto bin = static_cast<std::size_t>((x / box_.size_x + 0.5) * static_cast<double>(bins));
    ++counts[std::min(bin, bins - 1)];
    ++counts[bins + owner(x)];
  }
  ranks_.sum(std::span(counts));
  std::uint64_t all = 0, largest = 0;
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    all += counts[bins + rank];
    largest = std::max(largest, counts[bins + rank]);
  }
  if (static_cast<double>(largest * ranks_.size()) <= uneven * static_cast<double>(all))
    return;
  std::uint64_t before = 0;
  std::size_t rank = 1;
  for (std::size_t bin = 0; bin < bins && rank < ranks_.size(); before += counts[bin++])
    for (; rank < ranks_.size(); ++rank) {
      const double wanted = static_cast<double>(all) * static_cast<double>(rank) / static_cast<double>(ranks_.size()),
                   missing = wanted - static_cast<double>(before), here = static_cast<double>(counts[bin]);
      if (missing > here)
        break;
      const double part = here > 0.0 ? missing / here : 0.0;
      bounds_[rank] = box_.size_x * ((static_cast<double>(bin) + part) / static_cast<double>(bins) - 0.5);
    }
}

void Slabs::migrate(Holding& holding, const std::vector<double>& across) const {
  std::vector<std::uint32_t> to(across.size());
  std::transform(across.begin(), across.end(), to.begin(),
                 [&](double x) { return static_cast<std::uint32_t>(owner(x)); });
  const std::vector<std::uint32_t> leave = leaving(to, ranks_.rank());
  route(ranks_, holding.particles.bodies, to, leave);
  route(ranks_, holding.particles.ids, to, leave);
  if (holding.particles.rough)
    route(ranks_, holding.particles.spins, to, leave);
  for (std::vector<Vec3>* rows : holding.rows)
    if (ranks_.any(!rows->empty()))
      route(ranks_, *rows, to, leave);
}

// Copies to all whose particles they may touch before borders are made anew, and to some rows beyond.
void Slabs::lend(const Particles& particles, double step) {
  double radius = 0.0, radii = 0.0;
  for (const Body& body : particles.bodies) {
    radius = std::max(radius, body.radius);
    radii += body.radius;
  }
  radius = ranks_.largest(radius);
  const double mean = ranks_.largest(radii / static_cast<double>(std::max<std::size_t>(1, particles.size())));
  const double way = largest_way(particles, borders_.references, step);
  borders_.margin = std::max({reach_.growth * way, 0.5 * mean, std::exchange(min_margin_, 0.0)}); // cold, it warms soon
  const double near = (2.0 * borders_.margin + 2.0 * radius) * (1.0 + 1e-9),
               reach = near + 2.0 * reach_.rows_beyond * mean;
  borders_.own = particles.size();
  borders_.lent.assign(ranks_.size(), {});
  borders_.is_lent.assign(particles.size(), 0);
  std::vector<std::vector<Body>> bodies(ranks_.size());
  std::vector<std::vector<std::uint64_t>> ids(ranks_.size());
  for (std::size_t k = 0; k < particles.size(); ++k)
    for_each_within(borders_.references[k], reach, [&](std::size_t rank) {
      borders_.lent[rank].push_back(static_cast<std::uint32_t>(k));
      borders_.is_lent[k] = 1;
      bodies[rank].push_back(particles.bodies[k]);
      ids[rank].push_back(particles.ids[k]);
    });
  copies_.bodies.clear();
  copies_.ids.clear();
  borders_.first.assign(1, particles.size());
  const auto all_bodies = ranks_.exchange(bodies);
  const auto all_ids = ranks_.exchange(ids);
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    copies_.bodies.insert(copies_.bodies.end(), all_bodies[rank].begin(), all_bodies[rank].end());
    copies_.ids.insert(copies_.ids.end(), all_ids[rank].begin(), all_ids[rank].end());
    borders_.first.push_back(particles.size() + copies_.bodies.size());
  }
  borders_.near.clear();
  for (const double x : places_across(copies_, box_.size_x))
    borders_.near.push_back(is_within(x, ranks_.rank(), near));
}

void Slabs::add_copies(Particles& particles) {
  assert(made_ && particles.size() == borders_.own);
  std::vector<std::vector<Elements>> paths(ranks_.size());
  std::vector<std::vector<Vec3>> spins(ranks_.size());
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank)
    for (const std::uint32_t k : borders_.lent[rank]) {
      paths[rank].push_back(particles.bodies[k].elements);
      if (particles.rough)
        spins[rank].push_back(particles.spins[k]);
    }
  std::size_t copy = 0;
  for (const std::vector<Elements>& from : ranks_.exchange(paths))
    for (const Elements& path : from)
      copies_.bodies[copy++].elements = path;
  assert(copy == copies_.size());
  particles.bodies.reserve(particles.size() + copies_.size()); // insert() would make room for twice as many
  particles.ids.reserve(particles.size() + copies_.size());
  particles.bodies.insert(particles.bodies.end(), copies_.bodies.begin(), copies_.bodies.end());
  particles.ids.insert(particles.ids.end(), copies_.ids.begin(), copies_.ids.end());
  if (!particles.rough)
    return;
  particles.spins.reserve(particles.bodies.size());
  for (const std::vector<Vec3>& from : ranks_.exchange(spins))
    particles.spins.insert(particles.spins.end(), from.begin(), from.end());
}

void Slabs::drop_copies(Particles& particles) const {
  particles.bodies.resize(borders_.own);
  particles.ids.resize(borders_.own);
  if (particles.rough)
    particles.spins.resize(borders_.own);
}

} // namespace keeler
