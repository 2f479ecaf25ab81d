// The exitance that a picture shows, against a converged reference.
#include "deviations.h"
#include "receivers.h"
#include "sss/base/error.h"
#include "sss/base/parallel.h"
#include "sss/integrate/body_field.h"
#include "sss/integrate/cloud_cache.h"
#include "stopwatch.h"
#include "subjects.h"
#include "sum_methods.h"

namespace sss::bench {
namespace {

JsonValue list(const DRgb& v) {
    JsonValue array = JsonValue::array();
    for (int c = 0; c < 3; ++c) array.push(v[c]);
    return array;
}

std::vector<Vec3> positionsOf(std::span<const Receiver> receivers) {
    std::vector<Vec3> positions;
    for (const Receiver& r : receivers) positions.push_back(r.position);
    return positions;
}

std::vector<Rgb> rounded(std::span<const DRgb> values) {
    return std::vector<Rgb>(values.begin(), values.end());
}

// A reference read back: where, and what each seed gave.
struct Reference {
    std::vector<Receiver> receivers;
    std::vector<DRgb> first, second, mean;
};

DRgb readColour(const JsonValue& list) {
    return {list.items()[0].asNumber(), list.items()[1].asNumber(), list.items()[2].asNumber()};
}

Reference readReference(const std::filesystem::path& path, const Stage& stage,
                        std::size_t receivers) {
    Reference reference;
    reference.receivers = receiversInView(stage, receivers);
    const JsonValue json = readJsonFile(path);
    const JsonMember* values = json.find("values");
    if (values == nullptr || values->value.items().size() != reference.receivers.size())
        throw Error(ErrorKind::BadInput, path.string(), "was made for other receivers",
                    "remove it; run.py makes it again");
    for (const JsonValue& pair : values->value.items()) {
        reference.first.push_back(readColour(pair.items()[0]));
        reference.second.push_back(readColour(pair.items()[1]));
        reference.mean.push_back(0.5 * (reference.first.back() + reference.second.back()));
    }
    return reference;
}

// Time of a lookup where everything has been computed: the mean over many.
double lookupSeconds(const BodyField& field, std::span<const Receiver> receivers) {
    constexpr int kRounds = 64;
    Rgb sum(0);
    const double began = threadSeconds();
    for (int round = 0; round < kRounds; ++round)
        for (const Receiver& r : receivers) sum += field.exitance(r.face, r.barycentrics);
    const double seconds = threadSeconds() - began;
    if (!isFinite(sum)) throw Error(ErrorKind::Internal, "exitance", "is not finite", "");
    return seconds / (kRounds * static_cast<double>(receivers.size()));
}

}  // namespace

JsonValue makeReference(const Arguments& arguments) {
    Quality quality;
    quality.spacingMm = arguments.number("spacing", 0);
    quality.irradianceSamples = static_cast<int>(arguments.number("irradiance-samples", 64));
    const auto count = static_cast<std::size_t>(arguments.number("receivers", 1024));
    arguments.check();

    std::vector<DRgb> values[2];
    JsonValue json = JsonValue::object();
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
        quality.seed = 101 + seed;
        const Stage stage(readScene(arguments.scene(), quality));
        Stage::Made made = stage.makeCloud();
        const Hierarchy hierarchy(stage, std::move(made.cloud));
        values[seed] = hierarchy.bruteForce(positionsOf(receiversInView(stage, count)));
        json.set("points", made.report.points)
            .set("spacingMm", made.report.spacingMm)
            .set("irradianceSamples", made.report.irradianceSamples);
    }
    JsonValue pairs = JsonValue::array();
    for (std::size_t i = 0; i < values[0].size(); ++i) {
        JsonValue pair = JsonValue::array();
        pair.push(list(values[0][i])).push(list(values[1][i]));
        pairs.push(std::move(pair));
    }
    // Two seeds differ by sqrt(2) of the error of one, their mean errs by 1 / sqrt(2) of it.
    json.set("seedsApart", describeDeviations(rounded(values[0]), values[1]))
        .set("values", std::move(pairs));
    return json;
}

JsonValue measureFrame(const Arguments& arguments) {
    const std::string cachePath = arguments.text("cache"), where = arguments.text("reference");
    const auto count = static_cast<std::size_t>(arguments.number("receivers", 1024));
    const auto relightSamples = static_cast<int>(arguments.number("irradiance-samples", 64));
    arguments.check();

    const Stage stage(readScene(arguments.scene(), Quality{}));
    const Reference reference = readReference(where, stage, count);
    const std::vector<Vec3> places = positionsOf(reference.receivers);
    const CloudCache cache(cachePath, stage.world(), stage.allOptics());
    const BodyCloud::View view = cache.view(0);
    const double tolerance = stage.world().scene().quality.tolerance;

    // What the renderer shows.
    const BodyField field(stage.body(), stage.optics(), view, tolerance);
    std::vector<Rgb> shown(places.size());
    parallelFor(places.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            shown[i] =
                field.exitance(reference.receivers[i].face, reference.receivers[i].barycentrics);
    });
    // The same points without hierarchy and interpolation, then with converged irradiance.
    std::vector<DRgb> brute(places.size());
    parallelFor(places.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) brute[i] = field.sum().bruteForce(places[i]);
    });
    const Stage relit(readScene(
        arguments.scene(),
        {.spacingMm = 0, .tolerance = 0, .irradianceSamples = relightSamples, .seed = 0}));
    const std::vector<DRgb> converged =
        Hierarchy(relit, relit.makeCloud().cloud).bruteForce(places);

    JsonValue json = JsonValue::object();
    json.set("tolerance", tolerance)
        .set("points", view.cloud.size())
        .set("nodes", view.nodes.size())
        .set("spacingMm", view.spacingMm)
        .set("receivers", places.size())
        .set("lookupSeconds", lookupSeconds(field, reference.receivers))
        .set("error", describeDeviations(shown, reference.mean))
        .set("fromInterpolationAndHierarchy", describeDeviations(shown, brute))
        .set("fromLightNoise", describeDeviations(rounded(brute), converged))
        .set("fromPoints", describeDeviations(rounded(converged), reference.mean))
        .set("ofReference", describeDeviations(rounded(reference.first), reference.mean));
    return json;
}

}  // namespace sss::bench
