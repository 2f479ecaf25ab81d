#include "sss/scene/animation.h"

#include "sss/base/frame_list.h"
#include "sss/scene/interpolation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sss {
namespace {

constexpr std::size_t kMostKeys = 100000;
constexpr Range kFrameRange{-999999, 999999};
constexpr Range kAnyNumber{-1e30, 1e30};
constexpr std::string_view kInterpolations[] = {"linear", "smooth"};  // in the order of the enum
constexpr std::string_view kAnimatedParts[] = {"camera", "materials", "objects", "lights",
                                               "volumes"};
constexpr std::string_view kFileKeys[] = {"mesh", "map", "file"};

struct Key {
    double frame = 0;
    std::optional<Node> value;
};
struct Curve {
    std::vector<Key> keys;
    Interpolation how = Interpolation::Linear;
};

constexpr Field<Key> kKeyFields[] = {
    {"frame", [](Key& k, const Node& n) { k.frame = number(n, kFrameRange); }, true},
    {"value", [](Key& k, const Node& n) { k.value.emplace(n); }, true},
};

std::vector<Key> readKeys(const Node& node) {
    std::vector<Key> keys;
    for (const Node& entry : entries(node, 1, kMostKeys)) {
        Key key;
        FieldSet fields;
        fields.add(key, kKeyFields);
        fields.read(entry);
        if (!keys.empty() && !(key.frame > keys.back().frame))
            fail(entry,
                 fmt::format("is of frame {}, not after the one before it, of frame {}", key.frame,
                             keys.back().frame),
                 "write the keys in the order of their frames, one a frame");
        keys.push_back(std::move(key));
    }
    return keys;
}

constexpr Field<Curve> kCurveFields[] = {
    {"keys", [](Curve& c, const Node& n) { c.keys = readKeys(n); }, true},
    {"interpolation",
     [](Curve& c, const Node& n) {
         c.how = static_cast<Interpolation>(choice(n, kInterpolations));
     }},
};

/// An animated value, not a material that is called "keys".
bool isCurve(const JsonValue& value) {
    if (!value.isObject()) return false;
    const JsonMember* keys = value.find("keys");
    return keys != nullptr && keys->value.isArray();
}

bool isFileKey(std::string_view key) {
    return std::find(std::begin(kFileKeys), std::end(kFileKeys), key) != std::end(kFileKeys);
}

/// An array or object of the same kind with other contents, at the same place of the file.
JsonValue at(JsonPlace place, JsonValue value) {
    value.place = place;
    return value;
}

class FrameResolver {
public:
    explicit FrameResolver(double frame) : frame_(frame) {}

    JsonValue resolved(const Node& node) const {
        const JsonValue& value = node.value;
        if (isCurve(value)) return at(value.place, valueOf(node));
        if (value.isArray()) {
            JsonValue::Array items;
            for (std::size_t i = 0; i < value.items().size(); ++i)
                items.push_back(resolved(
                    {value.items()[i], fmt::format("{}[{}]", node.name, i), node.context}));
            return at(value.place, JsonValue::array(std::move(items)));
        }
        if (!value.isObject()) return value;
        JsonValue object = JsonValue::object();
        for (const JsonMember& member : value.members()) {
            const bool isFile = isFileKey(member.key) && member.value.isString();
            JsonValue now = isFile ? at(member.value.place, frameName(member.value.asString(),
                                                                      static_cast<int>(frame_)))
                                   : resolved({member.value, member.key, node.context});
            object.append({member.key, member.keyPlace, std::move(now)});
        }
        return at(value.place, std::move(object));
    }

private:
    JsonValue valueOf(const Node& node) const {
        Curve curve;
        FieldSet fields;
        fields.add(curve, kCurveFields);
        fields.read(node);
        const JsonValue& first = curve.keys.front().value->value;
        if (first.isObject()) return rotation(curve);
        if (!first.isArray()) {
            std::vector<double> values;
            for (const Key& key : curve.keys) values.push_back(number(*key.value, kAnyNumber));
            return numberOf(curve, values);
        }
        const std::size_t count = first.items().size();
        std::vector<std::vector<double>> values(count);
        for (const Key& key : curve.keys) {
            const std::vector<Node> parts = entries(*key.value, count, count);
            for (std::size_t i = 0; i < count; ++i)
                values[i].push_back(number(parts[i], kAnyNumber));
        }
        JsonValue::Array items;
        for (const std::vector<double>& component : values)
            items.push_back(at(node.value.place, numberOf(curve, component)));
        return JsonValue::array(std::move(items));
    }

