#pragma once
#include "sss/scene/node.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace sss {

/// One key of an object of the scene file: a row of its table. A row with no `read` is read
/// elsewhere (its comment says where) and stands in the table so that the key is known.
template <typename Target>
struct Field {
    std::string_view key;
    void (*read)(Target&, const Node&) = nullptr;
    bool required = false;
};

/// The keys that one object may have, gathered from one or more tables, each bound to what it
/// fills.
class FieldSet {
public:
    /// Adds a table. `target` must live until read().
    template <typename Target>
    void add(Target& target, std::span<const Field<std::type_identity_t<Target>>> rows) {
        for (const Field<Target>& row : rows) {
            auto read = row.read == nullptr
                            ? std::function<void(const Node&)>()
                            : [&target, read = row.read](const Node& node) { read(target, node); };
            fields_.push_back({row.key, std::move(read), row.required});
        }
    }

    /// Reads the members of `object` in the order of the file. Throws Error{BadInput} if it is not
    /// an object, has an unknown key (with the nearest known one) or lacks a required one.
    void read(const Node& object) const;

    std::vector<std::string_view> keys() const;

private:
    struct BoundField {
        std::string_view key;
        std::function<void(const Node&)> read;
        bool required;
    };
    std::vector<BoundField> fields_;
};

/// A kind of something (material, shape, light): what its "type" says, the alternative of the
/// variant that it is, with defaults, and its keys. A new kind costs a row.
template <typename Variant>
struct Kind {
    std::string_view name;
    Variant start;
    void (*addFields)(Variant&, FieldSet&);
    /// What only all members together can tell, or null.
    void (*finish)(Variant&, const Node&) = nullptr;
};

/// The addFields of a kind whose alternative is `Target` and whose keys are `rows`.
template <typename Target, const auto& rows, typename Variant>
void addRows(Variant& variant, FieldSet& fields) {
    fields.add(std::get<Target>(variant), rows);
}

/// The row of `kinds` named by the member `key` of `object`. Throws Error{BadInput} naming the
/// nearest one.
std::size_t kindIndex(const Node& object, std::string_view key,
                      std::span<const std::string_view> names);
template <typename Variant>
const Kind<Variant>& kindOf(const Node& object, std::string_view key,
                            std::span<const Kind<Variant>> kinds) {
    std::vector<std::string_view> names;
    for (const Kind<Variant>& kind : kinds) names.push_back(kind.name);
    return kinds[kindIndex(object, key, names)];
}

/// Reads an object of a known kind.
template <typename Variant>
Variant readKind(const Kind<Variant>& kind, const Node& object) {
    Variant out = kind.start;
    FieldSet fields;
    kind.addFields(out, fields);
    fields.read(object);
    if (kind.finish != nullptr) kind.finish(out, object);
    return out;
}

/// Throws Error{BadInput} at the first member whose key looks like a slip for one of `keys`, none
/// of which `object` has.
void refuseSlips(const Node& object, std::span<const std::string_view> keys);

/// The member of `object` under `key`. Throws Error{BadInput} if there is none, with the member
/// that looks like a slip for it or else with `hint`.
Node memberNode(const Node& object, std::string_view key, const std::string& hint);

/// The keys that the scene reader knows in one kind of object, e.g. {"material.metal", {...}}:
/// scenes/scene.schema.json has a definition of the same name with the same properties.
struct KeyList {
    std::string owner;
    std::vector<std::string_view> keys;
};

template <typename Target>
KeyList listRows(std::string_view owner, std::span<const Field<Target>> rows) {
    KeyList list{std::string(owner), {}};
    for (const Field<Target>& row : rows) list.keys.push_back(row.key);
    return list;
}
template <typename Variant>
void listKinds(std::string_view family, std::span<const Kind<Variant>> kinds,
               std::vector<KeyList>& out) {
    for (const Kind<Variant>& kind : kinds) {
        Variant scratch = kind.start;
        FieldSet fields;
        kind.addFields(scratch, fields);
        out.push_back({std::string(family) + "." + std::string(kind.name), fields.keys()});
    }
}

}  // namespace sss
