#pragma once
#include "material_argument.h"

/// Prints the profile asked for to stdout: '#' lines with model, source, coefficients, mean free
/// paths and totals, a header line, then one line a radius. Throws sss::Error for what cannot be
/// had.
void printProfile(const ProfileRequest& request, std::optional<double> metersPerUnit);
