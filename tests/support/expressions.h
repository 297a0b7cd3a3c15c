#pragma once

#include <string>
#include <vector>

#include "facs/facs_catalogue.h"

namespace mimik::test {

/// An expression of the catalogue that Mimik ships.
inline facs::Expression expression(const std::string& text) { return facs::builtin_catalogue().expression(text); }

inline std::vector<facs::Expression> expressions(const std::vector<std::string>& texts) {
    std::vector<facs::Expression> all;
    for (const auto& text : texts) all.push_back(expression(text));
    return all;
}

}  // namespace mimik::test
