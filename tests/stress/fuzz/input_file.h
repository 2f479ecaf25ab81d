#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

namespace sss::stress {

/// The bytes as a file, for readers that open files: one place a process and extension, in memory
/// where the system has such a folder, written anew at each call. Ends the process if it cannot.
const std::filesystem::path& inputFile(const char* extension, std::span<const std::byte> bytes);

/// Prints the sentence and ends the process so that a fuzzer keeps the input.
[[noreturn]] void fail(const char* sentence);

}  // namespace sss::stress
