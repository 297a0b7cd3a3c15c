#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "synthesis/builtin_sheet.h"
#include "synthesis/face_model.h"

namespace mimik::synthesis {

/// Which lip a muscle holds; the other lip follows at the corners only.
enum class Lip { both, upper, lower };

/// A place on the mean face's left half (mm from the midline, mm over the nasion).
struct Place {
    double s, t;
};

/// A linear or sheet muscle (Waters 1987): skin round the insertion moves toward the origin; full at the insertion,
/// none at `ahead` toward the origin, `behind` away from it and `side` across; the tissue under it keeps its volume.
struct Muscle {
    Place insertion, origin;
    geometry::Vector pull_mm;  ///< at the insertion, on the mean face: lateral, up, forward
    double ahead_mm, behind_mm, side_mm;
    Lip lip = Lip::both;
};

/// A furrow across the pull with the skin heaped on both sides of it, or (negative depth) a ridge.
struct Furrow {
    std::vector<Place> line;
    double depth_mm, width_mm;
    Lip lip = Lip::both;
};

/// Skin heaped up (or drawn in, if negative) along its normal.
struct Bulge {
    Place centre;
    double height_mm, reach_s_mm, reach_t_mm;
    Lip lip = Lip::both;
};

/// What lids and lips do that no straight pull describes.
struct Sphincter {
    double upper_lid_down = 0;  ///< share of the lid opening
    double lower_lid_up = 0;    ///< share of the lid opening
    double upper_lid_lift_mm = 0;
    double upper_roll_mm = 0;  ///< red of the upper lip turned in over the teeth: depth at the mouth line
    double lower_roll_mm = 0;
    double press = 0;    ///< share of the red that is pressed out of sight
    double jaw_rad = 0;  ///< opening of the jaw about the joints
    double jaw_forward_mm = 0;
    double jaw_left_mm = 0;  ///< to the subject's own left; negative: to the right
};

/// One elementary motion, described on the left side; `central` ones act on both.
struct Motion {
    bool central = false;
    std::vector<Muscle> muscles = {};
    std::vector<Furrow> furrows = {};
    std::vector<Bulge> bulges = {};
    Sphincter sphincter = {};
};

/// Name without side -> motion.
[[nodiscard]] const std::map<std::string, Motion>& facial_motions();

/// Neighbours along a row or a column of the sheet and where they lie on it, mm.
struct SheetLine {
    std::vector<std::uint32_t> vertices = {};
    std::vector<double> at = {};
    void add(std::uint32_t vertex, double position_mm) { vertices.push_back(vertex), at.push_back(position_mm); }
};

/// Moves the skin of a sheet. Holds what does not depend on the person.
class MuscleModel {
public:
    MuscleModel(const Sheet& sheet, std::vector<geometry::Point> mean_face_mm);

    /// Displacements at full strength of the left side (or of both, if central).
    [[nodiscard]] std::vector<geometry::Vector> displacement_mm(const Motion& motion,
                                                                std::span<const geometry::Point> neutral_mm) const;
    /// FaceModel::settle: smooths skin that would fold over, parts lips and lids that would cross, shuts closed eyes.
    void settle(std::span<const geometry::Point> neutral_mm, const Contact& contact,
                std::vector<geometry::Vector>& moved) const;

private:
    [[nodiscard]] double lip_share(std::size_t vertex, Lip lip) const;
    void pull(const Muscle& muscle, double side, std::span<const geometry::Point> neutral_mm,
              std::vector<geometry::Vector>& moved) const;
    void gather(std::span<const geometry::Point> neutral_mm, std::vector<geometry::Vector>& moved) const;
    void smooth_along(const SheetLine& line, std::vector<double>& values) const;
    void heap(const Motion& motion, double side, std::vector<geometry::Vector>& moved) const;
    void move_lids(const Sphincter& lids, std::span<const geometry::Point> neutral_mm,
                   std::vector<geometry::Vector>& moved) const;
    void turn_lips(const Sphincter& lips, double side, std::span<const geometry::Point> neutral_mm,
                   std::vector<geometry::Vector>& moved) const;
    void move_jaw(const Sphincter& jaw, std::span<const geometry::Point> neutral_mm,
                  std::vector<geometry::Vector>& moved) const;
    void unfold(std::span<const geometry::Point> neutral_mm, std::vector<geometry::Vector>& moved) const;
    void meet_lids(std::span<const geometry::Point> neutral_mm, bool right, bool closed,
                   std::vector<geometry::Vector>& moved) const;
    void part_crossing_lips(std::span<const geometry::Point> neutral_mm, std::vector<geometry::Vector>& moved) const;

    const Sheet& sheet_;
    std::vector<geometry::Point> mean_;
    std::vector<geometry::Vector> normals_;  ///< of the bare mean face: smooth over nose, lips and lids
    std::vector<geometry::Triangle> triangles_;
    std::vector<double> depth_;                       ///< of the soft tissue that is gathered and thinned, mm
    std::vector<double> bound_;                       ///< share of what is gathered that does not rise
    std::vector<SheetLine> lines_;                    ///< all columns, then all rows
    std::size_t columns_ = 0;                         ///< how many of the lines are columns
    std::vector<double> held_;                        ///< 0 at the rim of the sheet, 1 inside
    std::vector<std::array<std::uint32_t, 2>> seam_;  ///< upper and lower vertex of the mouth line, column after column
    std::vector<std::vector<std::uint32_t>> eye_columns_;  ///< left eye: per column, vertices from upper lid fold down
};

}  // namespace mimik::synthesis
