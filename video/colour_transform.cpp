#include "video/colour_transform.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace mimik::video {
namespace {

cv::Mat matrix_of(FloatImage& image) { return {image.height, image.width, CV_32FC1, image.values.data()}; }

/// The nose and the cheeks beside it: skin whatever the face does.
bool is_cheek(int x, int y) {
    const double u = (x - patch_middle_x) / patch_outer_eyes_px, v = (y - patch_middle_y) / patch_outer_eyes_px;
    return std::abs(u) < 0.42 && v > 0.15 && v < 0.48;
}
/// Within the oval of the face.
bool is_face(int x, int y) {
    const double u = (x - patch_middle_x) / (0.78 * patch_outer_eyes_px);
    const double v = (y - patch_middle_y - 0.4 * patch_outer_eyes_px) / (1.0 * patch_outer_eyes_px);
    return u * u + v * v < 1;
}

float quantile(std::vector<float>& values, double share) {
    if (values.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

template <class Use>
void over_pixels(int step, const Use& use) {
    for (int y = 0; y < patch_height_px; y += step)
        for (int x = 0; x < patch_width_px; x += step) use(x, y);
}

/// 0 on skin, 1 where the face's strongest features are.
void normalise(FloatImage& image, double top_share) {
    std::vector<float> skin, face;
    over_pixels(3, [&](int x, int y) {
        if (is_cheek(x, y)) skin.push_back(image.at(x, y));
        if (is_face(x, y)) face.push_back(image.at(x, y));
    });
    const float low = quantile(skin, 0.5), high = quantile(face, top_share);
    const float scale = 1 / std::max(0.08F, high - low);
    for (auto& value : image.values) value = (value - low) * scale;
}

}  // namespace

double lip_hue(double hue_deg) {
    double away = std::fmod(hue_deg - 352 + 540, 360) - 180;  // from 352 degrees, -180 to 180
    if (away > 0) away *= 1.4;                                // skin lies beyond, at 15 to 35 degrees
    return std::exp(-0.5 * away * away / (14.0 * 14.0));
}

double contrast(double intensity) {
    const double t = std::clamp(intensity, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

ColourChannels channels_of(double red, double green, double blue) {
    ColourChannels c;
    const double high = std::max({red, green, blue}), low = std::min({red, green, blue}), range = high - low;
    c.value = high;
    c.black = 1 - high;
    if (high <= 0) return c;
    c.magenta = (high - green) / high;
    c.saturation = range / high;
    if (range <= 0) return c;
    if (high == red)
        c.hue_deg = 60 * (green - blue) / range;
    else if (high == green)
        c.hue_deg = 60 * (blue - red) / range + 120;
    else
        c.hue_deg = 60 * (red - green) / range + 240;
    if (c.hue_deg < 0) c.hue_deg += 360;
    return c;
}

ColourComponents components_of(const io::Image& patch) {
    ColourComponents made;
    for (auto* image : {&made.magenta, &made.black, &made.value, &made.hue, &made.saturation})
        *image = FloatImage(patch.width, patch.height);
    FloatImage light(patch.width, patch.height);
    const auto byte = [&](std::size_t k, std::size_t c) { return patch.rgb[3 * k + c] / 255.0F; };
    auto& value = made.value.values;
    for (std::size_t k = 0; k < value.size(); ++k) value[k] = std::max({byte(k, 0), byte(k, 1), byte(k, 2)});
    // Slowly changing light: a wide blur of a small copy.
    cv::Mat small, wide = matrix_of(light);
    cv::resize(matrix_of(made.value), small, cv::Size(patch.width / 8, patch.height / 8), 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(small, small, cv::Size(), 4.5);
    cv::resize(small, wide, wide.size(), 0, 0, cv::INTER_LINEAR);
    static const auto lip_hues = [] {
        std::array<float, 361> table{};
        for (std::size_t k = 0; k < table.size(); ++k) table[k] = static_cast<float>(lip_hue(static_cast<double>(k)));
        return table;
    }();
    for (std::size_t k = 0; k < value.size(); ++k) {
        const float r = byte(k, 0), g = byte(k, 1), b = byte(k, 2), high = value[k];
        const float range = high - std::min({r, g, b}), saturation = high > 0 ? range / high : 0;
        const float coloured = std::clamp(4 * (saturation - 0.08F), 0.0F, 1.0F);
        value[k] = std::min(1.4F, high / std::max(0.05F, light.values[k]));
        made.black.values[k] = std::clamp(1.1F - value[k], 0.0F, 1.0F);
        made.saturation.values[k] = saturation;
        if (coloured <= 0) continue;
        made.magenta.values[k] = (high - g) / high * coloured;
        const float sixth = high == r ? (g - b) / range : high == g ? 2 + (b - r) / range : 4 + (r - g) / range;
        const float degrees = 60 * (sixth < 0 ? sixth + 6 : sixth);
        made.hue.values[k] = lip_hues[static_cast<std::size_t>(std::min(360.0F, degrees))] * coloured;
    }
    return made;
}

FeatureMaps transform_colours(const io::Image& patch, const ColourWeights& weights) {
    const auto parts = components_of(patch);
    FeatureMaps maps;
    maps.feature = maps.eye = maps.mouth = FloatImage(patch.width, patch.height);
    std::vector<float> skin_saturation, skin_level;
    over_pixels(3, [&](int x, int y) {
        if (!is_cheek(x, y)) return;
        skin_saturation.push_back(parts.saturation.at(x, y));
        skin_level.push_back(parts.value.at(x, y));
    });
    const float usual_saturation = std::max(0.05F, quantile(skin_saturation, 0.4));
    const float usual_level = quantile(skin_level, 0.5);
    const auto magenta = static_cast<float>(weights.magenta), black = static_cast<float>(weights.black);
    const auto value = static_cast<float>(weights.value), hue = static_cast<float>(weights.hue);
    for (std::size_t k = 0; k < maps.feature.values.size(); ++k) {
        maps.feature.values[k] = magenta * parts.magenta.values[k] + black * parts.black.values[k] +
                                 value * parts.value.values[k] + hue * parts.hue.values[k];
        const float dark = std::max(0.0F, usual_level - parts.value.values[k]);
        const float pale = std::max(0.0F, (usual_saturation - parts.saturation.values[k]) / usual_saturation);
        maps.eye.values[k] = dark + 0.35F * pale;
        maps.mouth.values[k] = 1.3F * std::max(0.0F, dark - 0.12F) + 0.5F * std::max(0.0F, pale - 0.15F);
    }
    normalise(maps.feature, 0.97);
    for (auto& v : maps.feature.values) v = static_cast<float>(contrast(v)) + 0.3F * std::min(0.0F, v);
    normalise(maps.eye, 0.97);
    normalise(maps.mouth, 0.985);
    return maps;
}

ColourInputs colour_inputs(const io::Image& patch, const FaceCurves& curves) {
    using Colour = Eigen::Vector3d;
    const auto mean = [&](const Pixel& from, const Pixel& to) {
        Colour sum = Colour::Zero();
        double count = 0;
        for (int y = std::max(0, static_cast<int>(from.y())); y <= std::min(patch.height - 1, int(to.y())); ++y)
            for (int x = std::max(0, static_cast<int>(from.x())); x <= std::min(patch.width - 1, int(to.x())); ++x) {
                const auto k = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(patch.width) +
                                    static_cast<std::size_t>(x));
                sum += Colour(patch.rgb[k], patch.rgb[k + 1], patch.rgb[k + 2]) / 255;
                ++count;
            }
        return Colour(sum / std::max(1.0, count));
    };
    const auto between = [&](FaceCurve upper, FaceCurve lower) {
        Pixel from = Pixel::Constant(1e9), to = -from;
        for (const double t : {0.2, 0.5, 0.8})
            for (const Pixel& at : {curves[upper].at(t), curves[lower].at(t)}) {
                from = from.cwiseMin(at);
                to = to.cwiseMax(at);
            }
        return mean(from, to);
    };
    const auto grey = [](const Colour& c) { return c.dot(Colour(0.299, 0.587, 0.114)); };
    using enum FaceCurve;
    const Colour skin = mean(patch_from_mean({-0.4, 0.2}), patch_from_mean({0.4, 0.45}));
    const Colour lips = between(lip_outer_upper, lip_outer_lower);
    return {skin[0],
            skin[1],
            skin[2],
            0.5 * (grey(between(brow_right_upper, brow_right_lower)) + grey(between(brow_left_upper, brow_left_lower))),
            0.5 * (grey(between(lid_right_upper, lid_right_lower)) + grey(between(lid_left_upper, lid_left_lower))),
            0.5 * (grey(mean(curves[nostril_right].at(0.2) - Pixel(0, 5), curves[nostril_right].at(0.8))) +
                   grey(mean(curves[nostril_left].at(0.2) - Pixel(0, 5), curves[nostril_left].at(0.8)))),
            lips[0],
            lips[1],
            lips[2],
            grey(mean(patch_from_mean({-0.25, -0.55}), patch_from_mean({0.25, -0.42}))),
            grey(mean(patch_from_mean({-0.12, 1.05}), patch_from_mean({0.12, 1.2})))};
}

}  // namespace mimik::video
