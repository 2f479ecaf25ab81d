#pragma once
#include "stage.h"

#include <vector>

namespace sss::bench {

/// A place of the body's surface.
struct Receiver {
    FaceIndex face = 0;
    Vec2 barycentrics{};
    Vec3 position{};  ///< body space, mm
};

/// Where the camera sees the body: about `count` places, through the centres of pixels on a regular
/// grid over the film, so that they weigh what they weigh in the picture.
std::vector<Receiver> receiversInView(const Stage& stage, std::size_t count);

/// Receivers in groups of neighbours, as the renderer forms them: places one mean free path apart
/// all over the mesh, in Morton order, of which evenly spread runs of `kGroup` are taken, `count`
/// in all at most.
inline constexpr std::size_t kGroup = 32;
std::vector<Vec3> receiverGroups(const TriangleMesh& mesh, double meanFreePathMm,
                                 std::size_t count);

}  // namespace sss::bench
