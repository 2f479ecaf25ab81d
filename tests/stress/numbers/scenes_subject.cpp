#include "numbers/passes.h"
#include "numbers/subjects.h"
#include "sss/base/error.h"

#include <fmt/format.h>

#include <cmath>

namespace sss::stress {
namespace {

Medium marble() { return toMedium(*findMeasuredMedium("Marble")); }

bool areSound(const std::vector<Rgb>& values) {
    for (const Rgb& v : values)
        if (!isFinite(v) || v.x < 0 || v.y < 0 || v.z < 0) return false;
    return !values.empty();
}

// Largest difference, relative to the brightest value of all.
double difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b, double factor) {
    if (a.size() != b.size()) return INFINITY;
    double most = 0, worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, maxComponent(DRgb(a[i])));
        worst = std::max(worst, maxComponent(glm::abs(DRgb(b[i]) / factor - DRgb(a[i]))));
    }
    return most > 0 ? worst / most : worst;
}

DRgb mean(const std::vector<Rgb>& values) {
    DRgb sum{0};
    for (const Rgb& v : values) sum += DRgb(v);
    return sum / static_cast<double>(values.size());
}

/// What diffusion in a box is asked of: by the profile, and solved on the shape.
struct BoxModel {
    const char* name;
    bool onShape;
    double spacingMm;  // with fewer points where they are costly

    testing::SceneMaker box(double unit = 1) const {
        Medium medium = marble();
        medium.sigmaA /= unit;
        medium.sigmaS /= unit;
        testing::SceneMaker maker = bodyScene(BoxShape{DVec3(8, 9, 10) * unit}, medium, onShape);
        maker.scene.quality.spacingMm = spacingMm * unit;
        // What the hierarchy may be off by is not what is asked here.
        maker.scene.quality.tolerance = 3e-4;
        return maker;
    }
};
// The area is no whole number of cells: else rounding would decide whether there is one more.
constexpr BoxModel kModels[] = {{"profile", false, 0.97}, {"shape", true, 1.93}};

// The same box elsewhere, up to a million times its own size away.
void translations(Report& report, Scope scope) {
    const std::vector<double> all{1, 1e3, 1e6}, few{1e6};
    Row row("scenes", "moved by up to 1e6 of its size: the same exitance", 1e-4);
    for (const BoxModel& model : kModels) {
        const Scene home = model.box().scene;
        const auto here = Passes(home).exitance(48);
        for (const double sizes : scope == Scope::Full ? all : few) {
            Scene scene = home;
            const DVec3 by = DVec3(0.6, -0.48, 0.64) * (10 * sizes);
            scene.objects[0].transform = {testing::moved(by)};
            scene.camera.position += by;
            scene.camera.lookAt += by;
            row.add(difference(here, Passes(scene).exitance(48), 1),
                    [&] { return fmt::format("{}, by {} sizes", model.name, sizes); });
        }
    }
    report.add(row);
}

// Everything in another unit of length: powers of two, which leave the digits of all numbers as
// they are, and others.
void units(Report& report, Scope scope) {
    Row row("scenes", "in units of 1e-6 to 1e6 mm: the same exitance", 1e-4);
    const std::vector<double> all{0x1p-20, 0x1p-10, 0x1p10, 0x1p20, 1e-6, 1e-3, 1. / 3, 25.4, 1e6};
    const std::vector<double> few{0x1p-20, 25.4};
    for (const BoxModel& model : kModels) {
        const auto here = Passes(model.box().scene).exitance(48);
        for (const double unit : scope == Scope::Full ? all : few)
            row.add(difference(here, Passes(model.box(unit).scene).exitance(48), 1),
                    [&] { return fmt::format("{}, unit {} mm", model.name, unit); });
    }
    report.add(row);
}

