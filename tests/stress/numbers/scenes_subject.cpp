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

// The same box elsewhere, up to a million times its own size away.
void translations(Report& report) {
    Row row("scenes", "moved by up to 1e6 of its size: the same exitance", 1e-4);
    testing::SceneMaker maker = bodyScene(BoxShape{DVec3(8, 9, 10)}, marble());
    maker.scene.quality.spacingMm = 0.7;
    const auto here = Passes(maker.scene).exitance(48);
    for (const double sizes : {1.0, 1e3, 1e6}) {
        Scene scene = maker.scene;
        const DVec3 by = DVec3(0.6, -0.48, 0.64) * (10 * sizes);
        scene.objects[0].transform = {testing::moved(by)};
        scene.camera.position += by;
        scene.camera.lookAt += by;
        row.add(difference(here, Passes(scene).exitance(48), 1),
                [&] { return fmt::format("by {} sizes", sizes); });
    }
    report.add(row);
}

// Everything in another unit of length. Units are powers of two, which leave the digits of all
// numbers as they are: any other moves some point to another place.
void units(Report& report) {
    Row row("scenes", "in units of 1e-6 to 1e6 mm: the same exitance", 1e-4);
    testing::SceneMaker maker = bodyScene(BoxShape{DVec3(8, 9, 10)}, marble());
    maker.scene.quality.spacingMm = 0.7;
    const auto here = Passes(maker.scene).exitance(48);
    for (const double unit : {0x1p-20, 0x1p-10, 0x1p10, 0x1p20}) {
        Medium medium = marble();
        medium.sigmaA /= unit;
        medium.sigmaS /= unit;
        testing::SceneMaker other = bodyScene(BoxShape{DVec3(8, 9, 10) * unit}, medium);
        other.scene.quality.spacingMm = 0.7 * unit;
        row.add(difference(here, Passes(other.scene).exitance(48), 1),
                [&] { return fmt::format("unit {} mm", unit); });
    }
    report.add(row);
}

void brightness(Report& report) {
    Row sound("scenes", "light of 0 and 1e-30 to 1e30: finite, >= 0", 0);
    Row linear("scenes", "light of 1e-24 to 1e30: exitance in proportion", 1e-4);
    testing::SceneMaker maker = bodyScene(BoxShape{DVec3(8, 9, 10)}, marble());
    maker.scene.quality.spacingMm = 0.7;
    const auto here = Passes(maker.scene).exitance(48);
    for (const float light : {0.0f, 1e-30f, 1e-24f, 1e-12f, 1e12f, 1e24f, 1e30f}) {
        maker.scene.lights = {DirectionalLight{{0, -1, -1}, Rgb(light)}};
        const auto lit = Passes(maker.scene).exitance(48);
        const auto where = [&] { return fmt::format("{} W m^-2", light); };
        sound.expect(areSound(lit), where);
        if (light > 1e-25f) linear.add(difference(here, lit, double{light}), where);
    }
    maker.scene.lights.clear();
    sound.expect(areSound(Passes(maker.scene).exitance(48)), [] { return "no light at all"; });
    report.add(sound);
    report.add(linear);
}

DRgb mean(const std::vector<Rgb>& values) {
    DRgb sum{0};
    for (const Rgb& v : values) sum += DRgb(v);
    return sum / static_cast<double>(values.size());
}

// What the programs do of themselves with a ball of so many mean free paths and any medium: points
// as they choose, or one sentence.
void media(Report& report, Scope scope) {
    Row row("scenes", "any medium, any size: sound, or refused in words", 0);
    Row energy("scenes", "convex bodies: mean exitance <= mean irradiance", 0.02);
    std::vector<double> sizes{1e-3, 30, 1e6}, absorptions{0.5, 0}, etas{1.3};
    std::vector<double> anisotropies{0.9};
    if (scope == Scope::Full) {
        sizes = {1e-3, 0.1, 1, 10, 30, 100, 1e4, 1e6};
        absorptions = {1, 0.9, 0.1, 1e-3, 1e-12, 0};
        etas = {0.5, 1, 1.3, 2, 4};
        anisotropies = {-0.99, 0, 0.99};
    }
    for (const double size : sizes)
        for (const double absorption : absorptions)
            for (const double eta : etas)
                for (const double g : anisotropies) {
                    Medium medium;
                    medium.sigmaA = DRgb(absorption);
                    medium.sigmaS = DRgb((1 - absorption) / (1 - g));
                    medium.g = DRgb(g);
                    medium.eta = eta;
                    const auto where = [&] {
                        return fmt::format("radius {} mean free paths, 1-alpha' {} eta {} g {}",
                                           size, absorption, eta, g);
                    };
                    testing::SceneMaker maker = bodyScene(SphereShape{size}, medium);
                    maker.scene.quality.tolerance = 0.3;
                    maker.scene.lights = {EnvironmentLight{}};
                    try {
                        const Passes passes(maker.scene);
                        const auto values = passes.exitance(40);
                        row.expect(areSound(values), where);
                        // Under an even light all places of a ball are alike.
                        energy.add(
                            maxComponent(mean(values) / mean(passes.clouds()[0].irradiance)) - 1,
                            where);
                    } catch (const Error& error) {
                        row.expect(error.kind() == ErrorKind::Resource ||
                                       error.kind() == ErrorKind::BadInput,
                                   where);
                    }
                }
    report.add(row);
    report.add(energy);
}

}  // namespace

void stressScenes(Report& report, Scope scope) {
    translations(report);
    units(report);
    brightness(report);
    media(report, scope);
}

}  // namespace sss::stress
