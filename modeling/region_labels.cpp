#include "modeling/region_labels.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "geometry/face_axes.h"
#include "geometry/point_index.h"
#include "modeling/average_fingerprint.h"
#include "preprocessing/nearest_on_average.h"

namespace mimik::modeling {

using geometry::Point;

std::vector<std::string> RegionLabels::names() const {
    std::set<std::string> all(label.begin(), label.end());
    all.erase("");
    return {all.begin(), all.end()};
}

RegionLabels label_regions(const geometry::QuadGrid& grid, const geometry::Landmarks& landmarks) {
    const auto at = [&](const char* name) { return landmarks.position_mm(name); };
    const Point eye_left = at("eye_outer_left"), eye_right = at("eye_outer_right");
    const double unit = geometry::outer_eye_distance_mm(landmarks);
    const double middle_x = 0.5 * (eye_left.x() + eye_right.x());
    const double eyes_y = 0.5 * (eye_left.y() + eye_right.y());
    const double brow_y = 0.25 * (at("brow_inner_left").y() + at("brow_inner_right").y() + at("brow_middle_left").y() +
                                  at("brow_middle_right").y());
    const double nose_base_y = 0.5 * (at("nose_wing_left").y() + at("nose_wing_right").y()) - 0.05 * unit;
    const double wing_x = 0.5 * (at("nose_wing_left") - at("nose_wing_right")).norm() + 0.03 * unit;
    const double saddle_x = 0.5 * (at("nose_saddle_left") - at("nose_saddle_right")).norm() + 0.02 * unit;
    const double mouth_x = 0.5 * (at("mouth_corner_left") - at("mouth_corner_right")).norm() + 0.06 * unit;
    const double lips_y = 0.5 * (at("upper_lip_inner").y() + at("lower_lip_inner").y());
    const double below_lips_y = at("lower_lip_outer").y() - 0.07 * unit;
    const double brow_half = 0.09 * unit;  // half the height of the brow band

    RegionLabels labels{grid.rows, grid.cols, std::vector<std::string>(grid.size())};
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.inside(v)) continue;
        const double x = grid.vertices_mm[v].x() - middle_x, y = grid.vertices_mm[v].y(), away = std::abs(x);
        const std::string side = x >= 0 ? "_left" : "_right";
        const double nose_half =
            saddle_x + (wing_x - saddle_x) * std::clamp((eyes_y - y) / (eyes_y - nose_base_y), 0.0, 1.0);
        auto& label = labels.label[v];
        if (y > brow_y + brow_half)
            label = away > 0.62 * unit ? "temple" + side : "forehead";
        else if (away > 0.66 * unit && y > eyes_y - 0.15 * unit)
            label = "temple" + side;
        else if (y > brow_y - brow_half)
            label = away < 0.07 * unit ? "nose" : "brow" + side;  // the nose's root, between the brows
        else if (away < nose_half && y > nose_base_y)
            label = "nose";
        else if (y > eyes_y - 0.16 * unit)
            label = "eye" + side;
        else if (away < mouth_x && y > lips_y && y <= nose_base_y)
            label = "upper_lip";
        else if (away < mouth_x && y > below_lips_y && y <= lips_y)
            label = "lower_lip";
        else if (away < 0.30 * unit && y <= below_lips_y)
            label = "chin";
        else if (y <= below_lips_y)
            label = "jaw" + side;
        else
            label = "cheek" + side;
    }
    return labels;
}

namespace {

// "# mimik regions, schema 1, average face 0123456789abcdef"
constexpr std::string_view comment_begin = "# mimik regions, schema ", comment_middle = ", average face ";
constexpr std::string_view schema = "1";

/// What the comment of a label file names must be what is read here.
void check_comment(const std::filesystem::path& file, const std::string& average_face) {
    const auto text = base::read_text(file, 1 << 26);
    base::LineReader lines(text, file.string());
    if (!lines.next_not_blank() || !lines.line().starts_with(comment_begin)) return;
    const auto rest = lines.line().substr(comment_begin.size());
    const auto middle = rest.find(comment_middle);
    const auto stated = base::trimmed(rest.substr(0, middle));
    if (stated != schema)
        lines.fail(fmt::format("schema is {}; this version of Mimik reads schema {}", base::in_quotes(stated), schema));
    if (middle == std::string_view::npos) return;
    const auto face = base::trimmed(rest.substr(middle + comment_middle.size()));
    if (face != average_face)
        lines.fail(
            fmt::format("these are regions of average face {}, and the workspace has {}; draw them again with 'mimik "
                        "regions'",
                        base::in_quotes(face), average_face));
}

}  // namespace

