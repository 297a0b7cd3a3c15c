#include "animation/motion_components.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::animation {

using geometry::Vector;

void MotionComponentsOptions::check() const {
    if (components < 1 || components > 256)
        throw InputError(fmt::format("components is {}; give 1 to 256", components));
    if (sampled_frames < 2 || sampled_frames > 4096)
        throw InputError(fmt::format("sampled_frames is {}; give 2 to 4096", sampled_frames));
}

namespace {

/// Columns: frames, evenly spaced, the last among them.
Eigen::MatrixXf sampled(std::size_t frames, std::size_t vertices, std::size_t count,
                        const std::function<void(std::size_t, std::span<Vector>)>& frame_mm) {
    Eigen::MatrixXf columns(static_cast<Eigen::Index>(3 * vertices), static_cast<Eigen::Index>(count));
    std::vector<Vector> moved(vertices);
    for (std::size_t k = 0; k < count; ++k) {
        frame_mm(count > 1 ? k * (frames - 1) / (count - 1) : 0, moved);
        for (std::size_t v = 0; v < vertices; ++v)
            columns.block<3, 1>(static_cast<Eigen::Index>(3 * v), static_cast<Eigen::Index>(k)) =
                moved[v].cast<float>();
    }
    return columns;
}

/// Orthonormal columns; as many as the motion has, at most `most`.
Eigen::MatrixXd principal(const Eigen::MatrixXf& columns, std::size_t most) {
    const Eigen::MatrixXd wide = columns.cast<double>();  // sums of squares in single precision would look like motion
    const Eigen::MatrixXd gram = wide.transpose() * wide;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
    const auto& values = solver.eigenvalues();
    const double negligible = 1e-9 * std::max(values.maxCoeff(), 0.0);
    std::vector<Eigen::VectorXd> list;
    for (Eigen::Index k = values.size() - 1; k >= 0 && list.size() < most; --k) {
        if (!(values[k] > negligible)) break;
        list.emplace_back(wide * (solver.eigenvectors().col(k) / std::sqrt(values[k])));
    }
    Eigen::MatrixXd basis(columns.rows(), static_cast<Eigen::Index>(list.size()));
    for (std::size_t k = 0; k < list.size(); ++k) basis.col(static_cast<Eigen::Index>(k)) = list[k];
    return basis;
}

}  // namespace

MotionComponents motion_components(std::size_t frames, std::size_t vertices,
                                   const std::function<void(std::size_t, std::span<Vector>)>& frame_mm,
                                   const MotionComponentsOptions& options) {
    options.check();
    if (frames == 0) throw InputError("there is no frame; a motion has one at least");
    auto basis =
        principal(sampled(frames, vertices, std::min(frames, options.sampled_frames), frame_mm), options.components);
    Eigen::MatrixXd weights(basis.cols(), static_cast<Eigen::Index>(frames));
    std::vector<Vector> moved(vertices);
    MotionComponents result;
    double squares = 0;
    for (std::size_t f = 0; f < frames; ++f) {
        frame_mm(f, moved);
        Eigen::VectorXd now(basis.rows());
        for (std::size_t v = 0; v < vertices; ++v) now.segment<3>(static_cast<Eigen::Index>(3 * v)) = moved[v];
        const Eigen::VectorXd w = basis.transpose() * now;
        weights.col(static_cast<Eigen::Index>(f)) = w;
        now -= basis * w;
        for (std::size_t v = 0; v < vertices; ++v) {
            const double error = now.segment<3>(static_cast<Eigen::Index>(3 * v)).norm();
            squares += error * error;
            if (error > result.largest_error_mm) {
                result.largest_error_mm = error;
                result.worst_frame = f;
                result.worst_vertex = v;
            }
        }
    }
    result.rms_error_mm = vertices > 0 ? std::sqrt(squares / static_cast<double>(frames * vertices)) : 0;
    result.weights.assign(frames, std::vector<double>(static_cast<std::size_t>(basis.cols())));
    for (Eigen::Index c = 0; c < basis.cols(); ++c) {
        // So that a viewer's sliders go up to 1.
        const double largest = weights.row(c).cwiseAbs().maxCoeff(), unit = largest > 0 ? largest : 1;
        auto& shape = result.shapes_mm.emplace_back(vertices);
        for (std::size_t v = 0; v < vertices; ++v)
            shape[v] = unit * basis.block<3, 1>(static_cast<Eigen::Index>(3 * v), c);
        for (std::size_t f = 0; f < frames; ++f)
            result.weights[f][static_cast<std::size_t>(c)] = weights(c, static_cast<Eigen::Index>(f)) / unit;
    }
    return result;
}

}  // namespace mimik::animation
