#include "io/body_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::io {

using geometry::Point;

const char* to_string(BodyFrame frame) { return frame == BodyFrame::lps ? "LPS" : "RAS"; }

BodyFrame other_frame(BodyFrame frame) { return frame == BodyFrame::lps ? BodyFrame::ras : BodyFrame::lps; }

BodyFrame parse_body_frame(std::string_view text) {
    const auto word = base::lower_case(base::trimmed(text));
    if (word == "lps" || word == "1" || word == "left-posterior-superior") return BodyFrame::lps;
    if (word == "ras" || word == "0" || word == "right-anterior-superior") return BodyFrame::ras;
    throw InputError(fmt::format("{}; it must be LPS, RAS, 0 (RAS) or 1 (LPS)", base::in_quotes(text)));
}

std::optional<BodyFrame> frame_in_comment(std::string_view comment, const std::string& file) {
    const auto text = base::lower_case(comment);
    const auto is_letter = [&](std::size_t at) {
        return at < text.size() && ((text[at] >= 'a' && text[at] <= 'z') || text[at] == '-' || text[at] == '_');
    };
    constexpr std::string_view key = "space";
    for (auto at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
        if (at > 0 && is_letter(at - 1)) continue;
        auto rest = base::trimmed(std::string_view(text).substr(at + key.size()));
        if (!rest.starts_with('=')) continue;
        rest = base::trimmed(rest.substr(1));
        std::size_t length = 0;
        while (length < rest.size() && ((rest[length] >= 'a' && rest[length] <= 'z') || rest[length] == '-')) ++length;
        const auto word = rest.substr(0, length);
        // Three letters, one for each axis of the body; other words are about something else.
        const bool axes = word.size() == 3 && word.find_first_not_of("rlapsi") == std::string_view::npos;
        if (!axes && !word.ends_with("-superior") && !word.ends_with("-inferior")) continue;
        try {
            return parse_body_frame(word);
        } catch (const InputError& e) {
            throw InputError(fmt::format("{}: SPACE is {}", file, e.what()));
        }
    }
    return std::nullopt;
}

void negate_x_and_y(std::span<Point> points) {
    for (auto& p : points) p = Point(0.0 - p.x(), 0.0 - p.y(), p.z());  // not -0
}

double mean_distance_to(std::span<const Point> mesh_points, std::span<const Point> points, const Point& factors) {
    // Some spread over the list are enough to tell frames and units apart.
    const std::size_t step = 1 + points.size() / 200;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); i += step, ++count) {
        const Point p = points[i].cwiseProduct(factors);
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& q : mesh_points) nearest = std::min(nearest, (q - p).squaredNorm());
        sum += std::sqrt(nearest);
    }
    return sum / static_cast<double>(count);
}

std::optional<BodyFrame> frame_judged_by(std::span<const Point> points_lps, std::span<const Point> mesh_points) {
    std::vector<Point> finite;
    Eigen::AlignedBox3d box;
    for (const auto& p : mesh_points) {
        if (!p.allFinite()) continue;
        finite.push_back(p);
        box.extend(p);
    }
    if (finite.empty() || points_lps.empty()) return std::nullopt;
    const double lps = mean_distance_to(finite, points_lps, Point(1, 1, 1));
    const double ras = mean_distance_to(finite, points_lps, Point(-1, -1, 1));
    const double limit = 0.05 * box.diagonal().norm();
    if (lps <= limit && lps < 0.5 * ras) return BodyFrame::lps;
    if (ras <= limit && ras < 0.5 * lps) return BodyFrame::ras;
    return std::nullopt;
}

}  // namespace mimik::io
