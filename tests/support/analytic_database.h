#pragma once

#include <filesystem>
#include <string>

#include "database/bnt.h"
#include "database/bosphorus_landmarks.h"
#include "tests/support/analytic_face.h"

namespace mimik::test {

/// Where the head is in the scan: other for every scan, as a person does not sit still between two shots.
inline geometry::Transform analytic_pose(int k) {
    return geometry::Transform(Eigen::Translation3d(3.0 * k - 4, 2.0 - k, 30.0 + 5 * k) *
                               Eigen::AngleAxisd(0.02 * (k % 3 - 1), geometry::Vector(0.3, 1, 0.1).normalized()));
}

/// <root>/<subject>/<name>.bnt and .lm3 of the closed form, moved by `pose`.
inline void write_analytic_scan(const std::filesystem::path& root, const std::string& name, const AnalyticFace& shape,
                                const geometry::Transform& pose, double step_mm = 2.0) {
    auto scan = shape.scan(step_mm);
    for (auto& p : scan.points_mm)
        if (p.allFinite()) p = pose * p;
    const auto folder = root / name.substr(0, name.find('_'));
    database::write_bnt(folder / (name + ".bnt"), database::to_bnt(scan));
    database::write_lm3(folder / (name + ".lm3"),
                        database::to_bosphorus_labels(geometry::transformed(shape.landmarks(), pose)));
}

inline constexpr double analytic_scales[] = {0.95, 1.0, 1.08}, analytic_smile_mm = 6;

/// Three subjects of other sizes, each with a neutral scan and a smile (AU 12) in another pose.
inline void write_analytic_database(const std::filesystem::path& root) {
    for (int k = 0; k < 3; ++k) {
        const std::string subject = "bs00" + std::to_string(k);
        write_analytic_scan(root, subject + "_N_N_0", {analytic_scales[k], 0}, analytic_pose(2 * k));
        write_analytic_scan(root, subject + "_LFAU_12_0", {analytic_scales[k], analytic_smile_mm},
                            analytic_pose(2 * k + 1));
    }
}

}  // namespace mimik::test
