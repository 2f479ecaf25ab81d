#include "sss/light/environment_light.h"

#include "sss/image/exr_file.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace sss {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Share of the mean radiance that every direction is sampled for at least: the darkest pixels of a
// map with a sun in it still get their samples where the sun is hidden.
constexpr double kImportanceFloor = 0.05;

double sinOfRow(std::size_t row, std::size_t height) {
    // Exact integral of sin over the row, divided by its width.
    const double step = kPi / static_cast<double>(height);
    const double middle = (static_cast<double>(row) + 0.5) * step;
    return std::sin(middle) * std::sin(0.5 * step) / (0.5 * step);
}

/// Mean over the channels of the bilinear lookup, averaged over each pixel: the tensor product of
/// (1, 6, 1) / 8, wrapping around in x, repeating the border in y.
std::vector<double> pixelMeans(const RgbMap& map) {
    const auto width = static_cast<std::size_t>(map.width);
    const auto height = static_cast<std::size_t>(map.height);
    std::vector<double> across(width * height), means(width * height);
    for (std::size_t y = 0; y < height; ++y) {
        const auto value = [&](std::size_t x) {
            return static_cast<double>(meanComponent(map.pixels[y * width + x]));
        };
        for (std::size_t x = 0; x < width; ++x)
            across[y * width + x] =
                (value((x + width - 1) % width) + 6 * value(x) + value((x + 1) % width)) / 8;
    }
    for (std::size_t y = 0; y < height; ++y) {
        const std::size_t above = y == 0 ? 0 : y - 1, below = std::min(y + 1, height - 1);
        for (std::size_t x = 0; x < width; ++x)
            means[y * width + x] = (across[above * width + x] + 6 * across[y * width + x] +
                                    across[below * width + x]) /
                                   8;
    }
    return means;
}

/// Mean radiance over the sphere.
double sphereMean(const std::vector<double>& means, std::size_t width, std::size_t height) {
    double sum = 0, weights = 0;
    for (std::size_t y = 0; y < height; ++y) {
        const double sine = sinOfRow(y, height);
        weights += sine * static_cast<double>(width);
        for (std::size_t x = 0; x < width; ++x) sum += means[y * width + x] * sine;
    }
    return sum / weights;
}

PiecewiseConstant2D makeDistribution(const RgbMap& map) {
    const auto width = static_cast<std::size_t>(map.width);
    const auto height = static_cast<std::size_t>(map.height);
    std::vector<double> weights = pixelMeans(map);
    const double floor = kImportanceFloor * sphereMean(weights, width, height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            double& weight = weights[y * width + x];
            weight = (weight + floor) * sinOfRow(y, height);
        }
    return {width, weights};
}

RgbMap scaled(RgbMap map, const Rgb& scale) {
    for (Rgb& pixel : map.pixels) pixel *= scale;
    return map;
}

}  // namespace

LightSample ConstantEnvironment::sample(const Vec3&, const Vec2& u) const {
    const float z = 1.0f - 2.0f * u.x;
    const float radius = 2.0f * std::sqrt(u.x * (1.0f - u.x));
    const float angle = 2.0f * kPiF * u.y;
    return {{radius * std::cos(angle), radius * std::sin(angle), z},
            kInfinity,
            radiance_,
            0.25f / kPiF};
}

Light::Seen ConstantEnvironment::seen(const Vec3&, const Vec3&) const {
    return {radiance_, 0.25f / kPiF, kInfinity};
}

MapEnvironment::MapEnvironment(RgbMap map, const Rgb& scale, double rotationDegrees)
    : map_(scaled(std::move(map), scale)),
      rotation_(static_cast<float>(rotationDegrees * kPi / 180.0)),
      distribution_(makeDistribution(map_)),
      importance_(static_cast<float>(kPi * sphereMean(pixelMeans(map_),
                                                      static_cast<std::size_t>(map_.width),
                                                      static_cast<std::size_t>(map_.height)))) {}

Rgb MapEnvironment::radianceAt(const Vec2& position) const {
    const float x = position.x * static_cast<float>(map_.width) - 0.5f;
    const float y = std::clamp(position.y * static_cast<float>(map_.height) - 0.5f, 0.0f,
                               static_cast<float>(map_.height - 1));
    const float left = std::floor(x), top = std::floor(y);
    const int x0 = (static_cast<int>(left) + map_.width) % map_.width;
    const int x1 = (x0 + 1) % map_.width;
    const int y0 = static_cast<int>(top), y1 = std::min(y0 + 1, map_.height - 1);
    const auto pixel = [&](int px, int py) {
        return map_.pixels[static_cast<std::size_t>(py) * static_cast<std::size_t>(map_.width) +
                           static_cast<std::size_t>(px)];
    };
    const Rgb above = glm::mix(pixel(x0, y0), pixel(x1, y0), x - left);
    const Rgb below = glm::mix(pixel(x0, y1), pixel(x1, y1), x - left);
    return glm::mix(above, below, y - top);
}

float MapEnvironment::solidAnglePdf(const Vec2& position, float squarePdf) const {
    // The unit square maps to the sphere with the area factor 2 pi * pi * sin(theta).
    const float sine = std::sin(kPiF * position.y);
    return sine > 0 ? squarePdf / (2.0f * kPiF * kPiF * sine) : 0.0f;
}

LightSample MapEnvironment::sample(const Vec3&, const Vec2& u) const {
    const PiecewiseConstant2D::Sample sample = distribution_.sample(u);
    const float theta = kPiF * sample.position.y;
    const float longitude = 2.0f * kPiF * (0.5f - sample.position.x) + rotation_;
    const float sine = std::sin(theta);
    return {{sine * std::sin(longitude), std::cos(theta), sine * std::cos(longitude)},
            kInfinity,
            radianceAt(sample.position),
            solidAnglePdf(sample.position, sample.pdf)};
}

Light::Seen MapEnvironment::seen(const Vec3&, const Vec3& direction) const {
    const float longitude = std::atan2(direction.x, direction.z) - rotation_;
    const float turns = 0.5f - longitude / (2.0f * kPiF);
    const float level = std::hypot(direction.x, direction.z);
    const Vec2 position{std::min(turns - std::floor(turns), 0x1.fffffep-1f),
                        std::min(std::atan2(level, direction.y) / kPiF, 0x1.fffffep-1f)};
    return {radianceAt(position), solidAnglePdf(position, distribution_.pdf(position)), kInfinity};
}

std::unique_ptr<Light> makeEnvironment(const EnvironmentLight& settings) {
    if (settings.map.empty()) return std::make_unique<ConstantEnvironment>(settings.radiance);
    return std::make_unique<MapEnvironment>(rgbMap(readExr(settings.map), settings.map.string()),
                                            settings.radiance, settings.rotationDegrees);
}

}  // namespace sss
