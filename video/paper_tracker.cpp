#include "video/paper_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"
#include "video/colour_network.h"
#include "video/face_finder.h"
#include "video/face_watch.h"

namespace mimik::video {
namespace {

using enum FaceCurve;

FaceCurves mapped(const FaceCurves& curves, const auto& map) {
    FaceCurves made;
    for (std::size_t c = 0; c < curve_count; ++c)
        for (std::size_t k = 0; k < 4; ++k) made.curve[c].control[k] = map(curves.curve[c].control[k]);
    return made;
}

FacePlace between(const FacePlace& a, const FacePlace& b, double share_of_b) {
    return {a.middle + share_of_b * (b.middle - a.middle),
            a.outer_eyes_px + share_of_b * (b.outer_eyes_px - a.outer_eyes_px),
            a.roll_rad + share_of_b * (b.roll_rad - a.roll_rad)};
}

/// The place of a face by the middles of its eyes, which are surer than their corners.
FacePlace place_of_eyes(const FaceCurves& curves) {
    const auto middle = [&](FaceCurve upper, FaceCurve lower) {
        Pixel sum = Pixel::Zero();
        for (const auto lid : {upper, lower}) sum += 0.25 * (curves[lid].control[0] + curves[lid].control[3]);
        return sum;
    };
    const auto& mean = mean_face_curves();
    const double apart = mean[lid_left_upper].control[0].x() + mean[lid_left_upper].control[3].x();
    const double below = 0.5 * (mean[lid_left_upper].control[0].y() + mean[lid_left_upper].control[3].y());
    auto place = place_between(middle(lid_right_upper, lid_right_lower), middle(lid_left_upper, lid_left_lower));
    place.outer_eyes_px /= apart;
    place.middle -= Eigen::Rotation2Dd(place.roll_rad) * Pixel(0, below * place.outer_eyes_px);
    return place;
}

/// How strongly a group is drawn to its shape when the face was found: what moves with the head alone is held most.
double hold(std::size_t curve) {
    switch (static_cast<FaceCurve>(curve)) {
        case nostril_right:
        case nostril_left:
        case lid_right_upper:
        case lid_right_lower:
        case lid_left_upper:
        case lid_left_lower:
            return 0.08;
        case lip_inner_upper:
        case lip_inner_lower:
        case lip_outer_upper:
        case lip_outer_lower:
            return 0.04;
        default:
            return 0.05;
    }
}

FaceCurves halfway(FaceCurves a, const FaceCurves& b) {
    for (std::size_t c = 0; c < curve_count; ++c)
        for (std::size_t k = 0; k < 4; ++k)
            a.curve[c].control[k] += 0.5 * (b.curve[c].control[k] - a.curve[c].control[k]);
    return a;
}

constexpr int points_a_curve = 5;

/// The square that a finder would put around it.
FaceBox box_of_place(const FacePlace& place) {
    const auto unit = FoundFace{Pixel::Zero(), 1}.place();
    const double size_px = place.outer_eyes_px / unit.outer_eyes_px;
    return {place.middle - size_px * unit.middle, size_px};
}

class PaperTracker final : public FeatureTracker {
public:
    PaperTracker(std::shared_ptr<const ColourNetwork> network, const PaperTrackerOptions& options)
        : network_(std::move(network)),
          options_((options.check(), options)),
          chooser_(options.face),
          watch_(options.watch) {}

    [[nodiscard]] std::string name() const override { return "paper"; }
    void restart() override {
        followed_.reset();
        chooser_.restart();
        watch_.forget();
    }

    [[nodiscard]] std::optional<TrackedFace> next(const io::Image& frame) override {
        chooser_.look_at(frame);
        std::optional<TrackedFace> face;
        if (followed_ && follow(frame)) {
            face = result(false);
        } else {
            followed_.reset();
            if (acquire(frame)) face = result(true);
        }
        if (face) {
            chooser_.followed(box_of_place(face->place));
        } else {
            chooser_.lost();
            watch_.note_lost();
        }
        return face;
    }

private:
    struct Followed {
        FacePlace place;
        FaceCurves curves;               ///< in the frame
        FaceCurves resting;              ///< in the patch: what the shape was when the face was found, slowly renewed
        std::vector<std::uint8_t> grey;  ///< of the last frame's patch
        FacePlace patch_place;           ///< where that was cut
        int width = 0, height = 0;       ///< of the frame
        ColourWeights weights;
        double contrast = 0, inliers = 1;
        int age = 0, misses = 0;
    };

