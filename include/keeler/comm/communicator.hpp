// The processes (ranks) of one run and their collective communication. Only a build with KEELER_MPI has more than one
// rank. In any other build distributed() is false at compile time, and code that depends on it is left out.
//
// Every member function but rank(), size(), distributed() and is_root() is collective: all ranks call it, in the same
// order.
#pragma once

#include <keeler/core/error.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace keeler {
class ExactSum;
} // namespace keeler

namespace keeler::comm {

/// One byte buffer per rank, to send to it or received from it.
using Parcels = std::vector<std::vector<std::byte>>;

/// Equally long blocks of bytes at a constant stride in memory (MPI's hvector): sent from there, or received there.
struct Blocks {
  std::byte* first = nullptr; ///< begin of the first block
  std::size_t count = 0;      ///< number of blocks
  std::size_t size = 0;       ///< bytes of one block
  std::size_t stride = 0;     ///< bytes from the begin of one block to that of the next
};

/// The ranks of one run, as one of them sees them.
class Communicator {
public:
  /// True in a build with KEELER_MPI, which may have several ranks.
#ifdef KEELER_MPI
  static constexpr bool possible = true;
#else
  static constexpr bool possible = false;
#endif

  /// This process alone.
  Communicator() = default;
  /// Returns the ranks that the launcher (mpirun) started together, or this process alone without a launcher.
  /// Precondition: called once, when the program begins. Throws UsageError in a build without MPI when a launcher has
  /// started several processes.
  static Communicator launched();

  /// Returns the number of this rank, from 0.
  std::size_t rank() const {
    return rank_;
  }
  /// Returns the number of ranks.
  std::size_t size() const {
    return size_;
  }
  /// True if there are several ranks.
  bool distributed() const {
    return possible && size_ > 1;
  }
  /// True on rank 0, the root.
  bool is_root() const {
    return rank_ == 0;
  }

  /// Sends parcels[r] to rank r and returns the parcels received, by sender. The rank's parcel to itself is moved.
  /// Precondition: parcels.size() == size().
  Parcels exchange(Parcels parcels) const;
  /// Sends rows[r] to rank r and returns the rows received, by sender. Precondition: rows.size() == size().
  template<class Row> std::vector<std::vector<Row>> exchange(const std::vector<std::vector<Row>>& rows) const;

  /// As above, among `partners` only: neither other ranks nor a collective call are waited for, and each partner gets a
  /// message of less than 1 GiB. Preconditions: partners are ascending and never this rank; a partner has this rank as
  /// a partner; rows to others are empty.
  template<class Row>
  std::vector<std::vector<Row>> exchange(const std::vector<std::vector<Row>>& rows,
                                         std::span<const std::size_t> partners) const;

  /// Sends sent[r] to rank r and receives received[r] from it, without intermediate buffers. Precondition: sender and
  /// receiver agree on the count and size of the blocks.
  void exchange(std::span<const Blocks> sent, std::span<const Blocks> received) const;

  /// Returns on the root the bytes of all ranks, in the order of the ranks; nothing on the others. Precondition: less
  /// than 2 GiB in all.
  std::vector<std::byte> gather(std::vector<std::byte> bytes) const;
  /// Returns on the root the rows of all ranks, in the order of the ranks; limits as above.
  template<class Row> std::vector<Row> gather(const std::vector<Row>& rows) const;

  /// Returns the rows of all ranks, in the order of the ranks, on each of them. Precondition: less than 2³¹ rows in
  /// all.
  template<class Row> std::vector<Row> gather_on_all(std::span<const Row> rows) const;

  /// Replaces each number by its sum over all ranks, modulo 2⁶⁴.
  void sum(std::span<std::uint64_t> numbers) const;
  /// Returns the sum of the numbers of all ranks, modulo 2⁶⁴.
  std::uint64_t sum(std::uint64_t number) const {
    sum(std::span(&number, 1));
    return number;
  }
  /// Replaces each exact sum by the exact sum over all ranks.
  void merge(std::initializer_list<ExactSum*> sums) const;
  /// Returns the largest of the numbers of all ranks.
  double max(double number) const;
  /// Returns the smallest of the numbers of all ranks.
  double min(double number) const {
    return -max(-number);
  }
  /// Returns true on all ranks if `here` is true on one.
  bool any(bool here) const {
    return max(here ? 1.0 : 0.0) > 0.0;
  }

  /// Replaces the bytes by the root's. Precondition: all ranks give equal numbers of bytes.
  void broadcast(std::span<std::byte> bytes) const;
  /// Replaces the text by the root's, of any length.
  void broadcast(std::string& text) const;
  /// Returns the root's value.
  template<class Value> Value broadcast(Value value) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    broadcast(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }

