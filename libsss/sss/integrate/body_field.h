#pragma once
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/exitance_field.h"
#include "sss/cloud/kernel_table.h"
#include "sss/integrate/body_cloud.h"
#include "sss/integrate/body_optics.h"

#include <memory>

namespace sss {

/// The radiant exitance of one body, ready to be looked up: the sum over its cloud by its profile,
/// and what the body's shape changes about that.
class BodyField {
public:
    /// All must outlive the field.
    BodyField(const Body& body, const BodyOptics& optics, const BodyCloud::View& cloud,
              double tolerance);
    BodyField(const BodyField&) = delete;
    BodyField& operator=(const BodyField&) = delete;

    /// M at a place of the body's surface, W m^-2 (not scaled).
    Rgb exitance(FaceIndex face, const Vec2& barycentrics) const {
        return field_.at(face, barycentrics);
    }
    /// What it would be if all light left as that which goes `towards` (unit, body space).
    Rgb exitance(FaceIndex face, const Vec2& barycentrics, const Vec3& towards) const {
        return field_.at(face, barycentrics, towards);
    }
    const DiffusionSum& sum() const { return sum_; }
    ExitanceField& field() { return field_; }
    const ExitanceField& field() const { return field_; }
    ExitanceCounts counts() const { return field_.counts(); }

private:
    KernelTable table_;
    DiffusionSum sum_;
    std::unique_ptr<PointInterpolator> correction_;
    ExitanceField field_;
};

}  // namespace sss
