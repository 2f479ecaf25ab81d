#include "sss/base/json.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_set>

namespace sss {
namespace {

/// Follows a text forwards and knows the line and column of each byte offset that it is asked for.
class PlaceCursor {
public:
    explicit PlaceCursor(std::string_view text) : text_(text) {
        if (text.starts_with("\xEF\xBB\xBF")) offset_ = 3;  // a byte order mark is no column
    }
    /// `offset` must not go backwards from call to call.
    JsonPlace at(std::size_t offset) {
        for (; offset_ < offset && offset_ < text_.size(); ++offset_) {
            const auto byte = static_cast<unsigned char>(text_[offset_]);
            if (byte == '\n') {
                ++place_.line;
                place_.column = 1;
            } else if ((byte & 0xC0u) != 0x80u) {  // not the continuation of a character
                ++place_.column;
            }
        }
        return place_;
    }

private:
    std::string_view text_;
    std::size_t offset_ = 0;
    JsonPlace place_{1, 1};
};

std::string located(const std::string& file, JsonPlace place) {
    return fmt::format("{}:{}:{}", file, place.line, place.column);
}

/// Feeds bytes to nlohmann's parser and tells how many it has taken: the library itself (3.11) says
/// nothing about positions but in syntax errors.
class CountingIterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, std::size_t* taken) : at_(at), taken_(taken) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        ++at_;
        ++*taken_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

private:
    const char* at_;
    std::size_t* taken_;
};

/// Builds the tree from nlohmann's events. An event comes when the parser has taken its token (and,
/// after a number, one byte more), so a token starts at the first byte after the previous event
/// that is neither white space nor a separator.
class TreeBuilder {
public:
    using number_integer_t = nlohmann::json::number_integer_t;
    using number_unsigned_t = nlohmann::json::number_unsigned_t;
    using number_float_t = nlohmann::json::number_float_t;
    using string_t = nlohmann::json::string_t;
    using binary_t = nlohmann::json::binary_t;

    TreeBuilder(std::string_view text, const std::string& file, const std::size_t& taken)
        : text_(text), file_(file), taken_(taken), cursor_(text) {}

    JsonValue takeRoot() { return std::move(root_); }

    // Names that nlohmann calls. NOLINTBEGIN(readability-identifier-naming)
    bool null() { return leaf(JsonValue()); }
    bool boolean(bool value) { return leaf(JsonValue(value)); }
    bool number_integer(number_integer_t value) { return leaf(JsonValue(value)); }
    bool number_unsigned(number_unsigned_t value) { return leaf(JsonValue(value)); }
    bool number_float(number_float_t value, const string_t&) { return leaf(JsonValue(value)); }
    bool string(string_t& value) { return leaf(JsonValue(std::move(value))); }
    bool binary(binary_t&) { return false; }  // not in textual JSON

