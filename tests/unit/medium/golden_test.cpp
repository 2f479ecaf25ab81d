// Every profile against the 25-digit table in the shared folder, and against a few rows of it that
// stand here, for when it is not there.
#include "sss/medium/profile.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace sss;

namespace {

std::vector<std::string> split(const std::string& line, char separator) {
    std::vector<std::string> parts;
    std::stringstream stream(line);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

std::map<std::string, double> parameters(const std::string& text) {
    std::map<std::string, double> values;
    for (const std::string& pair : split(text, ';')) {
        const auto equals = pair.find('=');
        if (equals == std::string::npos) continue;
        values[pair.substr(0, equals)] = std::strtod(pair.c_str() + equals + 1, nullptr);
    }
    return values;
}

struct Model {
    std::string profile;
    BoundaryModel boundary;
    int beamSamples = 0;
};

const std::map<std::string, Model>& models() {
    static const std::map<std::string, Model> table{
        {"dipole", {"dipole", BoundaryModel::Polynomial}},
        {"dipole_exactF", {"dipole", BoundaryModel::Exact}},
        {"better_dipole", {"better_dipole", BoundaryModel::Polynomial}},
        {"better_dipole_exactC", {"better_dipole", BoundaryModel::Exact}},
        {"nd_mfp_perp", {"normalized_diffusion_perpendicular", BoundaryModel::Polynomial}},
        {"nd_mfp_diff", {"normalized_diffusion", BoundaryModel::Polynomial}},
        {"nd_dmfp", {"normalized_diffusion_dmfp", BoundaryModel::Polynomial}},
        {"multipole_R", {"multipole", BoundaryModel::Polynomial}},
        {"multipole_T", {"multipole_transmittance", BoundaryModel::Polynomial}},
        {"pbd_ms_converged", {"photon_beam", BoundaryModel::Polynomial}},
        {"pbd_ss_converged", {"photon_beam_single", BoundaryModel::Polynomial}},
        {"pbd_ms_N100", {"photon_beam", BoundaryModel::Polynomial, 100}},
        {"pbd_ss_N100", {"photon_beam_single", BoundaryModel::Polynomial, 100}},
    };
    return table;
}

ChannelMedium mediumOf(const std::string& material, const std::string& channel,
                       const std::map<std::string, double>& p) {
    ChannelMedium medium;
    if (p.count("sigma_a") != 0) {
        medium.g = p.count("g") != 0 ? p.at("g") : 0.0;
        medium.sigmaA = p.at("sigma_a");
        medium.sigmaS =
            p.count("sigma_s") != 0 ? p.at("sigma_s") : p.at("sigma_prime_s") / (1 - medium.g);
        medium.eta = p.at("eta");
        return medium;
    }
    const std::map<std::string, ChannelMedium> measured{
        {"MarbleR", {0.0021, 2.19, 0, 1.5}},   {"MarbleG", {0.0041, 2.62, 0, 1.5}},
        {"MarbleB", {0.0071, 3.0, 0, 1.5}},    {"SkimmilkR", {0.0014, 0.7, 0, 1.3}},
        {"SkimmilkG", {0.0025, 1.22, 0, 1.3}}, {"SkimmilkB", {0.0142, 1.9, 0, 1.3}},
        {"KetchupR", {0.061, 0.18, 0, 1.3}},   {"KetchupG", {0.97, 0.07, 0, 1.3}},
        {"KetchupB", {1.45, 0.03, 0, 1.3}},    {"Skin1R", {0.032, 0.74, 0, 1.3}},
        {"Skin1G", {0.17, 0.88, 0, 1.3}},      {"Skin1B", {0.48, 1.01, 0, 1.3}}};
    return measured.at(material + channel);
}

struct GoldenRow {
    std::string model, material, channel, params;
    double r, value, tail;
};

std::unique_ptr<Profile> profileOf(const GoldenRow& row) {
    const Model& model = models().at(row.model);
    const auto p = parameters(row.params);
    ProfileOptions options;
    options.boundary = model.boundary;
    options.beamSamples = model.beamSamples;
    if (p.count("d") != 0) options.slabThicknessMm = p.at("d");
    return makeProfile(model.profile, mediumOf(row.material, row.channel, p), options);
}

double tolerance(const std::string& model) { return model.starts_with("pbd") ? 1e-8 : 1e-10; }

/// The table's own error: its multipole series and its tails were cut at 25 digits of the peak.
constexpr double kTableResidue = 1e-24;

void checkDouble(const GoldenRow& row, const Profile& profile, double peak) {
    if (std::abs(row.value) < 1e-30 * peak) return;
    const std::string where =
        row.model + " " + row.material + " " + row.channel + " at r = " + std::to_string(row.r);
    const double limit = tolerance(row.model);
    EXPECT_NEAR(profile.reflectance(row.r), row.value, limit * std::abs(row.value) + kTableResidue)
        << where;
    if (!std::isnan(row.tail)) {
        EXPECT_NEAR(profile.tail(row.r), row.tail, limit * std::abs(row.tail) + kTableResidue)
            << where;
    }
}

void checkSingle(const GoldenRow& row, const Profile& profile, double peak) {
    if (row.value < 1e-30 * peak || row.value < 1e-37) return;
    const std::array<float, 1> r{static_cast<float>(row.r)};
    std::array<float, 1> out{};
    profile.reflectance(r, out);
    // The rounding of r itself is no error of the profile's.
    const double expected = profile.reflectance(static_cast<double>(r[0]));
    EXPECT_NEAR(static_cast<double>(out[0]), expected, 2e-6 * expected)
        << row.model << " " << row.material << " " << row.channel << " at r = " << row.r;
}

double number(const std::string& text) {
    return text.empty() ? std::nan("") : std::strtod(text.c_str(), nullptr);
}

TEST(Golden, RowsKeptHere) {
    const std::vector<GoldenRow> rows{
        {"dipole", "Ketchup", "R", "", 4.149377593360995850622e-4, 2.719941517382341232124e-3,
         0.1638360092973587997966},
        {"nd_mfp_perp", "Ketchup", "R", "", 0.2214398021247431393425, 0.04380457714360743360873,
         0.1494852852269234753071},
        {"better_dipole", "x_eta3", "-", "sigma_prime_s=1;sigma_a=0.01;eta=3;g=0",
         99.00990099009900990099, -7.348330430654738294723e-13, -2.511584211175451155829e-9},
        {"multipole_R", "Marble", "G", "d=0.5", 10.85338161059335259671, 1.78379633634645e-8,
         std::nan("")},
        {"multipole_T", "Marble", "G", "d=0.5", 0.02033725555888232025514, 5.38740735555262031941,
         std::nan("")},
        {"pbd_ms_converged", "Marble", "R", "", 0.02434514498064098197234, 0.7387452473610754301673,
         std::nan("")},
        {"pbd_ms_N100", "Marble", "R", "", 0.02434514498064098197234, 0.7390563596620613180721,
         std::nan("")},
        {"pbd_ss_converged", "Marble", "R", "", 4.561835682678709912869e-5, 2367.528165124555087767,
         std::nan("")},
        {"pbd_ss_N100", "Skimmilk", "R", "", 6.171601484292926072717e-3, 5.931496369254814740079,
         std::nan("")},
    };
    for (const GoldenRow& row : rows) checkDouble(row, *profileOf(row), 0);
}

TEST(Golden, ProfilesOfTheSharedTable) {
    std::ifstream file(SSS_SHARED_DIR "/golden/profiles.csv");
    if (!file) GTEST_SKIP() << "no shared folder";
    std::string line;
    std::getline(file, line);
    // The table goes from model to model at every radius.
    struct Case {
        std::unique_ptr<Profile> profile;
        double peak;
    };
    std::map<std::string, Case> cases;
    int checked = 0;
    while (std::getline(file, line)) {
        const auto f = split(line, ',');
        const GoldenRow row{f[0],         f[1],         f[2],        f.size() > 7 ? f[7] : "",
                            number(f[3]), number(f[4]), number(f[6])};
        const std::string key = f[0] + f[1] + f[2] + row.params;
        if (cases.count(key) == 0) cases[key] = {profileOf(row), std::abs(row.value)};
        checkDouble(row, *cases[key].profile, cases[key].peak);
        checkSingle(row, *cases[key].profile, cases[key].peak);
        ++checked;
    }
    EXPECT_GT(checked, 2000);
}

TEST(Golden, TotalsOfTheSharedTable) {
    std::ifstream file(SSS_SHARED_DIR "/golden/totals.csv");
    if (!file) GTEST_SKIP() << "no shared folder";
    std::string line;
    std::getline(file, line);
    int checked = 0;
    while (std::getline(file, line)) {
        const auto f = split(line, ',');
        const std::string params = f[0].starts_with("nd_") ? std::string() : f[3];
        const GoldenRow row{f[0], f[1], f[2], params, 0, 0, 0};
        const double expected = number(f[4]);
        EXPECT_NEAR(profileOf(row)->total(), expected, 1e-10 * std::abs(expected)) << line;
        ++checked;
    }
    EXPECT_GT(checked, 100);
}

}  // namespace
