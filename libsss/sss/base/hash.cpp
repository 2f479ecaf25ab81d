#include "sss/base/hash.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <new>

namespace sss {
namespace {

XXH3_state_t* stateOf(void* state) { return static_cast<XXH3_state_t*>(state); }

}  // namespace

std::string Fingerprint::hex() const { return fmt::format("{:016x}{:016x}", hi, lo); }

Hasher::Hasher() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(stateOf(state_));
}

Hasher::~Hasher() { XXH3_freeState(stateOf(state_)); }

Hasher& Hasher::add(std::string_view text) { return addBytes(text.data(), text.size()); }

Hasher& Hasher::add(double value) {
    value += 0.0;  // -0.0 becomes 0.0
    XXH3_128bits_update(stateOf(state_), &value, sizeof value);
    return *this;
}

Hasher& Hasher::add(std::uint64_t value) {
    XXH3_128bits_update(stateOf(state_), &value, sizeof value);
    return *this;
}

Hasher& Hasher::add(const Fingerprint& value) { return add(value.lo).add(value.hi); }

Hasher& Hasher::addBytes(const void* data, std::size_t bytes) {
    const std::uint64_t size = bytes;
    XXH3_128bits_update(stateOf(state_), &size, sizeof size);
    XXH3_128bits_update(stateOf(state_), data, bytes);
    return *this;
}

Fingerprint Hasher::finish() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(stateOf(state_));
    return {hash.low64, hash.high64};
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace sss
