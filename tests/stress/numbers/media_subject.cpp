#include "numbers/subjects.h"
#include "sss/base/error.h"
#include "sss/base/vec.h"
#include "sss/medium/dipole.h"
#include "sss/medium/energy.h"
#include "sss/medium/half_space.h"
#include "sss/medium/profile.h"
#include "sss/medium/single_scatter.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace sss::stress {
namespace {

/// The values that a sweep crosses with each other.
struct Sweep {
    std::vector<double> sigmaTPrime{1e-6, 1e-3, 1, 1e3, 1e6};  // mm^-1
    std::vector<double> absorption{1, 0.9, 0.5, 0.1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0};
    std::vector<double> eta{0.5, 0.8, 1 - 1e-9, 1, 1 + 1e-9, 1.3, 1.5, 2, 4};
    std::vector<double> g{-0.99, 0, 0.99};
    std::vector<double> radius{0, 1e-6, 1e-3, 0.03, 0.3, 1,
                               3, 10,   100,  1e3,  1e5};  // mean free paths

    template <typename Visit>
    void forEachMedium(const Visit& visit) const {
        for (const double s : sigmaTPrime)
            for (const double a : absorption)
                for (const double index : eta)
                    for (const double mean : g)
                        // By parts, so that 1 - alpha' keeps its digits.
                        visit(ChannelMedium{s * a, s * (1 - a) / (1 - mean), mean, index});
    }
};

std::string describe(const ChannelMedium& m) {
    return fmt::format("sigma'_t {:.3g} 1-alpha' {:.3g} eta {:.10g} g {}", m.sigmaTPrime(),
                       m.reducedAbsorption(), m.eta, m.g);
}

ProfileOptions optionsFor(const ChannelMedium& medium) {
    ProfileOptions options;
    options.slabThicknessMm = 3 * medium.meanFreePathMm();
    return options;
}

Sweep sweepFor(std::string_view profile, Scope scope) {
    Sweep sweep;
    const bool isCostly =
        profile.substr(0, 11) == "photon_beam" || profile.substr(0, 9) == "multipole";
    if (scope == Scope::Quick) {
        sweep.sigmaTPrime = {1e-6, 1, 1e6};
        sweep.absorption = {1, 0.5, 1e-4, 1e-12, 0};
        sweep.eta = {0.5, 1, 1.3, 4};
        sweep.g = {0, 0.99};
    }
    if (isCostly && scope == Scope::Quick) {
        sweep.sigmaTPrime = {1e-6, 1e6};
        sweep.absorption = {0.5, 0};
        sweep.eta = {1, 1.5};
        sweep.g = {0};
        sweep.radius = {0, 1e-3, 1, 100, 1e5};
    }
    return sweep;
}

/// Values and tails of one profile over the sweep's radii.
struct Answers {
    std::vector<double> value, tail;
    double total;
    bool isSingular;

    Answers(const Profile& profile, const Sweep& sweep, double mfpMm)
        : total(profile.total()), isSingular(profile.singularAtZero()) {
        for (const double r : sweep.radius) {
            value.push_back(profile.reflectance(r * mfpMm));
            tail.push_back(profile.tail(r * mfpMm));
        }
    }
};

/// nullptr where the model has no answer and says so.
std::unique_ptr<Profile> madeFor(const ProfileKind& kind, const ChannelMedium& medium) {
    try {
        return kind.make(medium, optionsFor(medium));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::BadInput) throw;
        return nullptr;
    }
}

void stressProfile(const ProfileKind& kind, Report& report, Scope scope) {
    const std::string name(kind.name);
    Row sound("media", name + ": finite, >= 0", 0);
    Row energy("media", name + ": total in [0, 1], tails fall from it to 0", 1e-9);
    Row single("media", name + ": single precision against double", 2e-6);
    const Sweep sweep = sweepFor(kind.name, scope);
    sweep.forEachMedium([&](const ChannelMedium& medium) {
        const auto profile = madeFor(kind, medium);
        if (!profile) return;
        const double mfp = medium.meanFreePathMm();
        const Answers is(*profile, sweep, mfp);
        double last = is.total;
        energy.add(std::max({is.total - 1, -is.total, std::abs(is.tail[0] - is.total)}),
                   [&] { return describe(medium); });
        for (std::size_t i = 0; i < is.value.size(); ++i) {
            const auto where = [&] {
                return fmt::format("{} r {} value {} tail {}", describe(medium), sweep.radius[i],
                                   is.value[i], is.tail[i]);
            };
            const bool mayBeInfinite = sweep.radius[i] == 0 && is.isSingular;
            sound.expect(is.value[i] >= 0 && (std::isfinite(is.value[i]) || mayBeInfinite), where);
            sound.expect(is.tail[i] >= 0 && std::isfinite(is.tail[i]), where);
            energy.add(is.tail[i] - last, where);
            last = is.tail[i];
            if (mayBeInfinite || sweep.radius[i] * mfp > 1e30) continue;
            const float r = static_cast<float>(sweep.radius[i] * mfp);
            float out = 0;
            profile->reflectance({&r, 1}, {&out, 1});
            const double exact = profile->reflectance(double{r});
            if (exact > 1e-30) single.add(std::abs(out / exact - 1), where);
        }
    });
    report.add(sound);
    report.add(energy);
    report.add(single);
}

