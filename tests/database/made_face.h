#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "database/bnt.h"
#include "database/bosphorus_landmarks.h"
#include "geometry/landmarks.h"
#include "geometry/range_scan.h"

namespace mimik::database {

/// A face of known shape for tests: 81 x 61 points 2 mm apart on a smooth dome, 160 x 120 mm and 60 mm deep, with a
/// nose; nose tip near the middle, mm, canonical frame, texture coordinates over the whole of a square image.
struct MadeFace {
    geometry::RangeScan scan;
    geometry::Landmarks landmarks;               ///< the 22 regular ones under our names, each on a grid vertex exactly
    std::vector<ImageLandmark> image_landmarks;  ///< in an image of `image_size` pixels, Bosphorus labels
    int image_size = 100;
};
[[nodiscard]] MadeFace make_face(const std::string& texture_file = "");

/// The face with these landmarks moved by so much (and off the surface).
[[nodiscard]] geometry::Landmarks moved(const geometry::Landmarks& landmarks,
                                        const std::map<std::string, geometry::Vector>& by_mm);

/// Writes .bnt, .lm3, .lm2 and a grey .png as <root>/<subject>/<name>.*.
void write_scan(const std::filesystem::path& root, const std::string& name, const MadeFace& face);

}  // namespace mimik::database
