#pragma once
#include <sys/resource.h>

namespace sss::testing {

/// While it lives, the system opens no further file for this process: also for root, to whom
/// permissions mean nothing.
class NoMoreFiles {
public:
    NoMoreFiles() {
        getrlimit(RLIMIT_NOFILE, &was_);
        const rlimit none{0, was_.rlim_max};
        setrlimit(RLIMIT_NOFILE, &none);
    }
    ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &was_); }
    NoMoreFiles(const NoMoreFiles&) = delete;
    NoMoreFiles& operator=(const NoMoreFiles&) = delete;

private:
    rlimit was_{};
};

}  // namespace sss::testing
