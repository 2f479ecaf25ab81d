#include "sss/scene/object_reader.h"

#include "sss/base/near_name.h"
#include "sss/scene/shape_reader.h"
#include "sss/scene/transform_reader.h"

#include <fmt/format.h>

#include <unordered_map>
#include <unordered_set>

namespace sss {
namespace {

constexpr std::size_t kMostObjects = 1000000;

int readMaterialName(const Node& node) {
    std::vector<std::string_view> names;
    for (const NamedMaterial& material : *node.context.materials) names.push_back(material.name);
    return static_cast<int>(choice(node, names));
}

// In the order of NormalsMode.
constexpr std::string_view kNormalsModes[] = {"auto", "smooth", "flat"};

constexpr Field<ObjectSettings> kObjectFields[] = {
    {"name", [](ObjectSettings& o, const Node& n) { o.name = text(n); }},
    {"material", [](ObjectSettings& o, const Node& n) { o.material = readMaterialName(n); }, true},
    {"group", [](ObjectSettings& o, const Node& n) { o.group = text(n); }},
    {"normals",
     [](ObjectSettings& o, const Node& n) {
         o.normals = static_cast<NormalsMode>(choice(n, kNormalsModes));
     }},
    {"transform", [](ObjectSettings& o, const Node& n) { o.transform = readTransform(n); }},
};

ObjectSettings readObject(const Node& node) {
    const Kind<Shape>& kind = shapeKind(node);
    ObjectSettings object;
    object.shape = kind.start;
    object.line = node.value.place.line;
    object.column = node.value.place.column;
    FieldSet fields;
    kind.addFields(object.shape, fields);
    fields.add(object, kObjectFields);
    fields.read(node);
    return object;
}

/// The objects of the array, called by their names in messages if they have one.
std::vector<Node> objectNodes(const Node& node) {
    std::vector<Node> out;
    for (const Node& entry : entries(node, 1, kMostObjects)) {
        const JsonMember* name = entry.value.isObject() ? entry.value.find("name") : nullptr;
        const bool named = name != nullptr && name->value.isString();
        out.push_back({entry.value,
                       named ? "object " + inQuotes(name->value.asString()) : entry.name,
                       entry.context});
    }
    return out;
}

/// A group is one body, and a body has one medium.
class GroupCheck {
public:
    void add(const ObjectSettings& object, const Node& node) {
        if (object.group.empty()) return;
        const NamedMaterial& mine = material(object, node);
        if (!std::holds_alternative<TranslucentMaterial>(mine.material)) {
            fail(node,
                 fmt::format("is in a group, but its material {} is not translucent",
                             inQuotes(mine.name)),
                 "remove \"group\": it joins translucent objects into one body");
        }
        const auto [first, isNew] = first_.try_emplace(object.group, object.material);
        if (!isNew && first->second != object.material) {
            const auto other = static_cast<std::size_t>(first->second);
            fail(node,
                 fmt::format("is of {}, but its group {} is of {}", inQuotes(mine.name),
                             inQuotes(object.group),
                             inQuotes((*node.context.materials)[other].name)),
                 "give all objects of a group the same material");
        }
    }

private:
    static const NamedMaterial& material(const ObjectSettings& object, const Node& node) {
        return (*node.context.materials)[static_cast<std::size_t>(object.material)];
    }
    std::unordered_map<std::string, int> first_;
};

void nameTheNameless(const std::vector<Node>& nodes, std::vector<ObjectSettings>& objects) {
    std::unordered_set<std::string> names;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].name.empty() || names.insert(objects[i].name).second) continue;
        const Node name = memberNode(nodes[i], "name", "");
        fail(name, "is " + inQuotes(objects[i].name) + ", the name of an object before it",
             "give every object a name of its own, or none");
    }
    std::unordered_map<std::string, int> count;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (!objects[i].name.empty()) continue;
        const std::string base = shapeName(shapeKind(nodes[i]), objects[i].shape);
        do {
            const int number = ++count[base];
            objects[i].name = number == 1 ? base : fmt::format("{}-{}", base, number);
        } while (!names.insert(objects[i].name).second);
    }
}

}  // namespace

std::vector<ObjectSettings> readObjects(const Node& node) {
    std::vector<ObjectSettings> objects;
    GroupCheck groups;
    const std::vector<Node> nodes = objectNodes(node);
    for (const Node& entry : nodes) {
        objects.push_back(readObject(entry));
        groups.add(objects.back(), entry);
    }
    nameTheNameless(nodes, objects);
    return objects;
}

void listObjectKeys(std::vector<KeyList>& out) {
    for (const Kind<Shape>& kind : shapeKinds()) {
        Shape shape = kind.start;
        ObjectSettings object;
        FieldSet fields;
        kind.addFields(shape, fields);
        fields.add(object, kObjectFields);
        out.push_back({"object." + std::string(kind.name), fields.keys()});
    }
    listTransformKeys(out);
}

}  // namespace sss
