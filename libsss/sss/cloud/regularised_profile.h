#pragma once
#include "sss/medium/profile.h"

namespace sss {

/// A profile as the sum over samples sees it. A profile that grows without bound at r = 0 is
/// averaged over a sample's cell, so that the sum integrates the singularity over the sample's own
/// area: finite at 0, equal to the profile from 5 cell radii on, and with the profile's total (to
/// 1e-4), so that the sum converges to it as the spacing shrinks. In between, the average gives way
/// smoothly. Other profiles are left as they are.
///
/// The average's weight fades to the rim of a disk of 1.6 cell radii as (1 - rho^2 / R^2)^2. At its
/// middle the mean of 1/r is that over the cell's own disk of even weight; but it has no kink at
/// the rim, which a table of cubics could not follow, and sums between samples are half as far off.
class RegularisedProfile {
public:
    /// `profile` must outlive this.
    RegularisedProfile(const Profile& profile, double cellRadiusMm);
    /// mm^-2.
    double operator()(double rMm) const;
    /// Whether it is the same profile object as the other's.
    bool isSameAs(const RegularisedProfile& other) const { return &profile_ == &other.profile_; }

private:
    double average(double rMm) const;
    double weightOfCircle(double s, double rMm) const;
    double overCircles(double from, double to, double rMm, double without) const;

    const Profile& profile_;
    double a_, rim_;  // radii of the cell and of the disk of the average, mm
    bool isSingular_;
    double correction_ = 0;  // share that is left out at 0, less and less up to 5 cell radii, so
                             // that the total stays
};

}  // namespace sss
