#include "fuzz/mutations.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

namespace sss::stress {
namespace {

constexpr std::size_t kLongest = 32768;
// Where counts, sizes and signs go wrong.
constexpr std::array<std::uint64_t, 12> kNumbers{0,          1,          0x7f,       0x80,
                                                 0xff,       0x7fff,     0x80000000, 0x7fffffff,
                                                 0xffffffff, 0x7f800000, 1ull << 63, ~0ull};
constexpr std::array<const char*, 8> kTexts{"-1",    "0",   "4294967295", "9223372036854775808",
                                            "1e999", "nan", "1e38",       "-0.0"};

std::string contents(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t below(Rng& rng, std::size_t count) {
    return rng.next64() % std::max<std::size_t>(count, 1);
}

template <typename List>
const auto& oneOf(const List& list, Rng& rng) {
    return list[below(rng, list.size())];
}

std::string unescaped(const std::string& text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            plain += text[i];
        } else if (text[i + 1] == 'x' && i + 3 < text.size()) {
            plain += static_cast<char>(std::stoi(text.substr(i + 2, 2), nullptr, 16));
            i += 3;
        } else {
            plain += text[++i];
        }
    }
    return plain;
}

// A number of the text in place of the one that stands at or after `at`.
void replaceNumber(std::string& bytes, std::size_t at, Rng& rng) {
    constexpr const char* kDigits = "+-.0123456789eE";
    const std::size_t begin = bytes.find_first_of("0123456789", at);
    if (begin == bytes.npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of(kDigits, begin), bytes.size());
    bytes.replace(begin, end - begin, oneOf(kTexts, rng));
}

}  // namespace

std::vector<std::string> dictionaryWords(const std::filesystem::path& file) {
    std::vector<std::string> words;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        const std::size_t first = line.find('"'), last = line.rfind('"');
        if (line.empty() || line[0] == '#' || first == last) continue;
        words.push_back(unescaped(line.substr(first + 1, last - first - 1)));
    }
    return words;
}

Mutations::Mutations(const std::filesystem::path& seeds, const std::filesystem::path& words) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(seeds))
        files.push_back(entry.path());
    std::ranges::sort(files);
    for (const auto& file : files) seeds_.push_back(contents(file));
    if (!words.empty()) words_ = dictionaryWords(words);
}

void Mutations::edit(std::string& bytes, Rng& rng) const {
    const std::size_t at = below(rng, bytes.size() + 1);
    const std::size_t length = std::min(1 + below(rng, 64), bytes.size() - at);
    const std::string& other = oneOf(seeds_, rng);
    switch (below(rng, words_.empty() ? 8 : 10)) {
        case 0:
            if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(rng, 8));
            break;
        case 1:
            if (at < bytes.size()) bytes[at] = static_cast<char>(rng.next32());
            break;
        case 2: {  // one of 1, 2, 4 or 8 bytes
            const std::uint64_t number = oneOf(kNumbers, rng);
            const std::size_t size = std::size_t{1} << below(rng, 4);
            if (at + size <= bytes.size()) std::memcpy(&bytes[at], &number, size);
            break;
        }
        case 3:
            replaceNumber(bytes, at, rng);
            break;
        case 4:
            bytes.erase(at, length);
            break;
        case 5:
            bytes.insert(at, bytes.substr(at, length));
            break;
        case 6:  // the rest of another seed
            bytes = bytes.substr(0, at) + other.substr(below(rng, other.size() + 1));
            break;
        case 7: {  // a part of another seed
            const std::size_t from = below(rng, other.size() + 1);
            bytes.replace(at, length, other.substr(from, 1 + below(rng, 64)));
            break;
        }
        case 8:
            bytes.insert(at, oneOf(words_, rng));
            break;
        default:
            bytes.replace(at, length, oneOf(words_, rng));
    }
}

std::string Mutations::input(std::uint64_t index) const {
    Rng rng(mix64(index + 1));
    std::string bytes = oneOf(seeds_, rng);
    for (std::size_t edits = 1 + below(rng, 5); edits > 0; --edits) edit(bytes, rng);
    if (bytes.size() > kLongest) bytes.resize(kLongest);
    return bytes;
}

}  // namespace sss::stress
