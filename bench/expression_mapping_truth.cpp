// bench_expression_mapping_truth PERFORMER CHARACTER [MOTION.csv]: how well expression mapping finds the weights of a
// performance that are known. Both are folders of 'mimik examples'. The performer's features move by known weights,
// with noise; the weights found are set beside the true ones, and the character's face blended by them beside the face
// blended by the true ones, and beside doing nothing. Prints tables in Markdown; writes the motion if asked to.

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "animation/blend_examples.h"
#include "animation/expression_mapping.h"
#include "animation/facial_examples.h"
#include "animation/wires.h"
#include "base/quantile.h"
#include "base/random_stream.h"

namespace {

using namespace mimik;
using geometry::Point;
using geometry::Vector;

constexpr std::size_t frames = 900;
constexpr double rate_hz = 30;

/// Rises and falls of several lengths, mostly one or two examples at a time, as people act; 0 in the first second.
Eigen::MatrixXd true_weights(std::size_t examples) {
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(frames, static_cast<Eigen::Index>(examples));
    base::RandomStream chance(11);
    for (std::size_t begin = 30; begin < frames; begin += 15) {
        const auto example = static_cast<Eigen::Index>(chance.uniform() * static_cast<double>(examples));
        const double height = 0.3 + 0.7 * chance.uniform();
        const auto length = static_cast<std::size_t>(18 + 30 * chance.uniform());
        for (std::size_t k = 0; k < length && begin + k < frames; ++k) {
            const double rise = std::sin(M_PI * static_cast<double>(k) / static_cast<double>(length));
            auto& weight = weights(static_cast<Eigen::Index>(begin + k), example);
            weight = std::max(weight, height * rise * rise);
        }
    }
    return weights;
}

capture::FeatureMotion performance(const modeling::SourceExamples& source, const Eigen::MatrixXd& weights,
                                   double noise_mm) {
    capture::FeatureMotion motion{source.features, rate_hz, {}};
    base::RandomStream chance(12);
    for (std::size_t f = 0; f < frames; ++f) {
        capture::FeatureFrame frame;
        frame.time_s = static_cast<double>(f) / rate_hz;
        frame.state = capture::TrackState::tracked;
        frame.confidence = 1;
        for (std::size_t k = 0; k < source.features.size(); ++k) {
            Point p = source.neutral_mm[k];
            for (std::size_t i = 0; i < source.examples.size(); ++i)
                p += weights(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(i)) * source.displacement_mm[i][k];
            for (auto& c : p) c += noise_mm * chance.normal();
            frame.features.push_back({true, false, {0, 0}, p});
        }
        motion.frames.push_back(std::move(frame));
    }
    return motion;
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
    return x.dot(y) / std::max(1e-300, x.norm() * y.norm());
}

struct Found {
    double least_correlation = 1, median_correlation = 1, weight_rms = 0;
    std::string least_example;
    double error_mm = 0, nothing_mm = 0;  ///< rms over frames and vertices that some example moves
};

Found judged(const animation::FacialExamples& character, const std::vector<std::string>& names,
             const Eigen::MatrixXd& truth, const Eigen::MatrixXd& found) {
    Found result;
    std::vector<double> correlations;
    for (Eigen::Index i = 0; i < truth.cols(); ++i) {
        if (truth.col(i).maxCoeff() <= 0) continue;
        const double c = correlation(truth.col(i), found.col(i));
        correlations.push_back(c);
        if (c < result.least_correlation) {
            result.least_correlation = c;
            result.least_example = names[static_cast<std::size_t>(i)];
        }
    }
    result.median_correlation = base::median(correlations);
    result.weight_rms = std::sqrt((truth - found).squaredNorm() / static_cast<double>(truth.size()));
    std::vector<std::vector<Vector>> moved;
    for (const auto& name : names)
        for (const auto& example : character.examples)
            if (example.name == name) moved.push_back(example.displacement_mm);
    const animation::ExampleBlender blender(character.neutral.vertices_mm, moved);
    std::vector<Point> one(blender.vertices()), other(blender.vertices());
    std::vector<std::uint8_t> moves(blender.vertices(), 0);
    for (const auto& example : moved)
        for (std::size_t v = 0; v < example.size(); ++v) moves[v] |= example[v].norm() > 0.5 ? 1 : 0;
    double error = 0, nothing = 0, count = 0;
    for (Eigen::Index f = 0; f < truth.rows(); f += 5) {
        const Eigen::VectorXd t = truth.row(f), w = found.row(f);
        blender.blend({t.data(), static_cast<std::size_t>(t.size())}, one);
        blender.blend({w.data(), static_cast<std::size_t>(w.size())}, other);
        for (std::size_t v = 0; v < one.size(); ++v) {
            if (!moves[v]) continue;
            error += (one[v] - other[v]).squaredNorm();
            nothing += (one[v] - character.neutral.vertices_mm[v]).squaredNorm();
            ++count;
        }
    }
    result.error_mm = std::sqrt(error / count);
    result.nothing_mm = std::sqrt(nothing / count);
    return result;
}

void print_row(const std::string& what, double noise_mm, const animation::ExpressionMapping& mapping,
               const Found& found) {
    std::cout << fmt::format("| {} | {:.1f} | {} | {:.2f} | {:.3f} | {:.3f} ({}) | {:.3f} | {:.3f} | {:.3f} |\n", what,
                             noise_mm, mapping.parameters().dimensions(), mapping.basis().largest_residual(),
                             found.median_correlation, found.least_correlation, found.least_example, found.weight_rms,
                             found.error_mm, found.nothing_mm);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::cerr << "bench_expression_mapping_truth PERFORMER CHARACTER [MOTION.csv]\n";
        return 2;
    }
    const auto performer = animation::read_facial_examples(argv[1]);
    const auto character = animation::read_facial_examples(argv[2]);
    const auto own = modeling::read_source_examples(performer.features_file);
    const auto truth = true_weights(own.examples.size());
    if (argc > 3) capture::write_feature_motion(argv[3], performance(own, truth, 0.3));
    std::cout << "| source examples, ridge, threshold | noise, mm | axes | linear part off by | correlation, median | "
                 "least | weight rms | error, mm | nothing, mm |\n"
                 "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for (const double noise_mm : {0.0, 0.3, 1.0}) {
        const auto motion = performance(own, truth, noise_mm);
        const auto rest = animation::performer_rest(motion, 0, 29);
        const auto judge = [&](const std::string& what, const modeling::SourceExamples& source, double ridge,
                               double share) {
            animation::ExpressionMappingOptions options;
            options.basis.ridge_share = ridge;
            options.parameters.least_eigenvalue_share = share;
            const animation::ExpressionMapping mapping(animation::fitted_examples(source, motion, rest), options);
            const auto mapped = animation::map_performance(motion, rest, mapping);
            print_row(fmt::format("{}, {:g}, {:g}", what, ridge, share), noise_mm, mapping,
                      judged(character, source.examples, truth, mapped.weights));
        };
        for (const double ridge : {0.0, 1e-4, 1e-3, 1e-2})
            for (const double share : {1e-5, 1e-3, 1e-2}) judge("own", own, ridge, share);
        judge("standard", modeling::with_examples(modeling::standard_source_examples(), own.examples), 1e-3, 1e-5);
        judge("standard", modeling::with_examples(modeling::standard_source_examples(), own.examples), 1e-2, 1e-5);
    }
    const auto wires = animation::extract_wires(character);
    std::cout << fmt::format(
        "\n{} wires of {} vertices: {:.3f} mm rms off the examples, which move {:.3f} mm rms; "
        "largest {:.2f} mm\n",
        wires.wires().size(), wires.vertices(), wires.error().rms_mm, wires.error().motion_rms_mm,
        wires.error().largest_mm);
    for (const auto& wire : wires.wires()) std::cout << fmt::format("{} {:.1f} mm\n", wire.name, wire.radius_mm);
    return 0;
}
