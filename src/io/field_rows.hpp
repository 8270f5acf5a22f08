// The rows of a field as they go into a file: a piece at a time, from whoever has them to the first rank, so that
// nobody needs room for all.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/field_table.hpp>

#include <cstddef>
#include <functional>
#include <span>

namespace keeler {

class FieldRows {
public:
  /// What the first rank gets at a time, at most (or one row).
  static constexpr std::size_t largest_piece = std::size_t{16} << 20; // bytes

  /// Collective. Field and data must outlive it, and stay as they are.
  FieldRows(const Field& field, const Communicator& ranks, std::size_t max_bytes = largest_piece);

  /// Of a divided field those of all ranks.
  std::size_t count() const { return count_; }

  /// Collective. Calls piece(first, count, bytes) for all rows in turn, on each rank; the first one has the bytes.
  using Piece = std::function<void(std::size_t first, std::size_t count, std::span<const std::byte> bytes)>;
  void visit(const Piece& piece) const;

private:
  std::span<const std::byte> own(std::size_t first, std::size_t count) const;

  const Field& field_;
  Communicator ranks_;
  bool gathers_;
  std::size_t row_bytes_, rows_at_a_time_;
  std::size_t before_ = 0, count_; ///< rows of the ranks before this one, and of all
};

} // namespace keeler
