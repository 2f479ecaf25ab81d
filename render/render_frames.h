#pragma once
#include "options.h"

/// Renders all frames that the options ask for. Throws sss::Error.
void renderFrames(const RenderOptions& options);
