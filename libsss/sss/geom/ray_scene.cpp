#include "sss/geom/ray_scene.h"

#include "sss/base/error.h"
#include "sss/base/require_memory.h"

#include <embree3/rtcore.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

namespace sss {

namespace {

[[noreturn]] void throwEmbree(RTCError code, const char* doing, std::string_view words = {}) {
    // What its builders' tasks throw comes out as an unknown error; its words tell.
    if (code == RTC_ERROR_OUT_OF_MEMORY || saysOutOfMemory(words))
        throw Error(ErrorKind::Resource, "rays", fmt::format("out of memory while {}", doing),
                    "use coarser meshes or a machine with more memory");
    throw Error(ErrorKind::Internal, "rays",
                fmt::format("Embree error {} ({}) while {}", static_cast<int>(code), words, doing));
}

/// The process's Embree device, made for the first scene. It is never released: Embree allocates
/// to do so, in a destructor, which ends the process where memory is out.
class Device {
public:
    Device() {
        // A fixed number of build tasks (they run in TBB's pool, on as many threads as there are):
        // Embree orders triangles by task, and on a shared edge that order picks the hit face, so
        // the machine's core count would otherwise show in the picture.
        handle_ = rtcNewDevice("threads=8,start_threads=0,set_affinity=0");
        if (!handle_) throwEmbree(rtcGetDeviceError(nullptr), "starting");
        rtcSetDeviceErrorFunction(handle_, keepWords, this);
    }
    ~Device() = delete;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    RTCDevice get() const { return handle_; }
    /// Errors of scenes before this one, whose owners have heard of them, are not its own.
    void forgetErrors() const { rtcGetDeviceError(handle_); }
    void check(const char* doing) const {
        const RTCError code = rtcGetDeviceError(handle_);
        if (code != RTC_ERROR_NONE) throwEmbree(code, doing, words_.data());
    }

private:
    static void keepWords(void* device, RTCError, const char* words) {
        auto& kept = static_cast<Device*>(device)->words_;
        std::snprintf(kept.data(), kept.size(), "%s", words ? words : "");
    }

    std::array<char, 200> words_{};  // of the latest error; no allocation, as memory may be out
    RTCDevice handle_ = nullptr;
};

// Where making it fails, the next scene tries again.
const Device& sharedDevice() {
    static const Device* const device = new Device;
    return *device;
}

/// Copies `values` into a new buffer that Embree owns and pads.
template <typename T>
const T* setBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                   std::span<const T> values, const Device& device) {
    T* buffer = static_cast<T*>(
        rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size()));
    device.check("copying a mesh");
    if (buffer) std::copy(values.begin(), values.end(), buffer);
    return buffer;
}

/// Unit normal of a hit; of a needle whose float cross product vanished, a direction that at least
/// faces the ray.
Vec3 unitNormal(const Vec3& n, const Vec3& direction) {
    constexpr float kLeast = 1e-30f;  // whose square root has all its digits
    const float length2 = glm::dot(n, n);
    if (length2 > kLeast && length2 < 1 / kLeast) return n / std::sqrt(length2);
    const DVec3 exact(n);
    const double length = glm::length(exact);
    return length > 0 ? Vec3(exact / length) : -direction;
}

void fillRay(const Ray& ray, std::uint32_t mask, RTCRay& out) {
    out.org_x = ray.origin.x;
    out.org_y = ray.origin.y;
    out.org_z = ray.origin.z;
    out.dir_x = ray.direction.x;
    out.dir_y = ray.direction.y;
    out.dir_z = ray.direction.z;
    out.tnear = ray.tMin;
    out.tfar = ray.tMax;
    out.time = 0;
    out.mask = mask;
    out.id = 0;
    out.flags = 0;
}

constexpr std::size_t kPacket = 8;  // what AVX2 holds; Embree takes them apart where it must

/// Several rays and what each of them sees.
struct RayBundle {
    std::span<const Ray> rays;
    std::span<const std::uint32_t> masks;  ///< by ray; empty: everything

