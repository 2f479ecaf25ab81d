#include "fuzz/input_file.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace sss::stress {
namespace {

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

    const std::filesystem::path& named(const std::string& extension) {
        auto [place, isNew] = paths_.try_emplace(extension);
        if (isNew) place->second = folder_ / ("input." + extension);
        return place->second;
    }

private:
    std::filesystem::path folder_;
    std::map<std::string, std::filesystem::path> paths_;
};

}  // namespace

void fail(const char* sentence) {
    std::fprintf(stderr, "stress: %s\n", sentence);
    std::abort();
}

const std::filesystem::path& inputFile(const char* extension, std::span<const std::byte> bytes) {
    static InputFiles files;
    const std::filesystem::path& path = files.named(extension);
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) fail("cannot open the input's file");
    const bool isWhole = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (std::fclose(file) != 0 || !isWhole) fail("cannot write the input's file");
    return path;
}

}  // namespace sss::stress
