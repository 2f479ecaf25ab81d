#include "sss/base/error.h"
#include "sss/base/near_name.h"
#include "sss/medium/better_dipole.h"
#include "sss/medium/dipole.h"
#include "sss/medium/multipole.h"
#include "sss/medium/normalized_diffusion.h"
#include "sss/medium/photon_beam.h"
#include "sss/medium/profile.h"
#include "sss/medium/tabulated.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace sss {
namespace {

using Medium1 = const ChannelMedium&;
using Options = const ProfileOptions&;
using Made = std::unique_ptr<Profile>;

/// A length whose powers profiles can compute with.
bool isUsable(double lengthMm) { return lengthMm >= 1e-50 && lengthMm <= 1e50; }

void checkMeanFreePath(Medium1 medium) {
    if (medium.sigmaTPrime() == 0 || isUsable(medium.meanFreePathMm())) return;
    throw Error(ErrorKind::BadInput, "profile",
                fmt::format("a transport mean free path of {:.3g} mm is beyond what profiles "
                            "compute with, 1e-50 to 1e50 mm",
                            medium.meanFreePathMm()),
                "coefficients are in mm^-1: check their unit");
}

Made makeDipole(Medium1 medium, Options options) {
    return std::make_unique<Dipole>(medium, options.boundary);
}
Made makeBetterDipole(Medium1 medium, Options options) {
    return std::make_unique<BetterDipole>(medium, options.boundary);
}
template <NormalizedFit fit>
Made makeNormalizedDiffusion(Medium1 medium, Options options) {
    return std::make_unique<NormalizedDiffusion>(fit, medium, options);
}

template <Multipole::Face face>
Made makeMultipole(Medium1 medium, Options options) {
    if (!options.slabThicknessMm || !(*options.slabThicknessMm > 0)) {
        throw Error(ErrorKind::BadInput, "multipole",
                    "the profile of a slab needs the slab's thickness, above 0 mm",
                    "state the thickness, or take \"dipole\" for a thick object");
    }
    if (!isUsable(*options.slabThicknessMm)) {
        throw Error(ErrorKind::BadInput, "multipole",
                    fmt::format("a thickness of {:.3g} mm is beyond what profiles compute with, "
                                "1e-50 to 1e50 mm",
                                *options.slabThicknessMm));
    }
    return std::make_unique<Multipole>(medium, *options.slabThicknessMm, face, options.boundary);
}
template <PhotonBeam::Part part>
Made makePhotonBeam(Medium1 medium, Options options) {
    return std::make_unique<PhotonBeam>(medium, part, options);
}

Made makeTabulated(Medium1 medium, Options options) {
    return std::make_unique<Tabulated>(medium, options);
}

constexpr std::array kKinds{
    ProfileKind{"dipole", "classic dipole (Jensen et al. 2001)", makeDipole},
    ProfileKind{"better_dipole", "Grosjean diffusion, consistent boundary (d'Eon 2012)",
                makeBetterDipole},
    ProfileKind{"normalized_diffusion",
                "two exponentials fitted to Monte Carlo, diffuse light, by mean free path "
                "(Christensen & Burley 2015)",
                makeNormalizedDiffusion<NormalizedFit::IdealDiffuse>},
    ProfileKind{"normalized_diffusion_perpendicular",
                "the same, perpendicular light, by mean free path",
                makeNormalizedDiffusion<NormalizedFit::Perpendicular>},
    ProfileKind{"normalized_diffusion_dmfp",
                "the same, perpendicular light, by diffuse mean free path (needs absorption)",
                makeNormalizedDiffusion<NormalizedFit::DiffuseMfp>},
    ProfileKind{"multipole", "slab of stated thickness, reflected light (Donner & Jensen 2005)",
                makeMultipole<Multipole::Face::Lit>},
    ProfileKind{"multipole_transmittance", "the same slab, light through to the far face",
                makeMultipole<Multipole::Face::Far>},
    ProfileKind{"photon_beam",
                "diffused light of a beam along the normal (Habel et al. 2013, converged)",
                makePhotonBeam<PhotonBeam::Part::Multiple>},
    ProfileKind{"photon_beam_single", "light of that beam scattered exactly once",
                makePhotonBeam<PhotonBeam::Part::Single>},
    ProfileKind{"tabulated", "Monte Carlo of the half-space itself, once per medium, kept on disk",
                makeTabulated},
};

}  // namespace

std::span<const ProfileKind> profileTable() { return kKinds; }

std::unique_ptr<Profile> makeProfile(std::string_view name, const ChannelMedium& medium,
                                     const ProfileOptions& options) {
    checkMeanFreePath(medium);
    std::vector<std::string_view> names;
    for (const ProfileKind& kind : kKinds) {
        if (kind.name == name) return kind.make(medium, options);
        names.push_back(kind.name);
    }
    throw Error(ErrorKind::BadInput, "profile",
                fmt::format("there is no diffusion profile called \"{}\"", name),
                nameHint(name, names));
}

}  // namespace sss
