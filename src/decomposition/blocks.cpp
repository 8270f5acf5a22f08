#include "blocks.hpp"

#include <keeler/cells/order.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace keeler::decomposition {
namespace {

// A layer that cuts y is used for a tenth of an orbit, and one more step: then memory is sorted anyway.
constexpr double shortest_lifetime = 0.1 * two_pi; // rad
// work of a drift: a particle's part of a contact over a step of the particle without one (docs/dev/ranks.md)
constexpr std::uint64_t work_of_contact = 8;

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

Blocks::Blocks(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies, const Layout& layout)
    : ranks_(ranks), layout_(layout), grid_(box, ranks.size()) {
  assert(layout.strips <= ranks.size());
  ghosts_.box = box;
  ghosts_.kappa = frequencies.kappa;
}

void Blocks::distribute(Holding holding) {
  const std::vector<Point> at = positions(holding.particles, 0.0);
  choose_reach(holding.particles, at);
  grid_.divide(layout_.strips > 0 ? layout_.strips : grid_.best_strips(reach_));
  grid_.balance(at, std::vector<std::uint64_t>(at.size(), 1), ranks_);
  migrate(holding, at);
}

// Returns the position of each particle at the epoch, in the cell.
std::vector<Point> Blocks::positions(const Particles& particles, double offset) const {
  const ShearingBox& box = ghosts_.box;
  std::vector<Point> in_cell(particles.size());
  parallel_for(in_cell.size(), [&](std::size_t k) {
    const Point at = ghosts_.position(particles.bodies[k].elements);
    const double boxes = std::floor(at.x / box.size_x + 0.5), x = at.x - boxes * box.size_x, y = at.y + boxes * offset;
    in_cell[k] = {x, y - box.size_y * std::floor(y / box.size_y + 0.5)};
  });
  return in_cell;
}

// Returns the largest excursion of own particles of all ranks; infinite if one is not a number. Collective.
template<class Position>
double Blocks::max_excursion(const Particles& particles, const std::vector<Position>& references) const {
  assert(references.size() == particles.size());
  constexpr std::size_t block = 4096;
  std::vector<double> largest((particles.size() + block - 1) / block);
  parallel_for(
      largest.size(),
      [&](std::size_t b) {
        for (std::size_t k = b * block; k < std::min(particles.size(), (b + 1) * block); ++k) {
          const double distance = ghosts_.excursion(references[k], particles.bodies[k].elements);
          largest[b] = std::max(largest[b], distance == distance ? distance : HUGE_VAL); // not a number: the largest
        }
      },
      1);
  const double own = largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
  return ranks_.max(std::isfinite(own) ? own : std::numeric_limits<double>::infinity());
}

bool Blocks::is_valid(const Particles& particles, const Epoch& epoch) {
  if (!is_built_)
    return false;
  ghosts_.epoch = epoch;
  max_excursion_ = std::max(max_excursion_, max_excursion(particles, ghosts_.references));
  const bool is_young = !grid_.has_rows() || epoch.time + 0.5 * epoch.step <= ghosts_.built_at + lifetime_;
  return is_young && max_excursion_ <= ghosts_.margin;
}

// Adapts the margin of the next layer to the last one: wider if particles outgrew it, narrower if they used less than
// 0.4 of it before memory was sorted.
void Blocks::adapt_growth() {
  constexpr double min_growth = 2.0, max_growth = 64.0;
  if (max_excursion_ > ghosts_.margin)
    layout_.growth = std::min(max_growth, 1.5 * layout_.growth);
  else if (max_excursion_ < 0.4 * ghosts_.margin)
    layout_.growth = std::max(min_growth, layout_.growth / 1.2);
  max_excursion_ = 0.0;
}

// Returns the work of each own particle since the layer was built, in integers that do not depend on the blocks. A new
// particle counts as one that had no contacts.
std::vector<std::uint64_t> Blocks::work(std::size_t particles) const {
  std::vector<std::uint64_t> work(particles, std::max<std::uint64_t>(1, ghosts_.steps));
  if (ghosts_.contacts.size() == particles)
    for (std::size_t k = 0; k < particles; ++k)
      work[k] += work_of_contact * ghosts_.contacts[k];
  return work;
}

// Returns how many times the rank's block and its surroundings go into the box.
cells::Folds Blocks::folds(const Point& surroundings) const {
  const ShearingBox& box = ghosts_.box;
  const Point block = grid_.size(ranks_.rank());
  return {cells::Folds::of(block.x + 2.0 * surroundings.x, box.size_x),
          cells::Folds::of(block.y + 2.0 * surroundings.y, box.size_y)};
}

// Changes the number of strips if another one is much cheaper. Returns true if it did.
bool Blocks::choose_strips() {
  constexpr double much_cheaper = 0.8;
  if (layout_.strips > 0)
    return false;
  const std::size_t best = grid_.best_strips(reach_);
  if (!(grid_.cost(best, reach_) < much_cheaper * grid_.cost(grid_.strips(), reach_)))
    return false;
  grid_.divide(best);
  return true;
}

void Blocks::rebuild(Holding holding, const Epoch& epoch) {
  Particles& particles = holding.particles;
  if (rebuilds_++ > 0)
    adapt_growth();
  ghosts_.epoch = epoch;
  ghosts_.built_at = epoch.time;
  const std::vector<Point> at = positions(particles, epoch.offset);
  choose_reach(particles, at);
  if (choose_strips())
    choose_reach(particles, at); // y may matter now
  grid_.balance(at, work(at.size()), ranks_);
  migrants_ += migrate(holding, at);
  const std::vector<std::uint32_t> order = cells::order_by_position(particles, ghosts_.box, epoch.offset, folds({}));
  cells::reorder(particles.bodies, order);
  cells::reorder(particles.ids, order);
  if (particles.rough)
    cells::reorder(particles.spins, order);
  for (std::vector<Vec3>* rows : holding.rows)
    if (!rows->empty())
      cells::reorder(*rows, order);
  ghosts_.references.clear();
  for (const Point& position : positions(particles, epoch.offset))
    ghosts_.references.push_back(ghosts_.box_point(position));
  ghosts_.contacts.assign(particles.size(), 0);
  ghosts_.steps = 0;
  choose_ghosts(particles);
  ghosts_.folds = folds(reach_);
  min_margin_ = 0.0;
  is_built_ = true;
}

// Sends particles to the owners of their positions. Returns the number sent by this rank. Collective.
std::size_t Blocks::migrate(Holding& holding, const std::vector<Point>& positions) const {
  assert(positions.size() == holding.particles.size());
  std::vector<std::uint32_t> to(positions.size());
  std::transform(positions.begin(), positions.end(), to.begin(),
                 [&](const Point& position) { return static_cast<std::uint32_t>(grid_.owner(position)); });
  const std::vector<std::uint32_t> leave = emigrants(to, ranks_.rank());
  route(ranks_, holding.particles.bodies, to, leave);
  route(ranks_, holding.particles.ids, to, leave);
  if (holding.particles.rough)
    route(ranks_, holding.particles.spins, to, leave);
  for (std::vector<Vec3>* rows : holding.rows)
    if (ranks_.any(!rows->empty()))
      route(ranks_, *rows, to, leave);
  return leave.size();
}

// Chooses the margin and the width of the next layer. Collective.
void Blocks::choose_reach(const Particles& particles, const std::vector<Point>& positions) {
  double max_radius = 0.0, sum_of_radii = 0.0;
  for (const Body& body : particles.bodies) {
    max_radius = std::max(max_radius, body.radius);
    sum_of_radii += body.radius;
  }
  max_radius = ranks_.max(max_radius);
  const double mean = ranks_.max(sum_of_radii / static_cast<double>(std::max<std::size_t>(1, particles.size())));
  ghosts_.has_rows = grid_.has_rows();
  // half a mean radius at least: cold particles warm up soon
  ghosts_.margin = std::max({layout_.growth * max_excursion(particles, positions), 0.5 * mean, min_margin_});
  lifetime_ = shortest_lifetime + ghosts_.epoch.step;
  near_ = ghosts_.near_reach(max_radius, lifetime_);
  const double beyond = 2.0 * layout_.rows_beyond * mean;
  reach_ = {near_.x + beyond, near_.y + beyond};
}

// Sends ghosts of all particles that own particles of another rank may touch before the layer is rebuilt, and of some
// rows beyond. Collective.
void Blocks::choose_ghosts(const Particles& particles) {
  ghosts_.own = particles.size();
  ghosts_.sent.assign(ranks_.size(), {});
  ghosts_.is_sent.assign(particles.size(), 0);
  std::vector<std::vector<Body>> bodies(ranks_.size());
  std::vector<std::vector<std::uint64_t>> ids(ranks_.size());
  const double offset = ghosts_.epoch.offset;
  for (const std::size_t rank : grid_.neighbours(ranks_.rank(), reach_, offset))
    for (std::size_t k = 0; k < particles.size(); ++k)
      if (grid_.is_within(ghosts_.point(ghosts_.references[k]), rank, reach_, offset)) {
        ghosts_.sent[rank].push_back(static_cast<std::uint32_t>(k));
        ghosts_.is_sent[k] = 1;
        bodies[rank].push_back(particles.bodies[k]);
        ids[rank].push_back(particles.ids[k]);
      }
  ghost_particles_.bodies.clear();
  ghost_particles_.ids.clear();
  ghosts_.first.assign(1, particles.size());
  ghosts_.partners.clear();
  const auto received_bodies = ranks_.exchange(bodies);
  const auto received_ids = ranks_.exchange(ids);
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    assert(received_bodies[rank].size() == received_ids[rank].size());
    ghost_particles_.bodies.insert(ghost_particles_.bodies.end(), received_bodies[rank].begin(),
                                   received_bodies[rank].end());
    ghost_particles_.ids.insert(ghost_particles_.ids.end(), received_ids[rank].begin(), received_ids[rank].end());
    ghosts_.first.push_back(particles.size() + ghost_particles_.bodies.size());
    if (!bodies[rank].empty() || !received_bodies[rank].empty())
      ghosts_.partners.push_back(rank);
  }
  assert(ghosts_.sent[ranks_.rank()].empty() && received_ids[ranks_.rank()].empty());
  ghosts_.near.clear();
  for (const Point& position : positions(ghost_particles_, offset))
    ghosts_.near.push_back(grid_.is_within(position, ranks_.rank(), near_, offset));
}

