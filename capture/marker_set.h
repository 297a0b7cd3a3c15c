#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "facs/facs_catalogue.h"
#include "facs/placement.h"
#include "geometry/landmarks.h"

namespace mimik::capture {

/// A marker of a set: what surrounds it, and where it is stuck.
struct SetMarker {
    std::string name;                ///< "brow_inner_left"
    std::vector<std::string> group;  ///< markers that carry it where it is missing
    facs::Placement placement;       ///< on any face with the 22 landmarks
    facs::Side side = facs::Side::both;
};

/// The place of a marker in the frame of a sibling: origin at the sibling, first axis from `along[0]` to `along[1]`,
/// second across it towards `towards`.
struct SiblingFrame {
    std::string sibling;
    std::array<std::string, 2> along;
    std::string towards;
};

/// A point of the face to which no marker can be stuck (Sanchez et al. 2003, Sec. 5.2): it hangs on a sibling, or on
/// the rigid motion of a group.
struct DerivedMarker {
    std::string name;
    std::optional<SiblingFrame> frame;
    std::vector<std::string> group;  ///< empty where there is a frame
    facs::Placement placement;
    facs::Side side = facs::Side::both;
};

/// Where the face opens: a mouth, an eye. What moves one side does not move the other.
struct MarkerOpening {
    std::string name;                       ///< "mouth", "eye_left"
    std::vector<std::string> upper, lower;  ///< markers of what lies above and below it; its corners are in neither
    facs::Side side = facs::Side::both;
};

/// Which markers there are, which hangs on which, and which triangles span the face between them.
struct MarkerSet {
    std::string name;  ///< its file, or "built-in marker set"
    std::vector<SetMarker> markers;
    std::vector<DerivedMarker> derived;
    /// The control surface, counter-clockwise seen from outside; corners are markers or derived. Empty: the set has
    /// none.
    std::vector<std::array<std::string, 3>> triangles;
    std::vector<MarkerOpening> openings;

    [[nodiscard]] const SetMarker* find(const std::string& marker) const;
};

/// Every fault of a set, in the order of its lines: unknown keys, names and landmarks, groups of fewer than three,
/// what hangs on itself, markers that fall together or off the reference face; triangles that are flipped or flat on
/// the reference face, that are there twice, that three share an edge of, or that bridge an opening.
[[nodiscard]] std::vector<facs::LintFinding> lint_marker_set(std::string_view toml);
/// @throws InputError naming file, line and the first error of the linter.
[[nodiscard]] MarkerSet decode_marker_set(std::string_view toml, const std::string& name);
[[nodiscard]] MarkerSet read_marker_set(const std::filesystem::path& file);

/// The 68 markers and eight derived ones that Mimik ships (capture/marker_set.toml, embedded).
[[nodiscard]] const MarkerSet& builtin_marker_set();
[[nodiscard]] std::string_view builtin_marker_set_text();

/// Where the markers of a set are on a face, the derived ones after the others: near its surface, not on it.
/// @throws InputError naming a landmark that is missing.
[[nodiscard]] geometry::Landmarks place_markers(const MarkerSet& set, const geometry::Landmarks& face);

}  // namespace mimik::capture
