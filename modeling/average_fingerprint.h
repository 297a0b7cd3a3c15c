#pragma once

#include <string>

#include "preprocessing/average_face.h"

namespace mimik::modeling {

/// Tells one average face from another: what models and region labels say they stand on. 16 hexadecimal digits over
/// grid and landmarks.
[[nodiscard]] std::string average_fingerprint(const preprocessing::AverageFace& average);

}  // namespace mimik::modeling
