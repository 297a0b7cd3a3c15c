#pragma once

#include <cstdlib>
#include <iostream>
#include <string>

#include "adapters/remarks.h"

namespace mimik::adapters {

/// Ends an example that does not do what it says.
inline void expect(bool holds, const std::string& claim) {
    if (holds) return;
    std::cerr << "not so: " << claim << '\n';
    std::exit(1);
}

/// Whether something that cannot be converted is refused with these words.
template <class Convert>
bool refused(Convert convert, const std::string& words) {
    try {
        convert();
    } catch (const InputError& error) {
        return std::string(error.what()).find(words) != std::string::npos;
    }
    return false;
}

inline bool says(const Remarks& remarks, const std::string& words) {
    for (const auto& remark : remarks)
        if (remark.find(words) != std::string::npos) return true;
    return false;
}

}  // namespace mimik::adapters
