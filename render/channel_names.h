#pragma once
// The colour channels as the tables and pictures call them.

#include <array>

inline constexpr std::array kChannelNames{"R", "G", "B"};
