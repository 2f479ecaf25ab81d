#pragma once
#include "sss/base/rng.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sss::stress {

/// Inputs for a reader made from its seeds, the same in every build: number `index` is some seed
/// with a few edits (bits, bytes, numbers at their limits, words of the format, parts cut, repeated
/// and taken from other seeds).
class Mutations {
public:
    /// `seeds` is a folder of inputs; `words` a dictionary as libFuzzer takes them, or empty.
    Mutations(const std::filesystem::path& seeds, const std::filesystem::path& words);
    std::string input(std::uint64_t index) const;

private:
    void edit(std::string& bytes, Rng& rng) const;

    std::vector<std::string> seeds_, words_;
};

/// The words of a dictionary: between quotes, with \\, \" and \xNN.
std::vector<std::string> dictionaryWords(const std::filesystem::path& file);

}  // namespace sss::stress