    std::uint32_t mask(std::size_t i) const { return masks.empty() ? kAllGeometry : masks[i]; }
};

/// Fills a packet with the next rays; lanes without a ray are off.
struct PacketLanes {
    alignas(32) int valid[kPacket];
    std::size_t count;

    PacketLanes(const RayBundle& bundle, std::size_t first, RTCRay8& out)
        : count(std::min(kPacket, bundle.rays.size() - first)) {
        for (std::size_t i = 0; i < kPacket; ++i) {
            valid[i] = i < count ? -1 : 0;
            const std::size_t number = first + std::min(i, count - 1);
            const Ray& ray = bundle.rays[number];
            out.org_x[i] = ray.origin.x;
            out.org_y[i] = ray.origin.y;
            out.org_z[i] = ray.origin.z;
            out.dir_x[i] = ray.direction.x;
            out.dir_y[i] = ray.direction.y;
            out.dir_z[i] = ray.direction.z;
            out.tnear[i] = ray.tMin;
            out.tfar[i] = ray.tMax;
            out.time[i] = 0;
            out.mask[i] = bundle.mask(number);
            out.id[i] = 0;
            out.flags[i] = 0;
        }
    }
};

/// Hands every hit of a ray on, and lets the ray pass.
struct VisitContext {
    RTCIntersectContext embree;  // first: Embree knows no more of it
    Vec3 direction;
    const std::function<void(const Hit&)>* visit;

    static void pass(const RTCFilterFunctionNArguments* arguments) {
        const auto& self = *reinterpret_cast<const VisitContext*>(arguments->context);
        RTCHitN* const found = arguments->hit;
        Hit hit;
        hit.t = RTCRayN_tfar(arguments->ray, 1, 0);
        hit.geometry = RTCHitN_geomID(found, 1, 0);
        hit.face = RTCHitN_primID(found, 1, 0);
        hit.u = RTCHitN_u(found, 1, 0);
        hit.v = RTCHitN_v(found, 1, 0);
        hit.normal = unitNormal(
            {RTCHitN_Ng_x(found, 1, 0), RTCHitN_Ng_y(found, 1, 0), RTCHitN_Ng_z(found, 1, 0)},
            self.direction);
        (*self.visit)(hit);
        arguments->valid[0] = 0;
    }
};

// As packets, rays that part cost twice what they cost singly, even in an order by direction:
// Embree is told to part them, and is still faster than by calls for single rays.
RTCIntersectContext contextOf(RayScene::Together together) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = together == RayScene::Together::Parallel
                        ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                        : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

}  // namespace

struct RayScene::Impl {
    const Device& device = sharedDevice();
    RTCScene scene = nullptr;
    bool hasFailed = false;

    Impl() {
        device.forgetErrors();
        scene = rtcNewScene(device.get());
        device.check("making a scene");
    }
    /// A scene whose build has failed stays, cleared by Embree: a thread whose memory for building
    /// could not be noted would go on writing into it, whatever lay there by then.
    ~Impl() {
        if (!hasFailed) rtcReleaseScene(scene);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    /// Embree's own copies, which live as long as the scene.
    struct Mesh {
        const Vec3* positions;
        const UVec3* faces;
    };
    std::vector<Mesh> meshes;
    std::array<Vec3, 3> corners(const Hit& hit) const;
};

RayScene::RayScene(std::span<const Geometry> geometries) : impl_(std::make_unique<Impl>()) {
    const Device& device = impl_->device;
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_MEDIUM);
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        const Geometry& input = geometries[i];
        const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        if (!geometry) device.check("adding a mesh");
        impl_->meshes.push_back(
            {setBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, input.positions,
                       device),
             setBuffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, input.faces, device)});
        rtcSetGeometryMask(geometry, input.mask);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(impl_->scene, geometry, static_cast<unsigned>(i));
        rtcReleaseGeometry(geometry);
        device.check("adding a mesh");
        for (const UVec3& face : input.faces)
            for (int corner = 0; corner < 3; ++corner) bounds_.add(input.positions[face[corner]]);
    }
    impl_->hasFailed = true;
    rtcCommitScene(impl_->scene);
    device.check("building the ray hierarchy");
    impl_->hasFailed = false;
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

