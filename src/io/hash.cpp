#include <keeler/io/hash.hpp>

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdint>
#include <new>

namespace keeler::io {
namespace {

XXH3_state_t* as_state(void* state) {
  return static_cast<XXH3_state_t*>(state);
}

} // namespace

void Hash::Free::operator()(void* state) const {
  XXH3_freeState(as_state(state));
}

Hash::Hash() : state_(XXH3_createState()) {
  if (!state_)
    throw std::bad_alloc();
  XXH3_128bits_reset(as_state(state_.get()));
}

void Hash::add_bytes(std::span<const std::byte> bytes) {
  XXH3_128bits_update(as_state(state_.get()), bytes.data(), bytes.size());
}

void Hash::add_text(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  add_bytes(std::as_bytes(std::span(text)));
}

std::string Hash::hex() const {
  const XXH128_hash_t digest = XXH3_128bits_digest(as_state(state_.get()));
  return fmt::format("{:016x}{:016x}", digest.high64, digest.low64);
}

} // namespace keeler::io
