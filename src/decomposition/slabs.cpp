#include <keeler/decomposition/slabs.hpp>

#include <keeler/cells/order.hpp>
#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace keeler::decomposition {
namespace {

constexpr double max_imbalance = 1.05; // particles of the fullest rank over the mean; beyond it bounds move
constexpr std::size_t bins = 4096;     // of the histogram in x that sets new bounds

// Folds x into [−½ L, ½ L).
double folded(double x, double size) {
  const double inside = x - size * std::floor(x / size + 0.5);
  return inside < 0.5 * size ? inside : -0.5 * size;
}

// Returns x of each particle at the epoch, folded into the box.
std::vector<double> folded_x(const Particles& particles, double size_x) {
  std::vector<double> x(particles.size());
  parallel_for(x.size(),
               [&](std::size_t k) { x[k] = folded(GhostLayer::x_at_epoch(particles.bodies[k].elements), size_x); });
  return x;
}

// Returns the indices of the particles that go to another rank.
std::vector<std::uint32_t> emigrants(const std::vector<std::uint32_t>& to, std::size_t rank) {
  std::vector<std::uint32_t> indices;
  for (std::size_t k = 0; k < to.size(); ++k)
    if (to[k] != rank)
      indices.push_back(static_cast<std::uint32_t>(k));
  return indices;
}

// Sends row k to rank to[k], in pieces of 16 MiB. Rows that stay keep their order; received rows are appended.
// Collective.
template<class Row>
void route(const Communicator& ranks, std::vector<Row>& rows, const std::vector<std::uint32_t>& to,
           const std::vector<std::uint32_t>& emigrants) {
  assert(rows.size() == to.size());
  constexpr std::size_t piece = (std::size_t{16} << 20) / sizeof(Row);
  std::vector<Row> received;
  for (std::size_t begin = 0; ranks.any(begin < emigrants.size()); begin = std::min(begin + piece, emigrants.size())) {
    std::vector<std::vector<Row>> sent(ranks.size());
    for (std::size_t k = begin; k < std::min(begin + piece, emigrants.size()); ++k)
      sent[to[emigrants[k]]].push_back(rows[emigrants[k]]);
    for (const std::vector<Row>& from_rank : ranks.exchange(sent))
      received.insert(received.end(), from_rank.begin(), from_rank.end());
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (to[k] == ranks.rank())
      rows[kept++] = rows[k];
  rows.resize(kept);
  if (rows.capacity() > 2 * (kept + received.size())) // of a rank that had all particles
    rows.shrink_to_fit();
  rows.reserve(kept + received.size());
  rows.insert(rows.end(), received.begin(), received.end());
}

} // namespace

Slabs::Slabs(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies, const Reach& reach)
    : ranks_(ranks), box_(box), reach_(reach) {
  for (std::size_t rank = 0; rank <= ranks.size(); ++rank)
    bounds_.push_back(box.size_x * (static_cast<double>(rank) / static_cast<double>(ranks.size()) - 0.5));
  ghosts_.size_x = box.size_x;
  ghosts_.kappa = frequencies.kappa;
}

void Slabs::distribute(SlabHolding holding) {
  const std::vector<double> x = folded_x(holding.particles, box_.size_x);
  balance(x);
  migrate(holding, x);
}

std::size_t Slabs::owner(double x) const {
  const auto inner = bounds_.begin() + 1;
  return static_cast<std::size_t>(std::upper_bound(inner, bounds_.end() - 1, x) - inner);
}

// Returns true if x is within `reach` of the rank's slab, through the sheared edges too.
bool Slabs::is_within(double x, std::size_t rank, double reach) const {
  const double low = bounds_[rank], high = bounds_[rank + 1];
  const auto is_near = [&](double image) { return image >= low - reach && image < high + reach; };
  return is_near(x) || is_near(x - box_.size_x) || is_near(x + box_.size_x);
}

// Visits the other ranks with slabs within `reach` of x. They are consecutive, on both sides of this rank's slab.
template<class Visit> void Slabs::for_each_within(double x, double reach, const Visit& visit) const {
  const std::size_t count = ranks_.size(), own = ranks_.rank();
  std::size_t up = 1, down = 1;
  for (; up < count && is_within(x, (own + up) % count, reach); ++up)
    visit((own + up) % count);
  for (; up + down <= count && is_within(x, (own + count - down) % count, reach); ++down)
    visit((own + count - down) % count);
}

// Returns the largest excursion of own particles of all ranks; infinite if one is not a number. Collective.
double Slabs::max_excursion(const Particles& particles, const std::vector<double>& references, double step) const {
  assert(references.size() == particles.size());
  constexpr std::size_t block = 4096;
  std::vector<double> largest((particles.size() + block - 1) / block);
  parallel_for(
      largest.size(),
      [&](std::size_t b) {
        for (std::size_t k = b * block; k < std::min(particles.size(), (b + 1) * block); ++k) {
          const double distance = ghosts_.excursion(references[k], particles.bodies[k].elements, step);
          largest[b] = std::max(largest[b], distance == distance ? distance : HUGE_VAL); // not a number: the largest
        }
      },
      1);
  const double own = largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
  return ranks_.max(std::isfinite(own) ? own : std::numeric_limits<double>::infinity());
}

bool Slabs::is_valid(const Particles& particles, double step) {
  if (!is_built_)
    return false;
  max_excursion_ = std::max(max_excursion_, max_excursion(particles, ghosts_.references, step));
  return max_excursion_ <= ghosts_.margin;
}

// Adapts the margin of the next layer to the last one: wider if particles outgrew it, narrower if they used less than
// 0.4 of it before memory was sorted.
void Slabs::adapt_growth() {
  constexpr double min_growth = 2.0, max_growth = 64.0;
  if (max_excursion_ > ghosts_.margin)
    reach_.growth = std::min(max_growth, 1.5 * reach_.growth);
  else if (max_excursion_ < 0.4 * ghosts_.margin)
    reach_.growth = std::max(min_growth, reach_.growth / 1.2);
  max_excursion_ = 0.0;
}

void Slabs::rebuild(SlabHolding holding, double offset, double step) {
  Particles& particles = holding.particles;
  adapt_growth();
  ++rebuilds_;
  const std::vector<double> x = folded_x(particles, box_.size_x);
  balance(x);
  migrate(holding, x);
  const std::vector<std::uint32_t> order = cells::order_by_position(particles, box_, offset);
  cells::reorder(particles.bodies, order);
  cells::reorder(particles.ids, order);
  if (particles.rough)
    cells::reorder(particles.spins, order);
  for (std::vector<Vec3>* rows : holding.rows)
    if (!rows->empty())
      cells::reorder(*rows, order);
  ghosts_.references = folded_x(particles, box_.size_x);
  choose_ghosts(particles, step);
  is_built_ = true;
}

// Moves the bounds to equal numbers of particles per rank if the numbers differ too much. Collective.
void Slabs::balance(const std::vector<double>& x) {
  std::vector<std::uint64_t> counts(bins + ranks_.size());
  for (const double own_x : x) {
    const auto bin = static_cast<std::size_t>((own_x / box_.size_x + 0.5) * static_cast<double>(bins));
    ++counts[std::min(bin, bins - 1)];
    ++counts[bins + owner(own_x)];
  }
  ranks_.sum(std::span(counts));
  std::uint64_t all = 0, largest = 0;
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    all += counts[bins + rank];
    largest = std::max(largest, counts[bins + rank]);
  }
  if (static_cast<double>(largest * ranks_.size()) <= max_imbalance * static_cast<double>(all))
    return;
  std::uint64_t before = 0;
  std::size_t rank = 1;
  for (std::size_t bin = 0; bin < bins && rank < ranks_.size(); before += counts[bin++])
    for (; rank < ranks_.size(); ++rank) {
      const double target = static_cast<double>(all) * static_cast<double>(rank) / static_cast<double>(ranks_.size()),
                   missing = target - static_cast<double>(before), here = static_cast<double>(counts[bin]);
      if (missing > here)
        break;
      const double fraction = here > 0.0 ? missing / here : 0.0;
      bounds_[rank] = box_.size_x * ((static_cast<double>(bin) + fraction) / static_cast<double>(bins) - 0.5);
    }
  assert(std::is_sorted(bounds_.begin(), bounds_.end()));
}