    bool start_object(std::size_t) { return open(JsonValue::object()); }
    bool start_array(std::size_t) { return open(JsonValue::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(string_t& name) {
        const JsonPlace place = nextPlace();
        Level& level = levels_.back();
        if (!level.keys.insert(name).second) {
            throw Error(ErrorKind::BadInput, located(file_, place),
                        fmt::format("the key {} stands twice in this object", inQuotes(name)),
                        "remove one of the two");
        }
        level.key = std::move(name);
        level.keyPlace = place;
        return true;
    }

    bool parse_error(std::size_t position, const std::string& token,
                     const nlohmann::detail::exception& exception) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ...
        // - invalid string: ...; last read: '...'": only what is wrong, and no raw bytes.
        std::string what = exception.what();
        for (const std::string_view prefix : {"] ", ": "}) {
            const std::size_t at = what.find(prefix);
            if (at != std::string::npos) what.erase(0, at + prefix.size());
            if (!what.starts_with("parse error")) break;
        }
        what.resize(std::min(what.size(), what.find("; last read: ")));
        const std::size_t length = tokenLength(what, token);
        const std::size_t offset = what.find("unexpected end of input") != std::string::npos
                                       ? text_.size()
                                       : position - std::min(length, position);
        throw Error(
            ErrorKind::BadInput, located(file_, PlaceCursor(text_).at(offset)), what,
            what.find("invalid literal") != std::string::npos
                ? "JSON knows numbers, \"strings\", true, false and null; no NaN, no Infinity"
                : "");
    }
    // NOLINTEND(readability-identifier-naming)

private:
    /// How many bytes before the parser's position the trouble begins: a token in the wrong place
    /// is reported where it starts, a byte that fits nowhere at that byte. `token` is the token's
    /// text for strings and numbers only.
    static std::size_t tokenLength(std::string_view what, std::string_view token) {
        const auto says = [&](std::string_view part) {
            return what.find(part) != std::string_view::npos;
        };
        if (says("unexpected string") || says("unexpected number") || says("number overflow")) {
            return token.size();
        }
        if (says("unexpected false")) return 5;
        return says("unexpected true") || says("unexpected null") ? 4 : 1;
    }

    struct Level {
        JsonValue container;
        std::unordered_set<std::string> keys;
        std::string key;
        JsonPlace keyPlace;
    };

    JsonPlace nextPlace() {
        const std::size_t start = text_.find_first_not_of(" \t\r\n,:]}", previousEnd_);
        previousEnd_ = taken_;
        return cursor_.at(start);
    }
    bool leaf(JsonValue value) {
        value.place = nextPlace();
        put(std::move(value));
        return true;
    }
    bool open(JsonValue container) {
        container.place = nextPlace();
        if (levels_.size() == static_cast<std::size_t>(kMaxJsonDepth)) {
            throw Error(ErrorKind::BadInput, located(file_, container.place),
                        fmt::format("arrays and objects are nested deeper than {}", kMaxJsonDepth),
                        "flatten the file");
        }
        levels_.push_back({std::move(container), {}, {}, {}});
        return true;
    }
    bool close() {
        previousEnd_ = taken_;
        JsonValue done = std::move(levels_.back().container);
        levels_.pop_back();
        put(std::move(done));
        return true;
    }
    void put(JsonValue value) {
        if (levels_.empty()) {
            root_ = std::move(value);
            return;
        }
        Level& level = levels_.back();
        if (level.container.isArray()) {
            level.container.push(std::move(value));
        } else {
            level.container.append({std::move(level.key), level.keyPlace, std::move(value)});
        }
    }

    std::string_view text_;
    const std::string& file_;
    const std::size_t& taken_;
    PlaceCursor cursor_;
    std::size_t previousEnd_ = 0;
    std::vector<Level> levels_;
    JsonValue root_;
};

/// Appends values as text. nlohmann writes the texts and numbers only: its arrays and objects
/// allocate when they are destroyed, which ends the process where there is no memory left.
class Writer {
public:
    Writer(std::string& out, int indent) : out_(out), indent_(indent) {}

    void add(const JsonValue& value, int depth = 0) {
        if (value.isArray()) {
            addAll('[', value.items(), ']', depth,
                   [&](const JsonValue& item) { add(item, depth + 1); });
        } else if (value.isObject()) {
            addAll('{', value.members(), '}', depth, [&](const JsonMember& member) {
                addScalar(member.key);
                out_ += indent_ < 0 ? ":" : ": ";
                add(member.value, depth + 1);
            });
        } else if (value.isString()) {
            addScalar(value.asString());
        } else if (value.isBool()) {
            out_ += value.asBool() ? "true" : "false";
        } else if (value.isNumber()) {
            addNumber(value.asNumber());
        } else {
            out_ += "null";
        }
    }

private:
    template <typename Items, typename AddItem>
    void addAll(char open, const Items& items, char close, int depth, const AddItem& addItem) {
        out_ += open;
        bool isFirst = true;
        for (const auto& item : items) {
            if (!isFirst) out_ += ',';
            isFirst = false;
            newLine(depth + 1);
            addItem(item);
        }
        if (!items.empty()) newLine(depth);
        out_ += close;
    }
    void newLine(int depth) {
        if (indent_ < 0) return;
        out_ += '\n';
        out_.append(static_cast<std::size_t>(indent_) * static_cast<std::size_t>(depth), ' ');
    }
    void addNumber(double number) {
        constexpr double kExactIntegers = 9007199254740992.0;  // 2^53
        if (std::abs(number) <= kExactIntegers && number == std::trunc(number))
            addScalar(static_cast<std::int64_t>(number));
        else
            addScalar(number);
    }
    void addScalar(const nlohmann::json& scalar) {
        out_ += scalar.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    }

    std::string& out_;
    int indent_;
};

}  // namespace

JsonValue parseJson(std::string_view text, const std::string& fileName) {
    if (text.size() > kMaxJsonBytes) {
        throw Error(ErrorKind::BadInput, fileName,
                    fmt::format("the file has more than {} MiB", kMaxJsonBytes >> 20),
                    "keep large data in meshes and images, not in JSON");
    }
    std::size_t taken = 0;
    TreeBuilder builder(text, fileName, taken);
    const char* begin = text.data();
    nlohmann::json::sax_parse(CountingIterator(begin, &taken),
                              CountingIterator(begin + text.size(), &taken), &builder);
    return builder.takeRoot();
}

std::string dump(const JsonValue& value, int indent) {
    std::string text;
    Writer(text, indent).add(value);
    return text;
}

}  // namespace sss
