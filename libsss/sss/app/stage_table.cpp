#include "sss/app/stage_table.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {

std::string sentenceOf(const StageRow& row) {
    return row.reused ? fmt::format("{}: {} reused", row.body, row.stage)
                      : fmt::format("{}: {} made: {}", row.body, row.stage, row.why);
}

JsonValue toJson(const std::vector<StageRow>& rows) {
    JsonValue table = JsonValue::array();
    for (const StageRow& row : rows) {
        JsonValue json = JsonValue::object();
        json.set("body", row.body).set("stage", row.stage).set("reused", row.reused);
        if (!row.reused) json.set("why", row.why);
        table.push(std::move(json));
    }
    return table;
}

std::string differences(const BodyInputs& now, const BodyInputs& before,
                        const std::vector<std::string_view>& keys) {
    std::string text;
    for (const InputFingerprint& input : now) {
        if (!keys.empty() && std::ranges::find(keys, input.key) == keys.end()) continue;
        const auto same = std::ranges::find(before, input.key, &InputFingerprint::key);
        if (same != before.end() && same->value == input.value) continue;
        text += (text.empty() ? "" : "; ") + input.sentence;
    }
    return text;
}

}  // namespace sss
