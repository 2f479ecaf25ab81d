#pragma once
#include "sss/medium/medium.h"

#include <memory>
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

struct ProfileOptions {
    BoundaryModel boundary = BoundaryModel::Exact;
    std::optional<double> slabThicknessMm;  ///< multipole only
};

/// A radial diffusion profile of one channel: R_d(r), radiant exitance at distance r per unit
/// transmitted flux, mm^-2. Immutable and thread-safe. Everything is finite and >= 0 but for a
/// stated singularity at r = 0.
class Profile {
public:
    virtual ~Profile() = default;
    /// R_d(r) in mm^-2, r >= 0 in mm. +inf at r = 0 where singularAtZero().
    virtual double reflectance(double rMm) const = 0;
    /// Integral of 2 pi r R_d over r in [a, infinity); tail(0) = total().
    virtual double tail(double aMm) const = 0;
    /// Diffuse albedo R_tot in [0, 1].
    virtual double total() const = 0;
    /// Whether R_d grows like 1/r (integrable) as r goes to 0.
    virtual bool singularAtZero() const { return false; }
    /// R_d for many radii in single precision, relative error at most 2e-6.
    virtual void reflectance(std::span<const float> rMm, std::span<float> out) const;
};

/// Row of the table of profiles: adding one costs a file and a row in profile_table.cpp.
struct ProfileKind {
    std::string_view name;
    std::string_view summary;  ///< one line with its source, for --help and error messages
    std::unique_ptr<Profile> (*make)(const ChannelMedium&, const ProfileOptions&);
};

/// All profiles, in the order in which they are listed to the user.
std::span<const ProfileKind> profileTable();

/// The profile called `name` for one channel. Throws Error{BadInput} naming the nearest name.
std::unique_ptr<Profile> makeProfile(std::string_view name, const ChannelMedium& medium,
                                     const ProfileOptions& options = {});

}  // namespace sss
