#pragma once
#include "numbers/report.h"
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"
#include "unit/cloud/cloud_tools.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace sss::stress {

/// A cloud that no surface would give, in the octree's order.
struct HardCloud {
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;
    std::vector<OctreeNode> nodes;

    /// In any order: sorted here.
    HardCloud(std::vector<SurfacePoint> points, std::vector<Rgb> irradiance);
    CloudView view() const { return {points, irradiance}; }
    HardCloud shuffled(std::uint64_t seed) const;
    /// `factor` in length; areas follow.
    HardCloud scaled(float factor) const;
};

/// Where points lie, in mm, within some 10 mm of the origin; areas 0.6 to 1.4 mm^2.
struct Arrangement {
    std::string_view name;
    Vec3 (*place)(std::uint32_t index, std::uint32_t count);
};
std::span<const Arrangement> arrangements();

/// What enters at each.
struct Lighting {
    std::string_view name;
    Rgb (*irradiance)(std::uint32_t index, std::uint32_t count);
};
std::span<const Lighting> lightings();

HardCloud makeCloud(const Arrangement& where, const Lighting& light, std::uint32_t count);

/// On points, between them, near and far.
std::vector<Vec3> receiversFor(const HardCloud& cloud, std::size_t count);

/// What diffusion does in a medium, and the table of it for clouds of arrangements().
struct HardOptics {
    std::string name;
    testing::Optics optics;
    KernelTable table;

    /// `unit`: mm of the optics' unit of length, which clouds are scaled by as well.
    HardOptics(std::string name, const Medium& medium, std::string_view profile, double unit = 1);
    double cellRadiusMm() const { return cellRadiusMm_; }
    HardOptics inUnit(double unit) const;

private:
    std::string_view profile_;
    double cellRadiusMm_;
};
/// Measured and made media, from no absorption to hardly any scattering, under all profiles; in
/// brief without the costly ones, photon beams.
std::span<const HardOptics> hardOptics(Scope scope);

/// Sum over all points in double, by the profiles themselves rather than by the sum's table: by
/// what a sample's cell makes of them where they are singular (RegularisedProfile).
DRgb sumByProfiles(const HardCloud& cloud, const testing::Optics& optics, double cellRadiusMm,
                   const Vec3& receiver);

/// The sum as pass 2 takes it, all receivers in one group.
std::vector<Rgb> sumByTree(const HardCloud& cloud, const KernelTable& table,
                           std::span<const Vec3> receivers, double tolerance);

}  // namespace sss::stress
