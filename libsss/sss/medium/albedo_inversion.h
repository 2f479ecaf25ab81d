#pragma once
#include "sss/medium/profile.h"

#include <string_view>

namespace sss {

/// Which length an artist's radius is.
enum class RadiusKind {
    VolumeMfp,     ///< 1/sigma_t, whatever g is: OpenPBR, Principled, Standard Surface
    TransportMfp,  ///< 1/sigma'_t
    DiffuseMfp,    ///< 1/sigma_tr, as in Jensen & Buhler 2002
};

/// What an artist asks of one channel.
struct DiffuseLook {
    double color = 0.8;   ///< diffuse albedo per transmitted flux, in [0, 1]
    double radiusMm = 1;  ///< > 0
    RadiusKind radiusKind = RadiusKind::TransportMfp;
    double g = 0;
    double eta = 1.3;
};

/// 1 - alpha' at which the total of the profile called `profile` is `color`, by bracketing in
/// log((1 - alpha')/alpha') to 1e-12 of the color; 1 for color 0, 0 where color is the total
/// without absorption. "normalized_diffusion..." is inverted through the classic dipole's total,
/// "multipole..." as a slab of options.slabThicknessMm and a transport mean free path near 1 mm,
/// lit face. Throws Error{BadInput} if the color is outside [0, 1] or above what the profile
/// reaches without absorption. That is 1 but for a slab, which lets light through, and for
/// "photon_beam", which leaves light scattered once to others: 0.96 at eta = 1.3, 0.97 at 1.5.
double invertReducedAbsorption(std::string_view profile, double color, double g, double eta,
                               const ProfileOptions& options = {});

/// Coefficients in mm^-1 for which the profile returns the color, with the radius asked for; for a
/// slab those for which the lit face of its own thickness does. Throws as above, and for color 1 by
/// diffuse mean free path (it would have to be infinite).
ChannelMedium invertAlbedo(std::string_view profile, const DiffuseLook& look,
                           const ProfileOptions& options = {});

/// Subsurface parameters of OpenPBR 1.1 (defaults are the specification's). The mean free path of a
/// channel is subsurface_radius * subsurface_radius_scale.
struct OpenPbrSubsurface {
    DRgb color{0.8};                   ///< subsurface_color
    double radius = 1;                 ///< subsurface_radius, scene units
    DRgb radiusScale{1.0, 0.5, 0.25};  ///< subsurface_radius_scale
    double anisotropy = 0;             ///< subsurface_scatter_anisotropy, in (-1, 1)
    double ior = 1.5;                  ///< specular_ior
    double roughness = 0.3;            ///< specular_roughness, of the boundary
};

/// Subsurface parameters of the Principled shader (defaults are Blender 4's). The mean free path of
/// a channel is subsurface_scale * subsurface_radius.
struct PrincipledSubsurface {
    DRgb baseColor{0.8};
    DRgb radius{1.0, 0.2, 0.1};  ///< subsurface_radius
    double scale = 0.005;        ///< subsurface_scale, scene units
    double anisotropy = 0;       ///< subsurface_anisotropy, in (-1, 1)
    double ior = 1.4;            ///< subsurface_ior
    double roughness = 0.5;      ///< roughness, of the boundary
};

/// As media whose totals are the colors asked for, by the profile that will render them.
/// `mmPerUnit` is the length of a scene unit. Throw as invertAlbedo.
Medium mediumFromOpenPbr(const OpenPbrSubsurface& parameters, double mmPerUnit,
                         std::string_view profile = "dipole", const ProfileOptions& options = {});
Medium mediumFromPrincipled(const PrincipledSubsurface& parameters, double mmPerUnit,
                            std::string_view profile = "dipole",
                            const ProfileOptions& options = {});

/// OpenPBR's own single-scattering albedo of a color, for an index-matched boundary (the inverse of
/// van de Hulst's approximation); for comparison with the inversion above.
double openPbrAlbedo(double color, double g);

}  // namespace sss
