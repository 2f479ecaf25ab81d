#pragma once
#include "sss/base/vec.h"

#include <span>
#include <string_view>

namespace sss {

/// Complex index of refraction of a metal, eta + i k, by channel.
struct MetalKind {
    std::string_view name;
    Rgb eta, k;
};

/// The metals known by name.
std::span<const MetalKind> metalTable();

}  // namespace sss
