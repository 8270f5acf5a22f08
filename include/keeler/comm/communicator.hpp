// The processes that share one run, and what they tell each other. Only a build with KEELER_MPI has more than one; in
// any other build distributed() is false while compiling, and what depends on it is left out.
//
// Every call of many ranks but rank(), size() and distributed() is collective: all make it, in the same order.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>

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

/// Bytes for each rank, or from each, by its number.
using Parcels = std::vector<std::vector<std::byte>>;

/// Equal blocks of bytes at equal distances: sent from where they stand, or received there.
struct Blocks {
  std::byte* first = nullptr;
  std::size_t count = 0, size = 0, stride = 0; ///< stride: bytes from one block's begin to the next one's
};

class Communicator {
public:
#ifdef KEELER_MPI
  static constexpr bool possible = true;
#else
  static constexpr bool possible = false;
#endif

  /// This process alone.
  Communicator() = default;
  /// All that the launcher (mpirun) started together; this process alone where there is no launcher. To be called once,
  /// when the program begins. Throws UsageError in a build without ranks of which a launcher has started several.
  static Communicator launched();

  std::size_t rank() const {
    return rank_;
  }
  std::size_t size() const {
    return size_;
  }
  bool distributed() const {
    return possible && size_ > 1;
  }
  bool is_root() const {
    return rank_ == 0;
  }

  /// Hands each rank its parcel and returns one from each; one's own comes back as it is.
  Parcels exchange(Parcels parcels) const;
  /// The same of rows.
  template<class Row> std::vector<std::vector<Row>> exchange(const std::vector<std::vector<Row>>& rows) const;

  /// The same of blocks in place, as many and as large where they are sent as where they are received.
  void exchange(std::span<const Blocks> sent, std::span<const Blocks> received) const;

  /// On the first rank what all have, in the order of the ranks, less than 2 GiB in all; nothing on the others.
  std::vector<std::byte> gather(std::vector<std::byte> bytes) const;
  /// The same of rows.
  template<class Row> std::vector<Row> gather(const std::vector<Row>& rows) const;

  /// Over all ranks, number by number: modulo 2⁶⁴.
  void sum(std::span<std::uint64_t> numbers) const;
  std::uint64_t sum(std::uint64_t number) const {
    sum(std::span(&number, 1));
    return number;
  }
  /// Each becomes the sum of those of all ranks.
  void merge(std::initializer_list<ExactSum*> sums) const;
  double largest(double number) const;
  double least(double number) const {
    return -largest(-number);
  }
  bool any(bool here) const {
    return largest(here ? 1.0 : 0.0) > 0.0;
  }

  /// What the first rank has, on all.
  void broadcast(std::span<std::byte> bytes) const;
  void broadcast(std::string& text) const;
  template<class Value> Value broadcast(Value value) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    broadcast(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }

  /// Runs on every rank, or on the first one alone. Where it throws an Error on one, all throw: the least such rank
  /// what it threw, the others an Error of that code and those words, of which they need not speak.
  void together(const std::function<void()>& work) const;
  void on_root(const std::function<void()>& work) const;

private:
  Communicator(std::size_t rank, std::size_t size) : rank_(rank), size_(size) {}

  /// Sends some bytes to each rank, but oneself, from where they stand. `room` says where so many of a rank's go.
  void exchange(const std::vector<std::span<const std::byte>>& sent,
                const std::function<std::byte*(std::size_t rank, std::size_t size)>& room) const;

  std::size_t rank_ = 0, size_ = 1;
};

/// What this rank's calls of Ranks have cost so far.
struct ExchangeCosts {
  double seconds = 0.0;                  ///< wall time: sending, receiving, and waiting for the others
  std::uint64_t messages = 0, bytes = 0; ///< sent to others by exchange()
  std::uint64_t common = 0;  ///< calls in which all ranks get the same: sums, least, largest, what the first has
  std::uint64_t largest = 0; ///< bytes sent from here, or brought here, by one call: a part of the particles' at most
};
const ExchangeCosts& exchange_costs();

/// Of a launched program at its end: waits for the others.
void finish_ranks();
/// The same of a rank that ends with an error, and this code. Where the others do not know of it, they wait for this
/// rank somewhere else: then all are ended at once.
void fail_ranks(ExitCode code);
/// Whether somebody else tells the user of the error that this rank ends with.
bool another_rank_speaks();

template<class Row> std::vector<Row> Communicator::gather(const std::vector<Row>& rows) const {
  static_assert(std::is_trivially_destructible_v<Row>);
  const auto own = std::as_bytes(std::span(rows));
  const std::vector<std::byte> bytes = gather(std::vector<std::byte>(own.begin(), own.end()));
  std::vector<Row> all(bytes.size() / sizeof(Row));
  if (!bytes.empty())
    std::memcpy(static_cast<void*>(all.data()), bytes.data(), bytes.size());
  return all;
}

template<class Row>
std::vector<std::vector<Row>> Communicator::exchange(const std::vector<std::vector<Row>>& rows) const {
  static_assert(std::is_trivially_destructible_v<Row>); // plain numbers; those of Eigen are not copied trivially
  std::vector<std::vector<Row>> received(rows.size());
  received[rank()] = rows[rank()];
  std::vector<std::span<const std::byte>> sent;
  for (const std::vector<Row>& its : rows)
    sent.push_back(std::as_bytes(std::span(its)));
  exchange(sent, [&](std::size_t rank, std::size_t size) {
    received[rank].resize(size / sizeof(Row));
    return reinterpret_cast<std::byte*>(received[rank].data());
  });
  return received;
}

} // namespace keeler
