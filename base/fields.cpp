#include "base/fields.h"

#include <fmt/format.h>

namespace mimik::base {

std::string number_text(double value) { return fmt::format("{}", value); }
std::string number_text(long long value) { return fmt::format("{}", value); }
std::string number_text(unsigned long long value) { return fmt::format("{}", value); }

}  // namespace mimik::base
