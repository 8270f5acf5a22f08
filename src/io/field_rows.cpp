#include "field_rows.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <vector>

namespace keeler::io {

FieldRows::FieldRows(const Field& field, const Communicator& ranks, std::size_t max_bytes)
    : field_(field), ranks_(ranks), gathers_(field.divided && ranks.distributed()),
      row_bytes_(field.components * size_of(field.type)),
      rows_at_a_time_(std::max<std::size_t>(1, max_bytes / row_bytes_)), count_(ranks.broadcast(field.rows())) {
  assert(field.components > 0);
  if (!gathers_)
    return;
  std::vector<std::uint64_t> counts(ranks.size());
  counts[ranks.rank()] = field.rows();
  ranks.sum(std::span(counts));
  before_ = std::accumulate(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(ranks.rank()), std::size_t{0});
  count_ = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

// Returns the bytes of the rows in [first, first + count) that this rank has.
std::span<const std::byte> FieldRows::local_part(std::size_t first, std::size_t count) const {
  const std::size_t begin = std::max(first, before_), end = std::min(first + count, before_ + field_.rows());
  if (begin >= end)
    return {};
  const auto* const data = static_cast<const std::byte*>(field_.data());
  assert(data && end <= count_);
  return {data + (begin - before_) * row_bytes_, (end - begin) * row_bytes_};
}

void FieldRows::visit(const Piece& piece) const {
  for (std::size_t first = 0; first < count_; first += rows_at_a_time_) {
    const std::size_t count = std::min(rows_at_a_time_, count_ - first);
    const std::span<const std::byte> here = local_part(first, count);
    if (gathers_) {
      const std::vector<std::byte> all = ranks_.gather({here.begin(), here.end()});
      piece(first, count, all);
    } else
      piece(first, count, here);
  }
}

} // namespace keeler::io
