#pragma once

#include <limits>

#include "geometry/types.h"

namespace mimik::geometry {

/// A triangle as one corner and the edges from it to the others.
struct Corners {
    Point a;
    Vector ab, ac;
};

/// The point of a triangle that lies closest to a query.
struct Foot {
    double squared_mm2 = std::numeric_limits<double>::infinity();
    Vector from_a = Vector::Zero();  ///< foot - a
    double b = 0, c = 0;             ///< weights; exactly 0 (or b + c exactly 1) on an edge
    int edge = -1;                   ///< 0: ab, 1: ac, 2: bc, -1: inside
};

/// How far along `edge` the point of it lies that is closest to a query, `to_query` from its begin: 0 to 1.
inline double along(const Vector& to_query, const Vector& edge) {
    const double length2 = edge.squaredNorm();
    const double t = to_query.dot(edge);
    return t <= 0.0 || length2 == 0.0 ? 0.0 : (t >= length2 ? 1.0 : t / length2);
}

/// The closest point of one edge (as Foot::edge numbers them); `ap` leads from corner a to the query.
inline Foot measure_edge(const Corners& t, const Vector& ap, int edge) {
    double s = 0;
    Vector from_a;
    if (edge == 2) {
        const Vector bc = t.ac - t.ab;
        s = along(ap - t.ab, bc);
        from_a = t.ab + s * bc;
    } else {
        const Vector& side = edge == 0 ? t.ab : t.ac;
        s = along(ap, side);
        from_a = s * side;
    }
    return {(ap - from_a).squaredNorm(), from_a, edge == 0 ? s : (edge == 2 ? 1.0 - s : 0.0), edge == 0 ? 0.0 : s,
            edge};
}

/// Inside the prism over the triangle the distance is that to its plane; otherwise the closest point lies on an edge
/// whose outer side holds the query. Weights come from the normal (error ~ eps / aspect ratio) and not from the Gram
/// determinant (eps / aspect ratio squared), so slivers do no harm; without area only the edges are measured.
inline Foot measure(const Corners& t, const Point& query) {
    const Vector ap = query - t.a;
    const Vector normal = t.ab.cross(t.ac);
    const double area2 = normal.squaredNorm();
    const double b = normal.dot(ap.cross(t.ac));
    const double c = normal.dot(t.ab.cross(ap));
    const double a = area2 - b - c;
    const bool flat = area2 <= 1e-28 * t.ab.squaredNorm() * t.ac.squaredNorm();
    if (!flat && a > 0.0 && b > 0.0 && c > 0.0) {
        const double height = normal.dot(ap) / area2;
        return {height * height * area2, ap - height * normal, b / area2, c / area2, -1};
    }
    Foot best;
    const auto consider = [&](int edge) {
        const Foot foot = measure_edge(t, ap, edge);
        if (foot.squared_mm2 < best.squared_mm2) best = foot;
    };
    if (flat || c <= 0.0) consider(0);
    if (flat || b <= 0.0) consider(1);
    if (flat || a <= 0.0) consider(2);
    return best;
}

}  // namespace mimik::geometry
