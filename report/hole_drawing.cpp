#include "report/hole_drawing.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::report {

HoleDrawing parse_hole_drawing(const std::string& name) {
    for (const auto holes : {HoleDrawing::fill, HoleDrawing::gap, HoleDrawing::mark})
        if (name == to_string(holes)) return holes;
    throw InputError(fmt::format("holes is {}; give fill, gap or mark", base::in_quotes(name)));
}

}  // namespace mimik::report
