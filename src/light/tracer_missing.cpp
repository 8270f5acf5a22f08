// In place of tracer_embree.cpp where Embree is not installed.
#include "tracer.hpp"

#include <keeler/core/error.hpp>
#include <keeler/light/photometry.hpp>

namespace keeler::light {

bool can_trace() {
  return false;
}

void require_tracer() {
  throw Error(ExitCode::run_time, "this Keeler was built without Embree, which traces rays; install it (Debian: "
                                  "libembree-dev) and build Keeler again");
}

struct Tracer::Scene {};

Tracer::Tracer(const Patch&) {
  require_tracer();
}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

std::optional<Hit> Tracer::first_hit(const Vec3&, const Vec3&) const {
  return std::nullopt;
}

bool Tracer::blocked(const Vec3&, const Vec3&) const {
  return false;
}

std::size_t Tracer::count_blocked_in_cell(std::span<const Vec3>, const Vec3&, bool) const {
  return 0;
}

} // namespace keeler::light
