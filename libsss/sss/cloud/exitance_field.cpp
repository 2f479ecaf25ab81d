#include "sss/cloud/exitance_field.h"

namespace sss {
namespace {

// Marks a group that some thread is computing.
const ExitanceGroup* busy() {
    static const ExitanceGroup marker;
    return &marker;
}

}  // namespace

ExitanceField::ExitanceField(const TriangleMesh& mesh, const DiffusionSum& sum, double segmentMm,
                             double tolerance)
    : sum_(sum), sites_(mesh, segmentMm), tolerance_(tolerance), groups_(sites_.groupCount()) {}

ExitanceField::~ExitanceField() {
    for (const auto& entry : groups_) delete entry.load();
}

std::unique_ptr<ExitanceGroup> ExitanceField::compute(std::uint32_t index) const {
    ExitanceBuilder builder(sites_, sum_, tolerance_);
    ExitanceCounts spent;
    auto result = std::make_unique<ExitanceGroup>(builder.build(index, spent));
    const std::scoped_lock lock(countsMutex_);
    counts_.add(spent);
    return result;
}

const ExitanceGroup& ExitanceField::group(std::uint32_t index) const {
    std::atomic<const ExitanceGroup*>& entry = groups_[index];
    const ExitanceGroup* found = entry.load(std::memory_order_acquire);
    if (found != nullptr && found != busy()) return *found;
    const ExitanceGroup* absent = nullptr;
    if (entry.compare_exchange_strong(absent, busy())) {
        found = compute(index).release();
        entry.store(found, std::memory_order_release);
        entry.notify_all();
        return *found;
    }
    while ((found = entry.load(std::memory_order_acquire)) == busy()) entry.wait(found);
    return *found;
}

Rgb ExitanceField::at(FaceIndex face, const Vec2& barycentrics) const {
    const ExitanceSites::Location where = sites_.locate(face, barycentrics);
    return group(where.group).at(where.patch, where.inPatch);
}

ExitanceCounts ExitanceField::counts() const {
    const std::scoped_lock lock(countsMutex_);
    return counts_;
}

}  // namespace sss
