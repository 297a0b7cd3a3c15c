#include "evaluation/point_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/own_case.h"
#include "facs/reference_face.h"
#include "geometry/face_axes.h"

namespace mimik::evaluation {

void PointSensitivityOptions::check() const {
    if (!(std::isfinite(step_mm) && step_mm > 0))
        throw InputError(fmt::format("step_mm is {}; give more than 0, such as 1", step_mm));
}

double PointSensitivity::largest_mm() const {
    return std::max({std::abs(outward_mm), std::abs(inward_mm), std::abs(up_mm), std::abs(down_mm)});
}

namespace {

/// The cases of one unit, and their mean error for any places of its points.
class UnitCases {
public:
    UnitCases(const TuneGroup& group, const facs::FacsCatalogue& catalogue, const facs::ActionUnit& unit,
              const animation::ModelMethod& method, FailureList& failures)
        : catalogue_(catalogue), method_(method) {
        const auto both = facs::Expression::of_units({{unit.number, facs::Side::both, false}});
        const auto planned = planned_cases(group, catalogue, both, failures);
        cases_.resize(planned.size());
        base::parallel_for_each(planned.size(),
                                [&](std::size_t k) { cases_[k] = ready_case(planned[k], method, 1, failures); });
        std::erase_if(cases_, [](const auto& one) { return !one; });
    }
    [[nodiscard]] std::size_t size() const { return cases_.size(); }

    [[nodiscard]] OwnCase::Errors mean(const facs::ActionUnit& unit) const {
        const auto catalogue = unit_alone(catalogue_, unit);
        std::vector<OwnCase::Errors> errors(cases_.size());
        base::parallel_for_each(cases_.size(),
                                [&](std::size_t k) { errors[k] = cases_[k]->errors(catalogue, method_, true); });
        OwnCase::Errors mean;
        for (const auto& error : errors) {
            mean.own_mm += error.own_mm / static_cast<double>(errors.size());
            mean.nothing_mm += error.nothing_mm / static_cast<double>(errors.size());
        }
        return mean;
    }

private:
    const facs::FacsCatalogue& catalogue_;
    const animation::ModelMethod& method_;
    std::vector<std::unique_ptr<const OwnCase>> cases_;
};

}  // namespace

UnitSensitivity point_sensitivity(const TuneGroup& group, const facs::FacsCatalogue& catalogue, int unit,
                                  const animation::ModelMethod& method, const PointSensitivityOptions& options,
                                  FailureList& failures, const std::function<void()>& done) {
    options.check();
    require_points_on_source(method);
    const auto* known = catalogue.find(unit);
    if (!known) throw InputError(fmt::format("AU{} is not in the {}; name one that is", unit, catalogue.name()));
    if (known->points.empty()) throw InputError(fmt::format("AU{} has no points in the {}", unit, catalogue.name()));
    const UnitCases cases(group, catalogue, *known, method, failures);
    if (cases.size() == 0)
        throw InputError(fmt::format("AU{}: no subject shows it, so there is nothing to measure", unit));

    const auto before = cases.mean(*known);
    UnitSensitivity result{unit, cases.size(), before.own_mm, before.nothing_mm, options.step_mm, {}};
    const double step = options.step_mm / geometry::outer_eye_distance_mm(facs::reference_landmarks());
    for (std::size_t p = 0; p < known->points.size(); ++p) {
        const auto& point = known->points[p];
        const auto change = [&](double lateral, double up) {
            auto moved = *known;
            moved.points[p].placement.lateral += lateral;
            moved.points[p].placement.up += up;
            const double change_mm = cases.mean(moved).own_mm - before.own_mm;
            if (done) done();
            return change_mm;
        };
        PointSensitivity one{point.name, point.kind, facs::on_midline(point.placement)};
        if (!one.midline) {
            one.outward_mm = change(step, 0);
            one.inward_mm = change(-step, 0);
        }
        one.up_mm = change(0, step);
        one.down_mm = change(0, -step);
        result.points.push_back(one);
    }
    return result;
}

}  // namespace mimik::evaluation
