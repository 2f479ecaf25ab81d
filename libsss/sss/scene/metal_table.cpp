#include "sss/scene/metal_table.h"

namespace sss {
namespace {

// Measured at room temperature, linearly interpolated to 630, 550 and 450 nm. Gold, silver, copper:
// Johnson & Christy, Phys. Rev. B 6, 4370 (1972); chromium, iron: the same, Phys. Rev. B 9, 5056
// (1974); aluminium: McPeak et al., ACS Photonics 2, 326 (2015). Tables as in the public domain
// database refractiveindex.info.
constexpr MetalKind kMetals[] = {
    {"aluminium", {1.136f, 0.789f, 0.489f}, {6.663f, 5.852f, 4.778f}},
    {"chromium", {3.145f, 3.181f, 2.323f}, {3.312f, 3.329f, 3.135f}},
    {"copper", {0.275f, 1.007f, 1.240f}, {3.373f, 2.582f, 2.393f}},
    {"gold", {0.188f, 0.424f, 1.383f}, {3.403f, 2.472f, 1.915f}},
    {"iron", {2.892f, 2.950f, 2.584f}, {3.065f, 2.932f, 2.767f}},
    {"silver", {0.057f, 0.060f, 0.040f}, {4.254f, 3.597f, 2.648f}},
};

}  // namespace

std::span<const MetalKind> metalTable() { return kMetals; }

}  // namespace sss
