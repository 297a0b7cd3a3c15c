#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/landmarks.h"

namespace mimik::database {

/// .lm3 (mm, the frame of the .bnt): labels as written. See geometry/landmark_io.h; this is the same reader by name.
[[nodiscard]] geometry::Landmarks read_lm3(const std::filesystem::path& file);
void write_lm3(const std::filesystem::path& file, const geometry::Landmarks& bosphorus_labelled);

/// Our names on the subject's own side from Bosphorus labels: "Outer left eyebrow" is image-left, that is the subject's
/// right, where x("Outer left eye corner") < x("Outer right eye corner") (or the mouth corners, or the median of all
/// pairs); the original label is kept in Landmark::original_label. Unknown labels are kept, in lower case with '_'.
struct SideReport {
    bool left_label_is_subject_right = true;
    int pairs_agreeing = 0;
    int pairs_disagreeing = 0;  ///< > 0: some left/right pair is swapped against the rest
    std::vector<std::string> swapped_pairs;
};
[[nodiscard]] geometry::Landmarks from_bosphorus_labels(const geometry::Landmarks& raw, SideReport* report = nullptr);
/// Back to Bosphorus spelling, order and image-left labels.
[[nodiscard]] geometry::Landmarks to_bosphorus_labels(const geometry::Landmarks& landmarks);

/// .lm2: pixel positions in the texture, x = column, y = row from the top; labels as written.
struct ImageLandmark {
    std::string label;
    double column = 0, row = 0;
};
[[nodiscard]] std::vector<ImageLandmark> read_lm2(const std::filesystem::path& file);
void write_lm2(const std::filesystem::path& file, const std::vector<ImageLandmark>& marks);

}  // namespace mimik::database
