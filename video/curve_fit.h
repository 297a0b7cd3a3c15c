#pragma once

#include <array>
#include <vector>

#include "base/fields.h"
#include "video/bezier_snake.h"
#include "video/colour_transform.h"
#include "video/face_curves.h"
#include "video/feature_blobs.h"

namespace mimik::video {

/// The features whose outlines are found together.
enum class FeatureGroup : std::size_t {
    brow_right,
    brow_left,
    eye_right,
    eye_left,
    nostril_right,
    nostril_left,
    lips_outer,
    lips_inner,
    count
};
inline constexpr std::size_t feature_group_count = static_cast<std::size_t>(FeatureGroup::count);

struct CurveFitOptions {
    SnakeOptions snake = {};
    BlobOptions blob = {};
    double wide_blur_px = 2.6;  ///< of the first level of the pyramid, in the patch
    double fine_blur_px = 1.1;  ///< of the last
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("snake", self.snake);
        visit("blob", self.blob);
        visit("wide_blur_px", self.wide_blur_px);
        visit("fine_blur_px", self.fine_blur_px);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<CurveFitOptions>());

/// The three maps of a patch, blurred for the snakes.
struct PatchLevels {
    FeatureMaps maps;
    std::vector<SnakeLevel> feature, eye, mouth;
};
[[nodiscard]] PatchLevels levels_of(const io::Image& patch, const ColourWeights& weights,
                                    const CurveFitOptions& options = {});

/// Turn, size and shift of the mean face in the patch at which its curves see the most contrast: a coarse search, then
/// a finer one. The first guess is that of the face finder.
/// @returns the curves in the patch
/// @param coarse  false: the finer search alone, for a face that is about where the patch has it
[[nodiscard]] FaceCurves align_mean_face(const PatchLevels& levels, double& contrast, bool coarse = true);

/// Where a group's feature may lie, from curves that are near it (Sec. 3.2).
[[nodiscard]] BlobBox box_of(const FaceCurves& curves, FeatureGroup group);

struct GroupFit {
    double energy = 0;
    double contrast = 0;  ///< I inside less I outside, averaged over the group's curves
};
/// Moves the curves of one group to the image: snakes from `curves` themselves and, if `try_blob`, from the box of the
/// group's blob, whichever ends with less energy.
GroupFit fit_group(FaceCurves& curves, FeatureGroup group, const PatchLevels& levels, bool try_blob,
                   const CurveFitOptions& options = {});

/// The mean of what fit_group() calls contrast over all groups, of curves in the patch as they are.
[[nodiscard]] double contrast_of(const FaceCurves& curves, const PatchLevels& levels,
                                 const CurveFitOptions& options = {});
/// How sure a face is whose features show so much contrast: 0 to 1.
[[nodiscard]] double confidence_of(double contrast);

/// An upper lid is never below the lower one, nor a lip beyond the other: curves that cross meet halfway.
void part_curves(FaceCurves& curves);

}  // namespace mimik::video
