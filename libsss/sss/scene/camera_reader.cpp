#include "sss/scene/camera_reader.h"

#include "sss/scene/transform_reader.h"
#include "sss/scene/view.h"

namespace sss {
namespace {

constexpr Field<CameraSettings> kCameraFields[] = {
    {"position", [](CameraSettings& c, const Node& n) { c.position = point(n); }, true},
    {"lookAt", [](CameraSettings& c, const Node& n) { c.lookAt = point(n); }},
    {"up", [](CameraSettings& c, const Node& n) { c.up = direction(n); }},
    {"fovDegrees",
     [](CameraSettings& c, const Node& n) {
         c.fovDegrees = number(n, {0, 180, true, true, "degrees"});
     }},
    {"apertureRadius",
     [](CameraSettings& c, const Node& n) { c.apertureRadiusMm = length(n, kSizeOrZeroRange); }},
    {"focusDistance",
     [](CameraSettings& c, const Node& n) { c.focusDistanceMm = length(n, kSizeRange); }},
    {"transform"},  // read last, because it moves the others
};

}  // namespace

CameraSettings readCamera(const Node& node) {
    CameraSettings camera;
    FieldSet fields;
    fields.add(camera, kCameraFields);
    fields.read(node);
    checkView(node, "position", camera.position, camera.lookAt, camera.up);
    if (node.value.find("transform") != nullptr) {
        const RigidTransform motion = readMotion(memberNode(node, "transform", ""));
        camera.position = motion.transformPoint(camera.position);
        camera.lookAt = motion.transformPoint(camera.lookAt);
        camera.up = motion.transformDirection(camera.up);
    }
    return camera;
}

KeyList cameraKeys() { return listRows<CameraSettings>("camera", kCameraFields); }

}  // namespace sss
