#include <cmath>
#include <iostream>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/thin_plate_spline.h"

// Moves a tetrahedron by (1, 2, 3) mm and carries the nose tip along.
int main() {
    using mimik::geometry::Point;
    const std::vector<Point> from = {{10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {-10, -10, -10}};
    std::vector<Point> to;
    for (const auto& p : from) to.push_back(p + Point(1, 2, 3));
    const auto spline = mimik::geometry::ThinPlateSpline::fit(from, to);
    const mimik::geometry::Landmarks marks({{"nose_tip", spline(Point::Zero()), ""}});
    const Point tip = marks.position_mm("nose_tip");
    std::cout << "nose tip at " << std::llround(tip.x()) << ' ' << std::llround(tip.y()) << ' ' << std::llround(tip.z())
              << " mm\n";
}