// Sends particles to the owners of their positions x. Collective.
void Slabs::migrate(SlabHolding& holding, const std::vector<double>& x) const {
  assert(x.size() == holding.particles.size());
  std::vector<std::uint32_t> to(x.size());
  std::transform(x.begin(), x.end(), to.begin(),
                 [&](double own_x) { return static_cast<std::uint32_t>(owner(own_x)); });
  const std::vector<std::uint32_t> leave = emigrants(to, ranks_.rank());
  route(ranks_, holding.particles.bodies, to, leave);
  route(ranks_, holding.particles.ids, to, leave);
  if (holding.particles.rough)
    route(ranks_, holding.particles.spins, to, leave);
  for (std::vector<Vec3>* rows : holding.rows)
    if (ranks_.any(!rows->empty()))
      route(ranks_, *rows, to, leave);
}

// Chooses the margin, and sends ghosts of all particles that own particles of another rank may touch before the layer
// is rebuilt, and of some rows beyond. Collective.
void Slabs::choose_ghosts(const Particles& particles, double step) {
  double max_radius = 0.0, sum_of_radii = 0.0;
  for (const Body& body : particles.bodies) {
    max_radius = std::max(max_radius, body.radius);
    sum_of_radii += body.radius;
  }
  max_radius = ranks_.max(max_radius);
  const double mean = ranks_.max(sum_of_radii / static_cast<double>(std::max<std::size_t>(1, particles.size())));
  const double excursion = max_excursion(particles, ghosts_.references, step);
  // half a mean radius at least: cold particles warm up soon
  ghosts_.margin = std::max({reach_.growth * excursion, 0.5 * mean, std::exchange(min_margin_, 0.0)});
  const double near = (2.0 * ghosts_.margin + 2.0 * max_radius) * (1.0 + 1e-9),
               reach = near + 2.0 * reach_.rows_beyond * mean;
  ghosts_.own = particles.size();
  ghosts_.sent.assign(ranks_.size(), {});
  ghosts_.is_sent.assign(particles.size(), 0);
  std::vector<std::vector<Body>> bodies(ranks_.size());
  std::vector<std::vector<std::uint64_t>> ids(ranks_.size());
  for (std::size_t k = 0; k < particles.size(); ++k)
    for_each_within(ghosts_.references[k], reach, [&](std::size_t rank) {
      ghosts_.sent[rank].push_back(static_cast<std::uint32_t>(k));
      ghosts_.is_sent[k] = 1;
      bodies[rank].push_back(particles.bodies[k]);
      ids[rank].push_back(particles.ids[k]);
    });
  ghost_particles_.bodies.clear();
  ghost_particles_.ids.clear();
  ghosts_.first.assign(1, particles.size());
  const auto received_bodies = ranks_.exchange(bodies);
  const auto received_ids = ranks_.exchange(ids);
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    assert(received_bodies[rank].size() == received_ids[rank].size());
    ghost_particles_.bodies.insert(ghost_particles_.bodies.end(), received_bodies[rank].begin(),
                                   received_bodies[rank].end());
    ghost_particles_.ids.insert(ghost_particles_.ids.end(), received_ids[rank].begin(), received_ids[rank].end());
    ghosts_.first.push_back(particles.size() + ghost_particles_.bodies.size());
  }
  assert(ghosts_.sent[ranks_.rank()].empty() && received_ids[ranks_.rank()].empty());
  ghosts_.near.clear();
  for (const double x : folded_x(ghost_particles_, box_.size_x))
    ghosts_.near.push_back(is_within(x, ranks_.rank(), near));
}

