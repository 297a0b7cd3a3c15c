#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "database/bosphorus_landmarks.h"
#include "geometry/landmarks.h"
#include "geometry/range_scan.h"

namespace mimik::database {

/// How texture coordinates may lie in the image; the first is how Bosphorus has it and how RangeScan holds it.
enum class TextureAxes {
    u_right_v_up,    ///< column = u W, row = (1 - v) H
    u_right_v_down,  ///< column = u W, row = v H
    u_down_v_left,   ///< column = (1 - v) W, row = u H
    u_up_v_left      ///< column = (1 - v) W, row = (1 - u) H
};
/// "u to the right, v up"; with `v_from_top` as a format says it that counts v from the image's top (.bnt).
[[nodiscard]] std::string to_string(TextureAxes axes, bool v_from_top = false);

struct TextureOrientation {
    TextureAxes best = TextureAxes::u_right_v_up;
    std::array<double, 4> median_error_px{};  ///< per variant, in the order of TextureAxes
    int landmarks = 0;                        ///< compared
    bool fits = false;                        ///< the best variant is off by less than 3 % of the image's diagonal

    [[nodiscard]] bool as_expected() const { return fits && best == TextureAxes::u_right_v_up; }
};

/// The valid scan point nearest to a landmark.
struct NearestScanPoint {
    std::size_t index = 0;
    double distance_mm = 0;  ///< infinite if the scan has no valid point
};
/// One per landmark, in their order.
[[nodiscard]] std::vector<NearestScanPoint> nearest_scan_points(const geometry::RangeScan& scan,
                                                                const geometry::Landmarks& landmarks);

/// Compares the pixel of every landmark with the texture coordinate of the scan point nearest to it, for the four
/// variants that readers of .bnt files have used. A variant other than the expected one must be twice as good. Labels
/// pair the two files (case ignored). Empty if the scan has no texture coordinates or fewer than 3 landmarks have a
/// partner.
[[nodiscard]] std::optional<TextureOrientation> texture_orientation(const geometry::RangeScan& scan,
                                                                    const geometry::Landmarks& landmarks,
                                                                    const std::vector<NearestScanPoint>& nearest,
                                                                    const std::vector<ImageLandmark>& image_landmarks,
                                                                    std::array<int, 2> image_size);

/// What is to be said of a texture in several charts or images, for which a resampled face gets a picture of its own;
/// empty of others.
[[nodiscard]] std::string texture_charts(const geometry::RangeScan& scan);

/// Turns texture coordinates that lie as `axes` says into u_right_v_up.
void reorient_texture(geometry::RangeScan& scan, TextureAxes axes);

/// Correlations over the valid points that hold in every scan of the canonical frame: x grows with u and with the
/// column, y with v (counted from the bottom) and with the row. Empty where there is nothing to correlate.
struct FrameCorrelations {
    std::optional<double> x_u, y_v, y_row, x_column;
};
[[nodiscard]] FrameCorrelations frame_correlations(const geometry::RangeScan& scan);

}  // namespace mimik::database
