// Holes of a scan (database/doctor.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "database/doctor.h"
#include "geometry/box.h"
#include "geometry/disjoint_sets.h"
#include "geometry/face_axes.h"
#include "geometry/topology.h"

namespace mimik::database {
namespace {

void add_hole(HoleReport& report, std::vector<geometry::Point> rim) {
    const auto box = geometry::box_of(rim);
    ++report.count;
    report.rims_mm.push_back(std::move(rim));
    if (box.diagonal().norm() <= report.largest_mm) return;
    report.largest_mm = box.diagonal().norm();
    report.largest_at_mm = box.center();
}

/// Where scanners lose points on every face, seen along `out`. Radii in outer-eye distances, so that the holes of the
/// synthetic scanner (lids, brows, nostrils, lips and their shades) lie inside and a cheek or a forehead does not.
class OrdinaryPlaces {
public:
    explicit OrdinaryPlaces(const geometry::Landmarks& marks) : axes_(geometry::head_axes(marks)) {
        const auto* chin = marks.find("chin");
        if (!axes_ || !chin) {
            axes_.reset();
            return;
        }
        chin_mm_ = axes_->up.dot(chin->position_mm);
        const double eyes_mm = geometry::outer_eye_distance_mm(marks);
        const auto add = [&](const std::string& a, const std::string& b, double beyond, double beside) {
            const auto *from = marks.find(a), *to = marks.find(b);
            if (from && to)
                stripes_.push_back(
                    {seen(from->position_mm), seen(to->position_mm), beyond * eyes_mm, beside * eyes_mm});
        };
        for (const std::string side : {"_left", "_right"}) {
            add("eye_outer" + side, "eye_inner" + side, 0.08, 0.17);
            add("brow_outer" + side, "brow_middle" + side, 0.12, 0.12);
            add("brow_middle" + side, "brow_inner" + side, 0.12, 0.12);
            add("nose_wing" + side, "nose_tip", 0.15, 0.15);
            for (const char* lip : {"upper_lip_inner", "lower_lip_inner"}) add("mouth_corner" + side, lip, 0.12, 0.12);
        }
    }

    [[nodiscard]] bool hold(const geometry::Point& point) const {
        if (!axes_) return false;
        if (axes_->up.dot(point) < chin_mm_) return true;
        const auto p = seen(point);
        return std::any_of(stripes_.begin(), stripes_.end(), [&](const Stripe& stripe) {
            const Eigen::Vector2d along = (stripe.to - stripe.from).normalized(), from = p - stripe.from;
            const double t = along.dot(from), length = (stripe.to - stripe.from).norm();
            return t > -stripe.beyond_mm && t < length + stripe.beyond_mm &&
                   std::abs(along.x() * from.y() - along.y() * from.x()) < stripe.beside_mm;
        });
    }

private:
    struct Stripe {
        Eigen::Vector2d from, to;
        double beyond_mm, beside_mm;
    };
    [[nodiscard]] Eigen::Vector2d seen(const geometry::Point& p) const {
        return {axes_->lateral.dot(p), axes_->up.dot(p)};
    }

    std::optional<geometry::HeadAxes> axes_;
    double chin_mm_ = 0;
    std::vector<Stripe> stripes_;
};

/// Parts of the unmeasured cells that do not reach the edge of the lattice.
HoleReport holes_of_lattice(const geometry::RangeScan& scan) {
    const int rows = scan.rows, cols = scan.cols;
    const auto at = [&](int row, int col) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
    };
    std::vector<char> seen(scan.points_mm.size(), 0);
    std::vector<std::array<int, 2>> queue;
    HoleReport report;
    report.judged = true;
    for (int start_row = 0; start_row < rows; ++start_row)
        for (int start_col = 0; start_col < cols; ++start_col) {
            if (scan.valid(at(start_row, start_col)) || seen[at(start_row, start_col)]) continue;
            bool open = false;
            std::vector<geometry::Point> rim;
            queue.assign(1, {start_row, start_col});
            seen[at(start_row, start_col)] = 1;
            while (!queue.empty()) {
                const auto [row, col] = queue.back();
                queue.pop_back();
                for (const auto& [dr, dc] : {std::array{0, 1}, {0, -1}, {1, 0}, {-1, 0}}) {
                    const int r = row + dr, c = col + dc;
                    if (r < 0 || c < 0 || r >= rows || c >= cols) {
                        open = true;
                    } else if (scan.valid(at(r, c))) {
                        rim.push_back(scan.points_mm[at(r, c)]);
                    } else if (!seen[at(r, c)]) {
                        seen[at(r, c)] = 1;
                        queue.push_back({r, c});
                    }
                }
            }
            if (!open) add_hole(report, std::move(rim));
        }
    return report;
}

/// Rims of a mesh: edges with one face, joined where they share a vertex. The largest rim is the scan's outline.
HoleReport holes_of_mesh(const geometry::RangeScan& scan) {
    HoleReport report;
    report.judged = true;
    geometry::DisjointSets sets(scan.points_mm.size());
    std::vector<std::uint32_t> on_rim;
    for (const auto& [a, b] : geometry::border_edges(scan.faces)) {
        if (a == b) continue;
        sets.join(a, b);
        on_rim.insert(on_rim.end(), {a, b});
    }
    std::sort(on_rim.begin(), on_rim.end());
    on_rim.erase(std::unique(on_rim.begin(), on_rim.end()), on_rim.end());
    std::map<std::uint32_t, std::vector<geometry::Point>> rims;
    for (const auto vertex : on_rim) rims[sets.root(vertex)].push_back(scan.points_mm[vertex]);
    if (rims.size() < 2) return report;
    const auto outline = std::max_element(rims.begin(), rims.end(), [](const auto& a, const auto& b) {
        return geometry::box_of(a.second).diagonal().norm() < geometry::box_of(b.second).diagonal().norm();
    });
    for (auto it = rims.begin(); it != rims.end(); ++it)
        if (it != outline) add_hole(report, std::move(it->second));
    return report;
}

}  // namespace

HoleReport find_holes(const geometry::RangeScan& scan) {
    if (scan.organised()) return holes_of_lattice(scan);
    if (scan.faces.size() > 0) return holes_of_mesh(scan);
    return {};
}

SkinHole worst_skin_hole(const HoleReport& holes, const geometry::Landmarks& landmarks) {
    const OrdinaryPlaces ordinary(landmarks);
    SkinHole worst;
    for (const auto& rim : holes.rims_mm) {
        std::vector<geometry::Point> skin;
        std::copy_if(rim.begin(), rim.end(), std::back_inserter(skin),
                     [&](const auto& p) { return !ordinary.hold(p); });
        if (skin.empty()) continue;
        const auto box = geometry::box_of(skin);
        if (box.diagonal().norm() > worst.size_mm) worst = {box.diagonal().norm(), box.center()};
    }
    return worst;
}

}  // namespace mimik::database
