#include "preprocessing/control_pairs.h"

#include <fmt/format.h>

namespace mimik::preprocessing {

using geometry::Landmarks;
using geometry::Point;
using geometry::ThinPlateSpline;

ControlPairs::ControlPairs(const Landmarks& from, const Landmarks& to) {
    for (const auto& pair : geometry::pair_by_name(from, to).pairs) add(pair.name, pair.source_mm, pair.target_mm);
}

bool ControlPairs::add(const std::string& name, const Point& from_mm, const Point& to_mm) {
    for (std::size_t k = 0; k < from_mm_.size(); ++k)
        if ((from_mm_[k] - from_mm).norm() < coincident_mm) {
            merged_.push_back(fmt::format("'{}' lies on '{}'", name, names_[k]));
            return false;
        }
    from_mm_.push_back(from_mm);
    to_mm_.push_back(to_mm);
    names_.push_back(name);
    return true;
}

ThinPlateSpline ControlPairs::fit(const geometry::ThinPlateSplineOptions& options) const {
    return ThinPlateSpline::fit(from_mm_, to_mm_, options, names_);
}

ThinPlateSpline landmark_spline(const Landmarks& from, const Landmarks& to,
                                const geometry::ThinPlateSplineOptions& options) {
    return ControlPairs(from, to).fit(options);
}

}  // namespace mimik::preprocessing
