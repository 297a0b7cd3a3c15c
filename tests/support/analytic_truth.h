#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "database/truth.h"
#include "tests/support/analytic_database.h"

namespace mimik::test {

/// The truth of an analytic scan: its own lattice as the true surface, so the same vertex is the same skin point in all
/// of them; head frame = the frame of the closed form.
inline database::TrueScan analytic_truth(const std::string& name, const AnalyticFace& shape,
                                         const geometry::Transform& pose) {
    constexpr double step_mm = 3.0;
    constexpr int cols = 41, rows = 49;  // x -60 ... 60, y -72 ... 72
    database::TrueScan truth;
    truth.id = *database::parse_scan_name(name);
    truth.scanner_from_head = pose;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const double x = step_mm * (col - cols / 2), y = step_mm * (row - rows / 2);
            truth.vertices_mm.emplace_back(pose * shape.point(x, y));
            const Eigen::Vector2d shift = shape.scale * shape.shift(x, y);
            truth.displacement_mm.emplace_back(shift.x(), shift.y(), 0);
            if (row + 1 < rows && col + 1 < cols) {
                const auto at = static_cast<std::uint32_t>(row * cols + col);
                truth.faces.add(std::vector<std::uint32_t>{at, at + 1, at + cols + 1, at + cols});
            }
        }
    truth.landmarks = geometry::transformed(shape.landmarks(), pose);
    return truth;
}

/// The truth beside write_analytic_database(root).
inline void write_analytic_truth(const std::filesystem::path& root) {
    auto scans = nlohmann::json::array();
    std::size_t vertices = 0;
    for (int k = 0; k < 6; ++k) {
        const std::string name = "bs00" + std::to_string(k / 2) + (k % 2 ? "_LFAU_12_0" : "_N_N_0");
        const auto truth =
            analytic_truth(name, {analytic_scales[k / 2], k % 2 ? analytic_smile_mm : 0}, analytic_pose(k));
        database::write_true_scan(root / "truth", truth);
        vertices = truth.vertices_mm.size();
        scans.push_back(name);
    }
    const nlohmann::json document = {{"schema", 1},
                                     {"seed", 3},
                                     {"variances", {{"identity", 0.5}, {"field_length_mm", 12.0}}},
                                     {"face_model",
                                      {{"name", "analytic"},
                                       {"faces", nlohmann::json::array()},
                                       {"vertices", vertices},
                                       {"regions", nlohmann::json::object()},
                                       {"landmark_vertices", nlohmann::json::object()}}},
                                     {"subjects", nlohmann::json::array()},
                                     {"scans", scans}};
    base::write_atomically(root / "truth" / "truth.json", document.dump());
}

}  // namespace mimik::test
