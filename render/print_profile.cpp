#include "print_profile.h"

#include "channel_names.h"
#include "sss/base/error.h"
#include "sss/base/near_name.h"
#include "sss/medium/half_space.h"
#include "sss/medium/measured_media.h"
#include "sss/medium/tabulated.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace {

using namespace sss;

using Profiles = std::array<std::shared_ptr<const Profile>, 3>;
constexpr int kStepsPerDecade = 20;
// 17 significant digits read back as the same double; the width fits a negative exponent of three.
constexpr int kColumn = 25;

std::string number(double value) { return fmt::format("{:.16e}", value); }
std::string triple(const DRgb& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

const ProfileKind& kindOf(const std::string& model) {
    std::vector<std::string_view> names;
    for (const ProfileKind& kind : profileTable()) {
        if (kind.name == model) return kind;
        names.push_back(kind.name);
    }
    throw Error(ErrorKind::Usage, "--model",
                fmt::format("there is no diffusion profile called {}", inQuotes(model)),
                nameHint(model, names));
}

void checkThickness(const ProfileSubject& subject) {
    const bool slab = subject.model.starts_with("multipole");
    const bool given = subject.options.slabThicknessMm.has_value();
    if (slab == given) return;
    throw Error(
        ErrorKind::Usage, "--thickness",
        slab ? fmt::format("\"{}\" is the profile of a slab", subject.model)
             : fmt::format("\"{}\" is the profile of a half-space", subject.model),
        slab ? "say how thick it is: --thickness MM" : "leave it out, or take --model multipole");
}

Profiles makeProfiles(const ProfileSubject& subject) {
    Profiles profiles;
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = subject.medium.channel(c);
        if (!(channel.sigmaT() > 0))
            throw Error(ErrorKind::BadInput, subject.source,
                        fmt::format("channel {} neither absorbs nor scatters",
                                    kChannelNames[static_cast<std::size_t>(c)]),
                        "a profile needs some scattering or absorption");
        auto& profile = profiles[static_cast<std::size_t>(c)];
        // A simulated profile costs seconds: equal channels share it.
        if (c > 0 && channel == subject.medium.channel(c - 1))
            profile = profiles[static_cast<std::size_t>(c - 1)];
        else
            profile = makeProfile(subject.model, channel, subject.options);
    }
    return profiles;
}

std::vector<double> radiiOf(const ProfileRequest& request, const Medium& medium) {
    if (!request.radiiMm.empty()) return request.radiiMm;
    const DRgb paths = medium.meanFreePathMm();
    const double first = 1e-3 * minComponent(paths), last = 1e2 * maxComponent(paths);
    const int steps =
        static_cast<int>(std::ceil(std::log10(last / first) * kStepsPerDecade - 1e-9));
    std::vector<double> radii;
    for (int i = 0; i <= steps; ++i)
        radii.push_back(first * std::pow(last / first, static_cast<double>(i) / steps));
    return radii;
}

struct SimulatedTotals {
    DRgb total, error;
};

/// What the simulations themselves found, if these are simulated profiles.
std::optional<SimulatedTotals> simulatedTotals(const Profiles& profiles) {
    SimulatedTotals found;
    for (int c = 0; c < 3; ++c) {
        const auto* tabulated =
            dynamic_cast<const Tabulated*>(profiles[static_cast<std::size_t>(c)].get());
        if (tabulated == nullptr) return std::nullopt;
        found.total[c] = tabulated->simulatedTotal();
        found.error[c] = tabulated->simulatedError();
    }
    return found;
}

void printHead(const ProfileSubject& subject, const Profiles& profiles) {
    const Medium& m = subject.medium;
    std::string head;
    const auto line = [&](const std::string& text) { head += "# " + text + "\n"; };
    line(fmt::format("model {}: {}", subject.model, kindOf(subject.model).summary));
    line("source " + subject.source);
    line(fmt::format("boundary {}",
                     subject.options.boundary == BoundaryModel::Exact ? "exact" : "polynomial"));
    if (subject.options.slabThicknessMm)
        line(fmt::format("thickness_mm {}", *subject.options.slabThicknessMm));
    DRgb reduced, albedo, total, transfer;
    for (int c = 0; c < 3; ++c) {
        reduced[c] = m.channel(c).sigmaSPrime();
        albedo[c] = m.channel(c).reducedAlbedo();
        total[c] = profiles[static_cast<std::size_t>(c)]->total();
        transfer[c] = halfSpaceTotals(m.channel(c)).diffuse;
    }
    line("sigma_a_mm^-1 " + triple(m.sigmaA));
    line("sigma_s_mm^-1 " + triple(m.sigmaS));
    line("sigma_s_prime_mm^-1 " + triple(reduced));
    line("g " + triple(m.g));
    line(fmt::format("eta {}", m.eta));
    line("reduced_albedo " + triple(albedo));
    line("mean_free_path_mm " + triple(m.meanFreePathMm()));
    line("total " + triple(total));
    line(
        fmt::format("transfer_total {:.4f} {:.4f} {:.4f} (of the half-space by radiative transfer, "
                    "diffuse light)",
                    transfer.x, transfer.y, transfer.z));
    if (const auto simulated = simulatedTotals(profiles)) {
        line("simulated_total " + triple(simulated->total));
        line("total_error " + triple(simulated->error) + " (1 sigma of the simulated total)");
    }
    if (std::ranges::any_of(profiles, [](const auto& p) { return p->singularAtZero(); }))
        line("R_d grows without bound at r = 0; the cumulative stays finite");
    constexpr double kLarge = std::numeric_limits<double>::infinity();
    for (const std::string& warning : diffusionWarnings(m, kLarge, subject.options.boundary))
        line("note: " + warning);
    std::fwrite(head.data(), 1, head.size(), stdout);
}

void printRow(const std::vector<std::string>& cells, bool csv) {
    std::string row;
    for (const std::string& cell : cells) {
        if (csv)
            row += (row.empty() ? "" : ",") + cell;
        else
            row += fmt::format("{:>{}}", cell, kColumn);
    }
    row += "\n";
    std::fwrite(row.data(), 1, row.size(), stdout);
}

}  // namespace

void printProfile(const ProfileRequest& request, std::optional<double> metersPerUnit) {
    if (!request.model.empty()) kindOf(request.model);
    const ProfileSubject subject = readSubject(request, metersPerUnit);
    checkThickness(subject);
    const Profiles profiles = makeProfiles(subject);
    printHead(subject, profiles);
    std::vector<std::string> header{"r_mm"};
    for (const char* quantity : {"R_d", "cumulative"})
        for (const char* channel : kChannelNames)
            header.push_back(fmt::format("{}_{}", quantity, channel));
    printRow(header, request.csv);
    for (const double r : radiiOf(request, subject.medium)) {
        std::vector<std::string> cells{number(r)};
        for (const auto& profile : profiles) cells.push_back(number(profile->reflectance(r)));
        for (const auto& profile : profiles) cells.push_back(number(profile->cumulative(r)));
        printRow(cells, request.csv);
    }
}
