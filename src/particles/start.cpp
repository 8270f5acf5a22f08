#include <keeler/particles/start.hpp>

#include <keeler/core/registry.hpp>

namespace keeler::particles {
namespace {

Registry<StartEntry>& registered_starts() {
  static Registry<StartEntry> starts("start", &StartEntry::name, {}, KeyTable::shared);
  return starts;
}

} // namespace

void add_start(StartEntry entry, IfTaken if_taken) {
  registered_starts().add(std::move(entry), if_taken);
}

const std::vector<StartEntry>& start_laws() {
  return registered_starts().entries();
}

} // namespace keeler::particles