    [[nodiscard]] TrackedFace result(bool anew) const {
        TrackedFace face;
        face.curves = followed_->curves;
        face.place = followed_->place;
        face.found_anew = anew;
        face.confidence = confidence_of(followed_->contrast) * std::clamp(followed_->inliers / 0.7, 0.0, 1.0);
        return face;
    }

    /// All groups to the image. @returns the mean contrast
    double fit_all(FaceCurves& curves, const PatchLevels& levels, bool first) const {
        double sum = 0;
        for (std::size_t g = 0; g < feature_group_count; ++g) {
            const auto group = static_cast<FeatureGroup>(g);
            const bool moves_fast = group == FeatureGroup::lips_outer || group == FeatureGroup::lips_inner ||
                                    group == FeatureGroup::eye_right || group == FeatureGroup::eye_left;
            if (group == FeatureGroup::lips_inner) part_curves(curves);
            sum += fit_group(curves, group, levels, first || moves_fast, options_.fit).contrast;
        }
        part_curves(curves);
        return sum / static_cast<double>(feature_group_count);
    }

    bool acquire(const io::Image& frame) {
        if (!finder_) finder_.emplace();
        std::vector<FaceBox> boxes;
        for (const auto& found : finder_->find(frame)) boxes.push_back({found.corner, found.size_px});
        for (const auto& box : chooser_.candidates(boxes)) {
            Followed made;
            made.place = FoundFace{box.corner, box.size_px}.place();
            FaceCurves curves;
            double contrast = 0;
            for (int round = 0; round < 2; ++round) {
                const auto levels = levels_of(cut_patch(frame, made.place), made.weights, options_.fit);
                curves = align_mean_face(levels, contrast);
                curves = mapped(curves, [&](const Pixel& p) { return made.place.frame_from_patch(p); });
                made.place = place_between(curves[lid_right_upper].control[0], curves[lid_left_upper].control[3]);
            }
            const auto patch = cut_patch(frame, made.place);
            curves = mapped(curves, [&](const Pixel& p) { return made.place.patch_from_frame(p); });
            const auto aligned = curves;
            if (network_) made.weights = network_->weights(colour_inputs(patch, curves));
            const auto levels = levels_of(patch, made.weights, options_.fit);
            made.contrast = fit_all(curves, levels, true);
            if (std::min(contrast, made.contrast) < options_.least_contrast) continue;
            made.resting = halfway(curves, aligned);
            made.curves = mapped(curves, [&](const Pixel& p) { return made.place.frame_from_patch(p); });
            if (!is_whole_face(made.curves, made.place, frame.width, frame.height)) continue;
            made.grey = grey_of(patch);
            const double lips = lip_contrast(curves, levels, options_.fit);
            const auto look = watch_.look(made.grey, lips);
            if (lips < options_.least_lip_contrast || !watch_.accepts(look)) continue;
            watch_.learn(made.grey, lips);
            made.patch_place = made.place;
            made.width = frame.width;
            made.height = frame.height;
            followed_ = std::move(made);
            return true;
        }
        return false;
    }

