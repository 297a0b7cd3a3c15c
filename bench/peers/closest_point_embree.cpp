#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <embree3/rtcore.h>

#include "bench/peers/closest_point_peer.h"

namespace mimik::peers {
namespace {

using geometry::Point;
using geometry::Triangle;
using geometry::Vector;

// Region by region after Ericson, Real-Time Collision Detection (2005), 5.1.5: other arithmetic than SurfaceIndex.
Point closest_on_triangle(const Point& q, const Point& a, const Point& b, const Point& c) {
    const Vector ab = b - a, ac = c - a, ap = q - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Vector bp = q - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
    const Vector cp = q - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    const double sum = va + vb + vc;
    return a + vb / sum * ab + vc / sum * ac;
}

class EmbreePeer : public ClosestPointPeer {
public:
    EmbreePeer(std::span<const Point> vertices_mm, std::span<const Triangle> triangles)
        : vertices_(vertices_mm.begin(), vertices_mm.end()),
          triangles_(triangles.begin(), triangles.end()),
          device_(rtcNewDevice("threads=1")),
          scene_(rtcNewScene(device_)) {
        if (!device_) throw std::runtime_error("Embree gives no device");
        auto* geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                              3 * sizeof(float), vertices_.size()));
        for (const auto& p : vertices_)
            for (int k = 0; k < 3; ++k) *v++ = static_cast<float>(p[k]);
        auto* i = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles_.size()));
        for (const auto& t : triangles_) i = std::copy(t.begin(), t.end(), i);
        rtcSetGeometryPointQueryFunction(geometry, measure);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~EmbreePeer() override {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreePeer(const EmbreePeer&) = delete;
    EmbreePeer& operator=(const EmbreePeer&) = delete;

    [[nodiscard]] Point closest(const Point& query) const override {
        Search search{this, query, Point::Zero(), std::numeric_limits<double>::infinity()};
        RTCPointQuery point{};
        point.x = static_cast<float>(query.x());
        point.y = static_cast<float>(query.y());
        point.z = static_cast<float>(query.z());
        point.radius = std::numeric_limits<float>::infinity();
        RTCPointQueryContext context{};
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_, &point, &context, nullptr, &search);
        return search.best;
    }

private:
    struct Search {
        const EmbreePeer* peer;
        Point query;
        Point best;
        double squared;
    };
    static bool measure(RTCPointQueryFunctionArguments* arguments) {
        auto& search = *static_cast<Search*>(arguments->userPtr);
        const auto& t = search.peer->triangles_[arguments->primID];
        const auto& v = search.peer->vertices_;
        const Point p = closest_on_triangle(search.query, v[t[0]], v[t[1]], v[t[2]]);
        const double squared = (p - search.query).squaredNorm();
        if (squared >= search.squared) return false;
        search.squared = squared;
        search.best = p;
        // The tree holds rounded vertices: leave them their rounding.
        arguments->query->radius = static_cast<float>(std::sqrt(squared) * 1.000001 + 1e-4);
        return true;
    }

    std::vector<Point> vertices_;
    std::vector<Triangle> triangles_;
    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace

std::unique_ptr<ClosestPointPeer> make_embree_peer(std::span<const Point> vertices_mm,
                                                   std::span<const Triangle> triangles) {
    return std::make_unique<EmbreePeer>(vertices_mm, triangles);
}

}  // namespace mimik::peers
