#include "capture/length_units.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::capture {

io::LengthUnit unit_of_motion_file(const std::string& text, const std::string& file_name, const std::string& place) {
    auto word = base::lower_case(base::trimmed(text));
    if (word.size() > 2 && word.ends_with('s')) word.pop_back();
    using Unit = io::LengthUnit;
    if (word == "mm" || word == "millimeter" || word == "millimetre") return Unit::millimetre;
    if (word == "cm" || word == "centimeter" || word == "centimetre") return Unit::centimetre;
    if (word == "m" || word == "meter" || word == "metre") return Unit::metre;
    if (word == "in" || word == "inch" || word == "inche") return Unit::inch;
    throw InputError(fmt::format("{}: {} is {}; say which unit it is: mm, cm, m or inch (--unit)", file_name, place,
                                 base::in_quotes(text)));
}

}  // namespace mimik::capture
