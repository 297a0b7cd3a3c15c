#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "database/scan_database.h"

namespace mimik::database {

enum class Severity {
    note,     ///< worth knowing; preprocessing copes
    warning,  ///< look at it: results on this scan may suffer
    error     ///< the scan cannot be used as it is
};
[[nodiscard]] std::string to_string(Severity severity);

/// One thing that is wrong, and how to mend it.
struct Finding {
    Severity severity = Severity::note;
    std::string kind;   ///< stable word for programs: "unit", "frame", "sides", ... (docs/database.md lists them)
    std::string what;   ///< with the value
    std::string where;  ///< the file, or the landmark
    std::string mend;

    bool operator==(const Finding&) const = default;
};

struct DoctorOptions {
    double min_size_ratio = 0.6;  ///< eye distance, mouth width ... against the adult mean: children and extremes pass
    double max_size_ratio = 1.6;
    double max_hole_mm = 15.0;  ///< of what a hole takes of the skin; more gets a warning (see find_holes)
    double spike_mm = 4.0;      ///< as CleaningOptions of preprocessing, which removes the spikes (geometry/spikes.h)
    double max_spike_share = 0.002;  ///< of the valid points; more get a warning
    /// From the surface (database/landmark_distance.h); more gets a warning, five times as much an error.
    double landmark_off_scan_mm = 2.0;
    double order_tolerance_mm = 2.0;  ///< landmarks may lie this much in the wrong order: closed lips, marking noise
    int min_points = 2000;            ///< a face at the usual 0.8 mm has 35,000
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("min_size_ratio", self.min_size_ratio);
        visit("max_size_ratio", self.max_size_ratio);
        visit("max_hole_mm", self.max_hole_mm);
        visit("spike_mm", self.spike_mm);
        visit("max_spike_share", self.max_spike_share);
        visit("landmark_off_scan_mm", self.landmark_off_scan_mm);
        visit("order_tolerance_mm", self.order_tolerance_mm);
        visit("min_points", self.min_points);
    }
    void check() const;  ///< throws InputError naming field and value
};
static_assert(base::lists_every_field<DoctorOptions>());

/// Everything the doctor finds on one scan, worst first; nothing is thrown for a bad file. `neutral` (may be null): a
/// neutral scan of the same subject, for the side of one-sided codes. Holes are judged on scans with rows or faces.
[[nodiscard]] std::vector<Finding> check_scan(const ScanEntry& entry, const ScanEntry* neutral = nullptr,
                                              const DoctorOptions& options = {});
/// The same for a scan that is already loaded.
[[nodiscard]] std::vector<Finding> check_scan(const LoadedScan& loaded, const geometry::Landmarks* neutral = nullptr,
                                              const DoctorOptions& options = {});

/// Why lengths on this scan cannot be trusted: the doctor's errors of unit, frame and of landmarks off the scan, worst
/// first; empty for a scan that may be used. Cheaper than check_scan().
[[nodiscard]] std::vector<Finding> reasons_to_refuse(const LoadedScan& loaded, const DoctorOptions& options = {});

/// The landmarks of a scan under our names; empty if it cannot be loaded (checking that scan says why).
[[nodiscard]] std::optional<geometry::Landmarks> landmarks_of(const ScanEntry& entry);

/// Holes of a scan: what is not measured but surrounded by what is.
struct HoleReport {
    bool judged = false;  ///< false for a bare cloud
    int count = 0;
    double largest_mm = 0;                                    ///< diagonal of the box around its rim
    geometry::Point largest_at_mm = geometry::Point::Zero();  ///< middle of that box
    std::vector<std::vector<geometry::Point>> rims_mm;        ///< points around each hole, in no order
};
[[nodiscard]] HoleReport find_holes(const geometry::RangeScan& scan);

/// The hole that takes most of the skin, as the diagonal of the box around that part of its rim which lies away from
/// where every scanner loses points: eyes, brows, nostrils, lips and under the chin.
struct SkinHole {
    double size_mm = 0;  ///< 0: none
    geometry::Point at_mm = geometry::Point::Zero();
};
/// Without eyes, mouth, nose and chin among the landmarks all counts as skin.
[[nodiscard]] SkinHole worst_skin_hole(const HoleReport& holes, const geometry::Landmarks& landmarks);

/// As a JSON array of objects with the fields of Finding, and back. @throws InputError on anything else.
[[nodiscard]] std::string to_json(const std::vector<Finding>& findings);
[[nodiscard]] std::vector<Finding> findings_from_json(std::string_view json);

}  // namespace mimik::database
