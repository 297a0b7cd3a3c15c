#include "animation/torn_faces.h"

#include <algorithm>
#include <unordered_map>

namespace mimik::animation {

using geometry::Vector;
using preprocessing::LipSide;

namespace {

constexpr double parted_by_mm = 1.5;  // less is how exactly lips are found
constexpr double opened_by_mm = 0.5;  // where they surely part nearby

/// How far apart a motion takes the corners of one lip and those of the other; 0 within a lip.
double parting_mm(std::span<const LipSide> lip_sides, std::span<const Vector> field_mm,
                  std::span<const std::uint32_t> corners) {
    double parting = 0;
    for (const auto a : corners)
        for (const auto b : corners)
            if (lip_sides[a] == LipSide::upper && lip_sides[b] == LipSide::lower)
                parting = std::max(parting, (field_mm[a] - field_mm[b]).norm());
    return parting;
}

void tear_lips(std::vector<std::uint8_t>& torn, const AnimatedFace& animated, std::span<const Vector> field_mm,
               const geometry::Faces& faces) {
    std::unordered_map<std::uint32_t, std::vector<std::size_t>> opened_at;  // by vertex
    std::vector<std::size_t> next;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const double parting = parting_mm(animated.lip_sides, field_mm, faces[f]);
        if (parting <= opened_by_mm) continue;
        for (const auto v : faces[f]) opened_at[v].push_back(f);
        if (parting > parted_by_mm) next.push_back(f);
    }
    for (const auto f : next) torn[f] = 1;
    while (!next.empty()) {
        const auto f = next.back();
        next.pop_back();
        for (const auto v : faces[f])
            for (const auto other : opened_at[v])
                if (!torn[other]) {
                    torn[other] = 1;
                    next.push_back(other);
                }
    }
}

}  // namespace

std::vector<std::uint8_t> torn_faces(const AnimatedFace& animated, std::span<const Vector> field_mm,
                                     const geometry::Faces& faces) {
    std::vector<std::uint8_t> torn(faces.size(), 0);
    if (!animated.lip_sides.empty()) tear_lips(torn, animated, field_mm, faces);
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (torn_lids(animated.lid_sheets, field_mm, faces[f])) torn[f] = 1;
    return torn;
}

std::vector<std::uint8_t> torn_faces_of_any_shape(const AnimatedFace& animated, const geometry::Faces& faces) {
    auto torn = torn_faces(animated, animated.field.mm, faces);
    for (const auto& shape : animated.shapes) {
        const auto by_shape = torn_faces(animated, shape.mm, faces);
        for (std::size_t f = 0; f < torn.size(); ++f) torn[f] |= by_shape[f];
    }
    return torn;
}

}  // namespace mimik::animation
