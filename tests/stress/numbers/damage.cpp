#include "numbers/damage.h"

#include <fmt/format.h>

namespace sss::stress {

void forEachDamage(const std::string& whole,
                   const std::function<void(const std::string&, const std::string&)>& visit) {
    for (std::size_t size = 0; size < whole.size(); size += 64)
        visit(whole.substr(0, size), fmt::format("cut at byte {}", size));
    for (std::size_t place = 0; place < whole.size(); place += 97) {
        std::string flipped = whole;
        flipped[place] = static_cast<char>(flipped[place] ^ (1 << place % 8));
        visit(flipped, fmt::format("bit {} of byte {} flipped", place % 8, place));
    }
}

}  // namespace sss::stress
