#pragma once
// What the tests of this module share: media by name, lit clouds, and exact integrals over patches.

#include "sss/base/sampler.h"
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/octree.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/cloud/surface_strata.h"
#include "sss/medium/measured_media.h"
#include "sss/medium/profile.h"

#include <array>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace sss::testing {

/// A medium and its profiles, one a channel.
struct Optics {
    Medium medium;
    std::array<std::unique_ptr<Profile>, 3> profiles;

    /// `slabPerMfp`: thickness of the slab in smallest mean free paths, for profiles that need one.
    explicit Optics(std::string_view mediumName, std::string_view profile = "dipole",
                    double slabPerMfp = 0)
        : Optics(toMedium(*findMeasuredMedium(mediumName)), profile, slabPerMfp) {}
    explicit Optics(const Medium& m, std::string_view profile = "dipole", double slabPerMfp = 0)
        : medium(m) {
        ProfileOptions options;
        if (slabPerMfp > 0) options.slabThicknessMm = slabPerMfp * smallestMfp();
        for (int c = 0; c < 3; ++c)
            profiles[static_cast<std::size_t>(c)] =
                makeProfile(profile, medium.channel(c), options);
    }
    const Profile& profile(int c) const { return *profiles[static_cast<std::size_t>(c)]; }
    std::array<const Profile*, 3> pointers() const {
        return {profiles[0].get(), profiles[1].get(), profiles[2].get()};
    }
    double smallestMfp() const { return medium.smallestMeanFreePathMm(); }
};

using Light = std::function<Rgb(const Vec3&)>;  ///< transmitted irradiance at a place

inline Rgb white(const Vec3& /*place*/) { return Rgb(1.0f); }
/// Across a terminator, with a little colour to it.
inline Rgb fromOneSide(const Vec3& p) {
    return Rgb(1.0f, 0.8f, 0.5f) * std::max(0.0f, glm::normalize(p).x);
}
inline Rgb halfPlane(const Vec3& p) { return Rgb(p.x > 0 ? 1.0f : 0.0f); }

/// Points on a mesh, each with the mean irradiance of its cell as in pass 1, and their octree.
struct LitCloud {
    SurfaceSamples samples;
    std::vector<Rgb> irradiance;
    std::vector<OctreeNode> nodes;
    double spacingMm;

    LitCloud(const TriangleMesh& mesh, double spacing, const Light& light, std::uint64_t seed = 1)
        : samples(sampleSurface(mesh, {.spacingMm = spacing, .seed = seed})), spacingMm(spacing) {
        constexpr std::uint32_t kPlaces = 64;
        for (std::size_t p = 0; p < samples.size(); ++p) {
            DRgb sum{0};
            for (std::uint32_t k = 0; k < kPlaces; ++k) {
                Sampler sampler(p, k);
                const SurfacePlace place = samples.cells.placeIn(p, sampler.next2D());
                sum += DRgb(light(Vec3(mesh.positionAt(place.face, DVec2(place.barycentrics)))));
            }
            irradiance.push_back(Rgb(sum / double{kPlaces}));
        }
        nodes = buildOctree(view());
    }
    CloudView view() const { return {samples.points, irradiance}; }
    KernelTable table(const Optics& optics, double reachMm) const {
        return {optics.pointers(), reachMm, spacingMm / std::sqrt(kPi)};
    }
};

/// `count` random places on a mesh by area, in Morton order: neighbours stand together.
inline std::vector<Vec3> placesOn(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    const SurfaceStrata strata = makeStrata(mesh, count, seed);
    std::vector<Vec3> sorted;
    for (const std::uint32_t i : mortonOrder(strata.positions))
        sorted.push_back(strata.positions[i]);
    return sorted;
}

/// How far answers lie from the truth, relative, against a tolerance.
class Deviations {
public:
    explicit Deviations(double tolerance) : tolerance_(tolerance) {}
    void add(const Rgb& answer, const DRgb& truth) {
        double worst = 0;
        for (int c = 0; c < 3; ++c) {
            if (truth[c] < 1e-25) continue;  // near the end of single precision
            const double relative = static_cast<double>(answer[c]) / truth[c] - 1;
            sum_[c] += relative;
            worst = std::max(worst, std::abs(relative));
        }
        largest_ = std::max(largest_, worst);
        outside_ += worst > tolerance_;
        ++count_;
    }
    double largest() const { return largest_; }
    double shareOutside() const { return outside_ / count_; }
    /// Largest over channels of |mean deviation|.
    double bias() const { return maxComponent(glm::abs(sum_)) / count_; }

private:
    double tolerance_;
    DRgb sum_{0};
    double largest_ = 0, outside_ = 0, count_ = 0;
};

/// Sums at receivers one by one or in groups of `group` neighbours in their order.
inline std::vector<Rgb> sumAt(const DiffusionSum& sum, std::span<const Vec3> receivers,
                              double tolerance, std::size_t group) {
    std::vector<Rgb> out(receivers.size());
    DiffusionSum::Scratch scratch;
    SumCounts counts;
    for (std::size_t i = 0; i < receivers.size(); i += group) {
        const std::size_t n = std::min(group, receivers.size() - i);
        sum.evaluate(receivers.subspan(i, n), tolerance, std::span(out).subspan(i, n), scratch,
                     counts);
    }
    return out;
}

/// Integral over directions phi of (1 / 2 pi) f(distance to the edge along phi): what a plane patch
/// sends to a place on it if f is cum(a) = total - tail(a), or what it lacks if f is tail(a).
inline double overDirections(const std::function<double(double)>& f) {
    constexpr int kSteps = 720;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += f((i + 0.5) / kSteps * 2.0 * kPi);
    return sum / kSteps;
}

/// From a place at `rho` inside a circle of radius `a` to the circle, along angle `phi`.
inline double toCircle(double a, double rho, double phi) {
    const double c = rho * std::cos(phi), s = rho * std::sin(phi);
    return std::sqrt(a * a - s * s) - c;
}

}  // namespace sss::testing
