#pragma once
#include "sss/integrate/body_field.h"
#include "sss/integrate/integrator.h"

#include <memory>
#include <span>
#include <string_view>

namespace sss {

/// What an integrator works on. All outlive it.
struct IntegratorInput {
    const World& world;
    std::span<const std::unique_ptr<BodyOptics>> optics;  ///< by body
    std::span<const std::unique_ptr<BodyField>>
        fields;  ///< by body; empty unless needsFields, null for bodies in their diffuse limit
};

/// One row of the table of integrators.
struct IntegratorKind {
    std::string_view name;
    bool needsFields;  ///< pass 1, or a cache of it
    /// Throws Error{BadInput} for a scene that this integrator cannot do justice to.
    std::unique_ptr<Integrator> (*make)(const IntegratorInput& input);
};

std::span<const IntegratorKind> integratorTable();

/// The row called `name`; nullptr if there is none.
const IntegratorKind* findIntegrator(std::string_view name);
/// The row that a scene's quality block names. Throws Error{BadInput} with the nearest name.
const IntegratorKind& integratorOf(const Scene& scene);

}  // namespace sss
