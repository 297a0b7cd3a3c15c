#include "preprocessing/consensus_outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/statistics.h"
#include "preprocessing/normalisation.h"

namespace mimik::preprocessing {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Point;

namespace {

/// What most sets have of the standard landmarks, in each set.
std::vector<Landmarks> shared_landmarks(std::span<const Landmarks> sets) {
    std::map<std::string, std::size_t, std::less<>> seen;
    for (const auto& set : sets)
        for (const auto& mark : set.all()) ++seen[mark.name];
    std::vector<Landmarks> shared;
    for (const auto& set : sets) {
        std::vector<Landmark> marks;
        for (const auto name : geometry::standard_landmark_names())
            if (const auto found = seen.find(name); found != seen.end() && 2 * found->second >= sets.size())
                if (const auto* mark = set.find(name)) marks.push_back(*mark);
        shared.emplace_back(std::move(marks));
    }
    return shared;
}

/// The farthest landmark of a set from its partner, after the similarity that brings the set there.
struct Farthest {
    double distance_mm = 0;  ///< as large as `to` is
    std::string landmark;
    double scale = 1;  ///< of the similarity
};
Farthest farthest(const Landmarks& set, const Landmarks& to) {
    const auto there = similarity_normalisation(set, to);
    Farthest result;
    result.scale = std::cbrt(std::abs(there.linear().determinant()));
    for (const auto& pair : geometry::pair_by_name(set, to).pairs) {
        const double distance_mm = (there * pair.source_mm - pair.target_mm).norm();
        if (distance_mm >= result.distance_mm) {
            result.distance_mm = distance_mm;
            result.landmark = pair.name;
        }
    }
    return result;
}

std::optional<Farthest> farthest_if_any(const Landmarks& set, const Landmarks& to) {
    try {
        return farthest(set, to);
    } catch (const std::exception&) {  // too few or on one line: nothing can be fitted
        return std::nullopt;
    }
}

/// At most `most` of `count`, evenly spread.
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
    std::vector<std::size_t> chosen;
    const std::size_t number = std::min(count, most);
    for (std::size_t k = 0; k < number; ++k) chosen.push_back(k * count / number);
    return chosen;
}

/// The set that most others resemble.
const Landmarks& most_alike(const std::vector<const Landmarks*>& sets) {
    constexpr std::size_t most_candidates = 15, most_compared = 31;
    const Landmarks* best = sets.front();
    double least_mm = std::numeric_limits<double>::infinity();
    for (const auto c : spread(sets.size(), most_candidates)) {
        std::vector<double> off_mm;
        for (const auto k : spread(sets.size(), most_compared)) {
            const auto off = farthest_if_any(*sets[k], *sets[c]);
            // In its own size: a set that is ten times too small must not look near to all.
            if (k != c && off) off_mm.push_back(off->distance_mm / (off->scale > 0 ? off->scale : 1));
        }
        if (off_mm.empty()) continue;
        if (const double middle_mm = geometry::median(std::move(off_mm)); middle_mm < least_mm) {
            least_mm = middle_mm;
            best = sets[c];
        }
    }
    return *best;
}

Landmarks median_of(const std::vector<const Landmarks*>& sets, const Landmarks& reference) {
    std::map<std::string, std::array<std::vector<double>, 3>> coordinates;
    for (const auto* set : sets) {
        if (!farthest_if_any(*set, reference)) continue;  // they share too little
        const auto there = similarity_normalisation(*set, reference);
        for (const auto& mark : set->all()) {
            const Point p = there * mark.position_mm;
            for (int axis = 0; axis < 3; ++axis)
                coordinates[mark.name][static_cast<std::size_t>(axis)].push_back(p[axis]);
        }
    }
    std::vector<Landmark> marks;
    for (auto& [name, xyz] : coordinates)
        marks.push_back({name, {geometry::median(xyz[0]), geometry::median(xyz[1]), geometry::median(xyz[2])}, ""});
    return Landmarks(std::move(marks));
}

/// As a unit of length: outer eyes where they are, else what comes near it on a face.
double outer_eyes_mm(const Landmarks& marks) {
    const auto* left = marks.find("eye_outer_left");
    const auto* right = marks.find("eye_outer_right");
    if (left && right) return (left->position_mm - right->position_mm).norm();
    double widest_mm = 0;
    for (const auto& a : marks.all())
        for (const auto& b : marks.all()) widest_mm = std::max(widest_mm, (a.position_mm - b.position_mm).norm());
    return 0.7 * widest_mm;
}

Landmarks without(const Landmarks& set, const std::string& name) {
    std::vector<Landmark> marks;
    for (const auto& mark : set.all())
        if (mark.name != name) marks.push_back(mark);
    return Landmarks(std::move(marks));
}

/// The one landmark without which the set lies near the others, and how far off it is then; empty if there is none.
std::optional<Farthest> culprit(const Landmarks& set, const Landmarks& middle, double limit_mm) {
    std::optional<Farthest> found;
    double least_mm = limit_mm;
    for (const auto& mark : set.all()) {
        if (!middle.find(mark.name)) continue;
        const auto rest = without(set, mark.name);
        const auto off = farthest_if_any(rest, middle);
        if (!off || off->distance_mm > least_mm) continue;
        least_mm = off->distance_mm;
        const auto there = similarity_normalisation(rest, middle);
        found = Farthest{(there * mark.position_mm - middle.position_mm(mark.name)).norm(), mark.name, off->scale};
    }
    return found;
}

}  // namespace

