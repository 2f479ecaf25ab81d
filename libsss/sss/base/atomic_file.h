#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace sss {

/// A file under construction: written to "NAME.tmp-PID-N" beside its place, and renamed to NAME by
/// commit(), after fsync. Destroyed without commit, the temporary is removed and NAME is untouched.
/// All failures throw Error{Io} with the path and the system's reason.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write: for libraries that open files themselves. It exists, empty.
    const std::filesystem::path& temporaryPath() const { return temporary_; }
    void append(std::span<const std::byte> bytes);
    void append(std::string_view text);
    void commit();

private:
    std::filesystem::path target_, temporary_;
    int descriptor_ = -1;
};

/// Throws Error{Io} now, rather than after an hour's work, if `target` could not be written.
void requireWritable(const std::filesystem::path& target);

}  // namespace sss
