#pragma once
#include "sss/medium/medium.h"

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sss {

/// How the diffuse Fresnel moments of the boundary are computed.
enum class BoundaryModel {
    Exact,       ///< closed form or quadrature; right at every eta
    Polynomial,  ///< the papers' fits; for reproducing their figures
};

/// How the half-space is lit for the Monte Carlo profile.
enum class Illumination {
    Normal,   ///< pencil beam along the normal, as in the searchlight problem
    Diffuse,  ///< Lambertian light from outside, refracted: what an irradiance cache holds
};

struct ProfileOptions {
    BoundaryModel boundary = BoundaryModel::Exact;
    std::optional<double> slabThicknessMm;  ///< multipole only
    /// normalized_diffusion only: its surface albedo A in [0, 1]; without, the classic dipole's
    /// total for the medium and the boundary above.
    std::optional<double> surfaceAlbedo;
    /// photon_beam only: 0 = converged quadrature, else that many exponential samples, as in
    /// [HCJ13] (100).
    int beamSamples = 0;
    /// tabulated only: 1 sigma of the total, relative. Default 0.003.
    double tabulatedError = 0.003;
    Illumination tabulatedIllumination = Illumination::Diffuse;
    /// tabulated only: where simulated profiles are kept; empty = defaultProfileCacheFolder().
    std::filesystem::path tabulatedCacheFolder;
};

class RadialEnvelope;
class RadialTable;

/// A radial diffusion profile of one channel: R_d(r), radiant exitance at distance r per unit
/// transmitted flux, mm^-2. Immutable and thread-safe. Everything is finite and >= 0 but for a
/// stated singularity at r = 0.
class Profile {
public:
    /// `scaleMm` is the length over which the profile varies, a mean free path; it places tables.
    explicit Profile(double scaleMm = 1);
    virtual ~Profile();
    Profile(const Profile&) = delete;
    Profile& operator=(const Profile&) = delete;

    /// R_d(r) in mm^-2, any finite r >= 0 in mm. +inf at r = 0 where singularAtZero().
    virtual double reflectance(double rMm) const = 0;
    /// Integral of 2 pi r R_d over r in [a, infinity); tail(0) = total().
    virtual double tail(double aMm) const = 0;
    /// Diffuse albedo R_tot in [0, 1].
    virtual double total() const = 0;
    /// The total that the same model has for the half-space: differs from total() for a slab only.
    virtual double halfSpaceTotal() const { return total(); }
    /// Whether R_d grows without bound (integrably, at most like 1/r) as r goes to 0.
    virtual bool singularAtZero() const { return false; }
    /// An upper bound of |d^order R_d / dr^order| over [r, infinity), mm^-(2 + order), order 1 to
    /// 3; within a few per cent of it. +inf at r = 0 where singular. The first call samples the
    /// profile some thousand times.
    virtual double derivativeBound(int order, double rMm) const;
    /// R_d for many radii in single precision, relative error at most 2e-6 (0 where R_d lies below
    /// what single precision holds).
    virtual void reflectance(std::span<const float> rMm, std::span<float> out) const;
    /// Integral of 2 pi r R_d over r in [0, rMm], finite also where R_d is not: total - tail, but
    /// by quadrature where that would cancel. 0 below 1e-200 mean free paths.
    double cumulative(double rMm) const;

    double scaleMm() const { return scaleMm_; }

protected:
    /// Batch evaluation through a table of log R_d, for profiles that cost more than 100 ns: built
    /// at the first call, relative error below 1e-6.
    void reflectanceByTable(std::span<const float> rMm, std::span<float> out) const;

private:
    double scaleMm_;
    mutable std::once_flag envelopeOnce_, tableOnce_;
    mutable std::unique_ptr<const RadialEnvelope> envelope_;
    mutable std::unique_ptr<const RadialTable> table_;
};

/// Row of the table of profiles: adding one costs a file and a row in profile_table.cpp.
struct ProfileKind {
    std::string_view name;
    std::string_view summary;  ///< one line with its source, for --help and error messages
    std::unique_ptr<Profile> (*make)(const ChannelMedium&, const ProfileOptions&);
};

/// All profiles, in the order in which they are listed to the user.
std::span<const ProfileKind> profileTable();

/// The profile called `name` for one channel. Throws Error{BadInput} naming the nearest name, the
/// option that the profile lacks, or a transport mean free path or thickness (mm) that is neither
/// 0, infinite nor between 1e-50 and 1e50.
std::unique_ptr<Profile> makeProfile(std::string_view name, const ChannelMedium& medium,
                                     const ProfileOptions& options = {});

}  // namespace sss
