#pragma once

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "animation/animate.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/expressions.h"

namespace mimik::animation {

/// A source that smiles by 6 mm and a target of another size, both in closed form.
class AnalyticSmile : public testing::Test {
protected:
    static void SetUpTestSuite() {
        average_ = new preprocessing::AverageFace(test::analytic_average());
        source_ = new test::AnalyticSubject(test::analytic_subject(*average_, 1.0, 6.0));
        target_ = new test::AnalyticSubject(test::analytic_subject(*average_, 1.1, 6.0));
    }
    static void TearDownTestSuite() {
        delete target_;
        delete source_;
        delete average_;
    }
    static modeling::ExpressionModel smile(const modeling::ModelOptions& options = modeling::ModelOptions::sparse(),
                                           const std::string& code = "12") {
        return modeling::measure_expression(facs::builtin_catalogue(), test::expression(code), *average_,
                                            source_->neutral, source_->smiling, options);
    }
    /// Mean distance of the animated lower face to the true smile, in the head frame of the closed form.
    static double smile_error_mm(const AnimatedFace& animated, const preprocessing::Face& neutral, double scale,
                                 double smile_mm) {
        const test::AnalyticFace truth{scale, smile_mm};
        const geometry::Transform scan_from_head =
            preprocessing::rigid_by_landmarks(test::AnalyticFace{scale}.landmarks(), neutral.landmarks);
        double sum = 0;
        int count = 0;
        for (std::size_t v = 0; v < neutral.grid.size(); ++v) {
            if (!neutral.grid.measured(v)) continue;
            const geometry::Point moved = neutral.grid.vertices_mm[v] + animated.field.mm[v];
            const geometry::Point rest = scan_from_head.inverse() * neutral.grid.vertices_mm[v] / scale;
            if (std::abs(std::abs(rest.x()) - 25) > 15 || std::abs(rest.y() + 31.5) > 15) continue;
            sum += (scan_from_head.inverse() * moved - truth.point(rest.x(), rest.y())).norm();
            ++count;
        }
        return sum / count;
    }

    static inline preprocessing::AverageFace* average_ = nullptr;
    static inline test::AnalyticSubject* source_ = nullptr;
    static inline test::AnalyticSubject* target_ = nullptr;
};

}  // namespace mimik::animation