// R_d(s r; sigma / s) s^2 = R_d(r; sigma): the unit of length is nobody's business.
void scaleInvariance(const ProfileKind& kind, Report& report, Scope scope) {
    Row same("media", std::string(kind.name) + ": the same at every scale", 1e-9);
    Sweep sweep = sweepFor(kind.name, scope);
    sweep.sigmaTPrime = {1};
    sweep.forEachMedium([&](const ChannelMedium& medium) {
        const auto profile = madeFor(kind, medium);
        if (!profile) return;
        const Answers one(*profile, sweep, medium.meanFreePathMm());
        for (const double scale : {1e-6, 0.1, 1e6}) {
            ChannelMedium scaled = medium;
            scaled.sigmaA *= scale;
            scaled.sigmaS *= scale;
            const Answers other(*kind.make(scaled, optionsFor(scaled)), sweep,
                                scaled.meanFreePathMm());
            for (std::size_t i = 0; i < sweep.radius.size(); ++i)
                if (std::isfinite(one.value[i]) && one.value[i] > 1e-100)
                    same.add(std::abs(other.value[i] / one.value[i] / scale / scale - 1), [&] {
                        return fmt::format("{} r {} scale {}", describe(medium), sweep.radius[i],
                                           scale);
                    });
        }
    });
    report.add(same);
}

// [JMLH01 Eq. 4] as it stands, in 64 bits of mantissa.
long double dipoleByDefinition(const ChannelMedium& medium, double rMm) {
    using Long = long double;
    const Long total = Long{medium.sigmaA} + (1 - Long{medium.g}) * Long{medium.sigmaS};
    const Long albedo = (1 - Long{medium.g}) * Long{medium.sigmaS} / total;
    const Long transport = std::sqrt(3 * Long{medium.sigmaA} * total);
    const Long zr = 1 / total;
    const Long zv =
        zr * (1 + Long{4} / 3 * Long{dipoleBoundaryFactor(medium.eta, BoundaryModel::Exact)});
    Long sum = 0;
    for (const Long z : {zr, zv}) {
        const Long d = std::sqrt(Long{rMm} * Long{rMm} + z * z);
        sum += z * (1 + transport * d) * std::exp(-transport * d) / (d * d * d);
    }
    return albedo / (4 * std::numbers::pi_v<long double>)*sum;
}

void dipoleInLongPrecision(Report& report) {
    Row exact("media", "dipole against its formula in long double", 1e-11);
    const Sweep sweep;
    sweep.forEachMedium([&](const ChannelMedium& medium) {
        const Dipole dipole(medium);
        for (const double r : sweep.radius) {
            const double rMm = r * medium.meanFreePathMm();
            const long double truth = dipoleByDefinition(medium, rMm);
            if (truth < 1e-250L) continue;
            exact.add(static_cast<double>(
                          std::abs(static_cast<long double>(dipole.reflectance(rMm)) / truth - 1)),
                      [&] { return fmt::format("{} r {}", describe(medium), r); });
        }
    });
    report.add(exact);
}

// What leaves after all scattering, and after one; both 20 ms a medium.
void halfSpaces(Report& report, Scope scope) {
    Row totals("media", "half-space: 0 <= single <= total <= 1", 1e-3);
    Row scaled("media", "diffusion + single scattering <= 1", 1e-3);
    Sweep sweep;
    sweep.sigmaTPrime = {1};
    sweep.g = {-0.99, -0.5, 0, 0.5, 0.9, 0.99};
    if (scope == Scope::Quick) {
        sweep.absorption = {1, 0.1, 1e-12, 0};
        sweep.eta = {0.5, 1, 1.3, 4};
        sweep.g = {0, 0.99};
    }
    sweep.forEachMedium([&](const ChannelMedium& medium) {
        const auto where = [&] { return describe(medium); };
        const HalfSpaceTotals total = halfSpaceTotals(medium);
        const double single = singleScatterAlbedo(medium, Illumination::Diffuse);
        totals.add(std::max({-single, single - total.diffuse, total.diffuse - 1, -total.diffuse,
                             total.normal - 1, -total.normal}),
                   where);
        const Dipole dipole(medium);
        const double diffusion = dipole.total() * multipleScatterScale(dipole, medium);
        scaled.add(std::max(-diffusion, diffusion + single - 1), where);
    });
    report.add(totals);
    report.add(scaled);
}

}  // namespace

void stressMedia(Report& report, Scope scope) {
    for (const ProfileKind& kind : profileTable()) {
        if (kind.name == "tabulated") continue;  // Monte Carlo, with its own tests
        stressProfile(kind, report, scope);
        scaleInvariance(kind, report, scope);
    }
    dipoleInLongPrecision(report);
    halfSpaces(report, scope);
}

}  // namespace sss::stress
