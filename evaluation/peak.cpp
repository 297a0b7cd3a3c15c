#include "evaluation/peak.h"

#include "geometry/statistics.h"

namespace mimik::evaluation {
namespace {

constexpr double peak_share = 0.99;  // the very largest is that of one vertex, and a spike may be it

class Peak : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "peak"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        const auto& target = face.target;
        std::vector<double> animated_mm, true_mm;
        for (std::size_t k = 0; k < target.vertices.size(); ++k) {
            if (!target.in_zone[k]) continue;
            animated_mm.push_back(face.way_mm(target.vertices[k]).norm());
            if (!target.true_displacement_mm.empty()) true_mm.push_back(target.true_displacement_mm[k].norm());
        }
        if (animated_mm.empty()) return {};
        std::vector<Measure> measures = {
            {"zone", "animated", geometry::quantile(std::move(animated_mm), peak_share), "mm"}};
        if (!true_mm.empty())
            measures.push_back({"zone", "true", geometry::quantile(std::move(true_mm), peak_share), "mm"});
        return measures;
    }
};

}  // namespace

std::unique_ptr<const Estimator> peak_estimator() { return std::make_unique<Peak>(); }

}  // namespace mimik::evaluation