std::vector<FarSet> sets_far_off(std::span<const Landmarks> sets, const OutlierOptions& options) {
    std::vector<FarSet> far;
    const auto shared = shared_landmarks(sets);
    std::vector<const Landmarks*> usable;
    std::vector<std::size_t> place;
    for (std::size_t k = 0; k < shared.size(); ++k) {
        try {
            (void)similarity_normalisation(shared[k], shared[k]);
            usable.push_back(&shared[k]);
            place.push_back(k);
        } catch (const std::exception& e) {
            far.push_back({k, fmt::format("its landmarks are of no use for the average face: {}", e.what())});
        }
    }
    if (usable.size() < 3) return far;
    const auto middle = median_of(usable, most_alike(usable));
    std::vector<std::optional<Farthest>> off;
    std::vector<double> distances_mm, scales;
    for (const auto* set : usable) {
        off.push_back(farthest_if_any(*set, middle));
        if (!off.back()) continue;
        distances_mm.push_back(off.back()->distance_mm);
        scales.push_back(off.back()->scale);
    }
    const double unit_mm = outer_eyes_mm(middle), scale = geometry::median(scales);
    const double limit_mm = std::max(options.times_median * geometry::median(distances_mm), options.least * unit_mm);
    const double mm = 1 / scale;  // as large as people are
    for (std::size_t k = 0; k < usable.size(); ++k) {
        if (!off[k]) {
            far.push_back({place[k], "it shares fewer than three landmarks with the other neutral faces; mark more"});
            continue;
        }
        const double size = scale / off[k]->scale;
        const bool other_size = size > options.size || size * options.size < 1;
        if (off[k]->distance_mm <= limit_mm && !other_size) continue;
        if (const auto one = culprit(*usable[k], middle, limit_mm); one && one->distance_mm > limit_mm)
            far.push_back({place[k], fmt::format("its landmark '{}' lies {:.0f} mm from where the other neutral faces "
                                                 "have it (more than {:.0f} mm is taken for a mistake); mark it again",
                                                 one->landmark, one->distance_mm * mm, limit_mm * mm)});
        else if (other_size)
            far.push_back({place[k], fmt::format("its landmarks are {:.3g} times as large as those of the other "
                                                 "neutral faces; give them the same unit",
                                                 size)});
        else
            far.push_back({place[k], fmt::format("its landmarks lie up to {:.0f} mm ('{}') from where the other "
                                                 "neutral faces have them (more than {:.0f} mm is taken for a "
                                                 "mistake); mark the face again",
                                                 off[k]->distance_mm * mm, off[k]->landmark, limit_mm * mm)});
    }
    std::sort(far.begin(), far.end(), [](const FarSet& a, const FarSet& b) { return a.set < b.set; });
    return far;
}

}  // namespace mimik::preprocessing
