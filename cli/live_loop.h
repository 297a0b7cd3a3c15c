#pragma once

#include "cli/capture_options.h"

namespace mimik::cli {

/// 'mimik live': capture, mapping and blending in one, frame after frame. @throws InputError
void run_live(const LiveArguments& arguments);

}  // namespace mimik::cli
