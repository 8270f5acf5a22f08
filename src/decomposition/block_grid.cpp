#include "block_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace keeler::decomposition {
namespace {

constexpr double max_imbalance = 1.05; // weight of the heaviest block over the mean; beyond it bounds move
constexpr std::size_t x_bins = 4096;   // of the histograms that set new bounds
constexpr std::size_t y_bins = 1024;
// time to send a particle to another rank's mesh and its acceleration back, over that of a ghost
constexpr double cost_of_mesh_guest = 0.05;

// Returns bounds in [−½ L, ½ L] that divide a histogram in the ratio of the `parts`' increments.
std::vector<double> bounds_of(std::span<const std::uint64_t> histogram, std::span<const std::size_t> parts,
                              double size) {
  const auto all = static_cast<double>(std::accumulate(histogram.begin(), histogram.end(), std::uint64_t{0}));
  const auto part = [&](std::size_t k) {
    return static_cast<double>(parts[k] - parts.front()) / static_cast<double>(parts.back() - parts.front());
  };
  std::vector<double> bounds{-0.5 * size};
  double before = 0.0;
  std::size_t bin = 0;
  for (std::size_t k = 1; k + 1 < parts.size(); ++k) {
    double position = part(k); // of nothing: equal parts
    if (all > 0.0) {
      while (bin + 1 < histogram.size() && before + static_cast<double>(histogram[bin]) < all * part(k))
        before += static_cast<double>(histogram[bin++]);
      const auto here = static_cast<double>(histogram[bin]);
      const double fraction = here > 0.0 ? std::min(1.0, (all * part(k) - before) / here) : 0.0;
      position = (static_cast<double>(bin) + fraction) / static_cast<double>(histogram.size());
    }
    bounds.push_back(size * (position - 0.5));
  }
  bounds.push_back(0.5 * size);
  assert(std::is_sorted(bounds.begin(), bounds.end()));
  return bounds;
}

// Returns a bin for any number: later checks reject particles without a position.
std::size_t bin_of(double position, double size, std::size_t bins) {
  const double bin = (position / size + 0.5) * static_cast<double>(bins);
  return bin >= 0.0 ? std::min(static_cast<std::size_t>(bin), bins - 1) : 0;
}

std::size_t interval_of(double position, std::span<const double> bounds) {
  const auto inner = bounds.begin() + 1;
  return static_cast<std::size_t>(std::upper_bound(inner, bounds.end() - 1, position) - inner);
}

} // namespace

void BlockGrid::divide(std::size_t strips) {
  assert(strips >= 1 && strips <= ranks_);
  first_.clear();
  for (std::size_t s = 0; s <= strips; ++s)
    first_.push_back(s * ranks_ / strips);
  x_bounds_ = bounds_of({}, first_, box_.size_x);
  y_bounds_.clear();
  for (std::size_t s = 0; s < strips; ++s) {
    std::vector<std::size_t> blocks(first_[s + 1] - first_[s] + 1);
    std::iota(blocks.begin(), blocks.end(), 0);
    y_bounds_.push_back(bounds_of({}, blocks, box_.size_y));
  }
}

double BlockGrid::cost(std::size_t strips, const Point& reach) const {
  double largest = 0.0;
  for (const std::size_t rows : {ranks_ / strips, (ranks_ + strips - 1) / strips}) {
    const double width = box_.size_x * static_cast<double>(rows) / static_cast<double>(ranks_),
                 height = box_.size_y / static_cast<double>(rows),
                 wide = std::min(box_.size_x, width + (strips > 1 ? 2.0 * reach.x : 0.0)),
                 high = std::min(box_.size_y, height + (rows > 1 ? 2.0 * reach.y : 0.0)),
                 guests = 1.0 - 1.0 / static_cast<double>(rows);
    largest = std::max(largest, wide * high / (width * height) - 1.0 + cost_of_mesh_guest * guests);
  }
  return largest;
}

