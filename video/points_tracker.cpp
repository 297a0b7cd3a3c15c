#include "video/points_tracker.h"

#include <utility>

#include "video/face_watch.h"

namespace mimik::video {
namespace {

constexpr int look_every_frames = 10;  ///< a finder takes longer than all the rest

class PointsTracker final : public FeatureTracker {
public:
    PointsTracker(std::unique_ptr<PointSource> source, const FaceChoiceOptions& choice)
        : source_(std::move(source)), chooser_(choice) {}
    [[nodiscard]] std::string name() const override { return source_->name(); }
    void restart() override {
        box_.reset();
        chooser_.restart();
        watch_.forget();
    }

    [[nodiscard]] std::optional<TrackedFace> next(const io::Image& frame) override {
        chooser_.look_at(frame);
        found_.reset();
        std::optional<TrackedFace> face;
        if (box_) face = carry_on(frame);
        if (!face) face = acquire(frame);
        if (!face) {
            box_.reset();
            chooser_.lost();
            watch_.note_lost();
        }
        return face;
    }

private:
    /// Points in the box, if they can be those of a face.
    [[nodiscard]] std::optional<TrackedFace> face_in(const io::Image& frame, const FaceBox& box) {
        const auto points = source_->points(frame, box);
        if (!points) return std::nullopt;
        TrackedFace face;
        face.curves = curves_through(*points);
        face.points = points;
        face.place = place_between((*points)[36], (*points)[45]);
        return is_whole_face(face.curves, face.place, frame.width, frame.height) ? std::optional(face) : std::nullopt;
    }

    /// What the watch is told of a face.
    struct Seen {
        std::vector<std::uint8_t> grey;
        double lips = 0;
    };
    /// Says in the face how sure it is, by the contrast of its features.
    [[nodiscard]] static Seen seen(const io::Image& frame, TrackedFace& face) {
        const auto patch = cut_patch(frame, face.place);
        auto in_patch = face.curves;
        for (auto& curve : in_patch.curve)
            for (auto& p : curve.control) p = face.place.patch_from_frame(p);
        const auto levels = levels_of(patch, ColourWeights{});
        face.confidence = confidence_of(contrast_of(in_patch, levels));
        return {grey_of(patch), lip_contrast(in_patch, levels)};
    }

    [[nodiscard]] std::optional<TrackedFace> carry_on(const io::Image& frame) {
        if (++age_ % look_every_frames == 0) {
            const auto there = candidates(frame);
            if (there.empty()) return std::nullopt;
            take_box(there.front());
        }
        auto face = face_in(frame, *box_);
        if (!face) return std::nullopt;
        const auto now = seen(frame, *face);
        const auto look = watch_.look(now.grey, now.lips);
        if (watch_.covered(look)) watch_.note_covered();
        if (!watch_.alike(look) || watch_.covered(look)) return std::nullopt;  // the finder is asked at once
        watch_.learn(now.grey, now.lips);
        follow_box(face->place);
        return face;
    }

    [[nodiscard]] std::optional<TrackedFace> acquire(const io::Image& frame) {
        for (const auto& box : candidates(frame)) {
            auto face = face_in(frame, box);
            if (!face) continue;
            const auto now = seen(frame, *face);
            // A net gives points in any box, whatever is in it.
            if (now.lips < least_lip_contrast || !watch_.accepts(watch_.look(now.grey, now.lips))) continue;
            watch_.learn(now.grey, now.lips);
            age_ = 0;
            face->found_anew = true;
            take_box(box);
            follow_box(face->place);
            return face;
        }
        return std::nullopt;
    }

    /// The finder looks once a frame at most.
    [[nodiscard]] std::vector<FaceBox> candidates(const io::Image& frame) {
        if (!found_) found_ = source_->find(frame);
        return chooser_.candidates(*found_);
    }

    void take_box(const FaceBox& box) {
        box_ = box;
        place_then_.reset();
    }

    /// Until the finder looks again the box goes with the eyes.
    void follow_box(const FacePlace& place) {
        if (place_then_ && place_then_->outer_eyes_px > 0) {
            const double scale = place.outer_eyes_px / place_then_->outer_eyes_px;
            box_->corner = place.middle + scale * (box_then_.corner - place_then_->middle);
            box_->size_px = scale * box_then_.size_px;
        } else {
            place_then_ = place;
            box_then_ = *box_;
        }
        chooser_.followed(*box_);
    }

    std::unique_ptr<PointSource> source_;
    FaceChooser chooser_;
    FaceWatch watch_;
    std::optional<std::vector<FaceBox>> found_;  ///< in this frame
    std::optional<FaceBox> box_;
    FaceBox box_then_;
    std::optional<FacePlace> place_then_;
    int age_ = 0;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_points_tracker(std::unique_ptr<PointSource> source,
                                                    const FaceChoiceOptions& choice) {
    return std::make_unique<PointsTracker>(std::move(source), choice);
}

}  // namespace mimik::video
