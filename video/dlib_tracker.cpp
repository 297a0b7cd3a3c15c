#include "video/dlib_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <dlib/geometry.h>
#include <dlib/image_processing.h>
#include <dlib/image_processing/frontal_face_detector.h>
#include <dlib/image_transforms.h>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"

namespace mimik::video {
namespace {

constexpr const char* debians_points = "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";
constexpr int look_every_frames = 10;  ///< the detector takes longer than all the rest
constexpr double detector_rows = 480;  ///< larger frames are made smaller for it

FacePlace place_of(const Points68& points) {
    const Pixel across = points[45] - points[36];
    return {0.5 * (points[36] + points[45]), across.norm(), std::atan2(across.y(), across.x())};
}

class DlibTracker final : public FeatureTracker {
public:
    explicit DlibTracker(const std::filesystem::path& file) {
        if (!base::is_there(file))
            throw InputError(fmt::format("{}: there is no such file; install the package libdlib-data", file.string()));
        try {
            dlib::deserialize(file.string()) >> predictor_;
        } catch (const std::exception&) {
            throw InputError(fmt::format("{}: dlib does not read it as a shape predictor", file.string()));
        }
        if (predictor_.num_parts() != 68)
            throw InputError(fmt::format("{}: gives {} points; 68 are needed", file.string(), predictor_.num_parts()));
    }
    [[nodiscard]] std::string name() const override { return "dlib"; }
    void restart() override { box_.reset(); }

    [[nodiscard]] std::optional<TrackedFace> next(const io::Image& frame) override {
        dlib::array2d<unsigned char> grey(frame.height, frame.width);
        const auto bytes = grey_of(frame);
        for (int y = 0; y < frame.height; ++y)
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(y) * frame.width, frame.width, &grey[y][0]);
        const bool anew = !box_.has_value();
        if (anew || ++age_ % look_every_frames == 0) {
            box_ = detect(grey);
            if (!box_) return std::nullopt;
        }
        const auto shape = predictor_(grey, *box_);
        TrackedFace face;
        Points68 points;
        for (unsigned long k = 0; k < 68; ++k)
            points[k] = {static_cast<double>(shape.part(k).x()), static_cast<double>(shape.part(k).y())};
        face.curves = curves_through(points);
        face.points = points;
        face.place = place_of(points);
        face.confidence = 1;
        face.found_anew = anew;
        follow_box(face.place);
        return face;
    }

private:
    std::optional<dlib::rectangle> detect(const dlib::array2d<unsigned char>& grey) {
        const double scale = std::min(1.0, detector_rows / static_cast<double>(grey.nr()));
        dlib::array2d<unsigned char> small;
        small.set_size(std::lround(scale * static_cast<double>(grey.nr())),
                       std::lround(scale * static_cast<double>(grey.nc())));
        dlib::resize_image(grey, small);
        auto boxes = detector_(small);
        if (boxes.empty()) return std::nullopt;
        const auto& box = *std::max_element(boxes.begin(), boxes.end(),
                                            [](const auto& a, const auto& b) { return a.area() < b.area(); });
        place_then_.reset();
        return dlib::rectangle(std::lround(static_cast<double>(box.left()) / scale),
                               std::lround(static_cast<double>(box.top()) / scale),
                               std::lround(static_cast<double>(box.right()) / scale),
                               std::lround(static_cast<double>(box.bottom()) / scale));
    }

    /// Until the detector looks again the box goes with the face.
    void follow_box(const FacePlace& place) {
        if (place_then_ && place_then_->outer_eyes_px > 0) {
            const double scale = place.outer_eyes_px / place_then_->outer_eyes_px;
            const auto moved = [&](long x, long y) {
                return Pixel(place.middle +
                             scale * (Pixel(static_cast<double>(x), static_cast<double>(y)) - place_then_->middle));
            };
            const Pixel from = moved(box_then_.left(), box_then_.top());
            const Pixel to = moved(box_then_.right(), box_then_.bottom());
            box_ =
                dlib::rectangle(std::lround(from.x()), std::lround(from.y()), std::lround(to.x()), std::lround(to.y()));
        } else {
            place_then_ = place;
            box_then_ = *box_;
        }
    }

    dlib::frontal_face_detector detector_ = dlib::get_frontal_face_detector();
    dlib::shape_predictor predictor_;
    std::optional<dlib::rectangle> box_;
    dlib::rectangle box_then_;
    std::optional<FacePlace> place_then_;
    int age_ = 0;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_dlib_tracker(const std::filesystem::path& points) {
    return std::make_unique<DlibTracker>(points.empty() ? std::filesystem::path(debians_points) : points);
}

}  // namespace mimik::video
