#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "animation/method.h"

namespace mimik::animation {

/// An expression of one source on the template, average frame of the source.
struct PooledSource {
    std::span<const geometry::Point> rest_mm;     ///< the template on its neutral face
    std::span<const geometry::Vector> motion_mm;  ///< per vertex
};

/// What sources are pooled for.
struct PoolTask {
    const preprocessing::FaceTemplate& face_template;
    bool both_sides = true;                    ///< the expression is that of both sides
    std::span<const geometry::Point> rest_mm;  ///< the template on the target's neutral face, average frame
};

/// One motion of the template from those of several sources; per vertex, mm.
using Pool = std::function<std::vector<geometry::Vector>(std::span<const PooledSource>, const PoolTask&)>;

/// Method `mean`, with another way than the mean to make one motion of the template from those of all others, which may
/// look at the target's neutral face. Everything else, lids and lips too, is as there.
class PooledMethod : public Method {
public:
    struct Setting {
        std::string name, summary;
        Pool pool;
    };
    explicit PooledMethod(Setting setting) : setting_(std::move(setting)) {}

    [[nodiscard]] std::string name() const override { return setting_.name; }
    [[nodiscard]] std::string summary() const override { return setting_.summary; }
    [[nodiscard]] SourceKind needs() const override { return SourceKind::all_but_target; }
    [[nodiscard]] std::string lessons_key() const override { return "pooled"; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask& task) const override;

private:
    Setting setting_;
};

/// The mean of a motion and its mirror image: what is left of people's own asymmetry in a mean is noise.
/// @param motion_mm  per vertex of the template
[[nodiscard]] std::vector<geometry::Vector> symmetric_motion(const preprocessing::FaceTemplate& face_template,
                                                             std::span<const geometry::Vector> motion_mm);
/// The mean, in which a source weighs exp(-d^2 / 2 h^2): d is the rms distance of its neutral face to the target's, h
/// the median of those distances.
[[nodiscard]] std::vector<geometry::Vector> near_motion(std::span<const PooledSource> sources, const PoolTask& task);

}  // namespace mimik::animation
