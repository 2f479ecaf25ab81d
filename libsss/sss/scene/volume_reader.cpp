#include "sss/scene/volume_reader.h"

#include "sss/scene/shape_reader.h"
#include "sss/scene/transform_reader.h"

#include <fmt/format.h>

namespace sss {
namespace {

constexpr std::size_t kMostVolumes = 1000;
constexpr int kMostNodes = 4096;  // along one axis
constexpr Range kCoefficientRange{0, 1e9, false, false, "mm^-1"};
constexpr Range kMeanCosineRange{-1, 1, true, true};

constexpr Field<GridFile> kGridFields[] = {
    {"file", [](GridFile& g, const Node& n) { g.path = filePath(n); }, true},
    {"dimensions",
     [](GridFile& g, const Node& n) {
         const std::vector<Node> sizes = entries(n, 3, 3);
         g.nx = wholeNumber(sizes[0], 2, kMostNodes);
         g.ny = wholeNumber(sizes[1], 2, kMostNodes);
         g.nz = wholeNumber(sizes[2], 2, kMostNodes);
     },
     true},
    {"channels",
     [](GridFile& g, const Node& n) {
         g.channels = wholeNumber(n, 1, 4);
         if (g.channels != 1 && g.channels != 4)
             fail(n, fmt::format("is {}", g.channels),
                  "1 is density alone, 4 is density and three factors of the emission");
     }},
};

GridFile readGrid(const Node& node) {
    GridFile grid;
    FieldSet fields;
    fields.add(grid, kGridFields);
    fields.read(node);
    return grid;
}

constexpr Field<VolumeSettings> kVolumeFields[] = {
    {"name", [](VolumeSettings& v, const Node& n) { v.name = text(n); }},
    {"transform", [](VolumeSettings& v, const Node& n) { v.transform = readTransform(n); }},
    {"sigmaAPerMm", [](VolumeSettings& v, const Node& n) { v.sigmaA = rgb(n, kCoefficientRange); }},
    {"sigmaSPerMm", [](VolumeSettings& v, const Node& n) { v.sigmaS = rgb(n, kCoefficientRange); }},
    {"g", [](VolumeSettings& v, const Node& n) { v.g = number(n, kMeanCosineRange); }},
    {"emission", [](VolumeSettings& v, const Node& n) { v.emission = rgb(n, kLightRange); }},
    {"grid", [](VolumeSettings& v, const Node& n) { v.grid = readGrid(n); }},
};

bool enclosesSpace(const Shape& shape) {
    return !std::holds_alternative<RectangleShape>(shape) &&
           !std::holds_alternative<DiskShape>(shape);
}

void checkVolume(const VolumeSettings& volume, const Node& node) {
    if (!enclosesSpace(volume.shape))
        fail(node, "is flat: it has no inside",
             "take a box, a sphere, a cylinder or the mesh of a closed surface");
    if (isZero(volume.sigmaA) && isZero(volume.sigmaS))
        fail(node, "neither absorbs nor scatters",
             "give \"sigmaAPerMm\" or \"sigmaSPerMm\", in mm^-1");
    if (!isZero(volume.emission) && isZero(volume.emission * volume.sigmaA))
        fail(node, "has \"emission\" but absorbs nothing of that colour, so that it emits nothing",
             "give \"sigmaAPerMm\": what is emitted along a mm is the product of the two");
}

VolumeSettings readVolume(const Node& node) {
    const Kind<Shape>& kind = shapeKind(node);
    VolumeSettings volume;
    volume.shape = kind.start;
    volume.line = node.value.place.line;
    volume.column = node.value.place.column;
    FieldSet fields;
    kind.addFields(volume.shape, fields);
    fields.add(volume, kVolumeFields);
    fields.read(node);
    checkVolume(volume, node);
    return volume;
}

}  // namespace

std::vector<VolumeSettings> readVolumes(const Node& node) {
    std::vector<VolumeSettings> volumes;
    for (const Node& entry : entries(node, 0, kMostVolumes)) {
        volumes.push_back(readVolume(entry));
        if (volumes.back().name.empty()) volumes.back().name = entry.name;
    }
    return volumes;
}

void listVolumeKeys(std::vector<KeyList>& out) {
    for (const Kind<Shape>& kind : shapeKinds()) {
        Shape shape = kind.start;
        if (!enclosesSpace(shape)) continue;
        VolumeSettings volume;
        FieldSet fields;
        kind.addFields(shape, fields);
        fields.add(volume, kVolumeFields);
        out.push_back({"volume." + std::string(kind.name), fields.keys()});
    }
    out.push_back(listRows<GridFile>("volume.grid", kGridFields));
}

}  // namespace sss