    /// Points of the head that do not move with expressions, where the patch has corners.
    [[nodiscard]] static std::vector<Pixel> head_points(const std::vector<std::uint8_t>& grey) {
        static const cv::Mat mask = [] {
            cv::Mat made = cv::Mat::zeros(patch_height_px, patch_width_px, CV_8U);
            const auto box = [&](double x0, double y0, double x1, double y1) {
                const Pixel a = patch_from_mean({x0, y0}), b = patch_from_mean({x1, y1});
                made(cv::Rect(cv::Point(int(a.x()), int(a.y())), cv::Point(int(b.x()), int(b.y())))) = 255;
            };
            box(-0.6, -0.1, 0.6, 0.18);    // the corners of the eyes; lids are outvoted
            box(-0.22, -0.1, 0.22, 0.58);  // the nose
            box(-0.45, 0.18, 0.45, 0.42);  // cheeks
            return made;
        }();
        std::vector<cv::Point2f> corners;
        const cv::Mat image(patch_height_px, patch_width_px, CV_8U, const_cast<std::uint8_t*>(grey.data()));  // NOLINT
        cv::goodFeaturesToTrack(image, corners, 36, 0.01, 6, mask, 5);
        std::vector<Pixel> points;
        points.reserve(corners.size());
        for (const auto& c : corners) points.emplace_back(c.x, c.y);
        return points;
    }

    /// The curves in the new frame as the flow carries them: their own motion where it is seen, else the head's.
    void carry_curves(const std::vector<FlowedPoint>& flowed, std::size_t first, const FacePlace& before,
                      const PlaneSimilarity& head) {
        auto& followed = *followed_;
        for (std::size_t c = 0; c < curve_count; ++c) {
            const auto old = followed.curves.curve[c];
            // What the points move beyond the head, as a straight line over the curve's parameter.
            double count = 0, sum_t = 0, sum_tt = 0;
            Pixel sum = Pixel::Zero(), sum_t_way = Pixel::Zero();
            for (int k = 0; k < points_a_curve; ++k) {
                const auto& point = flowed[first + c * points_a_curve + static_cast<std::size_t>(k)];
                if (!point.followed) continue;
                const double t = k / (points_a_curve - 1.0) - 0.5;
                const Pixel way = point.at - head(before.patch_from_frame(old.at(t + 0.5)));
                if (way.norm() > 0.12 * patch_outer_eyes_px) continue;
                ++count, sum_t += t, sum_tt += t * t, sum += way, sum_t_way += t * way;
            }
            Pixel shift = Pixel::Zero(), slope = Pixel::Zero();
            if (count >= 3) {
                const double spread = sum_tt - sum_t * sum_t / count;
                if (spread > 1e-6) slope = (sum_t_way - sum_t * sum / count) / spread;
                shift = sum / count - slope * sum_t / count;
            }
            for (std::size_t k = 0; k < 4; ++k) {
                const Pixel at =
                    head(before.patch_from_frame(old.control[k])) + shift + (static_cast<double>(k) / 3 - 0.5) * slope;
                followed.curves.curve[c].control[k] = before.frame_from_patch(at);
            }
        }
    }

    bool follow(const io::Image& frame) {
        auto& followed = *followed_;
        if (frame.width != followed.width || frame.height != followed.height) return false;
        const auto before = followed.patch_place;
        const auto& old_grey = followed.grey;
        const auto grey = grey_of(cut_patch(frame, before));
        auto points = head_points(old_grey);
        const auto head_count = points.size();
        for (const auto& curve : followed.curves.curve)
            for (int k = 0; k < points_a_curve; ++k)
                points.push_back(before.patch_from_frame(curve.at(k / (points_a_curve - 1.0))));
        const auto flowed = flow_points(old_grey, grey, patch_width_px, patch_height_px, points, options_.flow);
        std::vector<Pixel> from, to;
        for (std::size_t k = 0; k < head_count; ++k)
            if (flowed[k].followed) from.push_back(points[k]), to.push_back(flowed[k].at);
        const auto head = fit_similarity(from, to);
        followed.inliers =
            head.inliers * static_cast<double>(from.size()) / std::max<double>(1, static_cast<double>(head_count));
        if (from.size() < 6 || followed.inliers < options_.least_inliers) return false;
        carry_curves(flowed, head_count, before, head);
        const auto carried = [&](double x) {
            const Pixel was = followed.place.frame_from_patch(patch_from_mean({x, 0}));
            return before.frame_from_patch(head(before.patch_from_frame(was)));
        };
        followed.place = place_between(carried(-0.5), carried(0.5));
        return refine(frame);
    }

