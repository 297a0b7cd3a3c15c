#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/fields.h"
#include "io/image.h"
#include "video/curve_fit.h"
#include "video/face_patch.h"

namespace mimik::video {

/// Whether the curves lie in the frame, all but a tenth, and have the size of a face that can be followed.
[[nodiscard]] bool is_whole_face(const FaceCurves& curves, const FacePlace& place, int width, int height);

/// I inside less I outside of the outer lips, in units of I (0 to 1): about 0 where something lies on them.
/// @param in_patch  curves in pixels of the patch whose `levels` these are
[[nodiscard]] double lip_contrast(const FaceCurves& in_patch, const PatchLevels& levels,
                                  const CurveFitOptions& options = {});

/// Below it nobody's mouth is seen: a face is not taken up, whichever tracker found it.
inline constexpr double least_lip_contrast = 0.02;

struct FaceWatchOptions {
    /// Correlation of brows, eyes and nose with how they usually look. Talking heads stay above 0.8, a cut falls to
    /// about 0 (docs/results.md); below this the finder is asked at once.
    double least_alike = 0.6;
    /// A mouth is covered if it is less like itself than this (talking: above 0.33; a hand: below 0.2) and its lips
    /// show less than `least_lips` of their usual contrast (talking: above 0.35 where the mouth is so unlike).
    double least_mouth = 0.35;
    double least_lips = 0.3;
    double newest = 0.05;  ///< share of the last frame in the usual look, which so changes within a second
    int wait_frames = 45;  ///< that a face is lost before another that shows little is taken for it
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("least_alike", self.least_alike);
        visit("least_mouth", self.least_mouth);
        visit("least_lips", self.least_lips);
        visit("newest", self.newest);
        visit("wait_frames", self.wait_frames);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<FaceWatchOptions>());

/// Remembers how a followed face looks, so that one that is gone or covered is noticed at once.
class FaceWatch {
public:
    explicit FaceWatch(const FaceWatchOptions& options = {});

    /// What one frame shows where the tracker believes the face to be.
    struct Look {
        double upper = 1, mouth = 1;  ///< correlations with the usual look, 1: alike but for light
        double lips = 1;              ///< contrast of the lips, as a share of the usual one
    };
    /// @param patch_grey  of grey_of(cut_patch())
    [[nodiscard]] Look look(std::span<const std::uint8_t> patch_grey, double lip_contrast) const;
    [[nodiscard]] bool alike(const Look& look) const { return look.upper >= options_.least_alike; }
    [[nodiscard]] bool covered(const Look& look) const {
        return look.mouth < options_.least_mouth && look.lips < options_.least_lips;
    }

    /// Whether what a finder found may be the performer, or a new one: it looks like the face and is not covered, or
    /// shows its lips about as clearly. What shows less is taken for a misfit on a face that is covered; only if no
    /// cover was seen, and the face has been lost for some while, is it taken.
    [[nodiscard]] bool accepts(const Look& look) const {
        // Cuts to another person: above 0.5. Misfits: below 0.4, on a hand now and then 0.6.
        const double clear_lips = was_covered_ ? 0.8 : 0.45;
        if (alike(look)) return !covered(look);
        return look.lips >= clear_lips || (!was_covered_ && lost_frames_ > options_.wait_frames);
    }
    void note_covered() { was_covered_ = true; }
    void note_lost() { ++lost_frames_; }  ///< in this frame

    /// The patch shows the face; one that is not alike is a new one.
    void learn(std::span<const std::uint8_t> patch_grey, double lip_contrast);
    void forget();
    [[nodiscard]] bool knows() const { return !upper_.empty(); }

private:
    FaceWatchOptions options_;
    std::vector<float> upper_, mouth_;  ///< grey cells, how they usually are
    double lips_ = 0;
    bool was_covered_ = false;
    int lost_frames_ = 0;
};

}  // namespace mimik::video