  /// Runs the work on every rank. If it throws an Error on any rank, all ranks throw: the lowest such rank its own
  /// exception, the others an Error of the same code and text, which they need not report. All throw Interrupted if no
  /// rank has another error.
  void together(const std::function<void()>& work) const;
  /// As together(), with work for the root alone.
  void on_root(const std::function<void()>& work) const;

private:
  Communicator(std::size_t rank, std::size_t size) : rank_(rank), size_(size) {
    assert(rank < size);
  }

  /// Returns the memory for `size` bytes received from a rank.
  using Allocate = std::function<std::byte*(std::size_t rank, std::size_t size)>;

  template<class Row, class Exchange>
  std::vector<std::vector<Row>> exchange_by(const Exchange& exchange_bytes,
                                            const std::vector<std::vector<Row>>& rows) const {
    static_assert(std::is_trivially_destructible_v<Row>); // plain numbers; Eigen's vectors are not trivially copyable
    assert(rows.size() == size_);
    std::vector<std::vector<Row>> received(rows.size());
    received[rank()] = rows[rank()];
    std::vector<std::span<const std::byte>> sent;
    for (const std::vector<Row>& to_rank : rows)
      sent.push_back(std::as_bytes(std::span(to_rank)));
    exchange_bytes(sent, [&](std::size_t rank, std::size_t size) {
      assert(size % sizeof(Row) == 0);
      received[rank].resize(size / sizeof(Row));
      return reinterpret_cast<std::byte*>(received[rank].data());
    });
    return received;
  }
  /// Sends sent[r] to every other rank r.
  void exchange(const std::vector<std::span<const std::byte>>& sent, const Allocate& allocate) const;
  /// Sends sent[r] to every partner r. Throws UsageError if one of them gets 1 GiB or more.
  void exchange(const std::vector<std::span<const std::byte>>& sent, std::span<const std::size_t> partners,
                const Allocate& allocate) const;
  /// Writes the rows of all ranks, each of `row_size` bytes, to the memory that `allocate` returns for their number.
  void gather_on_all(std::span<const std::byte> rows, std::size_t row_size,
                     const std::function<std::byte*(std::size_t count)>& allocate) const;

  std::size_t rank_ = 0, size_ = 1;
};

/// Communication of this rank since the start of the program.
struct ExchangeCosts {
  double seconds = 0.0;          ///< wall time of communication, waiting for other ranks included
  std::uint64_t messages = 0;    ///< sent to other ranks by exchange()
  std::uint64_t bytes = 0;       ///< of these messages
  std::uint64_t collectives = 0; ///< calls of sum(), merge(), max(), min(), any(), broadcast() and gather_on_all()
  std::uint64_t max_bytes = 0;   ///< the most bytes that one call sent from or received on this rank
};
const ExchangeCosts& exchange_costs(); ///< up to now

/// Ends a launched program that has succeeded; waits for the other ranks.
void finish_ranks();
/// Ends a rank that failed with this code. If the other ranks do not know of the error they wait for this rank in some
/// other call; then it aborts all ranks.
void fail_ranks(ExitCode code);
/// True if all ranks have thrown the error at hand together, so that they may go on with collective calls. A rank that
/// fails alone in these aborts all ranks again.
bool take_common_error();
/// True if another rank reports the error that ends this rank.
bool another_rank_reports();

template<class Row> std::vector<Row> Communicator::gather(const std::vector<Row>& rows) const {
  static_assert(std::is_trivially_destructible_v<Row>);
  const auto own = std::as_bytes(std::span(rows));
  const std::vector<std::byte> bytes = gather(std::vector<std::byte>(own.begin(), own.end()));
  assert(bytes.size() % sizeof(Row) == 0);
  std::vector<Row> all(bytes.size() / sizeof(Row));
  if (!bytes.empty())
    std::memcpy(static_cast<void*>(all.data()), bytes.data(), bytes.size());
  return all;
}

template<class Row> std::vector<Row> Communicator::gather_on_all(std::span<const Row> rows) const {
  static_assert(std::is_trivially_destructible_v<Row>);
  std::vector<Row> all;
  gather_on_all(std::as_bytes(rows), sizeof(Row), [&](std::size_t count) {
    all.resize(count);
    return reinterpret_cast<std::byte*>(all.data());
  });
  return all;
}

template<class Row>
std::vector<std::vector<Row>> Communicator::exchange(const std::vector<std::vector<Row>>& rows) const {
  return exchange_by([&](const auto& sent, const Allocate& allocate) { exchange(sent, allocate); }, rows);
}

template<class Row>
std::vector<std::vector<Row>> Communicator::exchange(const std::vector<std::vector<Row>>& rows,
                                                     std::span<const std::size_t> partners) const {
  return exchange_by([&](const auto& sent, const Allocate& allocate) { exchange(sent, partners, allocate); }, rows);
}

} // namespace keeler::comm

namespace keeler {
using comm::Communicator;
} // namespace keeler
