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
#include "video/face_patch.h"
#include "video/points_tracker.h"

namespace mimik::video {
namespace {

constexpr const char* debians_points = "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";
constexpr double detector_rows = 480;  ///< larger frames are made smaller for it

dlib::array2d<unsigned char> grey_image(const io::Image& frame) {
    dlib::array2d<unsigned char> grey(frame.height, frame.width);
    const auto bytes = grey_of(frame);
    for (int y = 0; y < frame.height; ++y)
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(y) * frame.width, frame.width, &grey[y][0]);
    return grey;
}

class DlibSource final : public PointSource {
public:
    explicit DlibSource(const std::filesystem::path& file) {
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

    [[nodiscard]] std::vector<FaceBox> find(const io::Image& frame) override {
        const auto grey = grey_image(frame);
        const double scale = std::min(1.0, detector_rows / static_cast<double>(grey.nr()));
        dlib::array2d<unsigned char> small;
        small.set_size(std::lround(scale * static_cast<double>(grey.nr())),
                       std::lround(scale * static_cast<double>(grey.nc())));
        dlib::resize_image(grey, small);
        std::vector<FaceBox> boxes;
        for (const auto& box : detector_(small))
            boxes.push_back({Pixel(static_cast<double>(box.left()), static_cast<double>(box.top())) / scale,
                             static_cast<double>(box.right() - box.left()) / scale});
        std::stable_sort(boxes.begin(), boxes.end(),
                         [](const auto& a, const auto& b) { return a.size_px > b.size_px; });
        return boxes;
    }

    [[nodiscard]] std::optional<Points68> points(const io::Image& frame, const FaceBox& face) override {
        const Pixel end = face.corner + Pixel(face.size_px, face.size_px);
        const auto shape =
            predictor_(grey_image(frame), dlib::rectangle(std::lround(face.corner.x()), std::lround(face.corner.y()),
                                                          std::lround(end.x()), std::lround(end.y())));
        Points68 points;
        for (unsigned long k = 0; k < 68; ++k)
            points[k] = {static_cast<double>(shape.part(k).x()), static_cast<double>(shape.part(k).y())};
        return points;
    }

private:
    dlib::frontal_face_detector detector_ = dlib::get_frontal_face_detector();
    dlib::shape_predictor predictor_;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_dlib_tracker(const std::filesystem::path& points,
                                                  const FaceChoiceOptions& choice) {
    return make_points_tracker(
        std::make_unique<DlibSource>(points.empty() ? std::filesystem::path(debians_points) : points), choice);
}

}  // namespace mimik::video
