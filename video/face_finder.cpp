#include "video/face_finder.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include "base/errors.h"
#include "base/file.h"

namespace mimik::video {
namespace {

constexpr const char* debians_cascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml";

std::filesystem::path cascade_file(const std::filesystem::path& given) {
    if (!given.empty()) return given;
    const char* named =
        std::getenv("MIMIK_FACE_CASCADE");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    return named && *named ? named : debians_cascade;
}

// Shares of the box, measured on the rendered performance and on the talking heads of docs/results.md.
constexpr double outer_eyes_of_box = 0.50, middle_x_of_box = 0.5, middle_y_of_box = 0.40;

cv::Mat matrix_of(const io::Image& image) {
    return {image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data())};  // NOLINT: only read
}

}  // namespace

FacePlace FoundFace::place() const {
    return {corner + size_px * Pixel(middle_x_of_box, middle_y_of_box), outer_eyes_of_box * size_px, 0};
}

struct FaceFinder::Parts {
    cv::CascadeClassifier cascade;
};

FaceFinder::FaceFinder(const std::filesystem::path& cascade) : parts_(std::make_unique<Parts>()) {
    const auto file = cascade_file(cascade);
    if (!base::is_there(file))
        throw InputError(fmt::format(
            "{}: there is no such file; install the package opencv-data, or name a cascade in MIMIK_FACE_CASCADE",
            file.string()));
    bool loaded = false;
    try {
        loaded = parts_->cascade.load(file.string());
    } catch (const cv::Exception&) {
        loaded = false;
    }
    if (!loaded) throw InputError(fmt::format("{}: OpenCV does not read it as a cascade", file.string()));
}
FaceFinder::~FaceFinder() = default;
FaceFinder::FaceFinder(FaceFinder&&) noexcept = default;

std::vector<FoundFace> FaceFinder::find(const io::Image& frame) {
    cv::Mat grey, small;
    cv::cvtColor(matrix_of(frame), grey, cv::COLOR_RGB2GRAY);
    const double scale = std::min(1.0, 240.0 / frame.height);
    cv::resize(grey, small, cv::Size(), scale, scale, cv::INTER_AREA);
    cv::equalizeHist(small, small);
    std::vector<cv::Rect> boxes;
    const int least = std::max(20, small.rows / 10);
    parts_->cascade.detectMultiScale(small, boxes, 1.1, 4, 0, cv::Size(least, least));
    std::vector<FoundFace> faces;
    for (const auto& box : boxes)
        faces.push_back({Pixel((box.x + 0.5) / scale - 0.5, (box.y + 0.5) / scale - 0.5), box.width / scale});
    std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.size_px > b.size_px; });
    return faces;
}

bool FaceFinder::sees(const io::Image& frame, const FacePlace& place) {
    // A copy in which the face stands upright and its box would be 48 pixels wide.
    constexpr int box_px = 48, size_px = 88;
    const double scale = place.outer_eyes_px / outer_eyes_of_box / box_px;
    const auto frame_at = [&](double x, double y) {
        const Pixel from_eyes = scale * (Pixel(x, y) - Pixel(size_px / 2.0, size_px / 2.0 - 0.1 * box_px));
        return Pixel(place.middle + Eigen::Rotation2Dd(place.roll_rad) * from_eyes);
    };
    const Pixel origin = frame_at(0, 0), along = frame_at(1, 0) - origin, down = frame_at(0, 1) - origin;
    cv::Mat colour, grey;
    cv::warpAffine(matrix_of(frame), colour,
                   cv::Matx23d(along.x(), down.x(), origin.x(), along.y(), down.y(), origin.y()),
                   cv::Size(size_px, size_px), cv::INTER_AREA | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
    cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
    cv::equalizeHist(grey, grey);
    std::vector<cv::Rect> boxes;
    parts_->cascade.detectMultiScale(grey, boxes, 1.1, 1, 0, cv::Size(36, 36), cv::Size(64, 64));
    return !boxes.empty();
}

}  // namespace mimik::video
