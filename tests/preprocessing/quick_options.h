#pragma once

#include "preprocessing/preprocess_run.h"

namespace mimik::preprocessing {

/// Grids so small that a test runs the whole chain in a moment.
inline PreprocessOptions quick() {
    PreprocessOptions options;
    options.steps.gridding.rows = options.steps.gridding.cols = 60;
    options.average.rows = options.average.cols = 60;
    return options;
}

}  // namespace mimik::preprocessing
