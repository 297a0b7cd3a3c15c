#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/fields.h"
#include "io/image.h"
#include "video/face_curves.h"
#include "video/picture_memory.h"

namespace mimik::video {

/// A square around a face, as a finder gives it.
struct FaceBox {
    Pixel corner = Pixel::Zero();  ///< upper left, pixels of the frame
    double size_px = 0;
    [[nodiscard]] Pixel middle() const { return corner + Pixel(0.5 * size_px, 0.5 * size_px); }
};

inline constexpr int most_faces = 100;  ///< that are counted in a picture
/// Whether a frame of some size may have such a pixel.
[[nodiscard]] constexpr bool may_be_pixel(double x, double y) { return x >= 0 && y >= 0 && x < 1e5 && y < 1e5; }

/// Which of several faces in a picture is the performer's.
struct FaceChoiceOptions {
    int rank = 1;                                ///< by size: 1 is the largest, 2 the next
    std::optional<double> x_px = {}, y_px = {};  ///< or the face at a pixel of the frame; both or neither
    /// A performer who is lost is waited for, so many frames, where they were last: who is elsewhere in the same
    /// picture is somebody else.
    int wait_frames = 45;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("rank", self.rank);
        visit("x_px", self.x_px);
        visit("y_px", self.y_px);
        visit("wait_frames", self.wait_frames);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<FaceChoiceOptions>());

/// Keeps to one face: that which was asked for, then that which was followed.
class FaceChooser {
public:
    explicit FaceChooser(const FaceChoiceOptions& options = {});

    /// The next frame; then its candidates() may be asked for, and followed() or lost() ends it.
    /// @throws InputError if the frame does not have the pixel that was asked for
    void look_at(const io::Image& frame);

    /// The faces of a frame that may be the performer's, the likeliest first.
    /// @param faces  the largest first
    [[nodiscard]] std::vector<FaceBox> candidates(std::span<const FaceBox> faces) const;
    /// Where the performer's face is in this frame.
    void followed(const FaceBox& face);
    void lost();  ///< in this frame
    void restart();

private:
    [[nodiscard]] std::vector<FaceBox> near(std::span<const FaceBox> faces, const Pixel& at, double within_sizes) const;

    FaceChoiceOptions options_;
    [[nodiscard]] bool may_have_left() const;  ///< they were last seen at the edge of the picture

    PictureMemory picture_;
    int width_px_ = 0, height_px_ = 0;  ///< of frames; 0: none was looked at
    std::optional<FaceBox> last_;
    int since_ = 0;  ///< frames that the face has been lost
};

}  // namespace mimik::video
