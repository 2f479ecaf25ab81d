#include "sss/medium/energy.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"
#include "sss/medium/single_scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sss {

EnergyConvention energyConvention(std::string_view name) {
    constexpr std::array<std::string_view, 2> kNames{"consistent", "jensen"};
    if (name == kNames[0]) return EnergyConvention::Consistent;
    if (name == kNames[1]) return EnergyConvention::Jensen;
    throw Error(ErrorKind::BadInput, "energy",
                fmt::format("there is no energy convention called \"{}\"", name),
                nameHint(name, kNames));
}

double multipleScatterScale(const Profile& profile, const ChannelMedium& medium,
                            EnergyConvention convention, std::optional<double> shownTotal) {
    if (convention == EnergyConvention::Jensen) return 1;
    const double total = profile.halfSpaceTotal();
    if (!(total > 0)) return 0;
    const double all = shownTotal ? *shownTotal : halfSpaceTotals(medium).diffuse;
    const double once = singleScatterAlbedo(medium, Illumination::Diffuse);
    return std::max(all - once, 0.0) / total;
}

}  // namespace sss
