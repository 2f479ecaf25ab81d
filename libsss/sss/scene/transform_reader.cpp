#include "sss/scene/transform_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sss {
namespace {

constexpr std::size_t kMostSteps = 1000;

TransformStep readTranslate(const Node& node) { return glm::translate(DMat4(1), point(node)); }

struct Rotation {
    DVec3 axis{0, 1, 0};
    double degrees = 0;
};
constexpr Field<Rotation> kRotationFields[] = {
    {"axis", [](Rotation& r, const Node& n) { r.axis = direction(n); }, true},
    {"degrees", [](Rotation& r, const Node& n) { r.degrees = number(n, kAngleRange); }, true},
};

TransformStep readRotate(const Node& node) {
    Rotation rotation;
    FieldSet fields;
    fields.add(rotation, kRotationFields);
    fields.read(node);
    return glm::rotate(DMat4(1), rotation.degrees * (kPi / 180), glm::normalize(rotation.axis));
}

/// A number, or one for each axis. Negative ones mirror.
TransformStep readScale(const Node& node) {
    const Range range{-1e9, 1e9};
    const DVec3 factors = node.value.isNumber() ? DVec3(number(node, range)) : vector(node, range);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(factors[axis]) >= 1e-9) continue;
        fail(node, fmt::format("is {} along {}", factors[axis], "xyz"[axis]),
             "a factor must be at least 1e-9 in size, or nothing is left of the object");
    }
    return glm::scale(DMat4(1), factors);
}

/// Row by row as one writes it; the last column is the translation in scene units.
TransformStep readMatrix(const Node& node) {
    DMat4 matrix(1);
    const std::vector<Node> numbers = entries(node, 16, 16);
    for (int i = 0; i < 16; ++i)
        matrix[i % 4][i / 4] = number(numbers[static_cast<std::size_t>(i)], {-1e9, 1e9});
    for (int column = 0; column < 4; ++column) {
        if (matrix[column][3] == (column == 3 ? 1.0 : 0.0)) continue;
        fail(node, "is not affine", "its last four numbers, the last row, must be 0, 0, 0, 1");
    }
    const DMat3 linear(matrix);
    double edges = 1;
    for (int column = 0; column < 3; ++column) edges *= glm::length(linear[column]);
    // Relative to the box that the columns would span at right angles.
    if (!(std::abs(glm::determinant(linear)) > 1e-12 * edges)) {
        fail(node, "flattens the object", "its first three columns must span a volume");
    }
    matrix[3] = {DVec3(matrix[3]) * node.context.mmPerUnit, 1.0};
    return matrix;
}

constexpr Field<FitStep> kFitFields[] = {
    {"height", [](FitStep& f, const Node& n) { f.heightMm = length(n, kSizeRange); }, true},
    {"centre", [](FitStep& f, const Node& n) { f.centre = point(n); }},
};

TransformStep readFit(const Node& node) {
    FitStep fit;
    FieldSet fields;
    fields.add(fit, kFitFields);
    fields.read(node);
    return fit;
}

constexpr Field<TransformStep> kStepFields[] = {
    {"translate", [](TransformStep& s, const Node& n) { s = readTranslate(n); }},
    {"rotate", [](TransformStep& s, const Node& n) { s = readRotate(n); }},
    {"scale", [](TransformStep& s, const Node& n) { s = readScale(n); }},
    {"matrix", [](TransformStep& s, const Node& n) { s = readMatrix(n); }},
    {"fit", [](TransformStep& s, const Node& n) { s = readFit(n); }},
};

}  // namespace

std::vector<TransformStep> readTransform(const Node& node) {
    std::vector<TransformStep> steps;
    for (const Node& entry : entries(node, 0, kMostSteps)) {
        TransformStep step = DMat4(1);
        FieldSet fields;
        fields.add(step, kStepFields);
        fields.read(entry);
        if (const std::size_t count = entry.value.members().size(); count != 1) {
            fail(entry, fmt::format("has {} steps", count),
                 "one step an entry, so that their order is plain: [{ \"scale\": 2 }, "
                 "{ \"translate\": [1, 0, 0] }]");
        }
        steps.push_back(step);
    }
    return steps;
}

RigidTransform readMotion(const Node& node) {
    DMat4 matrix(1);
    for (const TransformStep& step : readTransform(node)) {
        const auto* affine = std::get_if<DMat4>(&step);
        if (affine == nullptr)
            fail(node, "has a \"fit\"", "that is for objects, which have a size");
        matrix = *affine * matrix;
    }
    const RigidTransform motion{DMat3(matrix), DVec3(matrix[3])};
    const DMat3 gram = glm::transpose(motion.rotation) * motion.rotation;
    double worst = std::abs(glm::determinant(motion.rotation) - 1);
    for (int column = 0; column < 3; ++column)
        worst = std::max(worst, maxComponent(glm::abs(gram[column] - DMat3(1)[column])));
    if (worst > 1e-6)
        fail(node, "scales, shears or mirrors", "a camera or a light can be moved and turned only");
    return motion;
}

void listTransformKeys(std::vector<KeyList>& out) {
    out.push_back(listRows<TransformStep>("transform", kStepFields));
    out.push_back(listRows<Rotation>("transform.rotate", kRotationFields));
    out.push_back(listRows<FitStep>("transform.fit", kFitFields));
}

}  // namespace sss
