#include "sss/scene/view.h"

#include <fmt/format.h>

namespace sss {

void checkView(const Node& object, std::string_view fromKey, const DVec3& from, const DVec3& to,
               DVec3& up) {
    const DVec3 view = to - from;
    const double distance = glm::length(view);
    // Coordinates are exact to 1 in 1e16; closer than this the direction has no digits.
    if (!(distance > 1e-9 * (glm::length(from) + glm::length(to)))) {
        fail(object, fmt::format("has its \"{}\" where its \"lookAt\" is", fromKey),
             "move one of the two");
    }
    const double sine = glm::length(glm::cross(view / distance, up / glm::length(up)));
    if (sine >= 1e-6) return;
    if (object.value.find("up") != nullptr) {
        fail(object, "has its \"up\" along the line of sight",
             "give an \"up\" that points aside, or leave it out");
    }
    up = {0, 0, 1};
}

}  // namespace sss
