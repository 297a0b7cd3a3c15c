#pragma once

#include <cstdint>
#include <string_view>

#include "base/fields.h"
#include "geometry/landmarks.h"

namespace mimik::preprocessing {

/// Marking errors that are drawn on top of those that a database has: for experiments on how much a result depends on
/// whoever marked the scans.
struct LandmarkErrorOptions {
    double mean_mm = 0;      ///< mean distance from where the landmark was; 0: none
    std::uint64_t seed = 1;  ///< the same seed moves each mark the same way, farther for a larger mean

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("mean_mm", self.mean_mm);
        visit("seed", self.seed);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<LandmarkErrorOptions>());

/// Every mark moved by an error of its own, normal and alike in all directions: its length has the given mean (of the
/// Maxwell distribution, 2 sqrt(2/pi) standard deviations of a coordinate). The marks need not lie on the scan
/// afterwards; preprocess_scan() snaps them.
/// @param scan  its name: each scan is marked anew
[[nodiscard]] geometry::Landmarks with_landmark_error(const geometry::Landmarks& landmarks, std::string_view scan,
                                                      const LandmarkErrorOptions& options);

}  // namespace mimik::preprocessing
