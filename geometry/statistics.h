#pragma once

#include "base/quantile.h"

namespace mimik::geometry {

using base::median;
using base::quantile;
using base::upper_median;

}  // namespace mimik::geometry
