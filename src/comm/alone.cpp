// Ranks of a build without KEELER_MPI: there is one, and it has nobody to tell anything.
#include <keeler/comm/communicator.hpp>

#include <cstdlib>
#include <string>

namespace keeler {
namespace {

// How many the launchers of MPI say that they have started.
bool one_of_several() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* const size = std::getenv(name); size && std::atoi(size) > 1)
      return true;
  return false;
}

} // namespace

Communicator Communicator::launched() {
  if (one_of_several())
    throw UsageError(
        "this Keeler was built without ranks, and a launcher of MPI has started several of it, which would "
        "all do the same; start one, or build with -DKEELER_MPI=ON");
  return {};
}

Parcels Communicator::exchange(Parcels parcels) const {
  return parcels;
}
void Communicator::exchange(const std::vector<std::span<const std::byte>>&,
                            const std::function<std::byte*(std::size_t, std::size_t)>&) const {}
std::vector<std::byte> Communicator::gather(std::vector<std::byte> bytes) const {
  return bytes;
}
void Communicator::sum(std::span<std::uint64_t>) const {}
void Communicator::merge(std::initializer_list<ExactSum*>) const {}
double Communicator::largest(double number) const {
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
bool another_rank_speaks() {
  return false;
}

} // namespace keeler
