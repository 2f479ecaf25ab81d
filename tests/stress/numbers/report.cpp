#include "numbers/report.h"

#include <fmt/format.h>

namespace sss::stress {

JsonValue Row::json() const {
    JsonValue row = JsonValue::object();
    row.set("subject", subject_)
        .set("name", name_)
        .set("cases", cases_)
        .set("worst", cases_ > 0 ? worst_ : 0.0)
        .set("limit", limit_)
        .set("worstAt", worstAt_)
        .set("passed", isPassed());
    return row;
}

std::string Row::line() const {
    return fmt::format("{:6} {:9} {:52} {:>9} cases  worst {:<9.3g} limit {:<9.3g} {}",
                       isPassed() ? "ok" : "FAILED", subject_, name_, cases_, worst_, limit_,
                       isPassed() ? "" : worstAt_);
}

}  // namespace sss::stress
