#include "cli/libraries.h"

namespace mimik::cli {

const std::vector<std::pair<std::string, std::string>>& libraries() {
    static const std::vector<std::pair<std::string, std::string>> all = {
#include "cli/libraries.inc"
    };
    return all;
}

const char* commit() {
    return
#include "cli/commit.inc"
        ;
}

}  // namespace mimik::cli
