// Ranks on MPI: the only source that knows of it.
#include <keeler/comm/communicator.hpp>

#include <keeler/core/error_at_hand.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>

#include <mpi.h>

namespace keeler {
namespace {

constexpr std::size_t longest_message = std::size_t{1} << 30; // bytes: MPI counts in int

bool is_launched = false;
bool all_know = false;       // of the error that ends this rank
bool another_speaks = false; // of it
ExchangeCosts costs;

bool has_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name))
      return true;
  return false;
}

void note(std::size_t bytes) {
  costs.largest = std::max(costs.largest, static_cast<std::uint64_t>(bytes));
}

int as_int(std::size_t number) {
  assert(number <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
  return static_cast<int>(number);
}

// Blocks as MPI has them.
class BlockType {
public:
  explicit BlockType(const Blocks& blocks) {
    MPI_Type_create_hvector(as_int(blocks.count), as_int(blocks.size), static_cast<MPI_Aint>(blocks.stride), MPI_BYTE,
                            &type_);
    MPI_Type_commit(&type_);
  }
  BlockType(const BlockType&) = delete;
  BlockType& operator=(const BlockType&) = delete;
  ~BlockType() { MPI_Type_free(&type_); } // what goes on with it ends as it would have

  MPI_Datatype operator*() const { return type_; }

private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

void copy(const Blocks& from, const Blocks& to) {
  assert(from.count == to.count && from.size == to.size);
  for (std::size_t k = 0; k < from.count; ++k)
    std::memcpy(to.first + k * to.stride, from.first + k * from.stride, from.size);
}

// Whatever must be the same in all for the same bits.
std::string build() {
  return fmt::format("{} of {} by {} {}", program_version(), source_commit(), build_compiler(), build_flags());
}

void require_one_build(const Communicator& ranks) {
  std::string first = build();
  ranks.broadcast(first);
  ranks.together([&] {
    if (first != build())
      throw UsageError(fmt::format("rank {} runs another build of Keeler ({}) than rank 0 ({}), and would not have the "
                                   "same bits; start the same program on all machines",
                                   ranks.rank(), build(), first));
  });
}

} // namespace

Communicator Communicator::launched() {
  if (!has_launcher())
    return {};
  int provided = 0, own = 0, count = 1;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &own);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  is_launched = true;
  const Communicator ranks(static_cast<std::size_t>(own), static_cast<std::size_t>(count));
  require_one_build(ranks);
  return ranks;
}

const ExchangeCosts& exchange_costs() {
  return costs;
}

void finish_ranks() {
  if (is_launched)
    MPI_Finalize();
}

void fail_ranks(ExitCode code) {
  if (is_launched && !all_know)
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  finish_ranks();
}

bool another_rank_speaks() {
  return another_speaks;
}

