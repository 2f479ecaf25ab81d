#include "sss/app/exitance_chain.h"

#include <fmt/core.h>

namespace sss {
namespace {

// Exitance is kept at the end, and on the way not more often than this.
constexpr double kSaveEverySeconds = 20;

std::uint64_t groupsOf(std::span<const std::unique_ptr<BodyField>> fields) {
    std::uint64_t groups = 0;
    for (const auto& field : fields) groups += field ? field->counts().groups : 0;
    return groups;
}

}  // namespace

// One file, and the fields of the bodies in it.
struct ExitanceChain::Keeper {
    ExitanceCache cache;
    std::size_t first, count;
    Fingerprint made;         // of the first body, for the lock
    std::uint64_t saved = 0;  // groups computed when it was last written
};

ExitanceChain::ExitanceChain(const StageFolder* folder, Reporter& reporter, RunStats& stats)
    : folder_(folder), reporter_(reporter), stats_(stats) {}

ExitanceChain::~ExitanceChain() = default;

void ExitanceChain::retire(std::size_t body) {
    if (fields_[body]) retired_.add(fields_[body]->counts());
    fields_[body].reset();
}

std::span<const std::unique_ptr<BodyField>> ExitanceChain::fields(
    std::vector<FieldInput> wanted, double tolerance, const std::filesystem::path& beside) {
    bool isChanged = wanted.size() != kept_.size();
    for (std::size_t b = 0; !isChanged && b < wanted.size(); ++b)
        isChanged = wanted[b].exitance != kept_[b].input.exitance;
    for (Kept& kept : kept_) kept.isNew = false;
    if (isChanged) {
        save();
        keepers_.clear();
        for (std::size_t b = wanted.size(); b < fields_.size(); ++b) retire(b);
        fields_.resize(wanted.size());
        kept_.resize(wanted.size());
        for (std::size_t b = 0; b < wanted.size(); ++b) {
            FieldInput& input = wanted[b];
            if (fields_[b] && input.exitance == kept_[b].input.exitance) continue;
            retire(b);
            kept_[b] = {std::move(input), 0, true};
            const FieldInput& own = kept_[b].input;
            if (own.exitance == Fingerprint{}) continue;
            fields_[b] = std::make_unique<BodyField>(*own.body, *own.optics, own.cloud, tolerance);
        }
        keep(beside);
    }
    for (std::size_t b = 0; b < fields_.size(); ++b)
        kept_[b].groups = fields_[b] ? fields_[b]->counts().groups : 0;
    return fields_;
}

void ExitanceChain::keep(const std::filesystem::path& beside) {
    std::vector<Fingerprint> all;
    for (const Kept& kept : kept_) all.push_back(kept.input.exitance);
    if (folder_ != nullptr) {
        for (std::size_t b = 0; b < all.size(); ++b)
            if (fields_[b])
                keepers_.push_back(
                    {{folder_->file(Stage::Exitance, all[b]), {all[b]}}, b, 1, all[b]});
    } else if (!beside.empty() && !all.empty()) {
        keepers_.push_back({{exitanceFileOf(beside), all}, 0, all.size(), all[0]});
    }
    const auto timer = stats_.seconds("cache");
    for (Keeper& keeper : keepers_) {
        const auto fields = std::span(fields_).subspan(keeper.first, keeper.count);
        stats_.count("exitanceGroupsReused", keeper.cache.load(fields, reporter_));
        keeper.saved = groupsOf(fields);
    }
}

void ExitanceChain::save() {
    for (Keeper& keeper : keepers_) {
        const auto fields = std::span(fields_).subspan(keeper.first, keeper.count);
        const std::uint64_t groups = groupsOf(fields);
        if (groups == keeper.saved) continue;
        const auto timer = stats_.seconds("write");
        StageFolder::Lock lock;
        if (folder_ != nullptr) lock = folder_->lock(Stage::Exitance, keeper.made, [] {});
        keeper.cache.save(fields, reporter_);
        keeper.saved = groups;
    }
    sinceSaved_.restart();
}

std::vector<StageRow> ExitanceChain::finishFrame(bool now) {
    std::vector<StageRow> rows;
    for (std::size_t b = 0; b < fields_.size(); ++b) {
        if (!fields_[b]) continue;
        const std::uint64_t made = fields_[b]->counts().groups - kept_[b].groups;
        StageRow row{kept_[b].input.body->name, "exitance", made == 0, ""};
        if (made > 0)
            row.why =
                fmt::format("{} groups of sites {}", made,
                            kept_[b].isNew ? "that the cache has not" : "seen for the first time");
        rows.push_back(std::move(row));
    }
    if (now || sinceSaved_.seconds() > kSaveEverySeconds) save();
    return rows;
}

ExitanceCounts ExitanceChain::counts() const {
    ExitanceCounts total = retired_;
    for (const auto& field : fields_)
        if (field) total.add(field->counts());
    return total;
}

}  // namespace sss
