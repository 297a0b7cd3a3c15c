#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/landmarks.h"

namespace mimik::database {

/// .lm3 (mm, the frame of the .bnt): labels as written. Landmarks that the marker could not see are simply absent.
/// @throws InputError naming file and line. The geometry layer's reader and writer, whatever the file's extension.
[[nodiscard]] geometry::Landmarks read_lm3(const std::filesystem::path& file);
[[nodiscard]] geometry::Landmarks parse_lm3(std::string_view text, const std::string& name);
/// As the database's own readers expect it: a comment line, an empty line, the count, then label and position in turn.
/// LF line ends (a carriage return sticks to the label in readers that do not strip it); numbers read back bit-exact.
void write_lm3(const std::filesystem::path& file, const geometry::Landmarks& bosphorus_labelled);

/// How the labels' left and right relate to the subject, decided by position.
struct SideReport {
    bool left_label_is_subject_right = true;  ///< image-left, as Bosphorus has it
    int pairs_agreeing = 0;
    int pairs_disagreeing = 0;               ///< > 0: some left/right pair is swapped against the rest
    std::vector<std::string> swapped_pairs;  ///< our names without the side: "mouth_corner"
};

/// Our names on the subject's own side from Bosphorus labels: "Outer left eyebrow" is image-left, that is the subject's
/// right, where x of the "left" label is less than x of the "right" one in most pairs (a tie: the outer eye corners
/// decide; no pair at all: as Bosphorus has it). The original label is kept in Landmark::original_label; unknown labels
/// are kept, in lower case with '_'. A swapped pair keeps the side its label says: it is reported, not mended.
[[nodiscard]] geometry::Landmarks from_bosphorus_labels(const geometry::Landmarks& raw, SideReport* report = nullptr);
/// Back to Bosphorus spelling, order and image-left labels; further landmarks follow under their original label.
[[nodiscard]] geometry::Landmarks to_bosphorus_labels(const geometry::Landmarks& landmarks);

/// Our names from whatever a landmark file of another program uses: our own names; Bosphorus labels (side by position,
/// as above); the anthropometric names and abbreviations (exocanthion_left, ex_l, prn, ch_r ...: always the subject's
/// own side); or the numbers of the 68-point scheme, if the file has all of 0..67 or 1..68. The rest is kept.
[[nodiscard]] geometry::Landmarks from_any_labels(const geometry::Landmarks& raw, SideReport* report = nullptr);

/// .lm2: pixel positions in the texture, x = column, y = row from the top; labels as written.
struct ImageLandmark {
    std::string label;
    double column = 0, row = 0;
};
[[nodiscard]] std::vector<ImageLandmark> read_lm2(const std::filesystem::path& file);
[[nodiscard]] std::vector<ImageLandmark> parse_lm2(std::string_view text, const std::string& name);
void write_lm2(const std::filesystem::path& file, const std::vector<ImageLandmark>& marks);

}  // namespace mimik::database
