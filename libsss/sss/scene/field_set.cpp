#include "sss/scene/field_set.h"

#include "sss/base/near_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sss {
namespace {

Node nodeOf(const Node& object, const JsonMember& member) {
    return {member.value, inQuotes(member.key), object.context};
}

void requireObject(const Node& node) {
    if (node.value.isObject()) return;
    fail(node, fmt::format("is {}", node.value.kindName()),
         "it must be an object { \"key\": value, ... }");
}

}  // namespace

void FieldSet::read(const Node& object) const {
    requireObject(object);
    for (const JsonMember& member : object.value.members()) {
        const auto field = std::ranges::find(fields_, member.key, &BoundField::key);
        if (field == fields_.end()) {
            fail(object, member.keyPlace,
                 fmt::format("unknown key {} in {}", inQuotes(member.key), object.name),
                 nameHint(member.key, keys()));
        }
        if (field->read) field->read(nodeOf(object, member));
    }
    for (const BoundField& field : fields_) {
        if (field.required && object.value.find(field.key) == nullptr) {
            fail(object, fmt::format("lacks \"{}\"", field.key),
                 "add it; scenes/README.md says what it holds");
        }
    }
}

std::vector<std::string_view> FieldSet::keys() const {
    std::vector<std::string_view> out;
    for (const BoundField& field : fields_) out.push_back(field.key);
    return out;
}

void refuseSlips(const Node& object, std::span<const std::string_view> keys) {
    requireObject(object);
    for (const JsonMember& member : object.value.members()) {
        const std::string meant = nearestName(member.key, keys);
        if (meant.empty()) continue;
        fail(object, member.keyPlace,
             fmt::format("unknown key {} in {}", inQuotes(member.key), object.name),
             fmt::format("did you mean \"{}\"?", meant));
    }
}

Node memberNode(const Node& object, std::string_view key, const std::string& hint) {
    requireObject(object);
    if (const JsonMember* member = object.value.find(key)) return nodeOf(object, *member);
    refuseSlips(object, std::array{key});
    fail(object, fmt::format("lacks \"{}\"", key), hint);
}

std::size_t kindIndex(const Node& object, std::string_view key,
                      std::span<const std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) {
        list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
    }
    return choice(memberNode(object, key, "it must be one of " + list), names);
}

}  // namespace sss
