#include "fuzz/input_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace sss::stress {
namespace {

/// A file that stays open, as opening it takes longer than many a reader.
struct InputFile {
    std::filesystem::path path;
    int descriptor = -1;
};

/// Removes what it has written when the process ends.
class InputFiles {
public:
    InputFiles() {
        const std::filesystem::path memory = "/dev/shm";
        const bool isThere = access(memory.c_str(), W_OK) == 0;
        folder_ = (isThere ? memory : std::filesystem::temp_directory_path()) /
                  ("sss-stress-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~InputFiles() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    InputFiles(const InputFiles&) = delete;
    InputFiles& operator=(const InputFiles&) = delete;

    const InputFile& named(const std::string& extension) {
        auto [place, isNew] = files_.try_emplace(extension);
        InputFile& file = place->second;
        if (!isNew) return file;
        file.path = folder_ / ("input." + extension);
        file.descriptor = open(file.path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
        if (file.descriptor < 0) fail("cannot open the input's file");
        return file;
    }

private:
    std::filesystem::path folder_;
    std::map<std::string, InputFile> files_;
};

}  // namespace

void fail(const char* sentence) {
    std::fprintf(stderr, "stress: %s\n", sentence);
    std::abort();
}

const std::filesystem::path& inputFile(const char* extension, std::span<const std::byte> bytes) {
    static InputFiles files;
    const InputFile& file = files.named(extension);
    const auto size = static_cast<ssize_t>(bytes.size());
    if (ftruncate(file.descriptor, size) != 0 ||
        pwrite(file.descriptor, bytes.data(), bytes.size(), 0) != size)
        fail("cannot write the input's file");
    return file.path;
}

}  // namespace sss::stress
