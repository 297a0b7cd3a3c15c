#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/quad_grid.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::modeling {

/// A name per vertex of the average face's grid: the finer division that the thesis left as future work (7.2), so that
/// a moving mouth need not drag the nose along. Sides are the subject's own. "" outside the face.
struct RegionLabels {
    int rows = 0, cols = 0;
    std::vector<std::string> label;  ///< [row * cols + col]

    [[nodiscard]] std::vector<std::string> names() const;  ///< every region there is, sorted
};

/// The division that Mimik draws from landmarks: forehead, brow_left/right, eye_left/right, nose, cheek_left/right,
/// upper_lip, lower_lip, chin, jaw_left/right, temple_left/right. Every vertex of the inside has exactly one.
[[nodiscard]] RegionLabels label_regions(const geometry::QuadGrid& grid, const geometry::Landmarks& landmarks);

/// CSV `row,col,region` of the inside vertices: readable, and to be edited with any name. A comment before it names the
/// schema and the average face (average_fingerprint) that the rows and columns are of.
[[nodiscard]] std::string encode_region_labels(const RegionLabels& labels, const std::string& average_face);
/// Labels of this average face: a file whose comment names another is refused; one without it must fit the grid.
/// @throws InputError as below.
[[nodiscard]] RegionLabels read_region_labels(const std::filesystem::path& file,
                                              const preprocessing::AverageFace& average);
/// @throws InputError naming file, line and value; rows and cols must be those of the grid.
[[nodiscard]] RegionLabels read_region_labels(const std::filesystem::path& file, int rows, int cols);
/// The same in memory; `name` stands for the file.
[[nodiscard]] RegionLabels decode_region_labels(std::string_view text, const std::string& name, int rows, int cols);

/// The names that `lists` hold: each text is a region, or several with commas between them. A region of `labels` whose
/// own name has a comma is taken whole.
[[nodiscard]] std::vector<std::string> listed_regions(const RegionLabels& labels, std::span<const std::string> lists);

/// How much of a displacement each vertex of a face keeps when the regions `held` stay still: 0 in them, rising
/// smoothly to 1 over `border_mm` outside. Labels go to the face by the landmark spline and the nearest vertex of the
/// average face.
/// @throws InputError if a region is not among the labels; the message lists them.
[[nodiscard]] std::vector<double> held_weights(const RegionLabels& labels, const preprocessing::AverageFace& average,
                                               const preprocessing::Face& face, std::span<const std::string> held,
                                               double border_mm);

}  // namespace mimik::modeling
