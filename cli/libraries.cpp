#include "cli/libraries.h"

namespace mimik::cli {

const std::vector<std::pair<std::string, std::string>>& libraries() {
    static const std::vector<std::pair<std::string, std::string>> all = {
#include "cli/libraries.inc"
    };
    return all;
}

}  // namespace mimik::cli
