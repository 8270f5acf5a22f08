// Single-process build (no KEELER_MPI): every collective is a no-op.
#include <keeler/comm/communicator.hpp>
#include <keeler/core/exact_sum.hpp>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <string>

namespace keeler::comm {
namespace {

// True if the environment of an MPI launcher says that it has started several processes.
bool one_of_several() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* const size = std::getenv(name); size && std::atoi(size) > 1)
      return true;
  return false;
}

} // namespace

Communicator Communicator::launched() {
  if (one_of_several())
    throw UsageError("this build of Keeler has no MPI, but an MPI launcher has started several processes of it, which "
                     "would all do the same work; start one process, or keeler-mpi (a package of its own; from source, "
                     "build with -DKEELER_MPI=ON)");
  return {};
}

Parcels Communicator::exchange(Parcels parcels) const {
  assert(parcels.size() == size_);
  return parcels;
}
void Communicator::exchange([[maybe_unused]] const std::vector<std::span<const std::byte>>& sent,
                            const Allocate&) const {
  assert(sent.size() == size_);
}
void Communicator::exchange([[maybe_unused]] const std::vector<std::span<const std::byte>>& sent,
                            [[maybe_unused]] std::span<const std::size_t> partners, const Allocate&) const {
  assert(sent.size() == size_ && partners.empty());
}
std::vector<std::byte> Communicator::gather(std::vector<std::byte> bytes) const {
  return bytes;
}
void Communicator::exchange(std::span<const Blocks> sent, std::span<const Blocks> received) const {
  assert(sent.size() == 1 && received.size() == 1);
  const Blocks &from = sent.front(), &to = received.front();
  assert(from.count == to.count && from.size == to.size);
  for (std::size_t k = 0; k < from.count; ++k)
    std::memmove(to.first + k * to.stride, from.first + k * from.stride, from.size);
}
void Communicator::gather_on_all(std::span<const std::byte> rows, std::size_t row_size,
                                 const std::function<std::byte*(std::size_t)>& allocate) const {
  assert(row_size > 0 && rows.size() % row_size == 0);
  std::copy(rows.begin(), rows.end(), allocate(rows.size() / row_size));
}
void Communicator::sum(std::span<std::uint64_t>) const {}
void Communicator::merge(std::initializer_list<ExactSum*>) const {}
double Communicator::max(double number) const {
  return number;
}
void Communicator::broadcast(std::span<std::byte>) const {}
void Communicator::broadcast(std::string&) const {}
void Communicator::together(const std::function<void()>& work) const {
  work();
}
void Communicator::on_root(const std::function<void()>& work) const {
  work();
}
const ExchangeCosts& exchange_costs() {
  static const ExchangeCosts none;
  return none;
}
void finish_ranks() {}
void fail_ranks(ExitCode) {}
bool take_common_error() {
  return true;
}
bool another_rank_reports() {
  return false;
}

} // namespace keeler::comm
