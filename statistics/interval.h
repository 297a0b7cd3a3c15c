#pragma once

namespace mimik::statistics {

/// Both ends belong to it.
struct Interval {
    double low = 0;
    double high = 0;

    bool operator==(const Interval&) const = default;
};

/// @throws InputError unless 0 < confidence < 1.
void check_confidence(double confidence);

}  // namespace mimik::statistics
