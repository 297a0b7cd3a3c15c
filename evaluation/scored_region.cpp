#include "evaluation/scored_region.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "facs/expression_zone.h"
#include "facs/face_regions.h"
#include "modeling/region_labels.h"
#include "preprocessing/nearest_on_average.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::VertexMask;
using preprocessing::Face;

namespace {

constexpr double rim_mm = 5.0;      // as of zones: beyond the average face's border nothing is known
constexpr double wrinkle_mm = 8.0;  // a furrow's point is marked by a rule, and the furrow runs past it

struct LabelGroup {
    std::string_view name;
    std::vector<std::string_view> labels;
};

const std::vector<LabelGroup>& label_groups() {
    static const std::vector<LabelGroup> groups = {{"nose", {"nose"}},
                                                   {"mouth", {"upper_lip", "lower_lip"}},
                                                   {"eyes", {"eye_left", "eye_right"}},
                                                   {"cheeks", {"cheek_left", "cheek_right"}},
                                                   {"forehead", {"forehead", "brow_left", "brow_right"}},
                                                   {"chin", {"chin"}},
                                                   {"brow_left", {"brow_left"}},
                                                   {"brow_right", {"brow_right"}},
                                                   {"eye_left", {"eye_left"}},
                                                   {"eye_right", {"eye_right"}},
                                                   {"cheek_left", {"cheek_left"}},
                                                   {"cheek_right", {"cheek_right"}},
                                                   {"upper_lip", {"upper_lip"}},
                                                   {"lower_lip", {"lower_lip"}},
                                                   {"jaw_left", {"jaw_left"}},
                                                   {"jaw_right", {"jaw_right"}},
                                                   {"temple_left", {"temple_left"}},
                                                   {"temple_right", {"temple_right"}}};
    return groups;
}

constexpr std::array<std::string_view, 5> drawn_otherwise = {"zone", "face", "upper", "lower", "wrinkles"};

VertexMask half(const Face& neutral, bool upper) {
    const facs::RegionBorder border(neutral.landmarks);
    VertexMask mask(neutral.grid.size(), 0);
    for (std::size_t v = 0; v < mask.size(); ++v)
        if (neutral.grid.inside(v)) mask[v] = (border.above_mm(neutral.grid.vertices_mm[v]) >= 0) == upper ? 1 : 0;
    return mask;
}

VertexMask whole(const Face& neutral) {
    VertexMask mask(neutral.grid.size(), 0);
    for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = neutral.grid.inside(v) ? 1 : 0;
    return mask;
}

VertexMask about_wrinkles(const Face& neutral, const facs::FacsCatalogue& catalogue,
                          const facs::Expression& expression) {
    const auto upright = geometry::transformed(neutral.landmarks, neutral.average_from_scan);
    std::vector<Point> points;
    for (const auto& sided : catalogue.units(expression))
        for (const auto side : facs::sides_of(sided))
            for (const auto& point : sided.unit->points)
                if (point.kind == facs::ControlKind::wrinkle)
                    points.push_back(facs::place(point.placement, upright, side));
    VertexMask mask(neutral.grid.size(), 0);
    for (std::size_t v = 0; v < mask.size(); ++v) {
        if (!neutral.grid.inside(v)) continue;
        const Point p = neutral.average_from_scan * neutral.grid.vertices_mm[v];
        // Seen from the front: a placement says nothing of depth.
        for (const auto& point : points)
            if ((p - point).head<2>().norm() <= wrinkle_mm) mask[v] = 1;
    }
    return mask;
}

/// Of label groups, made when the first is asked for.
class CarriedLabels {
public:
    CarriedLabels(const Face& neutral, const preprocessing::AverageFace& average)
        : labels_(modeling::label_regions(average.grid, average.landmarks)),
          nearest_(preprocessing::nearest_on_average(neutral, average)) {}
    [[nodiscard]] VertexMask of(const LabelGroup& group) const {
        VertexMask mask(nearest_.size(), 0);
        for (std::size_t v = 0; v < mask.size(); ++v) {
            if (nearest_[v].distance_mm >= rim_mm) continue;
            const auto& label = labels_.label[nearest_[v].vertex];
            mask[v] = std::find(group.labels.begin(), group.labels.end(), label) != group.labels.end() ? 1 : 0;
        }
        return mask;
    }

private:
    modeling::RegionLabels labels_;
    std::vector<preprocessing::NearestOnAverage> nearest_;
};

}  // namespace

std::vector<std::string> known_regions() {
    std::vector<std::string> names(drawn_otherwise.begin(), drawn_otherwise.end());
    for (const auto& group : label_groups()) names.emplace_back(group.name);
    return names;
}

void check_region(const std::string& name) {
    const auto known = known_regions();
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw InputError(fmt::format("region '{}' is unknown; there are: {}", name, fmt::join(known, ", ")));
}

RegionMasks regions_on(const Face& neutral, const preprocessing::AverageFace& average,
                       const facs::FacsCatalogue& catalogue, const facs::Expression& expression, const VertexMask& zone,
                       std::span<const std::string> names) {
    RegionMasks masks;
    std::optional<CarriedLabels> labels;
    for (const auto& name : names) {
        check_region(name);
        if (name == "zone")
            masks[name] = zone;
        else if (name == "face")
            masks[name] = whole(neutral);
        else if (name == "upper" || name == "lower")
            masks[name] = half(neutral, name == "upper");
        else if (name == "wrinkles")
            masks[name] = about_wrinkles(neutral, catalogue, expression);
        else {
            if (!labels) labels.emplace(neutral, average);
            const auto& groups = label_groups();
            masks[name] =
                labels->of(*std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; }));
        }
    }
    return masks;
}

}  // namespace mimik::evaluation