    /// A fit from scratch against what was carried on: drift ends where the image shows a better one.
    void compete(FaceCurves& curves, const PatchLevels& levels) {
        double unused = 0;
        const auto aligned = align_mean_face(levels, unused, false);
        auto fresh = aligned;
        const double contrast = fit_all(fresh, levels, true);
        if (contrast < 1.08 * followed_->contrast + 0.01) return;
        curves = fresh;
        followed_->contrast = contrast;
        followed_->resting = halfway(fresh, aligned);
    }

    /// The carried curves to the image of the new frame; then the place of the face to its eyes.
    bool refine(const io::Image& frame) {
        auto& followed = *followed_;
        const auto place = followed.place;
        if (!(place.outer_eyes_px > 12 && place.outer_eyes_px < 2 * frame.width)) return false;
        auto curves = mapped(followed.curves, [&](const Pixel& p) { return place.patch_from_frame(p); });
        for (std::size_t c = 0; c < curve_count; ++c)
            for (std::size_t k = 0; k < 4; ++k) {
                auto& at = curves.curve[c].control[k];
                at += hold(c) * (followed.resting.curve[c].control[k] - at);
            }
        const auto patch = cut_patch(frame, place);
        const auto levels = levels_of(patch, followed.weights, options_.fit);
        followed.contrast = fit_all(curves, levels, false);
        if (followed.age % options_.look_every_frames == std::min(2, options_.look_every_frames - 1))
            compete(curves, levels);
        if (followed.contrast < 0.5 * options_.least_contrast) return false;
        followed.curves = mapped(curves, [&](const Pixel& p) { return place.frame_from_patch(p); });
        followed.grey = grey_of(patch);
        followed.patch_place = place;
        followed.place = between(place, place_of_eyes(followed.curves), 0.15);
        if (!is_whole_face(followed.curves, followed.place, frame.width, frame.height)) return false;
        return is_still_there(frame, lip_contrast(curves, levels, options_.fit));
    }

    /// Whether what is followed still looks like the face, and is seen by the finder now and then.
    bool is_still_there(const io::Image& frame, double lips) {
        auto& followed = *followed_;
        const auto look = watch_.look(followed.grey, lips);
        if (watch_.covered(look)) {
            watch_.note_covered();
            return false;
        }
        ++followed.age;
        if (!watch_.alike(look) || followed.misses > 0 || followed.age % options_.look_every_frames == 0) {
            if (!finder_) finder_.emplace();
            followed.misses = finder_->sees(frame, followed.place) ? 0 : followed.misses + 1;
        }
        if (followed.misses > 0 && !watch_.alike(look)) return false;
        if (followed.misses >= options_.misses) return false;
        watch_.learn(followed.grey, lips);
        return true;
    }

    std::shared_ptr<const ColourNetwork> network_;
    PaperTrackerOptions options_;
    std::optional<FaceFinder> finder_;
    std::optional<Followed> followed_;
    FaceChooser chooser_;
    FaceWatch watch_;
};

}  // namespace

void PaperTrackerOptions::check() const {
    fit.check();
    flow.check();
    face.check();
    watch.check();
    if (!(least_contrast > 0)) throw InputError(fmt::format("least_contrast is {}; give more than 0", least_contrast));
    if (!(least_inliers > 0 && least_inliers <= 1))
        throw InputError(fmt::format("least_inliers is {}; give more than 0, at most 1", least_inliers));
    if (!(least_lip_contrast >= 0))
        throw InputError(fmt::format("least_lip_contrast is {}; give 0 or more", least_lip_contrast));
    if (look_every_frames < 1)
        throw InputError(fmt::format("look_every_frames is {}; give 1 or more", look_every_frames));
    if (misses < 1) throw InputError(fmt::format("misses is {}; give 1 or more", misses));
}

std::unique_ptr<FeatureTracker> make_paper_tracker(std::shared_ptr<const ColourNetwork> network,
                                                   const PaperTrackerOptions& options) {
    return std::make_unique<PaperTracker>(std::move(network), options);
}

}  // namespace mimik::video
