#include "animation/combine.h"

namespace mimik::animation {

geometry::Vector parallel_resultant(std::span<const geometry::Vector> pulls) {
    geometry::Vector weighted = geometry::Vector::Zero();
    double strength = 0;
    for (const auto& pull : pulls) {
        const double length = pull.norm();
        weighted += length * pull;
        strength += length;
    }
    return strength > 0 ? geometry::Vector(weighted / strength) : geometry::Vector(geometry::Vector::Zero());
}

}  // namespace mimik::animation
