#include "geometry/landmarks.h"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::geometry {

Landmarks::Landmarks(std::vector<Landmark> marks) : marks_(std::move(marks)) {
    std::unordered_set<std::string_view> seen;
    for (const auto& mark : marks_) {
        if (mark.name.empty()) throw InputError("a landmark has an empty name; give every landmark a name");
        if (!seen.insert(mark.name).second)
            throw InputError(fmt::format("landmark {} appears twice; keep one of the two", base::in_quotes(mark.name)));
        if (!mark.position_mm.allFinite())
            throw InputError(
                fmt::format("landmark {} has a coordinate that is not a finite number; mark it again or "
                            "delete it",
                            base::in_quotes(mark.name)));
    }
}

const Landmark* Landmarks::find(std::string_view name) const {
    const auto it = std::find_if(marks_.begin(), marks_.end(), [&](const Landmark& m) { return m.name == name; });
    return it == marks_.end() ? nullptr : &*it;
}

const Landmark& Landmarks::at(std::string_view name) const {
    if (const auto* mark = find(name)) return *mark;
    std::vector<std::string_view> names;
    for (const auto& mark : marks_) names.push_back(mark.name);
    throw InputError(fmt::format("landmark '{}' is missing; there are: {}", name,
                                 names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

LandmarkPairing pair_by_name(const Landmarks& source, const Landmarks& target) {
    LandmarkPairing pairing;
    for (const auto& mark : source.all()) {
        if (const auto* partner = target.find(mark.name))
            pairing.pairs.push_back({mark.name, mark.position_mm, partner->position_mm});
        else
            pairing.only_in_source.push_back(mark.name);
    }
    for (const auto& mark : target.all())
        if (!source.find(mark.name)) pairing.only_in_target.push_back(mark.name);
    return pairing;
}

Landmarks transformed(const Landmarks& landmarks, const Transform& target_from_source) {
    std::vector<Landmark> marks(landmarks.all().begin(), landmarks.all().end());
    for (auto& mark : marks) mark.position_mm = target_from_source * mark.position_mm;
    return Landmarks(std::move(marks));
}

std::span<const std::string_view> standard_landmark_names() {
    static constexpr std::array<std::string_view, 22> names = {"brow_outer_right",  "brow_middle_right",
                                                               "brow_inner_right",  "brow_inner_left",
                                                               "brow_middle_left",  "brow_outer_left",
                                                               "eye_outer_right",   "eye_inner_right",
                                                               "eye_inner_left",    "eye_outer_left",
                                                               "nose_saddle_right", "nose_saddle_left",
                                                               "nose_wing_right",   "nose_tip",
                                                               "nose_wing_left",    "mouth_corner_right",
                                                               "upper_lip_outer",   "mouth_corner_left",
                                                               "upper_lip_inner",   "lower_lip_inner",
                                                               "lower_lip_outer",   "chin"};
    return names;
}

std::string mirrored_name(std::string_view name) {
    const auto swap_suffix = [&](std::string_view from, std::string_view to) {
        return std::string(name.substr(0, name.size() - from.size())) + std::string(to);
    };
    if (name.ends_with("_left")) return swap_suffix("_left", "_right");
    if (name.ends_with("_right")) return swap_suffix("_right", "_left");
    return std::string(name);
}

}  // namespace mimik::geometry
