#pragma once
#include "sss/medium/profile.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sss {

/// One published measurement; coefficients in mm^-1, channels red, green, blue.
struct MeasuredMedium {
    std::string_view name;
    std::string_view source;            ///< the paper, and how its numbers became these
    std::array<double, 3> sigmaSPrime;  ///< reduced scattering
    std::array<double, 3> sigmaA;       ///< absorption
    double eta;
    bool hasScattering;            ///< whether sigmaS and g were measured
    std::array<double, 3> sigmaS;  ///< scattering; 0 unless hasScattering
    std::array<double, 3> g;
};

/// The 12 media of [JMLH01] and the 35 of [NGR*06], in the order of the papers' tables.
std::span<const MeasuredMedium> measuredMedia();

/// By name, ignoring case, blanks, '_' and '-'; nullptr if there is none.
const MeasuredMedium* findMeasuredMedium(std::string_view name);

/// As a medium to render: with the measured sigma_s and g, or else with g = 0 and
/// sigma_s = sigma'_s.
Medium toMedium(const MeasuredMedium& measured);

/// Why diffusion is out of its reach for this medium in an object of this size (its shortest
/// extent, mm) with this boundary, one sentence a reason; empty if it is not.
std::vector<std::string> diffusionWarnings(const Medium& medium, double objectSizeMm,
                                           BoundaryModel boundary = BoundaryModel::Exact);

}  // namespace sss
