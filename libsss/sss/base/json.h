#pragma once
#include <concepts>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace sss {

/// Where a token stands in its file: 1-based line and column, columns counted in characters (UTF-8
/// code points, a tab is one). 0 = built in memory, not read.
struct JsonPlace {
    int line = 0, column = 0;
    bool operator==(const JsonPlace&) const = default;
};

struct JsonMember;

template <typename T>
concept JsonNumber = (std::integral<T> && !std::same_as<T, bool>) || std::floating_point<T>;

/// A JSON value that knows where it was read. Objects keep the order of their keys. Numbers are
/// doubles; whole numbers are exact up to 2^53 (RFC 8259 section 6) and written without a point.
class JsonValue {
public:
    using Array = std::vector<JsonValue>;
    using Object = std::vector<JsonMember>;

    JsonValue() = default;  ///< null
    JsonValue(bool value);
    template <JsonNumber Number>
    JsonValue(Number value);
    JsonValue(std::string value);
    JsonValue(std::string_view value);
    JsonValue(const char* value);
    ~JsonValue();
    JsonValue(const JsonValue& other);
    JsonValue& operator=(const JsonValue& other);
    JsonValue(JsonValue&& other) noexcept;
    JsonValue& operator=(JsonValue&& other) noexcept;

    static JsonValue array();
    static JsonValue array(Array items);
    static JsonValue object();

    bool isNull() const { return std::holds_alternative<std::monostate>(data_); }
    bool isBool() const { return std::holds_alternative<bool>(data_); }
    bool isNumber() const { return std::holds_alternative<double>(data_); }
    bool isString() const { return std::holds_alternative<std::string>(data_); }
    bool isArray() const { return std::holds_alternative<Array>(data_); }
    bool isObject() const { return std::holds_alternative<Object>(data_); }
    /// "null", "true or false", "a number", "a string", "an array" or "an object": for messages.
    std::string_view kindName() const;

    /// The content; the caller has checked the kind (std::bad_variant_access otherwise).
    bool asBool() const { return std::get<bool>(data_); }
    double asNumber() const { return std::get<double>(data_); }
    const std::string& asString() const { return std::get<std::string>(data_); }
    const Array& items() const { return std::get<Array>(data_); }
    const Object& members() const { return std::get<Object>(data_); }

    /// The member of an object with this key, or null.
    const JsonMember* find(std::string_view key) const;

    /// Appends to an array. Returns this, so that calls chain.
    JsonValue& push(JsonValue item);
    /// Sets a member of an object; a new key goes to the end. Returns this, so that calls chain.
    JsonValue& set(std::string key, JsonValue value);
    /// As set(), for a key that the caller knows to be new.
    JsonValue& append(JsonMember member);

    JsonPlace place;

private:
    std::variant<std::monostate, bool, double, std::string, Array, Object> data_;
};

struct JsonMember {
    std::string key;
    JsonPlace keyPlace;
    JsonValue value;
};

template <JsonNumber Number>
JsonValue::JsonValue(Number value) : data_(static_cast<double>(value)) {}

inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
inline constexpr int kMaxJsonDepth = 64;

/// Parses strict JSON (UTF-8, no comments). Throws Error{BadInput} at "fileName:line:column" for
/// syntax errors, duplicate keys, invalid UTF-8, numbers that a double cannot hold, nesting deeper
/// than kMaxJsonDepth and text over kMaxJsonBytes.
JsonValue parseJson(std::string_view text, const std::string& fileName);

/// parseJson of a file. Throws Error{Io} if it cannot be read.
JsonValue readJsonFile(const std::filesystem::path& file);

/// The value as text: on one line if `indent` < 0, otherwise with that many spaces a level. Numbers
/// in the shortest form that reads back equal; NaN and infinity, which JSON lacks, become null;
/// bytes that are not UTF-8 become U+FFFD.
std::string dump(const JsonValue& value, int indent = 2);

}  // namespace sss
