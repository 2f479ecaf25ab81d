#include "numbers/clouds.h"

#include "sss/base/rng.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace sss::stress {
namespace {

float spread(std::uint32_t index, std::uint32_t salt) {
    Sampler sampler(index, salt);
    return 20 * sampler.next1D() - 10;
}

// Of the slab that some profiles are for, in smallest mean free paths.
constexpr double kSlabPerMfp = 6;

Vec3 inCube(std::uint32_t i, std::uint32_t /*count*/) {
    return {spread(i, 1), spread(i, 2), spread(i, 3)};
}

constexpr Arrangement kArrangements[] = {
    {"at one place", [](std::uint32_t, std::uint32_t) { return Vec3(1, 2, 3); }},
    {"equal after rounding",
     [](std::uint32_t i, std::uint32_t) {
         return Vec3(1, 2, 3) * (1.0f + 6e-8f * static_cast<float>(i % 3));
     }},
    {"on an axis", [](std::uint32_t i, std::uint32_t) { return Vec3(spread(i, 1), 0, 0); }},
    {"on a diagonal", [](std::uint32_t i, std::uint32_t) { return Vec3(spread(i, 1)); }},
    {"in a plane",
     [](std::uint32_t i, std::uint32_t) { return Vec3(spread(i, 1), spread(i, 2), 0); }},
    {"in a cube", inCube},
    {"one far from all others",
     [](std::uint32_t i, std::uint32_t count) {
         return i == 0 ? Vec3(1e6f, 0, 0) : inCube(i, count) * 0.1f;
     }},
};

constexpr Lighting kLightings[] = {
    {"even light", [](std::uint32_t, std::uint32_t) { return Rgb(1); }},
    {"no light", [](std::uint32_t, std::uint32_t) { return Rgb(0); }},
    {"one bright point in the dark",
     [](std::uint32_t i, std::uint32_t count) { return Rgb(i == count / 2 ? 1.0f : 0.0f); }},
    {"1e-30 W m^-2", [](std::uint32_t, std::uint32_t) { return Rgb(1e-30f); }},
    {"1e30 W m^-2", [](std::uint32_t, std::uint32_t) { return Rgb(1e30f); }},
    {"a channel a third",
     [](std::uint32_t i, std::uint32_t count) {
         Rgb light{0.0f};
         light[static_cast<int>(3 * std::uint64_t{i} / count)] = 1;
         return light;
     }},
    {"any light", [](std::uint32_t i, std::uint32_t) { return 0.1f * inCube(i + 77, 0) + 1.0f; }},
};

}  // namespace

std::span<const Arrangement> arrangements() { return kArrangements; }
std::span<const Lighting> lightings() { return kLightings; }

HardCloud::HardCloud(std::vector<SurfacePoint> unsorted, std::vector<Rgb> light) {
    for (const std::uint32_t i : cloudOrder({unsorted, light})) {
        points.push_back(unsorted[i]);
        irradiance.push_back(light[i]);
    }
    nodes = buildOctree(view());
}

HardCloud HardCloud::shuffled(std::uint64_t seed) const {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::uint32_t i = static_cast<std::uint32_t>(order.size()); i > 1; --i) {
        Sampler sampler(seed, i);
        std::swap(order[i - 1],
                  order[static_cast<std::uint32_t>(sampler.next1D() * static_cast<float>(i - 1))]);
    }
    std::vector<SurfacePoint> moved;
    std::vector<Rgb> light;
    for (const std::uint32_t i : order) {
        moved.push_back(points[i]);
        light.push_back(irradiance[i]);
    }
    return {std::move(moved), std::move(light)};
}

HardCloud HardCloud::scaled(float factor) const {
    std::vector<SurfacePoint> moved = points;
    for (SurfacePoint& p : moved) {
        p.position *= factor;
        p.areaMm2 *= factor * factor;
    }
    return {std::move(moved), irradiance};
}

HardCloud makeCloud(const Arrangement& where, const Lighting& light, std::uint32_t count) {
    std::vector<SurfacePoint> points(count);
    std::vector<Rgb> irradiance(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        points[i].position = where.place(i, count);
        points[i].areaMm2 = 1.0f + 0.04f * spread(i, 4);
        points[i].normal = i % 5;
        irradiance[i] = light.irradiance(i, count);
    }
    return {std::move(points), std::move(irradiance)};
}

