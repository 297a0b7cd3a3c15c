#include "base/content_hash.h"

#include <fmt/format.h>

namespace mimik::base {

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

}  // namespace mimik::base
