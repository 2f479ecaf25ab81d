#pragma once
#include "sss/image/image.h"

#include <cstddef>
#include <span>

namespace sss {

/// How far a picture is from a reference, each figure over the mean of the reference, so that
/// pictures of any brightness compare. All are NaN if a value compared is.
struct ImageDifference {
    double relativeRmse = 0;   ///< RMSE over pixels and channels / mean of the reference
    double bias = 0;           ///< mean of (picture - reference) / mean of the reference
    double maximum = 0;        ///< largest |picture - reference| / mean of the reference
    double referenceMean = 0;  ///< over what is compared
    std::size_t pixels = 0;    ///< compared
};

/// Compares all channels but alpha over the pixels where `mask`'s first channel is > 0 (nullptr =
/// everywhere). Zero where nothing is compared or the layers are equal; infinite against a
/// reference whose mean is 0. Throws Error{BadInput} if sizes or channels differ.
ImageDifference compareLayers(const ImageLayer& picture, const ImageLayer& reference,
                              const ImageLayer* mask = nullptr);

/// A mean, and its standard error by the spread of independent values: NaN for a single one.
struct MeanAndError {
    double mean = 0, error = 0;
};
/// At least one value.
MeanAndError meanOver(std::span<const double> values);

}  // namespace sss
