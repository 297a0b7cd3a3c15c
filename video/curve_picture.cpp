#include "video/curve_picture.h"

#include <algorithm>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace mimik::video {
namespace {

constexpr int cell_width = 256, cell_height = 300, columns = 5;

cv::Mat matrix_of(io::Image& image) { return {image.height, image.width, CV_8UC3, image.rgb.data()}; }

io::Image empty_image(int width, int height) {
    io::Image image;
    image.width = width;
    image.height = height;
    image.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return image;
}

template <class Map>
void draw_curves(cv::Mat& image, const FaceCurves& curves, int thickness, const Map& map) {
    constexpr int shift = 4, pieces = 16;
    for (std::size_t c = 0; c < curve_count; ++c) {
        std::vector<cv::Point> line;
        for (int k = 0; k <= pieces; ++k) {
            const Pixel at = (1 << shift) * map(curves.curve[c].at(static_cast<double>(k) / pieces));
            line.emplace_back(static_cast<int>(at.x()), static_cast<int>(at.y()));
        }
        const bool lower = name_of(static_cast<FaceCurve>(c)).ends_with("lower");
        cv::polylines(image, line, false, lower ? cv::Scalar(255, 220, 0) : cv::Scalar(0, 255, 60), thickness,
                      cv::LINE_AA, shift);
    }
}

void write_text(cv::Mat& image, const std::string& text, const cv::Scalar& colour) {
    cv::putText(image, text, {6, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(0, 0, 0), 3, cv::LINE_AA);
    cv::putText(image, text, {6, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
}

}  // namespace

void draw_face(io::Image& frame, const std::optional<TrackedFace>& face) {
    cv::Mat image = matrix_of(frame);
    if (!face) return write_text(image, "lost", cv::Scalar(255, 60, 40));
    draw_curves(image, face->curves, std::max(1, frame.height / 500), [](const Pixel& p) { return p; });
}

void draw_motion(io::Image& frame, const capture::FeatureMotion& motion, std::size_t row) {
    const auto& seen = motion.frames.at(row);
    if (seen.state == capture::TrackState::lost) return draw_face(frame, std::nullopt);
    Points68 points;
    points.fill(Pixel::Zero());
    for (const auto& feature : capture::face_features()) {
        const auto k = motion.find(feature.name);
        const bool known = k && seen.features[*k].in_image;
        // All but the tip of the nose lie on curves.
        if (!known && feature.name != "nose_tip") return;
        if (known) points[static_cast<std::size_t>(feature.point68)] = seen.features[*k].pixel - Pixel(0.5, 0.5);
    }
    TrackedFace face;
    face.curves = curves_through(points);
    draw_face(frame, face);
}

int beside_height(const io::Image& frame) { return std::min(frame.height, 720); }

io::Image beside(const io::Image& frame, const std::vector<io::Image>& faces, int height_px) {
    std::vector<cv::Mat> scaled;
    int width = 0;
    const auto add = [&](const io::Image& image) {
        const cv::Mat from(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));  // NOLINT
        cv::Mat to = from;
        if (image.height != height_px)
            cv::resize(from, to, cv::Size(std::max(1, image.width * height_px / image.height), height_px), 0, 0,
                       image.height > height_px ? cv::INTER_AREA : cv::INTER_LINEAR);
        width += to.cols;
        scaled.push_back(to);
    };
    add(frame);
    for (const auto& face : faces) add(face);
    auto made = empty_image(width, height_px);
    cv::Mat to = matrix_of(made);
    int left = 0;
    for (const auto& part : scaled) {
        part.copyTo(to(cv::Rect(left, 0, part.cols, height_px)));
        left += part.cols;
    }
    return made;
}

void ContactSheet::add(const io::Image& frame, const std::optional<TrackedFace>& face, const std::string& caption) {
    if (full()) return;
    auto cell = empty_image(cell_width, cell_height);
    cv::Mat to = matrix_of(cell);
    const cv::Mat from(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.rgb.data()));  // NOLINT
    if (face) {
        const double scale = face->place.outer_eyes_px / 130;
        const Pixel corner = face->place.middle - scale * Pixel(cell_width / 2.0, 110);
        cv::warpAffine(from, to, cv::Matx23d(scale, 0, corner.x(), 0, scale, corner.y()), to.size(),
                       cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
        draw_curves(to, face->curves, 1, [&](const Pixel& p) { return Pixel((p - corner) / scale); });
        write_text(to, caption, cv::Scalar(255, 255, 255));
    } else {
        const double scale = std::min(1.0 * cell_width / frame.width, 1.0 * cell_height / frame.height);
        cv::Mat small;
        cv::resize(from, small, cv::Size(), scale, scale, cv::INTER_AREA);
        small.copyTo(to(cv::Rect(0, 0, small.cols, small.rows)));
        write_text(to, caption + " lost", cv::Scalar(255, 60, 40));
    }
    pictures_.push_back(std::move(cell));
}

io::Image ContactSheet::image() const {
    const int rows = std::max(1, (static_cast<int>(pictures_.size()) + columns - 1) / columns);
    auto sheet = empty_image(columns * cell_width, rows * cell_height);
    cv::Mat to = matrix_of(sheet);
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
        auto cell = pictures_[k];
        const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
        matrix_of(cell).copyTo(to(cv::Rect(column * cell_width, row * cell_height, cell_width, cell_height)));
    }
    return sheet;
}

}  // namespace mimik::video
