#pragma once

#include <string>

#include "preprocessing/average_face.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/preprocess_scan.h"
#include "tests/support/analytic_face.h"

namespace mimik::test {

/// A preprocessed face in closed form, tied to the average face `AnalyticFace{}` with the nose tip at the origin.
inline preprocessing::Face analytic_face(const AnalyticFace& shape, const std::string& code,
                                         const geometry::Transform& pose) {
    database::LoadedScan loaded;
    loaded.entry.id = {"bs000", code == "N" ? "N" : "LFAU", code, 0};
    loaded.scan = shape.scan(1.0);
    for (auto& p : loaded.scan.points_mm)
        if (p.allFinite()) p = pose * p;
    loaded.landmarks = geometry::transformed(shape.landmarks(), pose);
    return preprocessing::preprocess_scan(loaded);
}

inline preprocessing::AverageFace analytic_average() {
    const auto face = analytic_face({}, "N", geometry::Transform::Identity());
    const std::vector<geometry::Landmarks> sets = {face.landmarks, face.landmarks};
    return preprocessing::build_average_face(
        2, [&](std::size_t) { return face; }, preprocessing::consensus_landmarks(sets));
}

/// Neutral and smiling scan of one subject, normalised both ways; the smile's own pose differs from the neutral's.
struct AnalyticSubject {
    preprocessing::Face neutral, smiling;
};

inline AnalyticSubject analytic_subject(const preprocessing::AverageFace& average, double scale, double smile_mm) {
    const geometry::Transform pose(Eigen::Translation3d(5, -3, 40) *
                                   Eigen::AngleAxisd(0.05, geometry::Vector::UnitY()));
    const geometry::Transform other_pose(Eigen::Translation3d(-4, 6, 30) *
                                         Eigen::AngleAxisd(-0.04, geometry::Vector::UnitX()));
    AnalyticSubject subject{analytic_face({scale, 0}, "N", pose), analytic_face({scale, smile_mm}, "12", other_pose)};
    auto& [neutral, smiling] = subject;
    neutral.average_from_scan = preprocessing::similarity_normalisation(neutral.landmarks, average.landmarks);
    neutral.average_from_scan_affine =
        preprocessing::affine_normalisation(neutral.snapped_landmarks, average.landmarks);
    smiling.neutral_from_scan = pose * other_pose.inverse();
    smiling.average_from_scan = neutral.average_from_scan * smiling.neutral_from_scan;
    smiling.average_from_scan_affine =
        preprocessing::affine_normalisation(smiling.snapped_landmarks, average.landmarks);
    return subject;
}

}  // namespace mimik::test