std::string encode_region_labels(const RegionLabels& labels, const std::string& average_face) {
    auto text = fmt::format("{}{}{}{}\nrow,col,region\n", comment_begin, schema, comment_middle, average_face);
    for (int row = 0; row < labels.rows; ++row)
        for (int col = 0; col < labels.cols; ++col) {
            const auto& label = labels.label[static_cast<std::size_t>(row) * static_cast<std::size_t>(labels.cols) +
                                             static_cast<std::size_t>(col)];
            if (!label.empty()) text += fmt::format("{},{},{}\n", row, col, base::csv_field(label));
        }
    return text;
}

RegionLabels read_region_labels(const std::filesystem::path& file, const preprocessing::AverageFace& average) {
    check_comment(file, average_fingerprint(average));
    return read_region_labels(file, average.grid.rows, average.grid.cols);
}

RegionLabels decode_region_labels(std::string_view text, const std::string& name, int rows, int cols) {
    base::CsvReader table(text, name);
    const auto row_column = table.column("row"), col_column = table.column("col"),
               region_column = table.column("region");
    RegionLabels labels{rows, cols,
                        std::vector<std::string>(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols))};
    while (table.next()) {
        const double row = table.number(row_column), col = table.number(col_column);
        if (!(row >= 0 && row < rows && col >= 0 && col < cols) || row != std::floor(row) || col != std::floor(col))
            table.fail(
                fmt::format("vertex ({}, {}) is not on the average face's grid of {} x {}", row, col, rows, cols));
        labels.label[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)] =
            table.field(region_column);
    }
    return labels;
}

RegionLabels read_region_labels(const std::filesystem::path& file, int rows, int cols) {
    return decode_region_labels(base::read_text(file, 1 << 26), file.string(), rows, cols);
}

std::vector<std::string> listed_regions(const RegionLabels& labels, std::span<const std::string> lists) {
    const auto known = labels.names();
    std::vector<std::string> listed;
    for (const auto& list : lists) {
        if (std::binary_search(known.begin(), known.end(), list)) {
            listed.push_back(list);
            continue;
        }
        for (std::size_t begin = 0; begin <= list.size();) {
            const auto end = std::min(list.find(',', begin), list.size());
            listed.emplace_back(base::trimmed(std::string_view(list).substr(begin, end - begin)));
            begin = end + 1;
        }
    }
    return listed;
}

std::vector<double> held_weights(const RegionLabels& labels, const preprocessing::AverageFace& average,
                                 const preprocessing::Face& face, std::span<const std::string> held, double border_mm) {
    const auto names = labels.names();
    for (const auto& region : held)
        if (!std::binary_search(names.begin(), names.end(), region))
            throw InputError(fmt::format("region '{}' is unknown; there are: {}", region, fmt::join(names, ", ")));
    std::vector<double> weights(face.grid.size(), 1.0);
    if (held.empty()) return weights;

    const auto nearest = preprocessing::nearest_on_average(face, average);
    std::vector<Point> still, vertices(weights.size(), Point::Zero());
    std::vector<char> is_held(weights.size(), 0);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        if (!face.grid.inside(v)) continue;
        vertices[v] = face.grid.vertices_mm[v];
        const auto& label = labels.label[nearest[v].vertex];
        if (std::find(held.begin(), held.end(), label) == held.end()) continue;
        is_held[v] = 1;
        still.push_back(vertices[v]);
    }
    if (still.empty()) return weights;
    const auto distance = geometry::PointIndex(still).nearest(vertices);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        if (!face.grid.inside(v)) continue;
        const double t = border_mm > 0 ? std::clamp(distance[v].distance_mm / border_mm, 0.0, 1.0) : 1.0;
        weights[v] = is_held[v] ? 0.0 : t * t * (3 - 2 * t);
    }
    return weights;
}

}  // namespace mimik::modeling
