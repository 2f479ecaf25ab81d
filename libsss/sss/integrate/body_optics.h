#pragma once
#include "sss/medium/profile.h"
#include "sss/optics/fresnel_moments.h"
#include "sss/world/world.h"

#include <array>
#include <memory>
#include <optional>

namespace sss {

/// Those that the material's boundary model takes.
FresnelMoments momentsFor(const TranslucentMaterial& material);

/// What light transport needs to know of a body's material, computed once.
struct BodyOptics {
    explicit BodyOptics(const TranslucentMaterial& material, bool solvesShape = false);

    const TranslucentMaterial& material;
    /// Channels of equal coefficients share one profile, and whatever is made from it once.
    std::array<std::shared_ptr<const Profile>, 3> profiles;
    float eta = 1;
    /// T: cosine-weighted mean of F_t over the hemisphere. M F_t(w_o) / (pi T) is radiance of
    /// exitance M exactly.
    float transmittance = 1;
    /// By which the diffusion sum is scaled before it leaves, so that light scattered once is not
    /// counted again by single scattering (medium/energy.h); 1 without single scattering.
    Rgb multipleScale{1.0f};
    /// Whether diffusion is solved on the body's shape: then it leaves out by itself, place by
    /// place, what is scattered once, and is not scaled.
    bool onShape = false;
    /// Whether enough light goes straight through to be looked for (shapeSolution()).
    bool seesThrough = false;
    /// DiffusionConstants::fading, mm^-1, where diffusion is solved on the shape.
    Rgb fading{0.0f};
    /// By which it is scaled where it is seen at second hand and nobody looks for single
    /// scattering.
    Rgb indirectScale{1.0f};
    /// Share of the camera samples that look for single scattering (weighted up accordingly): a
    /// quarter of them where it is a small part of what leaves, as it is at high albedo.
    float singleProbability = 1;
    /// Exitance per transmitted irradiance when mean free paths are short: the diffuse limit
    /// [JMLH01 section 2.4], single scattering included.
    Rgb diffuseAlbedo{0.0f};
    /// Whether pass 2 may show the body by that limit (findDiffuseLimits()): then it needs no
    /// points.
    bool inDiffuseLimit = false;
    /// mm into the body beyond which nothing scatters singly that anyone would notice; 0 where no
    /// channel scatters.
    float singleReachMm = 0;

    /// Sets seesThrough by the share of the entered light that leaves unscattered: not where that
    /// is less than a tenth of the tolerance, but where it is not known.
    void lookThroughIf(std::optional<double> unscatteredShare, double tolerance) {
        seesThrough = unscatteredShare.value_or(1.0) > 0.1 * tolerance;
    }

    std::array<const Profile*, 3> profilePointers() const {
        return {profiles[0].get(), profiles[1].get(), profiles[2].get()};
    }
    /// The first channel with the profile of this one.
    int firstLike(int channel) const;
    /// How many channels share the profile of an earlier one: 2 in a grey medium.
    int equalChannels() const;
    /// F_t(w) / (pi T) at a cosine: turns exitance into radiance.
    float radiancePerExitance(float cosine) const;
};

}  // namespace sss