void Slabs::add_ghosts(Particles& particles) {
  assert(is_built_ && particles.size() == ghosts_.own);
  std::vector<std::vector<Elements>> paths(ranks_.size());
  std::vector<std::vector<Vec3>> spins(ranks_.size());
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank)
    for (const std::uint32_t k : ghosts_.sent[rank]) {
      paths[rank].push_back(particles.bodies[k].elements);
      if (particles.rough)
        spins[rank].push_back(particles.spins[k]);
    }
  std::size_t ghost = 0;
  for (const std::vector<Elements>& from_rank : ranks_.exchange(paths))
    for (const Elements& path : from_rank)
      ghost_particles_.bodies[ghost++].elements = path;
  assert(ghost == ghost_particles_.size());
  particles.bodies.reserve(particles.size() + ghost_particles_.size()); // insert() would reserve twice as much
  particles.ids.reserve(particles.size() + ghost_particles_.size());
  particles.bodies.insert(particles.bodies.end(), ghost_particles_.bodies.begin(), ghost_particles_.bodies.end());
  particles.ids.insert(particles.ids.end(), ghost_particles_.ids.begin(), ghost_particles_.ids.end());
  if (!particles.rough)
    return;
  particles.spins.reserve(particles.bodies.size());
  for (const std::vector<Vec3>& from_rank : ranks_.exchange(spins))
    particles.spins.insert(particles.spins.end(), from_rank.begin(), from_rank.end());
  assert(particles.spins.size() == particles.bodies.size());
}

void Slabs::add_ghosts(std::vector<Vec3>& row) const {
  assert(is_built_ && row.size() == ghosts_.own);
  std::vector<std::vector<Vec3>> sent(ranks_.size());
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank)
    for (const std::uint32_t k : ghosts_.sent[rank])
      sent[rank].push_back(row[k]);
  row.reserve(ghosts_.own + ghosts_.ghosts());
  for (const std::vector<Vec3>& from_rank : ranks_.exchange(sent))
    row.insert(row.end(), from_rank.begin(), from_rank.end());
  assert(row.size() == ghosts_.own + ghosts_.ghosts());
}

void Slabs::remove_ghosts(Particles& particles) const {
  assert(particles.size() >= ghosts_.own);
  particles.bodies.resize(ghosts_.own);
  particles.ids.resize(ghosts_.own);
  if (particles.rough)
    particles.spins.resize(ghosts_.own);
}

} // namespace keeler::decomposition
