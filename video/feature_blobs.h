#pragma once

#include <optional>

#include "base/fields.h"
#include "video/face_patch.h"

namespace mimik::video {

/// Where a feature may lie (Sec. 3.2): sides of a rectangle in pixels, both ends inside.
struct BlobBox {
    double left = 0, top = 0, right = 0, bottom = 0;
    [[nodiscard]] double width() const { return right - left; }
    [[nodiscard]] double height() const { return bottom - top; }
};

struct BlobOptions {
    double threshold = 0.5;     ///< between the least and the greatest value of the rectangle, by Otsu's rule where 0
    double grow_px = 1.5;       ///< radius in which a pixel looks for more of its kind
    double closing_px = 1.5;    ///< of dilation, then erosion: joins parts
    double least_share = 0.01;  ///< of the rectangle that the blob must cover
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("threshold", self.threshold);
        visit("grow_px", self.grow_px);
        visit("closing_px", self.closing_px);
        visit("least_share", self.least_share);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<BlobOptions>());

struct FeatureBlob {
    BlobBox box;         ///< tightly around it
    double area_px = 0;  ///< pixels
    Pixel middle = Pixel::Zero();
    double threshold = 0;  ///< that its pixels exceed
};

/// The blob of a feature: grown from seeds that exceed the threshold, closed by dilation and erosion, the largest
/// component. None if nothing in the rectangle stands out.
[[nodiscard]] std::optional<FeatureBlob> feature_blob(const FloatImage& intensity, const BlobBox& within,
                                                      const BlobOptions& options = {});

}  // namespace mimik::video
