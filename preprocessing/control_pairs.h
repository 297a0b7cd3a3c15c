#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/thin_plate_spline.h"

namespace mimik::preprocessing {

/// Point pairs for a spline between two faces. Marks on a scan can fall together (closed lips: inner upper and inner
/// lower one on the same vertex), and a spline through both has no answer: the first speaks for both, and `merged` says
/// so.
class ControlPairs {
public:
    ControlPairs() = default;
    /// All landmarks that both have, in the order of `from`.
    ControlPairs(const geometry::Landmarks& from, const geometry::Landmarks& to);

    /// False: left out, since it lies within `coincident_mm` of an earlier one.
    bool add(const std::string& name, const geometry::Point& from_mm, const geometry::Point& to_mm);
    /// @throws what ThinPlateSpline::fit throws.
    [[nodiscard]] geometry::ThinPlateSpline fit(const geometry::ThinPlateSplineOptions& options = {}) const;

    [[nodiscard]] const std::vector<std::string>& merged() const { return merged_; }  ///< "'x' lies on 'y'"
    [[nodiscard]] std::size_t size() const { return names_.size(); }

    /// Far below the spacing of any scanner, and below what anybody marks.
    static constexpr double coincident_mm = 0.01;

private:
    std::vector<geometry::Point> from_mm_, to_mm_;
    std::vector<std::string> names_, merged_;
};

/// The thin-plate spline through the landmarks that both faces have.
[[nodiscard]] geometry::ThinPlateSpline landmark_spline(const geometry::Landmarks& from, const geometry::Landmarks& to,
                                                        const geometry::ThinPlateSplineOptions& options = {});

}  // namespace mimik::preprocessing
