#pragma once
#include <chrono>
#include <filesystem>

namespace sss {

/// Marks a temporary as being written, until its descriptor is closed, however the process ends
/// (an open file description lock). False if somebody was about to remove it, and has.
bool holdTemporary(int descriptor);

/// How long after its last byte a temporary may be taken for abandoned: a lock says more, but some
/// shared file systems keep locks to one machine, and a writer may be on another.
constexpr std::chrono::minutes kAbandonedAfter{60};

/// Removes the temporaries of AtomicFile in a folder that nobody will finish: their writers were
/// killed or lost their power. Nothing happens where files cannot be locked, or not be removed.
void removeAbandonedFiles(const std::filesystem::path& folder,
                          std::chrono::seconds after = kAbandonedAfter);

}  // namespace sss