void Blocks::add_ghosts(Particles& particles) {
  assert(is_built_ && particles.size() == ghosts_.own);
  std::vector<std::vector<Elements>> paths(ranks_.size());
  std::vector<std::vector<Vec3>> spins(ranks_.size());
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    paths[rank].reserve(ghosts_.sent[rank].size());
    for (const std::uint32_t k : ghosts_.sent[rank]) {
      paths[rank].push_back(particles.bodies[k].elements);
      if (particles.rough)
        spins[rank].push_back(particles.spins[k]);
    }
  }
  std::size_t ghost = 0;
  for (const std::vector<Elements>& from_rank : ranks_.exchange(paths, ghosts_.partners))
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
  for (const std::vector<Vec3>& from_rank : ranks_.exchange(spins, ghosts_.partners))
    particles.spins.insert(particles.spins.end(), from_rank.begin(), from_rank.end());
  assert(particles.spins.size() == particles.bodies.size());
}

void Blocks::add_ghosts(std::vector<Vec3>& row) const {
  assert(is_built_ && row.size() == ghosts_.own);
  std::vector<std::vector<Vec3>> sent(ranks_.size());
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    sent[rank].reserve(ghosts_.sent[rank].size());
    for (const std::uint32_t k : ghosts_.sent[rank])
      sent[rank].push_back(row[k]);
  }
  row.reserve(ghosts_.own + ghosts_.ghosts());
  for (const std::vector<Vec3>& from_rank : ranks_.exchange(sent, ghosts_.partners))
    row.insert(row.end(), from_rank.begin(), from_rank.end());
  assert(row.size() == ghosts_.own + ghosts_.ghosts());
}

void Blocks::remove_ghosts(Particles& particles) const {
  assert(particles.size() >= ghosts_.own);
  particles.bodies.resize(ghosts_.own);
  particles.ids.resize(ghosts_.own);
  if (particles.rough)
    particles.spins.resize(ghosts_.own);
}

} // namespace keeler::decomposition
