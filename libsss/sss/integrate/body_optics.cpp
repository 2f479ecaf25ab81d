#include "sss/integrate/body_optics.h"

#include "sss/medium/energy.h"
#include "sss/optics/fresnel.h"
#include "sss/shape/diffusion_constants.h"

#include <algorithm>

namespace sss {
namespace {

// Above this reduced albedo single scattering is less than a sixth of what leaves a half-space.
constexpr double kHighAlbedo = 0.9;
// Optical depth that a millionth of the light passes.
constexpr double kUnnoticedDepth = 14;

// How far single scattering reaches in the medium's clearest channel.
double singleReach(const Medium& medium) {
    double reach = 0;
    for (int c = 0; c < 3; ++c)
        if (medium.sigmaS[c] > 0)
            reach = std::max(reach, kUnnoticedDepth / medium.channel(c).sigmaT());
    return reach;
}

}  // namespace

FresnelMoments momentsFor(const TranslucentMaterial& material) {
    return material.profileOptions.boundary == BoundaryModel::Exact
               ? exactFresnelMoments(material.medium.eta)
               : polynomialFresnelMoments(material.medium.eta);
}

BodyOptics::BodyOptics(const TranslucentMaterial& translucent, bool solvesShape)
    : material(translucent), onShape(solvesShape) {
    eta = static_cast<float>(translucent.medium.eta);
    transmittance = static_cast<float>(hemisphericalTransmittance(translucent.medium.eta));
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = translucent.medium.channel(c);
        auto& profile = profiles[static_cast<std::size_t>(c)];
        for (int earlier = 0; earlier < c && !profile; ++earlier)
            if (translucent.medium.channel(earlier) == channel)
                profile = profiles[static_cast<std::size_t>(earlier)];
        if (!profile)
            profile = makeProfile(translucent.profile, channel, translucent.profileOptions);
        diffuseAlbedo[c] = static_cast<float>(profile->total());
        if (!translucent.singleScattering) continue;
        const int first = firstLike(c);
        std::optional<double> shown;
        // A slab's color is its own; the factor is that of the half-space.
        const bool isSlab = translucent.profileOptions.slabThicknessMm.has_value();
        if (translucent.diffuseColor && !isSlab) shown = (*translucent.diffuseColor)[c];
        if (first < c && (!shown || *shown == (*translucent.diffuseColor)[first])) {
            multipleScale[c] = multipleScale[first];
            continue;
        }
        multipleScale[c] =
            static_cast<float>(multipleScatterScale(*profile, channel, translucent.energy, shown));
    }
    if (onShape) {
        // Of the half-space, about: what it would be scaled by is what is left of it.
        indirectScale = 1.0f / glm::max(multipleScale, Rgb(1e-3f));
        multipleScale = Rgb(1);
        fading = Rgb(diffusionConstants(translucent.medium, momentsFor(translucent)).fading);
    }
    singleReachMm = static_cast<float>(singleReach(translucent.medium));
    double lowestAlbedo = 1;
    for (int c = 0; c < 3; ++c)
        lowestAlbedo = std::min(lowestAlbedo, translucent.medium.channel(c).reducedAlbedo());
    if (lowestAlbedo > kHighAlbedo) singleProbability = 0.25f;
}

int BodyOptics::firstLike(int channel) const {
    int first = 0;
    while (profiles[static_cast<std::size_t>(first)] != profiles[static_cast<std::size_t>(channel)])
        ++first;
    return first;
}

int BodyOptics::equalChannels() const { return int{firstLike(1) < 1} + int{firstLike(2) < 2}; }

float BodyOptics::radiancePerExitance(float cosine) const {
    return (1.0f - fresnelReflectance(cosine, eta)) / (kPiF * transmittance);
}

}  // namespace sss
