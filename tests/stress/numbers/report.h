#pragma once
#include "sss/base/json.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace sss::stress {

/// How much is tried: some seconds in all, or all that README.md names.
enum class Scope { Quick, Full };

/// One thing that was tried over many inputs: how far the worst of them was off, against what it
/// may be. A figure that is NaN or infinite counts as infinitely far off.
class Row {
public:
    Row(std::string subject, std::string name, double limit)
        : subject_(std::move(subject)), name_(std::move(name)), limit_(limit) {}

    /// `where` is asked for only if this is the worst so far.
    template <typename Where>
    void add(double figure, const Where& where) {
        ++cases_;
        if (figure <= worst_) return;  // false for NaN
        worst_ = std::isfinite(figure) ? figure : kInfinite;
        worstAt_ = where();
    }
    void add(double figure) {
        add(figure, [] { return std::string(); });
    }
    /// For what holds or does not: 0 or 1 off.
    template <typename Where>
    void expect(bool holds, const Where& where) {
        add(holds ? 0.0 : 1.0, where);
    }

    bool isPassed() const { return cases_ > 0 && worst_ <= limit_; }
    JsonValue json() const;
    std::string line() const;

private:
    static constexpr double kInfinite = 1e300;
    std::string subject_, name_, worstAt_;
    double limit_, worst_ = -kInfinite;
    std::uint64_t cases_ = 0;
};

/// What the subjects have to say, in the order in which it was found.
class Report {
public:
    void add(Row row) { rows_.push_back(std::move(row)); }
    const std::vector<Row>& rows() const { return rows_; }

private:
    std::vector<Row> rows_;
};

}  // namespace sss::stress
