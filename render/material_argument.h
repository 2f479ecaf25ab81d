#pragma once
#include "sss/medium/medium.h"
#include "sss/medium/profile.h"

#include <optional>
#include <string>
#include <vector>

/// What `sss-render --profile` was asked for.
struct ProfileRequest {
    std::string material;  ///< empty = not asked
    std::string model;     ///< empty = the scene material's, or the classic dipole
    std::optional<sss::BoundaryModel> boundary;
    std::optional<double> thicknessMm;
    std::vector<double> radiiMm;  ///< empty = chosen by mean free path
    bool csv = false;
};

/// A medium and how its profile is to be made.
struct ProfileSubject {
    std::string source;  ///< where the coefficients come from, for people
    sss::Medium medium;
    std::string model;
    sss::ProfileOptions options;
};

/// The material that the request names: a measured medium, a material of a scene file as FILE:NAME,
/// or numbers as "sigma_a=0.004,sigma_s_prime=2.6,eta=1.5". `metersPerUnit` replaces the scene
/// file's. Throws sss::Error{Usage} for what the command line says wrongly, as readScene for the
/// file.
ProfileSubject readSubject(const ProfileRequest& request, std::optional<double> metersPerUnit);
