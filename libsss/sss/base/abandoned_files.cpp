#include "sss/base/abandoned_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

namespace sss {
namespace {

// Whether the whole file is locked for us now.
bool lockWhole(int descriptor, int command) {
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    while (fcntl(descriptor, command, &whole) != 0)
        if (errno != EINTR) return false;
    return true;
}

bool hasName(int descriptor) {
    struct stat now {};
    return fstat(descriptor, &now) != 0 || now.st_nlink > 0;
}

// "NAME.tmp-PID-N".
bool isTemporaryName(std::string_view name) {
    constexpr std::string_view kDigits = "0123456789", kMark = ".tmp-";
    const std::size_t mark = name.rfind(kMark);
    if (mark == std::string_view::npos) return false;
    const std::string_view numbers = name.substr(mark + kMark.size());
    const std::size_t dash = numbers.find('-');
    return dash != std::string_view::npos && dash > 0 && dash + 1 < numbers.size() &&
           numbers.substr(0, dash).find_first_not_of(kDigits) == std::string_view::npos &&
           numbers.substr(dash + 1).find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

bool holdTemporary(int descriptor) {
    // Only one who removes it can be in the way.
    lockWhole(descriptor, F_OFD_SETLKW);
    return hasName(descriptor);
}

void removeAbandonedFiles(const std::filesystem::path& folder, std::chrono::seconds after) {
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
        if (!isTemporaryName(entry.path().filename().string())) continue;
        std::error_code vanished;
        const auto written = entry.last_write_time(vanished);
        if (vanished || std::filesystem::file_time_type::clock::now() - written < after) continue;
        const int descriptor = open(entry.path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
        if (descriptor < 0) continue;
        if (lockWhole(descriptor, F_OFD_SETLK)) unlink(entry.path().c_str());
        close(descriptor);
    }
}

}  // namespace sss
