#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/thin_plate_spline.h"

namespace mimik::geometry {

/// Point pairs for a spline between two faces, and what did not become one. Marks on a scan can fall together (closed
/// lips: inner upper and inner lower one on the same vertex); a spline through both has no answer, so the first speaks
/// for both and `merged` says so. A landmark that only one face has says nothing; `only_in_from` and `only_in_to` name
/// it.
class LandmarkPairs {
public:
    LandmarkPairs() = default;
    /// All landmarks that both have, in the order of `from`.
    LandmarkPairs(const Landmarks& from, const Landmarks& to);

    /// False: left out, since it lies within `coincident_mm` of an earlier one (of a smaller cloud: within the share
    /// `coincident_ratio` of its size).
    bool add(const std::string& name, const Point& from_mm, const Point& to_mm);
    /// @throws what ThinPlateSpline::fit throws.
    [[nodiscard]] ThinPlateSpline fit(const ThinPlateSplineOptions& options = {}) const;
    /// @throws InputError naming every landmark that has no partner.
    void require_partners() const;

    [[nodiscard]] std::span<const std::string> names() const { return names_; }
    [[nodiscard]] std::span<const std::string> merged() const { return merged_; }  ///< "'x' lies on 'y'"
    [[nodiscard]] std::span<const std::string> only_in_from() const { return only_in_from_; }
    [[nodiscard]] std::span<const std::string> only_in_to() const { return only_in_to_; }
    [[nodiscard]] std::size_t size() const { return names_.size(); }

    /// Far below the spacing of any scanner, and below what anybody marks.
    static constexpr double coincident_mm = 0.01;
    /// Of the root mean square radius of `from`, where that is less: coordinates may be in another unit. On a face 0.04
    /// mm.
    static constexpr double coincident_ratio = 1e-3;

private:
    double coincident_ = coincident_mm;  ///< as the coordinates are given
    std::vector<Point> from_mm_, to_mm_;
    std::vector<std::string> names_, merged_, only_in_from_, only_in_to_;
};

/// The thin-plate spline through the landmarks that both faces have. LandmarkPairs says which they do not share.
[[nodiscard]] ThinPlateSpline landmark_spline(const Landmarks& from, const Landmarks& to,
                                              const ThinPlateSplineOptions& options = {});

}  // namespace mimik::geometry
