#include "sss/integrate/cloud_sections.h"

#include "sss/base/error.h"
#include "sss/cloud/cloud_guard.h"

#include <fmt/core.h>

namespace sss {
namespace {

constexpr std::string_view kPoints = "points", kIrradiance = "irrad", kOctree = "octree",
                           kNodesBefore = "before", kMeta = "meta", kPieces = "pieces",
                           kCorners = "corners", kFirstPiece = "first", kShape = "shape",
                           kBeams = "beams";
constexpr const char* kUnscattered = "unscatteredShare";

JsonValue list(const DRgb& v) {
    JsonValue array = JsonValue::array();
    for (int c = 0; c < 3; ++c) array.push(v[c]);
    return array;
}

[[noreturn]] void refuse(const CacheFile& file, const std::string& what) {
    throw Error(ErrorKind::BadInput, file.path().string(), what, "run sss-preprocess again");
}

bool areSound(const SurfaceSamples& samples, std::size_t faces) {
    const SurfaceCells& cells = samples.cells;
    if (cells.firstPiece.size() != samples.size() + 1 || cells.firstPiece.front() != 0 ||
        cells.firstPiece.back() != cells.pieces.size())
        return false;
    for (std::size_t p = 0; p < samples.size(); ++p)
        if (cells.firstPiece[p] >= cells.firstPiece[p + 1] || samples.points[p].face >= faces)
            return false;
    for (const CellPiece& piece : cells.pieces)
        if (piece.face >= faces || piece.cornerCount < 3 ||
            std::uint64_t{piece.firstCorner} + piece.cornerCount > cells.corners.size())
            return false;
    return true;
}

template <typename T>
std::vector<T> copyOf(const CacheFile& file, std::string_view kind) {
    const auto section = file.section<T>(kind, 0);
    return {section.begin(), section.end()};
}

double numberIn(const JsonValue& described, std::string_view key, const std::string& where) {
    const JsonValue& value = metaMember(described, key, where);
    return value.isNumber() ? value.asNumber() : 0.0;
}

}  // namespace

void addCloud(CacheWriter& writer, std::uint32_t b, const BodyInputs& inputs,
              const BodyCloud::View& cloud) {
    const Fingerprint light = lightFingerprint(inputs);
    cloud.cloud.needAll();
    writer.add<SurfacePoint>(kPoints, b, pointsFingerprint(inputs), cloud.cloud.points);
    writer.add<Rgb>(kIrradiance, b, light, cloud.cloud.irradiance);
    writer.add<OctreeNode>(kOctree, b, light, cloud.nodes);
    writer.add<NodesBefore>(kNodesBefore, b, light,
                            nodesBefore(cloud.nodes, cachePartShift(sizeof(OctreeNode))));
    if (!cloud.solved.empty()) addSolved(writer, b, inputs, cloud.solved);
}

BodyCloud::View cloudOf(const CacheFile& file, std::uint32_t b, double spacingMm) {
    const CloudSections sections{
        file.unchecked<SurfacePoint>(kPoints, b), file.unchecked<Rgb>(kIrradiance, b),
        file.unchecked<OctreeNode>(kOctree, b), file.section<NodesBefore>(kNodesBefore, b)};
    return {{sections.points.elements, sections.irradiance.elements,
             std::make_shared<const CloudGuard>(sections)},
            sections.nodes.elements,
            spacingMm,
            {}};
}

void addSolved(CacheWriter& writer, std::uint32_t b, const BodyInputs& inputs,
               std::span<const SolvedExitance> solved) {
    writer.add<SolvedExitance>(kShape, b, shapeFingerprint(inputs), solved);
}

std::span<const SolvedExitance> solvedOf(const CacheFile& file, std::uint32_t b,
                                         std::size_t points) {
    const auto solved = file.section<SolvedExitance>(kShape, b);
    if (solved.size() != points)
        refuse(file, fmt::format("the solution of body {} does not fit its points", b));
    return solved;
}

void addBeams(CacheWriter& writer, const BodyInputs& inputs, const EnteredBeams& beams) {
    writer.add<std::uint32_t>(kBeams, 0, lightFingerprint(inputs), beams.directions);
}

EnteredBeams beamsOf(const CacheFile& file, std::size_t points) {
    EnteredBeams beams{copyOf<std::uint32_t>(file, kBeams)};
    if (beams.directions.size() != points * EnteredBeams::kPerPoint)
        refuse(file, "its beams do not fit its points");
    return beams;
}

void addSamples(CacheWriter& writer, const BodyInputs& inputs, const SurfaceSamples& samples) {
    const Fingerprint made = pointsFingerprint(inputs);
    writer.add<SurfacePoint>(kPoints, 0, made, samples.points);
    writer.add<CellPiece>(kPieces, 0, made, samples.cells.pieces);
    writer.add<Vec2>(kCorners, 0, made, samples.cells.corners);
    writer.add<std::uint32_t>(kFirstPiece, 0, made, samples.cells.firstPiece);
}

SurfaceSamples samplesOf(const CacheFile& file, std::size_t faces) {
    SurfaceSamples samples;
    samples.points = copyOf<SurfacePoint>(file, kPoints);
    samples.cells.pieces = copyOf<CellPiece>(file, kPieces);
    samples.cells.corners = copyOf<Vec2>(file, kCorners);
    samples.cells.firstPiece = copyOf<std::uint32_t>(file, kFirstPiece);
    if (!areSound(samples, faces)) refuse(file, "its cells do not fit its points");
    return samples;
}

JsonValue describeBody(const World& world, int index, const BodyReport& report,
                       const BodyInputs& inputs) {
    const Body& body = world.bodies()[static_cast<std::size_t>(index)];
    const TranslucentMaterial& material = world.materialOf(body);
    JsonValue hashes = JsonValue::object();
    for (const InputFingerprint& input : inputs) hashes.set(input.key, input.value.hex());
    JsonValue json = JsonValue::object();
    json.set("name", body.name)
        .set("points", report.points)
        .set("nodes", report.nodes)
        .set("areaMm2", report.areaMm2)
        .set("spacingMm", report.spacingMm)
        .set("meanFreePathMm", list(material.medium.meanFreePathMm()))
        .set("sigmaAPerMm", list(material.medium.sigmaA))
        .set("sigmaSPerMm", list(material.medium.sigmaS))
        .set("g", list(material.medium.g))
        .set("eta", material.medium.eta)
        .set("expectedQuadratureError", report.expectedQuadratureError)
        .set("irradianceSamples", report.irradianceSamples)
        .set("irradianceNoise", report.irradianceNoise)
        .set("inputs", std::move(hashes));
    if (report.unscatteredShare) json.set(kUnscattered, *report.unscatteredShare);
    return json;
}

BodyReport reportOf(const JsonValue& described, const std::string& where) {
    BodyReport report;
    const JsonValue& name = metaMember(described, "name", where);
    if (name.isString()) report.name = name.asString();
    report.points = static_cast<std::size_t>(numberIn(described, "points", where));
    report.nodes = static_cast<std::size_t>(numberIn(described, "nodes", where));
    report.areaMm2 = numberIn(described, "areaMm2", where);
    report.spacingMm = numberIn(described, "spacingMm", where);
    report.expectedQuadratureError = numberIn(described, "expectedQuadratureError", where);
    report.irradianceSamples = static_cast<int>(numberIn(described, "irradianceSamples", where));
    report.irradianceNoise = numberIn(described, "irradianceNoise", where);
    if (described.find(kUnscattered) != nullptr)
        report.unscatteredShare = numberIn(described, kUnscattered, where);
    return report;
}

JsonValue metadataOf(const CacheFile& file) {
    return parseJson(file.text(kMeta, 0), file.path().string());
}

void addMetadata(CacheWriter& writer, const JsonValue& meta) {
    writer.addText(kMeta, 0, {}, dump(meta, 2));
}

const JsonValue& metaMember(const JsonValue& object, std::string_view key,
                            const std::string& where) {
    const JsonMember* found = object.isObject() ? object.find(key) : nullptr;
    if (!found)
        throw Error(ErrorKind::BadInput, where, fmt::format("its metadata has no \"{}\"", key),
                    "run sss-preprocess again");
    return found->value;
}

}  // namespace sss
