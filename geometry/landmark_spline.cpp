#include "geometry/landmark_spline.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"

namespace mimik::geometry {

namespace {

double root_mean_square_radius(std::span<const Landmark> marks) {
    if (marks.empty()) return 0;
    Point centre = Point::Zero();
    for (const auto& mark : marks) centre += mark.position_mm;
    centre /= static_cast<double>(marks.size());
    double squares = 0;
    for (const auto& mark : marks) squares += (mark.position_mm - centre).squaredNorm();
    return std::sqrt(squares / static_cast<double>(marks.size()));
}

}  // namespace

LandmarkPairs::LandmarkPairs(const Landmarks& from, const Landmarks& to)
    : coincident_(std::min(coincident_mm, coincident_ratio * root_mean_square_radius(from.all()))) {
    auto pairing = pair_by_name(from, to);
    for (const auto& pair : pairing.pairs) add(pair.name, pair.source_mm, pair.target_mm);
    only_in_from_ = std::move(pairing.only_in_source);
    only_in_to_ = std::move(pairing.only_in_target);
}

bool LandmarkPairs::add(const std::string& name, const Point& from_mm, const Point& to_mm) {
    for (std::size_t k = 0; k < from_mm_.size(); ++k)
        if ((from_mm_[k] - from_mm).norm() < coincident_) {
            merged_.push_back(fmt::format("'{}' lies on '{}'", name, names_[k]));
            return false;
        }
    from_mm_.push_back(from_mm);
    to_mm_.push_back(to_mm);
    names_.push_back(name);
    return true;
}

ThinPlateSpline LandmarkPairs::fit(const ThinPlateSplineOptions& options) const {
    return ThinPlateSpline::fit(from_mm_, to_mm_, options, names_);
}

void LandmarkPairs::require_partners() const {
    const auto lacking = [](std::span<const std::string> names, const char* where, const char* other) {
        return names.empty() ? std::string()
                             : fmt::format("only the {} landmarks have '{}', the {} ones lack {}", where,
                                           fmt::join(names, "', '"), other, names.size() == 1 ? "it" : "them");
    };
    const auto first = lacking(only_in_from_, "source", "target");
    const auto second = lacking(only_in_to_, "target", "source");
    if (first.empty() && second.empty()) return;
    throw InputError(fmt::format("landmarks without a partner: {}{}{}; mark them in both or delete them", first,
                                 first.empty() || second.empty() ? "" : "; ", second));
}

ThinPlateSpline landmark_spline(const Landmarks& from, const Landmarks& to, const ThinPlateSplineOptions& options) {
    return LandmarkPairs(from, to).fit(options);
}

}  // namespace mimik::geometry
