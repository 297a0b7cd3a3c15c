#pragma once

#include <cstdlib>

namespace mimik::test {

/// As if neither OpenCV nor PCL had been there at the build.
class NoCompanions {
public:
    NoCompanions() { ::setenv("MIMIK_COMPANIONS", "/nowhere", 1); }
    ~NoCompanions() { ::unsetenv("MIMIK_COMPANIONS"); }
    NoCompanions(const NoCompanions&) = delete;
    NoCompanions& operator=(const NoCompanions&) = delete;
};

}  // namespace mimik::test
