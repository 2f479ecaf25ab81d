#include "sss/base/error.h"
#include "sss/base/json.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace sss {

JsonValue readJsonFile(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code ignored;
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    const int reason = std::filesystem::is_directory(file, ignored) ? EISDIR : errno;
    if (!stream || reason == EISDIR) {
        throw Error(
            ErrorKind::Io, name,
            fmt::format("the file cannot be opened: {}", std::generic_category().message(reason)),
            "check its name and that it may be read");
    }
    std::string text;
    // One byte over the limit is enough for parseJson to refuse a file that never ends.
    std::vector<char> block(std::size_t{1} << 20);
    while (stream && text.size() <= kMaxJsonBytes) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (stream.bad()) throw Error(ErrorKind::Io, name, "the file cannot be read to its end");
    return parseJson(text, name);
}

}  // namespace sss
