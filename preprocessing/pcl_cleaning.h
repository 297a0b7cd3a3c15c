#pragma once

#include <string>

#include "base/fields.h"
#include "geometry/range_scan.h"
#include "preprocessing/cleaning.h"

namespace mimik::preprocessing {

enum class CleaningMethod { own, pcl };
[[nodiscard]] const char* to_string(CleaningMethod method);
[[nodiscard]] CleaningMethod parse_cleaning_method(const std::string& text);  ///< "own", "pcl"; throws InputError

/// PCL's statistical outlier removal and Euclidean clusters (Rusu 2009), as a second opinion beside clean().
struct PclCleaningOptions {
    int neighbours = 24;        ///< whose mean distance judges a point; two rings of a lattice, as clean() takes
    double deviations = 3.0;    ///< standard deviations above the mean of all points that make a point an outlier
    double tolerance_mm = 4.0;  ///< points farther apart than this belong to different parts; scanners have 0.8 mm
    double min_part = 0.05;     ///< as CleaningOptions
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("neighbours", self.neighbours);
        visit("deviations", self.deviations);
        visit("tolerance_mm", self.tolerance_mm);
        visit("min_part", self.min_part);
    }
    void check() const;
};
static_assert(base::lists_every_field<PclCleaningOptions>());

/// @throws InputError naming the package, if the module that holds PCL is not installed or does not load. It is loaded
/// once, and stays.
void require_pcl_cleaning();

/// Leaves out outliers and stray parts by distances alone: neither faces nor the lattice say what hangs together, and
/// PCL works in single precision. Points at one place count once. Which parts are stray is decided as in clean(), and
/// what is left out is left out in the same way; outliers count as spikes in the report. From any thread.
/// @throws InputError as require_pcl_cleaning(), for bad options, or if nothing is left.
[[nodiscard]] geometry::RangeScan clean_with_pcl(const geometry::RangeScan& scan,
                                                 const PclCleaningOptions& options = {},
                                                 CleaningReport* report = nullptr);

}  // namespace mimik::preprocessing