void brightness(Report& report, Scope scope) {
    Row sound("scenes", "light of 0 and 1e-30 to 1e30: finite, >= 0", 0);
    Row linear("scenes", "light of 1e-24 to 1e30: exitance in proportion", 1e-4);
    const std::vector<float> all{0, 1e-30f, 1e-24f, 1e-12f, 1e12f, 1e24f, 1e30f};
    const std::vector<float> few{0, 1e-30f, 1e30f};
    for (const BoxModel& model : kModels) {
        Scene scene = model.box().scene;
        const auto here = Passes(scene).exitance(48);
        for (const float light : scope == Scope::Full ? all : few) {
            scene.lights = {DirectionalLight{{0, -1, -1}, Rgb(light)}};
            const auto lit = Passes(scene).exitance(48);
            const auto where = [&] { return fmt::format("{}, {} W m^-2", model.name, light); };
            sound.expect(areSound(lit), where);
            if (light > 1e-25f) linear.add(difference(here, lit, double{light}), where);
        }
        scene.lights.clear();
        sound.expect(areSound(Passes(scene).exitance(48)), [] { return "no light at all"; });
    }
    report.add(sound);
    report.add(linear);
}

/// A ball of so many mean free paths in radius.
struct BallCase {
    double size, absorption, eta, g;  // absorption: 1 - alpha'
    bool onShape;

    std::string words() const {
        return fmt::format("{}, radius {} mean free paths, 1-alpha' {} eta {} g {}",
                           onShape ? "shape" : "profile", size, absorption, eta, g);
    }
    Scene scene() const {
        Medium medium;
        medium.sigmaA = DRgb(absorption);
        medium.sigmaS = DRgb((1 - absorption) / (1 - g));
        medium.g = DRgb(g);
        medium.eta = eta;
        testing::SceneMaker maker = bodyScene(SphereShape{size}, medium, onShape);
        maker.scene.quality.tolerance = 0.3;
        maker.scene.lights = {EnvironmentLight{}};
        return maker.scene;
    }
};

std::vector<BallCase> ballCases(Scope scope) {
    if (scope == Scope::Quick)
        return {{1e-3, 0.5, 1.3, 0.9, false}, {30, 0, 1.3, 0.9, false},
                {1e6, 0.5, 1.3, 0.9, false},  {1e-3, 0, 1.3, 0.9, true},
                {30, 0.5, 1.3, 0.9, true},    {1e6, 0, 1.3, 0.9, true}};
    std::vector<BallCase> cases;
    for (const double size : {1e-3, 0.1, 1.0, 10.0, 30.0, 100.0, 1e4, 1e6})
        for (const double absorption : {1.0, 0.9, 0.1, 1e-3, 1e-12, 0.0})
            for (const double eta : {0.5, 1.0, 1.3, 2.0, 4.0})
                for (const double g : {-0.99, 0.0, 0.99}) {
                    cases.push_back({size, absorption, eta, g, false});
                    // Costs several times as much; of g it sees the reduced coefficients only.
                    if (g == 0 && (eta == 1 || eta == 1.3))
                        cases.push_back({size, absorption, eta, g, true});
                }
    return cases;
}

// What the programs do of themselves with a ball of any size and medium: points as they choose, or
// one sentence.
void media(Report& report, Scope scope) {
    Row row("scenes", "any medium, any size: sound, or refused in words", 0);
    Row energy("scenes", "convex bodies: mean exitance <= mean irradiance", 0.02);
    for (const BallCase& ball : ballCases(scope)) {
        const auto where = [&] { return ball.words(); };
        try {
            const Passes passes(ball.scene());
            const auto values = passes.exitance(40);
            row.expect(areSound(values), where);
            // Under an even light all places of a ball are alike.
            energy.add(maxComponent(mean(values) / mean(passes.clouds()[0].irradiance)) - 1, where);
        } catch (const Error& error) {
            row.expect(error.kind() == ErrorKind::Resource || error.kind() == ErrorKind::BadInput,
                       where);
        }
    }
    report.add(row);
    report.add(energy);
}

}  // namespace

void stressScenes(Report& report, Scope scope) {
    translations(report, scope);
    units(report, scope);
    brightness(report, scope);
    media(report, scope);
}

}  // namespace sss::stress
