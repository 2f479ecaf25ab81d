#include "list_materials.h"

#include "channel_names.h"
#include "sss/base/json.h"
#include "sss/medium/dipole.h"
#include "sss/medium/measured_media.h"

#include <fmt/core.h>

#include <array>
#include <limits>

namespace {

using namespace sss;

std::vector<std::string> warningsOf(const Medium& medium) {
    // Of the medium alone: how large the object is, is not known here.
    return diffusionWarnings(medium, std::numeric_limits<double>::infinity());
}

JsonValue jsonOf(const DRgb& v) { return JsonValue::array().push(v.x).push(v.y).push(v.z); }

template <typename Quantity>
DRgb perChannel(const Medium& medium, const Quantity& quantity) {
    DRgb values;
    for (int c = 0; c < 3; ++c) values[c] = quantity(medium.channel(c));
    return values;
}
DRgb reducedScattering(const Medium& medium) {
    return perChannel(medium, [](const ChannelMedium& c) { return c.sigmaSPrime(); });
}
DRgb reducedAlbedo(const Medium& medium) {
    return perChannel(medium, [](const ChannelMedium& c) { return c.reducedAlbedo(); });
}
DRgb dipoleTotal(const Medium& medium) {
    return perChannel(medium, [](const ChannelMedium& c) { return Dipole(c).total(); });
}

JsonValue entryOf(const MeasuredMedium& measured) {
    const Medium medium = toMedium(measured);
    JsonValue entry = JsonValue::object();
    entry.set("name", measured.name)
        .set("paper", measured.source)
        .set("unit", "mm^-1")
        .set("sigmaSPrimePerMm", jsonOf(reducedScattering(medium)))
        .set("sigmaAPerMm", jsonOf(medium.sigmaA))
        .set("sigmaSPerMm", measured.hasScattering ? jsonOf(medium.sigmaS) : JsonValue())
        .set("g", measured.hasScattering ? jsonOf(medium.g) : JsonValue())
        .set("eta", measured.eta)
        .set("reducedAlbedo", jsonOf(reducedAlbedo(medium)))
        .set("dipoleTotal", jsonOf(dipoleTotal(medium)))
        .set("meanFreePathMm", jsonOf(medium.meanFreePathMm()));
    JsonValue warnings = JsonValue::array();
    for (const std::string& sentence : warningsOf(medium)) warnings.push(sentence);
    entry.set("warnings", warnings);
    return entry;
}

void printTable() {
    std::string out = fmt::format("{:<27} {:>8} {:>10} {:>7} {:>5} {:>8} {:>8} {:>9}\n", "medium",
                                  "sigma'_s", "sigma_a", "g", "eta", "albedo'", "dipole", "mfp");
    out += fmt::format("{:<27} {:>8} {:>10} {:>7} {:>5} {:>8} {:>8} {:>9}\n", "", "mm^-1", "mm^-1",
                       "", "", "", "total", "mm");
    std::string_view source;
    for (const MeasuredMedium& measured : measuredMedia()) {
        if (measured.source != source) out += fmt::format("\n{}\n\n", source = measured.source);
        const Medium medium = toMedium(measured);
        const DRgb reduced = reducedScattering(medium), albedo = reducedAlbedo(medium);
        const DRgb total = dipoleTotal(medium), path = medium.meanFreePathMm();
        for (int c = 0; c < 3; ++c) {
            // Where g was not measured there is nothing to say of it.
            const std::string g = measured.hasScattering ? fmt::format("{:.4g}", medium.g[c]) : "-";
            out += fmt::format(
                "{:<25} {} {:>8.5g} {:>10.5g} {:>7} {:>5} {:>8.4f} {:>8.4f} {:>9.4g}\n",
                c == 0 ? measured.name : "", kChannelNames[static_cast<std::size_t>(c)], reduced[c],
                medium.sigmaA[c], g, measured.eta, albedo[c], total[c], path[c]);
        }
        for (const std::string& sentence : warningsOf(medium)) out += "    ! " + sentence + "\n";
    }
    std::fwrite(out.data(), 1, out.size(), stdout);
}

}  // namespace

void listMaterials(bool json) {
    if (!json) return printTable();
    JsonValue list = JsonValue::array();
    for (const MeasuredMedium& measured : measuredMedia()) list.push(entryOf(measured));
    fmt::print("{}\n", dump(list));
}
