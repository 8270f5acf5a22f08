// The communicator on MPI: the only source file that includes mpi.h.
#include <keeler/comm/communicator.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/memory.hpp>
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
#include <utility>

#include <mpi.h>

namespace keeler::comm {
namespace {

constexpr std::size_t max_message = std::size_t{1} << 30; // bytes: MPI counts in int

bool is_launched = false;
bool error_is_common = false; // all ranks have thrown the error that ends this rank
bool another_reports = false; // and another rank reports it
ExchangeCosts costs;

bool has_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name))
      return true;
  return false;
}

void record_bytes(std::size_t bytes) {
  costs.max_bytes = std::max(costs.max_bytes, static_cast<std::uint64_t>(bytes));
}

int as_int(std::size_t number) {
  assert(number <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
  return static_cast<int>(number);
}

// The MPI data type of some blocks.
class BlockType {
public:
  explicit BlockType(const Blocks& blocks) {
    MPI_Type_create_hvector(as_int(blocks.count), as_int(blocks.size), static_cast<MPI_Aint>(blocks.stride), MPI_BYTE,
                            &type_);
    MPI_Type_commit(&type_);
  }
  BlockType(const BlockType&) = delete;
  BlockType& operator=(const BlockType&) = delete;
  ~BlockType() { MPI_Type_free(&type_); } // pending communication that uses it completes normally

  MPI_Datatype operator*() const { return type_; }

private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

void copy(const Blocks& from, const Blocks& to) {
  assert(from.count == to.count && from.size == to.size);
  for (std::size_t k = 0; k < from.count; ++k)
    std::memcpy(to.first + k * to.stride, from.first + k * from.stride, from.size);
}

// Identifies the build: everything that must agree between ranks for results to agree in bits.
std::string build_id() {
  return fmt::format("{} of {} by {} {}", program_version(), source_commit(), build_compiler(), build_flags());
}

void require_one_build(const Communicator& ranks) {
  std::string of_root = build_id();
  ranks.broadcast(of_root);
  ranks.together([&] {
    if (of_root != build_id())
      throw UsageError(fmt::format("rank {} runs another build of Keeler ({}) than rank 0 ({}), so that their results "
                                   "could differ in bits; start the same program on all machines",
                                   ranks.rank(), build_id(), of_root));
  });
}

} // namespace

Communicator Communicator::launched() {
  assert(!is_launched);
  if (!has_launcher())
    return {};
  int provided = 0, rank = 0, size = 1;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  is_launched = true;
  if (size > 1)
    return_freed_memory();
  const Communicator ranks(static_cast<std::size_t>(rank), static_cast<std::size_t>(size));
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
  if (is_launched && !error_is_common)
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  finish_ranks();
}

bool take_common_error() {
  another_reports = false;
  return std::exchange(error_is_common, false);
}

bool another_rank_reports() {
  return another_reports;
}

// Each rank sends to rank + k and receives from rank − k (modulo their number) in round k. Long parcels go in pieces.
void Communicator::exchange(const std::vector<std::span<const std::byte>>& sent, const Allocate& allocate) const {
  assert(sent.size() == size_);
  if (!distributed())
    return;
  const Stopwatch watch(costs.seconds);
  std::vector<std::uint64_t> sent_sizes(size_), received_sizes(size_);
  std::transform(sent.begin(), sent.end(), sent_sizes.begin(), [](const auto& parcel) { return parcel.size(); });
  MPI_Alltoall(sent_sizes.data(), 1, MPI_UINT64_T, received_sizes.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  for (const auto& sizes : {sent_sizes, received_sizes})
    record_bytes(std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0}) - sizes[rank_]);
  std::vector<MPI_Request> requests;
  const auto in_pieces = [&](std::size_t size, const auto& start) {
    for (std::size_t begin = 0; begin < size; begin += max_message)
      start(begin, as_int(std::min(max_message, size - begin)), &requests.emplace_back());
  };
  for (std::size_t step = 1; step < size_; ++step) {
    const std::size_t other = (rank_ + size_ - step) % size_;
    std::byte* const bytes = allocate(other, received_sizes[other]);
    in_pieces(received_sizes[other], [&](std::size_t begin, int size, MPI_Request* request) {
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

// A partner's message tells its size when it arrives, so no sizes are sent before.
void Communicator::exchange(const std::vector<std::span<const std::byte>>& sent, std::span<const std::size_t> partners,
                            const Allocate& allocate) const {
  constexpr int tag = 1; // not mistaken for a message of the exchange between all ranks
  const Stopwatch watch(costs.seconds);
  std::vector<MPI_Request> requests;
  std::uint64_t bytes_sent = 0, bytes_received = 0;
  for (const std::size_t other : partners) {
    assert(other != rank_ && other < size_);
    const auto& parcel = sent[other];
    if (parcel.size() >= max_message)
      throw UsageError(fmt::format("rank {} has {} GiB for a neighbour, more than a message can be; start more ranks",
                                   rank_, parcel.size() >> 30));
    bytes_sent += parcel.size();
    ++costs.messages;
    MPI_Isend(parcel.data(), as_int(parcel.size()), MPI_BYTE, as_int(other), tag, MPI_COMM_WORLD,
              &requests.emplace_back());
  }
  for (const std::size_t other : partners) {
    MPI_Status status;
    int size = 0;
    MPI_Probe(as_int(other), tag, MPI_COMM_WORLD, &status);
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::byte* const bytes = allocate(other, static_cast<std::size_t>(size));
    MPI_Recv(bytes, size, MPI_BYTE, as_int(other), tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    bytes_received += static_cast<std::uint64_t>(size);
  }
  costs.bytes += bytes_sent;
  record_bytes(std::max(bytes_sent, bytes_received));
  MPI_Waitall(as_int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

Parcels Communicator::exchange(Parcels parcels) const {
  assert(parcels.size() == size_);
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
  record_bytes(std::max(bytes_sent, bytes_received));
  copy(sent[rank_], received[rank_]);
  MPI_Waitall(as_int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

std::vector<std::byte> Communicator::gather(std::vector<std::byte> bytes) const {
  if (!distributed())
    return bytes;
  const Stopwatch watch(costs.seconds);
  const int own_size = as_int(bytes.size());
  std::vector<int> sizes(is_root() ? size_ : 0), offsets(sizes.size());
  MPI_Gather(&own_size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  std::exclusive_scan(sizes.begin(), sizes.end(), offsets.begin(), 0);
  assert(!is_root() || offsets.back() <= std::numeric_limits<int>::max() - sizes.back()); // MPI counts in int
  std::vector<std::byte> all(is_root() ? static_cast<std::size_t>(offsets.back() + sizes.back()) : 0);
  record_bytes(std::max(bytes.size(), all.size()));
  MPI_Gatherv(bytes.data(), own_size, MPI_BYTE, all.data(), sizes.data(), offsets.data(), MPI_BYTE, 0, MPI_COMM_WORLD);
  return all;
}

void Communicator::gather_on_all(std::span<const std::byte> rows, std::size_t row_size,
                                 const std::function<std::byte*(std::size_t)>& allocate) const {
  assert(row_size > 0 && rows.size() % row_size == 0);
  const Stopwatch watch(costs.seconds);
  ++costs.collectives;
  const int own = as_int(rows.size() / row_size);
  std::vector<int> counts(size_, own), offsets(size_);
  if (distributed())
    MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD);
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  assert(offsets.back() <= std::numeric_limits<int>::max() - counts.back()); // MPI counts in int
  const auto all = static_cast<std::size_t>(offsets.back() + counts.back());
  std::byte* const to = allocate(all);
  record_bytes(all * row_size);
  if (!distributed()) {
    std::copy(rows.begin(), rows.end(), to);
    return;
  }
  MPI_Datatype row = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(as_int(row_size), MPI_BYTE, &row);
  MPI_Type_commit(&row);
  MPI_Allgatherv(rows.data(), own, row, to, counts.data(), offsets.data(), row, MPI_COMM_WORLD);
  MPI_Type_free(&row);
}

void Communicator::sum(std::span<std::uint64_t> numbers) const {
  const Stopwatch watch(costs.seconds);
  ++costs.collectives;
  if (distributed())
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), as_int(numbers.size()), MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
}

void Communicator::merge(std::initializer_list<ExactSum*> sums) const {
  if (!distributed())
    return;
  std::vector<std::uint64_t> words;
  for (const ExactSum* sum : sums) {
    assert(sum != nullptr);
    const std::vector<std::uint64_t> words_of_sum = sum->words();
    words.insert(words.end(), words_of_sum.begin(), words_of_sum.end());
  }
  sum(std::span(words));
  assert(words.size() % sums.size() == 0);
  const std::size_t words_per_sum = words.size() / sums.size();
  std::size_t begin = 0;
  for (ExactSum* sum : sums) {
    *sum = ExactSum::of_words(std::span(words).subspan(begin, words_per_sum));
    begin += words_per_sum;
  }
}

double Communicator::max(double number) const {
  const Stopwatch watch(costs.seconds);
  ++costs.collectives;
  if (distributed())
    MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return number;
}

void Communicator::broadcast(std::span<std::byte> bytes) const {
  const Stopwatch watch(costs.seconds);
  ++costs.collectives;
  record_bytes(bytes.size());
  for (std::size_t begin = 0; distributed() && begin < bytes.size(); begin += max_message)
    MPI_Bcast(bytes.data() + begin, as_int(std::min(max_message, bytes.size() - begin)), MPI_BYTE, 0, MPI_COMM_WORLD);
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
  bool is_interrupted = false;
  std::exception_ptr thrown;
  try {
    try {
      work();
    } catch (const Interrupted&) {
      is_interrupted = true;
      throw;
    }
  } catch (...) {
    error = error_at_hand();
    thrown = std::current_exception();
  }
  const std::size_t turn = !error ? 2 * size_ : is_interrupted ? size_ + rank_ : rank_; // faults before interruptions
  const auto first = static_cast<std::size_t>(min(static_cast<double>(turn)));
  if (first == 2 * size_)
    return;
  const std::size_t reporter = first % size_;
  error_is_common = true;
  another_reports = reporter != rank_;
  // the first rank in turn sends its error to all: three digits of the code, i or e, then the text
  Parcels parcels(size_);
  if (reporter == rank_) {
    const std::string text =
        fmt::format("{:3d}{}{}", static_cast<int>(error->code()), is_interrupted ? 'i' : 'e', error->what());
    const auto bytes = std::as_bytes(std::span(text));
    for (std::vector<std::byte>& parcel : parcels)
      parcel.assign(bytes.begin(), bytes.end());
  }
  const std::vector<std::byte> received = exchange(std::move(parcels))[reporter];
  if (reporter == rank_)
    std::rethrow_exception(thrown);
  assert(received.size() >= 4);
  const std::string text(reinterpret_cast<const char*>(received.data()), received.size());
  if (text[3] == 'i')
    throw Interrupted(text.substr(4));
  throw Error(static_cast<ExitCode>(std::stoi(text.substr(0, 3))), text.substr(4));
}

void Communicator::on_root(const std::function<void()>& work) const {
  together([&] {
    if (is_root())
      work();
  });
}

} // namespace keeler::comm