    static std::vector<double> timesOf(const Curve& curve) {
        std::vector<double> times;
        for (const Key& key : curve.keys) times.push_back(key.frame);
        return times;
    }

    JsonValue numberOf(const Curve& curve, std::span<const double> values) const {
        return interpolate(timesOf(curve), values, frame_, curve.how);
    }

    JsonValue rotation(const Curve& curve) const {
        std::vector<Quaternion> turns;
        for (const Key& key : curve.keys) {
            const DVec3 axis = glm::normalize(direction(memberNode(*key.value, "axis", "")));
            const double degrees = number(memberNode(*key.value, "degrees", ""), kAngleRange);
            if (const std::size_t count = key.value->value.members().size(); count != 2)
                fail(*key.value, fmt::format("has {} members", count),
                     "a rotation has \"axis\" and \"degrees\"");
            turns.push_back(quaternionOf(axis, degrees * (kPi / 180)));
        }
        const Quaternion turn = interpolate(timesOf(curve), turns, frame_, curve.how);
        const double sine = glm::length(turn.v);
        const DVec3 axis = sine > 1e-12 ? turn.v / sine : DVec3(0, 1, 0);
        JsonValue object = JsonValue::object();
        object.set("axis", JsonValue::array({axis.x, axis.y, axis.z}))
            .set("degrees", 2 * std::atan2(sine, turn.w) * (180 / kPi));
        return object;
    }

    double frame_;
};

void collectFrames(const JsonValue& value, std::vector<double>& frames) {
    if (isCurve(value)) {
        for (const JsonValue& key : value.find("keys")->value.items()) {
            const JsonMember* frame = key.isObject() ? key.find("frame") : nullptr;
            if (frame != nullptr && frame->value.isNumber())
                frames.push_back(frame->value.asNumber());
        }
    } else if (value.isArray()) {
        for (const JsonValue& item : value.items()) collectFrames(item, frames);
    } else if (value.isObject()) {
        for (const JsonMember& member : value.members()) collectFrames(member.value, frames);
    }
}

}  // namespace

JsonValue sceneAt(const JsonValue& root, int frame, const std::string& file) {
    if (!root.isObject()) return root;  // the reader says what is wrong with it
    const ReadContext context{file, {}};
    const FrameResolver resolver(frame);
    JsonValue scene = JsonValue::object();
    for (const JsonMember& member : root.members()) {
        const bool mayMove = std::find(std::begin(kAnimatedParts), std::end(kAnimatedParts),
                                       member.key) != std::end(kAnimatedParts);
        scene.append(
            {member.key, member.keyPlace,
             mayMove ? resolver.resolved({member.value, member.key, context}) : member.value});
    }
    return at(root.place, std::move(scene));
}

bool isAnimated(const JsonValue& value) {
    if (isCurve(value)) return true;
    if (value.isArray()) return std::ranges::any_of(value.items(), isAnimated);
    if (!value.isObject()) return false;
    return std::ranges::any_of(value.members(), [](const JsonMember& m) {
        return (isFileKey(m.key) && m.value.isString() && hasFrameField(m.value.asString())) ||
               isAnimated(m.value);
    });
}

std::vector<double> keyFrames(const JsonValue& value) {
    std::vector<double> frames;
    collectFrames(value, frames);
    std::ranges::sort(frames);
    // Not std::ranges::unique: clang 14, which builds the fuzzers, cannot compile GCC 12's.
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

void listAnimationKeys(std::vector<KeyList>& out) {
    out.push_back(listRows<Curve>("animated", kCurveFields));
    out.push_back(listRows<Key>("animated.key", kKeyFields));
}

}  // namespace sss