bool RayScene::intersect(const Ray& ray, Hit& hit, std::uint32_t mask) const {
    RTCRayHit query;
    fillRay(ray, mask, query.ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(impl_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit.t = query.ray.tfar;
    hit.geometry = query.hit.geomID;
    hit.face = query.hit.primID;
    hit.u = query.hit.u;
    hit.v = query.hit.v;
    hit.normal = unitNormal({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}, ray.direction);
    return true;
}

bool RayScene::occluded(const Ray& ray, std::uint32_t mask) const {
    RTCRay query;
    fillRay(ray, mask, query);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl_->scene, &context, &query);
    // Embree marks an occluded ray with tfar = -inf.
    return query.tfar < ray.tMin;
}

void RayScene::forEachHit(const Ray& ray, const std::function<void(const Hit&)>& visit,
                          std::uint32_t mask) const {
    RTCRay query;
    fillRay(ray, mask, query);
    VisitContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = VisitContext::pass;
    context.direction = ray.direction;
    context.visit = &visit;
    rtcOccluded1(impl_->scene, &context.embree, &query);
}

void RayScene::intersectTogether(std::span<const Ray> rays, Together together, std::span<Hit> hits,
                                 std::span<const std::uint32_t> masks) const {
    RTCIntersectContext context = contextOf(together);
    const RayBundle bundle{rays, masks};
    RTCRayHit8 query;
    for (std::size_t first = 0; first < rays.size(); first += kPacket) {
        const PacketLanes lanes(bundle, first, query.ray);
        std::fill_n(query.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
        rtcIntersect8(lanes.valid, impl_->scene, &context, &query);
        for (std::size_t i = 0; i < lanes.count; ++i) {
            Hit& hit = hits[first + i];
            hit.geometry = query.hit.geomID[i];
            if (hit.geometry == RTC_INVALID_GEOMETRY_ID) continue;
            hit.t = query.ray.tfar[i];
            hit.face = query.hit.primID[i];
            hit.u = query.hit.u[i];
            hit.v = query.hit.v[i];
            hit.normal = unitNormal({query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]},
                                    rays[first + i].direction);
        }
    }
}

void RayScene::occludedTogether(std::span<const Ray> rays, Together together,
                                std::span<bool> occluded,
                                std::span<const std::uint32_t> masks) const {
    RTCIntersectContext context = contextOf(together);
    const RayBundle bundle{rays, masks};
    RTCRay8 query;
    for (std::size_t first = 0; first < rays.size(); first += kPacket) {
        const PacketLanes lanes(bundle, first, query);
        rtcOccluded8(lanes.valid, impl_->scene, &context, &query);
        for (std::size_t i = 0; i < lanes.count; ++i)
            occluded[first + i] = query.tfar[i] < rays[first + i].tMin;
    }
}

std::array<Vec3, 3> RayScene::Impl::corners(const Hit& hit) const {
    const Mesh& mesh = meshes[hit.geometry];
    const UVec3 face = mesh.faces[hit.face];
    return {mesh.positions[face.x], mesh.positions[face.y], mesh.positions[face.z]};
}

namespace {

constexpr float kOffsetUlps = 64.0f * 0x1p-24f;

float largestCoordinate(const Vec3& v) { return maxComponent(glm::abs(v)); }

}  // namespace

RayScene::Place RayScene::place(const Hit& hit) const {
    const auto [a, b, c] = impl_->corners(hit);
    const float scale =
        largestCoordinate(glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c)));
    return {a * (1.0f - hit.u - hit.v) + b * hit.u + c * hit.v, scale * kOffsetUlps};
}

Vec3 offsetFromSurface(const Vec3& point, const Vec3& normal) {
    return point + normal * std::max(largestCoordinate(point) * kOffsetUlps, 0x1p-16f);
}

}  // namespace sss