// Pairs of ranks at equal distances round a ring, so that none waits for more than one other; long parcels in pieces.
void Communicator::exchange(const std::vector<std::span<const std::byte>>& sent,
                            const std::function<std::byte*(std::size_t rank, std::size_t size)>& room) const {
  assert(sent.size() == size_);
  if (!distributed())
    return;
  const Stopwatch watch(costs.seconds);
  std::vector<std::uint64_t> sizes(size_), from(size_);
  std::transform(sent.begin(), sent.end(), sizes.begin(), [](const auto& parcel) { return parcel.size(); });
  MPI_Alltoall(sizes.data(), 1, MPI_UINT64_T, from.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  for (const auto& bytes : {sizes, from})
    note(std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0}) - bytes[rank_]);
  std::vector<MPI_Request> requests;
  const auto in_pieces = [&](std::size_t size, const auto& start) {
    for (std::size_t begin = 0; begin < size; begin += longest_message)
      start(begin, as_int(std::min(longest_message, size - begin)), &requests.emplace_back());
  };
  for (std::size_t step = 1; step < size_; ++step) {
    const std::size_t other = (rank_ + size_ - step) % size_;
    std::byte* const bytes = room(other, from[other]);
    in_pieces(from[other], [&](std::size_t begin, int size, MPI_Request* request) {
      MPI_Irecv(bytes + begin, size, MPI_BYTE, as_int(other), 0, MPI_COMM_WORLD, request);
    });
  }
  for (std::size_t step = 1; step < size_; ++step) {
    const std::size_t other = (rank_ + step) % size_;
    costs.bytes += sent[other].size();
    in_pieces(sent[other].size(), [&](std::size_t begin, int size, MPI_Request* request) {
      ++costs.messages;
      MPI_Isend(sent[other].data() + begin, size, MPI_BYTE, as_int(other), 0, MPI_COMM_WORLD, request);
    });
  }
  MPI_Waitall(as_int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

Parcels Communicator::exchange(Parcels parcels) const {
  Parcels received(parcels.size());
  exchange({parcels.begin(), parcels.end()}, [&](std::size_t rank, std::size_t size) {
    received[rank].resize(size);
    return received[rank].data();
  });
  received[rank_] = std::move(parcels[rank_]);
  return received;
}

void Communicator::exchange(std::span<const Blocks> sent, std::span<const Blocks> received) const {
  assert(sent.size() == size_ && received.size() == size_);
  const Stopwatch watch(costs.seconds);
  std::vector<MPI_Request> requests;
  std::uint64_t bytes_sent = 0, bytes_received = 0;
  for (std::size_t step = 1; step < size_; ++step) {
    const std::size_t other = (rank_ + size_ - step) % size_;
    const Blocks& blocks = received[other];
    bytes_received += blocks.count * blocks.size;
    if (blocks.count * blocks.size > 0)
      MPI_Irecv(blocks.first, 1, *BlockType(blocks), as_int(other), 0, MPI_COMM_WORLD, &requests.emplace_back());
  }
  for (std::size_t step = 1; step < size_; ++step) {
    const std::size_t other = (rank_ + step) % size_;
    const Blocks& blocks = sent[other];
    bytes_sent += blocks.count * blocks.size;
    if (blocks.count * blocks.size == 0)
      continue;
    ++costs.messages;
    MPI_Isend(blocks.first, 1, *BlockType(blocks), as_int(other), 0, MPI_COMM_WORLD, &requests.emplace_back());
  }
  costs.bytes += bytes_sent;
  note(std::max(bytes_sent, bytes_received));
  copy(sent[rank_], received[rank_]);
  MPI_Waitall(as_int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

std::vector<std::byte> Communicator::gather(std::vector<std::byte> bytes) const {
  if (!distributed())
    return bytes;
  const Stopwatch watch(costs.seconds);
  const int own = as_int(bytes.size());
  std::vector<int> sizes(is_root() ? size_ : 0), places(sizes.size());
  MPI_Gather(&own, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  std::exclusive_scan(sizes.begin(), sizes.end(), places.begin(), 0);
  std::vector<std::byte> all(is_root() ? static_cast<std::size_t>(places.back() + sizes.back()) : 0);
  note(std::max(bytes.size(), all.size()));
  MPI_Gatherv(bytes.data(), own, MPI_BYTE, all.data(), sizes.data(), places.data(), MPI_BYTE, 0, MPI_COMM_WORLD);
  return all;
}

void Communicator::sum(std::span<std::uint64_t> numbers) const {
  const Stopwatch watch(costs.seconds);
  ++costs.common;
  if (distributed())
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), as_int(numbers.size()), MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
}

void Communicator::merge(std::initializer_list<ExactSum*> sums) const {
  if (!distributed())
    return;
  std::vector<std::uint64_t> words;
  for (const ExactSum* sum : sums) {
    const std::vector<std::uint64_t> its = sum->words();
    words.insert(words.end(), its.begin(), its.end());
  }
  sum(std::span(words));
  const std::size_t each = words.size() / sums.size();
  std::size_t begin = 0;
  for (ExactSum* sum : sums) {
    *sum = ExactSum::of_words(std::span(words).subspan(begin, each));
    begin += each;
  }
}

double Communicator::largest(double number) const {
  const Stopwatch watch(costs.seconds);
  ++costs.common;
  if (distributed())
    MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return number;
}

void Communicator::broadcast(std::span<std::byte> bytes) const {
  const Stopwatch watch(costs.seconds);
  ++costs.common;
  note(bytes.size());
  for (std::size_t begin = 0; distributed() && begin < bytes.size(); begin += longest_message)
    MPI_Bcast(bytes.data() + begin, as_int(std::min(longest_message, bytes.size() - begin)), MPI_BYTE, 0,
              MPI_COMM_WORLD);
}

void Communicator::broadcast(std::string& text) const {
  const std::uint64_t size = broadcast(static_cast<std::uint64_t>(text.size()));
  text.resize(size);
  broadcast(std::as_writable_bytes(std::span(text)));
}

void Communicator::together(const std::function<void()>& work) const {
  if (!distributed())
    return work();
  std::optional<Error> error;
  std::exception_ptr thrown;
  try {
    work();
  } catch (...) {
    error = error_at_hand();
    thrown = std::current_exception();
  }
  const auto speaker = static_cast<std::size_t>(least(static_cast<double>(error ? rank_ : size_)));
  if (speaker == size_)
    return;
  all_know = true;
  another_speaks = speaker != rank_;
  // from the speaker to all
  Parcels parcels(size_);
  const auto told = [&] { return fmt::format("{:3d}{}", static_cast<int>(error->code()), error->what()); };
  if (speaker == rank_) {
    const std::string text = told();
    const auto bytes = std::as_bytes(std::span(text));
    for (std::vector<std::byte>& parcel : parcels)
      parcel.assign(bytes.begin(), bytes.end());
  }
  const std::vector<std::byte> heard = exchange(std::move(parcels))[speaker];
  if (speaker == rank_)
    std::rethrow_exception(thrown);
  const std::string text(reinterpret_cast<const char*>(heard.data()), heard.size());
  throw Error(static_cast<ExitCode>(std::stoi(text.substr(0, 3))), text.substr(3));
}

void Communicator::on_root(const std::function<void()>& work) const {
  together([&] {
    if (is_root())
      work();
  });
}

} // namespace keeler