std::size_t BlockGrid::best_strips(const Point& reach) const {
  std::size_t best = ranks_;
  for (std::size_t strips = ranks_; strips-- > 1;)
    if (cost(strips, reach) < cost(best, reach))
      best = strips;
  return best;
}

void BlockGrid::balance(std::span<const Point> positions, std::span<const std::uint64_t> weights,
                        const Communicator& ranks) {
  assert(positions.size() == weights.size());
  std::vector<std::uint64_t> counts(x_bins + ranks_);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    counts[bin_of(positions[k].x, box_.size_x, x_bins)] += weights[k];
    counts[x_bins + owner(positions[k])] += weights[k];
  }
  ranks.sum(std::span(counts));
  const auto blocks = std::span(counts).subspan(x_bins);
  const auto all = static_cast<double>(std::accumulate(blocks.begin(), blocks.end(), std::uint64_t{0})),
             largest = static_cast<double>(*std::max_element(blocks.begin(), blocks.end()));
  if (largest * static_cast<double>(ranks_) <= max_imbalance * all)
    return;
  x_bounds_ = bounds_of(std::span(counts).first(x_bins), first_, box_.size_x);
  if (!has_rows())
    return;
  counts.assign(y_bins * strips(), 0);
  for (std::size_t k = 0; k < positions.size(); ++k)
    counts[y_bins * interval_of(positions[k].x, x_bounds_) + bin_of(positions[k].y, box_.size_y, y_bins)] += weights[k];
  ranks.sum(std::span(counts));
  for (std::size_t s = 0; s < strips(); ++s) {
    std::vector<std::size_t> rows(y_bounds_[s].size());
    std::iota(rows.begin(), rows.end(), 0);
    y_bounds_[s] = bounds_of(std::span(counts).subspan(y_bins * s, y_bins), rows, box_.size_y);
  }
}

std::size_t BlockGrid::owner(const Point& position) const {
  const std::size_t strip = interval_of(position.x, x_bounds_);
  return first_[strip] + interval_of(position.y, y_bounds_[strip]);
}

std::size_t BlockGrid::strip_of(std::size_t rank) const {
  assert(rank < ranks_);
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), rank) - first_.begin()) - 1;
}

BlockGrid::Block BlockGrid::block(std::size_t rank) const {
  const std::size_t strip = strip_of(rank), row = rank - first_[strip];
  const double x0 = x_bounds_[strip], x1 = x_bounds_[strip + 1], y0 = y_bounds_[strip][row],
               y1 = y_bounds_[strip][row + 1];
  return {{0.5 * (x0 + x1), 0.5 * (y0 + y1)}, {0.5 * (x1 - x0), 0.5 * (y1 - y0)}};
}

// True if an image of a may be within `reach` of b. Along y the nearest image of each image in x is tested.
bool BlockGrid::meet(const Block& a, const Block& b, const Point& reach, double offset) const {
  const double range_x = a.half_size.x + b.half_size.x + reach.x, range_y = a.half_size.y + b.half_size.y + reach.y,
               distance_x = a.middle.x - b.middle.x, distance_y = a.middle.y - b.middle.y;
  if (!(range_x < 2.0 * box_.size_x))
    return true;
  const double first = std::ceil((-range_x - distance_x) / box_.size_x),
               last = std::floor((range_x - distance_x) / box_.size_x);
  for (double image = first; image <= last; ++image)
    if (!(std::fabs(std::remainder(distance_y - image * offset, box_.size_y)) > range_y))
      return true;
  return false;
}

std::vector<std::size_t> BlockGrid::neighbours(std::size_t rank, const Point& reach, double offset) const {
  std::vector<std::size_t> near;
  for (std::size_t other = 0; other < ranks_; ++other)
    if (other != rank && meet(block(rank), block(other), reach, offset))
      near.push_back(other);
  return near;
}

} // namespace keeler::decomposition
