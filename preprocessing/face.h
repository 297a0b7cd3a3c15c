#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_digest.h"
#include "database/scan_id.h"
#include "geometry/landmarks.h"
#include "geometry/quad_grid.h"
#include "io/image.h"

namespace mimik::preprocessing {

/// One scan after preprocessing: cleaned, resampled, and tied to the average face by transforms that are kept beside
/// it, so that every later result can be had in the scanner's own millimetres.
struct Face {
    database::ScanId id;
    std::string sex;                        ///< "m", "f" or empty
    geometry::QuadGrid grid;                ///< scanner frame
    geometry::Landmarks landmarks;          ///< as marked, our names, scanner frame
    geometry::Landmarks snapped_landmarks;  ///< moved to the nearest grid vertex (thesis 5.4)
    std::filesystem::path texture_file;     ///< of the scan, or the face's own <stem>.png; empty: none, or the grid has
                                            ///< no texture coordinates
    std::shared_ptr<const io::Image> picture = {};  ///< to be written as <stem>.png, in place of texture_file

    /// Rigid: brings the scan onto the subject's first neutral (identity for that one itself).
    geometry::Transform neutral_from_scan = geometry::Transform::Identity();
    /// Similarity fitted on the subject's first neutral alone, after neutral_from_scan: the expression is kept.
    geometry::Transform average_from_scan = geometry::Transform::Identity();
    /// Eqs 5.1-5.4 of the thesis, fitted on this scan's own four landmarks: part of the expression is normalised away.
    geometry::Transform average_from_scan_affine = geometry::Transform::Identity();

    double alignment_rms_mm = 0.0;  ///< of neutral_from_scan on the stable region; 0 for the first neutral
    std::vector<std::string> remarks;
};

/// A grid as PLY: double precision, property `origin` (0 outside, 1 measured, 2 bridged), quads of the inside.
/// @return of the bytes that were written, as all digests of written files.
base::FileDigest write_grid(const std::filesystem::path& file, const geometry::QuadGrid& grid);
[[nodiscard]] geometry::QuadGrid read_grid(const std::filesystem::path& file, int rows, int cols);
/// The same from a mesh that was read; `name` stands for its file. @throws InputError naming what does not fit.
[[nodiscard]] geometry::QuadGrid to_grid(geometry::Mesh mesh, int rows, int cols, const std::string& name);

struct FaceDigests {
    base::FileDigest ply, json;
    std::optional<base::FileDigest> png = {};  ///< of a face with a picture of its own
};
/// `<stem>.ply` (grid, double precision, opens in any viewer), `<stem>.json` (everything else, schema 1) and, of a face
/// with a picture of its own, `<stem>.png`.
FaceDigests write_face(const std::filesystem::path& stem, const Face& face);
/// @throws InputError naming the file and what is wrong.
[[nodiscard]] Face read_face(const std::filesystem::path& stem);
/// What stands in the .json; of the grid, its rows and cols alone. `name` stands for the file. @throws InputError.
[[nodiscard]] Face decode_face(std::string_view text, const std::string& name);

}  // namespace mimik::preprocessing
