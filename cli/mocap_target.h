#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/marker_animator.h"
#include "animation/open_inside.h"
#include "animation/prepared_target.h"
#include "builtin/builtin_expressions.h"
#include "capture/marker_set.h"
#include "geometry/surface_index.h"
#include "io/mesh_io.h"

// The face that a recording moves, for 'mimik mocap animate'.

namespace mimik::cli {

struct MocapTargetArguments {
    std::string target;                        ///< a mesh file, or WORK:subject
    std::filesystem::path landmarks, markers;  ///< on the mesh; markers empty: placed by the landmarks
    std::string unit = "mm";
};

/// A face at rest with the labels of the markers on it.
struct MocapTarget {
    std::string name;
    geometry::Mesh mesh;
    std::vector<geometry::Triangle> triangles;
    geometry::Landmarks landmarks, labels;
    io::MadeBy made_by;
    bool is_scan = false;  ///< one surface from lip to lip and lid to eyeball, which is cut where lips and lids part
    std::vector<std::string> remarks;
    /// What knows of lids and AUs, and the target before it; where it was needed.
    std::shared_ptr<const builtin::BuiltinExpressions> expressions;
    std::shared_ptr<const animation::PreparedTarget> prepared;

    void prepare();
};
/// @throws InputError naming what is missing.
[[nodiscard]] MocapTarget read_mocap_target(const MocapTargetArguments& arguments, const capture::MarkerSet& set);

/// A target made ready for a method: masks, and AUs for those that ask for them.
class MocapRig {
public:
    MocapRig(MocapTarget target, animation::MarkerMethod method, const capture::MarkerSet& set,
             std::vector<std::string> tracked, const animation::MarkerAnimatorOptions& options);

    [[nodiscard]] const MocapTarget& target() const { return target_; }
    [[nodiscard]] const animation::MarkerAnimator& animator() const { return *animator_; }
    [[nodiscard]] std::span<const std::string> tracked() const { return tracked_; }
    [[nodiscard]] const animation::UnitFields& units() const { return units_; }
    [[nodiscard]] std::span<const std::string> remarks() const { return remarks_; }
    /// The target as it is drawn and written: of a scan, lips that can part and a dark inside behind them.
    [[nodiscard]] const animation::OpenableSurface& surface() const { return surface_; }
    /// It as a motion moves it. @param displacement_mm  per vertex of the target
    [[nodiscard]] geometry::Mesh moved(std::span<const geometry::Vector> displacement_mm) const;
    /// How far the skin at every label is from where its marker is.
    [[nodiscard]] std::vector<double> marker_errors_mm(std::span<const geometry::Point> markers_mm,
                                                       std::span<const geometry::Vector> displacement_mm) const;

private:
    void make_ready(animation::MarkerMethod method, const capture::MarkerSet& set);
    void cut_openings();

    MocapTarget target_;
    animation::OpenableSurface surface_;
    std::vector<std::string> tracked_, remarks_;
    std::vector<std::uint32_t> parts_;
    animation::UnitFields units_;
    std::unique_ptr<const animation::MarkerAnimator> animator_;
    std::vector<geometry::SurfacePoint> places_;  ///< of the tracked labels
};

}  // namespace mimik::cli
