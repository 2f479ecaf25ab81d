#pragma once
#include "options.h"

/// Makes the caches of all frames that the options ask for. Throws sss::Error.
void preprocessFrames(const PreprocessOptions& options);
