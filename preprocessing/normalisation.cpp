#include "preprocessing/normalisation.h"

#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::preprocessing {
namespace {

using geometry::Landmarks;
using geometry::Transform;

Transform least_squares(const Landmarks& source, const Landmarks& target, bool with_scale) {
    const auto pairing = geometry::pair_by_name(source, target);
    const auto n = static_cast<Eigen::Index>(pairing.pairs.size());
    if (n < 3)
        throw InputError(fmt::format(
            "only {} shared; a similarity needs three or more (eye corners, nose tip, mouth corners are best)",
            base::counted(n, "landmark is", "landmarks are")));
    Eigen::Matrix3Xd from(3, n), to(3, n);
    for (Eigen::Index k = 0; k < n; ++k) {
        from.col(k) = pairing.pairs[static_cast<std::size_t>(k)].source_mm;
        to.col(k) = pairing.pairs[static_cast<std::size_t>(k)].target_mm;
    }
    const Eigen::Matrix3Xd centred = from.colwise() - from.rowwise().mean();
    const Eigen::Vector3d spread = Eigen::JacobiSVD<Eigen::Matrix3Xd>(centred).singularValues();
    if (spread(1) < 1e-6 * (1.0 + spread(0)))
        throw NumericalError("the shared landmarks lie on one line, so no rotation is defined; mark one off the line");
    return Transform(Eigen::umeyama(from, to, with_scale));
}

}  // namespace

Transform affine_normalisation(const Landmarks& landmarks, const Landmarks& average_landmarks) {
    const geometry::Point& nose = landmarks.position_mm("nose_tip");
    const geometry::Point& average_nose = average_landmarks.position_mm("nose_tip");
    Eigen::Matrix4d a, b;
    for (int k = 0; k < 4; ++k) {
        const auto name = affine_landmarks[static_cast<std::size_t>(k)];
        a.col(k) << average_landmarks.position_mm(name) - average_nose, 1.0;
        b.col(k) << landmarks.position_mm(name) - nose, 1.0;
    }
    const double volume = std::abs(b.topLeftCorner<3, 3>().determinant()) / 6.0;
    const double extent = b.topLeftCorner<3, 3>().norm();
    if (!(volume > 1e-4 * extent * extent * extent))
        throw NumericalError(
            fmt::format("outer eye corners, chin and nose tip lie nearly in one plane (volume {:.3g} "
                        "mm^3), so Eq. 5.3 has no answer; check these four landmarks",
                        volume));
    Transform average_from_scan;
    average_from_scan.matrix() = b.transpose().partialPivLu().solve(a.transpose()).transpose();
    average_from_scan.makeAffine();
    return Eigen::Translation3d(average_nose) * average_from_scan * Eigen::Translation3d(-nose);
}

Transform similarity_normalisation(const Landmarks& landmarks, const Landmarks& average_landmarks) {
    return least_squares(landmarks, average_landmarks, true);
}

Transform rigid_by_landmarks(const Landmarks& source, const Landmarks& target) {
    return least_squares(source, target, false);
}

}  // namespace mimik::preprocessing
