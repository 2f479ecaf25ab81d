#pragma once
#include "sss/medium/profile.h"

#include <array>

namespace sss {

/// The multipole of a slab with equal boundaries on both faces [DJ05], lit on one face: R_d where
/// the light enters or T on the far face. Exact sums: images with the remainder integrated in
/// closed form near the source, the modes of the slab (Bessel K) far from it.
///
/// The paper puts the source one mean free path deep, which in a thinner slab is outside, and R or
/// T may be negative. With the exact boundary the source then lies in the slab's middle, and
/// nothing is below 0 (on the far face, where the limit would put it, it would be a point of
/// light); BoundaryModel::Polynomial keeps the paper's word.
class Multipole final : public Profile {
public:
    enum class Face { Lit, Far };

    Multipole(const ChannelMedium& medium, double thicknessMm, Face face,
              BoundaryModel boundary = BoundaryModel::Exact);
    using Profile::reflectance;
    /// R_d (Face::Lit) or T (Face::Far) at the distance `rMm` along the face, mm^-2.
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override;
    double halfSpaceTotal() const override { return halfSpaceTotal_; }
    void reflectance(std::span<const float> rMm, std::span<float> out) const override {
        // The table stores logarithms, and the paper's own values may be negative.
        literal_ ? Profile::reflectance(rMm, out) : reflectanceByTable(rMm, out);
    }

private:
    double imageSum(double r) const;
    double imageCumulative(double a) const;
    double modeSum(double r) const;
    double modeTail(double a) const;
    bool isFar(double r) const;
    double modeWeight(int n) const;

    // In transport mean free paths.
    double sigmaTPrime_;  ///< mm^-1
    double reducedAlbedo_;
    double sigmaTr_;
    double period_;         ///< L, the slab with both extrapolated boundaries
    double extrapolation_;  ///< z_b = 2 A D
    double sourceDepth_;
    Face face_;
    double halfSpaceTotal_;  ///< the dipole's
    bool literal_;           ///< the paper's source depth and signs
    /// Signed heights of the image series: sum over i of f(2 i L + first) - f(2 i L + second).
    double first_, second_;
};

}  // namespace sss
