#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace sss {

/// A file under construction: written to "NAME.tmp-PID-N" beside its place, and renamed to NAME by
/// commit(), after fsync. Destroyed without commit, the temporary is removed and NAME is untouched.
/// A symbolic link keeps pointing where it did: the file it names is replaced. Anything that is not
/// a regular file (a folder, a device) is refused. All failures throw Error{Io} with the path and
/// the system's reason.
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
    /// Replaces bytes written before, from `offset` on: for headers known only at the end.
    void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
    void commit();

private:
    struct Registration;
    void forgetTemporary() noexcept;
    friend void removeTemporaryFiles() noexcept;

    std::filesystem::path target_, temporary_;
    Registration* registration_ = nullptr;
    int descriptor_ = -1;
};

/// Throws Error{Io} now, rather than after an hour's work, if `target` could not be written.
void requireWritable(const std::filesystem::path& target);

/// Removes the temporaries of every AtomicFile alive in this process. Async-signal-safe: for the
/// handlers of SIGINT and SIGTERM, which end the process right after.
void removeTemporaryFiles() noexcept;

}  // namespace sss
