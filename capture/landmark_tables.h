#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "capture/feature_motion.h"

namespace mimik::capture {

struct LandmarkTableOptions {
    std::optional<double> rate_hz = {};  ///< frames a second, of tables without time; none: 30, with a remark
    double outer_eye_mm = 88.0;  ///< between the outer corners of the performer's eyes, where only pixels are known
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("rate_hz", self.rate_hz);
        visit("outer_eye_mm", self.outer_eye_mm);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<LandmarkTableOptions>());

/// A motion of features that other programs measured, and what is to be said of it.
struct LandmarkTable {
    FeatureMotion motion;
    std::vector<std::string> remarks;
};

/// 68 points per frame, in pixels: header `frame,detected,x0,y0,...,x67,y67`, frames from 0. Rows with detected 0 are
/// lost. Pixels say nothing of depth: positions in the head's frame are flat, z = 0. What the head does in the image
/// (place, roll, size) is taken away by a similarity through eyes and nose; turning and nodding stay in.
/// @param name  stands for the file in errors. Memory goes with the length of the text.
/// @throws InputError naming file, line, column, value and mend.
[[nodiscard]] LandmarkTable decode_points68_csv(std::string_view text, const std::string& name,
                                                const LandmarkTableOptions& options = {});

/// OpenFace's FeatureExtraction: columns timestamp, confidence, success, x_0 ... y_67; with X_0 ... Z_67 and
/// pose_Tx ... pose_Rz positions are three-dimensional and free of the head's motion, else as of 68 points. Of several
/// faces (face_id) the first one's rows are read.
[[nodiscard]] LandmarkTable decode_openface_csv(std::string_view text, const std::string& name,
                                                const LandmarkTableOptions& options = {});

enum class MotionTableFormat { features, points68, openface, live_link };
/// Which table of a face's motion a text is, by its first lines. @throws InputError naming the four there are.
[[nodiscard]] MotionTableFormat motion_table_format(std::string_view text, const std::string& name);

}  // namespace mimik::capture
