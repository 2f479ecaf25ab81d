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
                             double tolerance, const PointInterpolator* correction)
    : sum_(sum),
      correction_(correction),
      sites_(mesh, segmentMm),
      tolerance_(tolerance),
      groups_(sites_.groupCount()) {}

ExitanceField::~ExitanceField() {
    for (const auto& entry : groups_) delete entry.load();
}

std::unique_ptr<ExitanceBuilder> ExitanceField::idleBuilder() const {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty())
        return std::make_unique<ExitanceBuilder>(sites_, sum_, correction_, tolerance_);
    std::unique_ptr<ExitanceBuilder> builder = std::move(idle_.back());
    idle_.pop_back();
    return builder;
}

std::unique_ptr<ExitanceGroup> ExitanceField::compute(std::uint32_t index) const {
    std::unique_ptr<ExitanceBuilder> builder = idleBuilder();
    ExitanceCounts spent;
    auto result = std::make_unique<ExitanceGroup>(builder->build(index, spent));
    const std::scoped_lock lock(mutex_);
    counts_.add(spent);
    idle_.push_back(std::move(builder));
    return result;
}

const ExitanceGroup& ExitanceField::group(std::uint32_t index) const {
    std::atomic<const ExitanceGroup*>& entry = groups_[index];
    const auto leave = [&](const ExitanceGroup* group) {
        entry.store(group, std::memory_order_release);
        entry.notify_all();
    };
    while (true) {
        const ExitanceGroup* found = entry.load(std::memory_order_acquire);
        if (found == busy()) {
            entry.wait(found);
            continue;
        }
        if (found != nullptr) return *found;
        if (!entry.compare_exchange_strong(found, busy())) continue;
        try {
            found = compute(index).release();
        } catch (...) {
            leave(nullptr);  // who waits for it tries for himself
            throw;
        }
        leave(found);
        return *found;
    }
}

bool ExitanceField::adopt(std::uint32_t index, ExitanceGroup group) {
    if (index >= groups_.size() || groups_[index].load() != nullptr) return false;
    const std::vector<ExitanceSites::Patch> patches = sites_.patches(index);
    if (patches.size() != group.segments.size()) return false;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const std::uint32_t n = group.segments[p];
        if (n == 0 || n % patches[p].segments != 0) return false;
    }
    if (group.slopes.size() != (correction_ != nullptr ? group.values.size() : 0)) return false;
    groups_[index].store(new ExitanceGroup(std::move(group)));
    return true;
}

void ExitanceField::forEachGroup(
    const std::function<void(std::uint32_t, const ExitanceGroup&)>& visit) const {
    for (std::uint32_t i = 0; i < groups_.size(); ++i)
        if (const ExitanceGroup* group = groups_[i].load()) visit(i, *group);
}

Rgb ExitanceField::at(FaceIndex face, const Vec2& barycentrics) const {
    const ExitanceSites::Location where = sites_.locate(face, barycentrics);
    return group(where.group).at(where.patch, where.inPatch);
}

Rgb ExitanceField::at(FaceIndex face, const Vec2& barycentrics, const Vec3& towards) const {
    const ExitanceSites::Location where = sites_.locate(face, barycentrics);
    return group(where.group).at(where.patch, where.inPatch, towards);
}

ExitanceCounts ExitanceField::counts() const {
    const std::scoped_lock lock(mutex_);
    return counts_;
}

}  // namespace sss