std::vector<Vec3> receiversFor(const HardCloud& cloud, std::size_t count) {
    std::vector<Vec3> receivers;
    for (std::size_t i = 0; i < count; ++i) {
        const SurfacePoint& p = cloud.points[i * cloud.points.size() / count];
        const auto k = static_cast<std::uint32_t>(i);
        const float apart[] = {0, 1e-4f, 0.03f, 3};
        receivers.push_back(p.position + inCube(k + 100, 0) * apart[i % 4]);
    }
    return receivers;
}

HardOptics::HardOptics(std::string name_, const Medium& medium, std::string_view profile,
                       double unit)
    : name(std::move(name_)),
      optics(medium, profile, kSlabPerMfp),
      table(optics.pointers(), 1e7 * unit, 0.5 * unit),
      profile_(profile),
      cellRadiusMm_(0.5 * unit) {}

HardOptics HardOptics::inUnit(double unit) const {
    Medium medium = optics.medium;
    medium.sigmaA /= unit;
    medium.sigmaS /= unit;
    return {name, medium, profile_, unit};
}

namespace {

struct Choice {
    std::string_view medium, profile;
};
// The costly ones last.
constexpr Choice kChoices[] = {
    {"Marble", "dipole"},
    {"Skimmilk", "better_dipole"},
    {"Ketchup", "normalized_diffusion"},
    {"Wholemilk", "multipole"},
    {"Skin2", "multipole_transmittance"},
    {"Apple", "normalized_diffusion_dmfp"},
    {"no absorption", "dipole"},
    {"1 - alpha' of 1e-9, 0.1 and 0.9", "better_dipole"},
    {"Skin1", "photon_beam"},
    {"Marble", "photon_beam_single"},
};
constexpr std::size_t kCostly = 2;

// Of a mean free path of 1 mm, absorbing the stated share; or measured.
Medium mediumOf(std::string_view name) {
    Medium medium;
    medium.sigmaA = DRgb(0);
    if (const MeasuredMedium* found = findMeasuredMedium(name)) return toMedium(*found);
    if (name != "no absorption") medium.sigmaA = DRgb(1e-9, 0.1, 0.9);
    medium.sigmaS = 1.0 - medium.sigmaA;
    return medium;
}

}  // namespace

std::span<const HardOptics> hardOptics(Scope scope) {
    static std::vector<HardOptics> made;
    const std::size_t wanted = std::size(kChoices) - (scope == Scope::Full ? 0 : kCostly);
    made.reserve(std::size(kChoices));
    while (made.size() < wanted) {
        const Choice& choice = kChoices[made.size()];
        made.emplace_back(fmt::format("{} by {}", choice.medium, choice.profile),
                          mediumOf(choice.medium), choice.profile);
    }
    return {made.data(), wanted};
}

DRgb sumByProfiles(const HardCloud& cloud, const testing::Optics& optics, double cellRadiusMm,
                   const Vec3& receiver) {
    const RegularisedProfile profiles[] = {{optics.profile(0), cellRadiusMm},
                                           {optics.profile(1), cellRadiusMm},
                                           {optics.profile(2), cellRadiusMm}};
    DRgb sum{0};
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        if (isZero(cloud.irradiance[i])) continue;
        const double r = glm::length(DVec3(cloud.points[i].position) - DVec3(receiver));
        for (int c = 0; c < 3; ++c)
            sum[c] +=
                profiles[c](r) * double{cloud.points[i].areaMm2} * double{cloud.irradiance[i][c]};
    }
    return sum;
}

std::vector<Rgb> sumByTree(const HardCloud& cloud, const KernelTable& table,
                           std::span<const Vec3> receivers, double tolerance) {
    const DiffusionSum sum(cloud.view(), cloud.nodes, table);
    DiffusionSum::Scratch scratch;
    SumCounts counts;
    std::vector<Rgb> out(receivers.size());
    sum.evaluate(receivers, tolerance, out, scratch, counts);
    return out;
}

}  // namespace sss::stress
