#pragma once
#include "sss/base/vec.h"
#include "sss/integrate/body_optics.h"
#include "sss/optics/microfacet.h"
#include "sss/world/world.h"

namespace sss {

/// Local scattering at a surface point, in world directions away from the surface: everything that
/// needs no other place. What a translucent body sends out from within is not part of it, but for
/// the limit of short mean free paths, in which it is local by definition.
class Bsdf {
public:
    enum class BodyShading {
        Surface,        ///< a translucent body shows its reflection only
        DiffuseLimit,   ///< ... or only the diffuse limit of what comes from within
        ScatteredOnce,  ///< ... or only what a half-space sends back after one scattering
        Lambertian,     ///< ... or is a Lambertian surface with the reflectance of that limit
    };
    Bsdf(const World& world, const SurfaceHit& hit, const Vec3& wo, const BodyOptics* optics,
         BodyShading shading);

    /// Makes a glossy lobe at least as wide as roughness 0.5, as seen by light that has already
    /// been scattered widely: the few paths that would carry a sharp reflection of a lamp from
    /// there are what white dots are made of. Costs sharpness of such caustics, not their energy.
    void roughenForIndirect();

    struct Sample {
        Vec3 wi{};
        Rgb weight{0.0f};  ///< f cos / pdf
        float pdf = 0;     ///< sr^-1; 0 = absorbed
        bool isDelta = false;
    };
    Sample sample(const Vec2& u) const;
    struct Value {
        Rgb value{0.0f};  ///< f(wo, wi) x |cos|; 0 for a mirror
        float pdf = 0;    ///< of sample(), sr^-1
    };
    Value evaluate(const Vec3& wi) const;
    /// Whether light sampling can contribute.
    bool hasSmoothPart() const;
    bool isBlack() const { return kind_ == Kind::Black; }

    /// Unit normals on the side of wo.
    const Vec3& geometricNormal() const { return geometricNormal_; }
    const Vec3& shadingNormal() const { return frame_.normal; }
    float cosOutgoing() const { return woLocal_.z; }
    /// Hemispherical reflectance for the albedo layer; approximate for glossy kinds.
    Rgb albedo() const { return albedo_; }

private:
    enum class Kind { Black, Diffuse, DiffuseLimit, ScatteredOnce, Conductor, Coat };
    bool isWide() const;
    Rgb wideValue(const Vec3& wiLocal) const;

    Kind kind_ = Kind::Black;
    Vec3 geometricNormal_;
    Frame frame_;
    Vec3 woLocal_;
    Rgb albedo_{0.0f};
    Ggx ggx_{0.0f};
    ConductorIndex index_;
    const BodyOptics* optics_;
};

}  // namespace sss
