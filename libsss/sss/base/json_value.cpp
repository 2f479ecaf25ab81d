#include "sss/base/json.h"

namespace sss {

// Not in the class, where JsonMember is yet to come.
JsonValue::JsonValue(bool value) : data_(value) {}
JsonValue::JsonValue(std::string value) : data_(std::move(value)) {}
JsonValue::JsonValue(std::string_view value) : data_(std::string(value)) {}
JsonValue::JsonValue(const char* value) : data_(std::string(value)) {}
JsonValue::~JsonValue() = default;
JsonValue::JsonValue(JsonValue&& other) noexcept = default;
JsonValue& JsonValue::operator=(JsonValue&& other) noexcept = default;

// The content is copied beside, and moved: where memory runs out halfway, libstdc++ 12 destroys a
// variant of strings and vectors that has not been made yet.
JsonValue::JsonValue(const JsonValue& other) : place(other.place) {
    std::visit(
        [this](const auto& content) {
            auto copy = content;
            data_ = std::move(copy);
        },
        other.data_);
}

JsonValue& JsonValue::operator=(const JsonValue& other) {
    JsonValue copy(other);
    *this = std::move(copy);
    return *this;
}

JsonValue JsonValue::array() { return array(Array()); }

JsonValue JsonValue::array(Array items) {
    JsonValue value;
    value.data_ = std::move(items);
    return value;
}

JsonValue JsonValue::object() {
    JsonValue value;
    value.data_ = Object();
    return value;
}

std::string_view JsonValue::kindName() const {
    static constexpr std::string_view kNames[] = {"null",     "true or false", "a number",
                                                  "a string", "an array",      "an object"};
    return kNames[data_.index()];
}

const JsonMember* JsonValue::find(std::string_view key) const {
    for (const JsonMember& member : members()) {
        if (member.key == key) return &member;
    }
    return nullptr;
}

JsonValue& JsonValue::push(JsonValue item) {
    std::get<Array>(data_).push_back(std::move(item));
    return *this;
}

JsonValue& JsonValue::set(std::string key, JsonValue value) {
    for (JsonMember& member : std::get<Object>(data_)) {
        if (member.key == key) {
            member.value = std::move(value);
            return *this;
        }
    }
    return append({std::move(key), {}, std::move(value)});
}

JsonValue& JsonValue::append(JsonMember member) {
    std::get<Object>(data_).push_back(std::move(member));
    return *this;
}

}  // namespace sss
