#include "video/landmark_net.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "video/onnx_inputs.h"

namespace mimik::video {
namespace {

constexpr std::size_t value_count = 136;
constexpr int most_side = 2048;
constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;

std::string text_of(const cv::dnn::MatShape& shape) {
    std::string text;
    for (const int side : shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", side);
    return text.empty() ? std::string("of no fixed size") : text;
}

/// Depth, height and width of the one input.
cv::dnn::MatShape input_of(std::string_view model, const std::string& file) {
    const auto inputs = onnx_inputs(model);
    auto shape = inputs.size() == 1 ? cv::dnn::MatShape(inputs.front()) : cv::dnn::MatShape();
    if (shape.size() == 4 && shape[0] == 0) shape[0] = 1;  // any number of pictures: one
    const bool fits = shape.size() == 4 && shape[0] == 1 && (shape[1] == 1 || shape[1] == 3) && shape[2] >= 1 &&
                      shape[2] <= most_side && shape[3] >= 1 && shape[3] <= most_side;
    if (!fits)
        throw InputError(fmt::format(
            "{}: takes {}; a net of landmarks takes one picture of fixed size, 1 x 3 x height x width or 1 x 1 x "
            "height x width (export it so)",
            file, inputs.size() == 1 ? "an input " + text_of(shape) : fmt::format("{} inputs", inputs.size())));
    return shape;
}

}  // namespace

struct LandmarkNet::Parts {
    cv::dnn::Net net;
    std::string output;
    int width = 0, height = 0;
    bool grey = false;
};

LandmarkNet::LandmarkNet(const std::filesystem::path& onnx) : parts_(std::make_unique<Parts>()) {
    const auto name = onnx.string();
    if (!base::is_there(onnx)) throw InputError(fmt::format("{}: there is no such file", name));
    std::error_code error;
    const auto bytes = std::filesystem::file_size(onnx, error);
    if (error || bytes == 0 || bytes > most_bytes)
        throw InputError(fmt::format("{}: is no ONNX file of 1 byte to 1 GiB", name));
    auto& parts = *parts_;
    std::string fault;
    try {
        const auto model = base::read_text(onnx);
        parts.net = cv::dnn::readNetFromONNX(model.data(), model.size());
        parts.net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
        parts.net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
        const auto shape = input_of(model, name);
        parts.grey = shape[1] == 1;
        parts.height = shape[2];
        parts.width = shape[3];
        // Of several outputs the one that can be the points.
        std::vector<cv::Mat> outputs;
        const auto names = parts.net.getUnconnectedOutLayersNames();
        parts.net.setInput(cv::Mat(shape, CV_32F, cv::Scalar(0)));
        parts.net.forward(outputs, names);
        for (std::size_t k = 0; k < outputs.size(); ++k) {
            if (outputs[k].total() == value_count && outputs[k].depth() == CV_32F && parts.output.empty())
                parts.output = names[k];
            fault += fmt::format("{}{}", k ? ", " : "", outputs[k].total());
        }
    } catch (const cv::Exception&) {
        throw InputError(fmt::format("{}: OpenCV {} does not read it as an ONNX net", name, cv::getVersionString()));
    } catch (const std::bad_alloc&) {
        throw InputError(fmt::format("{}: OpenCV {} does not read it as an ONNX net", name, cv::getVersionString()));
    }
    if (parts.output.empty())
        throw InputError(fmt::format(
            "{}: gives {} values; a net of landmarks gives 136, x and y of the 68 points in shares of the picture",
            name, fault.empty() ? "no" : fault));
}
LandmarkNet::~LandmarkNet() = default;
LandmarkNet::LandmarkNet(LandmarkNet&&) noexcept = default;

int LandmarkNet::width() const { return parts_->width; }
int LandmarkNet::height() const { return parts_->height; }
bool LandmarkNet::grey() const { return parts_->grey; }

std::optional<Points68> LandmarkNet::points(const io::Image& frame, const FaceBox& crop) {
    auto& parts = *parts_;
    if (!(crop.size_px > 0) || !crop.corner.allFinite() || frame.width < 1) return std::nullopt;
    const double across = crop.size_px / parts.width, down = crop.size_px / parts.height;
    const cv::Mat from(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.rgb.data()));  // NOLINT
    cv::Mat picture;
    cv::warpAffine(from, picture,
                   cv::Matx23d(across, 0, crop.corner.x() + 0.5 * across, 0, down, crop.corner.y() + 0.5 * down),
                   cv::Size(parts.width, parts.height), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
    if (parts.grey) cv::cvtColor(picture, picture, cv::COLOR_RGB2GRAY);
    cv::Mat values;
    try {
        parts.net.setInput(cv::dnn::blobFromImage(picture, 1.0 / 255));
        values = parts.net.forward(parts.output);
    } catch (const cv::Exception&) {
        return std::nullopt;
    }
    if (values.total() != value_count || !values.isContinuous()) return std::nullopt;
    Points68 points;
    const auto* value = values.ptr<float>();
    for (std::size_t k = 0; k < points.size(); ++k)
        points[k] = crop.corner + crop.size_px * Pixel(value[2 * k], value[2 * k + 1]);
    const bool numbers = std::all_of(points.begin(), points.end(), [](const Pixel& p) { return p.allFinite(); });
    return numbers ? std::optional(points) : std::nullopt;
}

}  // namespace mimik::video
