#pragma once
#include "sss/integrate/body_field.h"
#include "sss/integrate/exitance_source.h"

#include <memory>
#include <span>

namespace sss {

/// Exitance as pass 1 left it.
class FieldExitance : public ExitanceSource {
public:
    /// By body; they outlive the source.
    explicit FieldExitance(std::span<const std::unique_ptr<BodyField>> fields) : fields_(fields) {}
    Rgb exitance(const SurfaceHit& hit, Sampler&, PathCounts&) const override {
        return fields_[static_cast<std::size_t>(hit.body)]->exitance(hit.bodyFace,
                                                                     hit.barycentrics);
    }

private:
    std::span<const std::unique_ptr<BodyField>> fields_;
};

}  // namespace sss
