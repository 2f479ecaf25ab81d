#pragma once
#include <cstddef>
#include <span>

namespace sss::stress {

/// The bytes of a cache file with whatever its header and table say, but with the right checksums
/// and file size, as many as its table asks for: what lies behind the checksums must stand on its
/// own feet. Bytes in which there is no table to be found come back as they are.
std::span<const std::byte> withRightChecksums(std::span<const std::byte> bytes);

}  // namespace sss::stress
