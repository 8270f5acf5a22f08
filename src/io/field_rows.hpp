// Gathers the rows of a field to the root rank piece by piece, in rank order, so that no rank needs memory for all of
// them.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/field_table.hpp>

#include <cstddef>
#include <functional>
#include <span>

namespace keeler::io {

class FieldRows {
public:
  /// Largest piece that the root receives, bytes (at least one row).
  static constexpr std::size_t max_piece = std::size_t{16} << 20;

  /// Collective. Precondition: field and data outlive this object and do not change.
  FieldRows(const Field& field, const Communicator& ranks, std::size_t max_bytes = max_piece);

  /// Returns the number of rows; for a divided field, the sum over all ranks.
  std::size_t count() const { return count_; }

  /// Calls piece(first, count, bytes) for all rows in order, on each rank; only the root has the bytes. Collective.
  using Piece = std::function<void(std::size_t first, std::size_t count, std::span<const std::byte> bytes)>;
  void visit(const Piece& piece) const;

private:
  std::span<const std::byte> local_part(std::size_t first, std::size_t count) const;

  const Field& field_;
  Communicator ranks_;
  bool gathers_;
  std::size_t row_bytes_, rows_at_a_time_;
  std::size_t before_ = 0, count_; ///< rows on lower ranks, and on all ranks
};

} // namespace keeler::io
