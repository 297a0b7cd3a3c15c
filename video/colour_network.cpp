#include "video/colour_network.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/ml.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/random_stream.h"

namespace mimik::video {
namespace {

using Components = Eigen::Vector4d;
constexpr int hidden_units = 10;

constexpr const char* shipped_text =
#include "video/shipped_colour_network.inc"
    ;

Components at(const ColourComponents& parts, int x, int y) {
    return {parts.magenta.at(x, y), parts.black.at(x, y), parts.value.at(x, y), parts.hue.at(x, y)};
}

/// Mean and scatter of a class of pixels; every feature counts alike, however large it is.
struct ColourClass {
    Components mean = Components::Zero();
    Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
    void set(const std::vector<std::vector<Components>>& parts) {
        double count = 0;
        for (const auto& part : parts)
            for (const auto& c : part) mean += c / static_cast<double>(part.size());
        for (const auto& part : parts) count += part.empty() ? 0 : 1;
        mean /= std::max(1.0, count);
        for (const auto& part : parts)
            for (const auto& c : part)
                scatter += (c - mean) * (c - mean).transpose() / (count * static_cast<double>(part.size()));
    }
};

std::vector<Components> pixels_between(const ColourComponents& parts, const BezierCurve& upper,
                                       const BezierCurve& lower) {
    std::vector<Components> found;
    for (int k = 1; k < 40; ++k) {
        const Pixel from = upper.at(k / 40.0), to = lower.at(k / 40.0);
        for (int row = 1; row < 8; ++row) {
            const Pixel p = from + row / 8.0 * (to - from);
            const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
            if (x < 0 || y < 0 || x >= parts.value.width || y >= parts.value.height) continue;
            found.push_back(at(parts, x, y));
        }
    }
    return found;
}

std::vector<Components> pixels_of_skin(const ColourComponents& parts) {
    std::vector<Components> found;
    const auto add = [&](const Pixel& a, const Pixel& b) {
        const Pixel from = patch_from_mean(a), to = patch_from_mean(b);
        for (int y = static_cast<int>(from.y()); y < static_cast<int>(to.y()); y += 2)
            for (int x = static_cast<int>(from.x()); x < static_cast<int>(to.x()); x += 2)
                if (x >= 0 && y >= 0 && x < parts.value.width && y < parts.value.height)
                    found.push_back(at(parts, x, y));
    };
    add({-0.42, 0.15}, {-0.2, 0.45});
    add({0.2, 0.15}, {0.42, 0.45});
    add({-0.12, 0.02}, {0.12, 0.4});
    add({-0.3, -0.5}, {0.3, -0.4});
    return found;
}

io::Image in_other_light(io::Image image, base::RandomStream& random) {
    const double gain = 0.6 + 0.8 * random.uniform(), gamma = 0.8 + 0.5 * random.uniform();
    const std::array<double, 3> cast = {1 + 0.08 * random.normal(), 1, 1 + 0.08 * random.normal()};
    for (std::size_t k = 0; k < image.rgb.size(); ++k) {
        const double light = std::pow(image.rgb[k] / 255.0, gamma) * gain * cast[k % 3];
        image.rgb[k] = static_cast<std::uint8_t>(std::clamp(255 * light + 0.5, 0.0, 255.0));
    }
    return image;
}

}  // namespace

ColourWeights best_weights(const LabelledPatch& labelled) {
    using enum FaceCurve;
    const auto parts = components_of(labelled.patch);
    const auto& curves = labelled.curves;
    ColourClass feature, skin;
    feature.set({pixels_between(parts, curves[brow_right_upper], curves[brow_right_lower]),
                 pixels_between(parts, curves[brow_left_upper], curves[brow_left_lower]),
                 pixels_between(parts, curves[lip_outer_upper], curves[lip_inner_upper]),
                 pixels_between(parts, curves[lip_inner_lower], curves[lip_outer_lower])});
    skin.set({pixels_of_skin(parts)});
    // K is 1 - V where neither is cut off: without the ridge their weights could be anything.
    const Eigen::Matrix4d within = feature.scatter + skin.scatter + 0.01 * Eigen::Matrix4d::Identity();
    Components w = within.ldlt().solve(feature.mean - skin.mean);
    for (const int k : {0, 1, 3}) w[k] = std::max(w[k], 0.0);
    w[2] = std::min(w[2], 0.0);
    const ColourWeights usual;
    const double size = w.cwiseAbs().sum(), wanted = usual.magenta + usual.black - usual.value + usual.hue;
    if (!(size > 1e-9)) return usual;
    w *= wanted / size;
    return {w[0], w[1], w[2], w[3]};
}

void ColourTrainingOptions::check() const {
    if (variations < 1) throw InputError(fmt::format("variations is {}; give 1 or more", variations));
    if (rounds < 1) throw InputError(fmt::format("rounds is {}; give 1 or more", rounds));
}

struct ColourNetwork::Parts {
    cv::Ptr<cv::ml::ANN_MLP> network;
    std::string made_of;
};

ColourNetwork::ColourNetwork(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ColourNetwork::~ColourNetwork() = default;
ColourNetwork::ColourNetwork(ColourNetwork&&) noexcept = default;

ColourNetwork ColourNetwork::train(std::span<const LabelledPatch> labelled, const std::string& made_of,
                                   const ColourTrainingOptions& options) {
    options.check();
    if (labelled.empty()) throw InputError("a colour network learns from labelled frames; there is none");
    const int rows = static_cast<int>(labelled.size()) * options.variations;
    cv::Mat inputs(rows, static_cast<int>(colour_input_count), CV_32F), outputs(rows, 4, CV_32F);
    base::RandomStream random(options.seed, "video/colours");
    for (int r = 0; r < rows; ++r) {
        LabelledPatch other = labelled[static_cast<std::size_t>(r / options.variations)];
        if (r % options.variations != 0) other.patch = in_other_light(std::move(other.patch), random);
        const auto in = colour_inputs(other.patch, other.curves);
        for (std::size_t c = 0; c < in.size(); ++c)
            inputs.at<float>(r, static_cast<int>(c)) = static_cast<float>(in[c]);
        const auto out = best_weights(other);
        const std::array<double, 4> weights = {out.magenta, out.black, out.value, out.hue};
        for (std::size_t c = 0; c < 4; ++c) outputs.at<float>(r, static_cast<int>(c)) = static_cast<float>(weights[c]);
    }
    auto parts = std::make_unique<Parts>();
    parts->made_of = made_of;
    parts->network = cv::ml::ANN_MLP::create();
    parts->network->setLayerSizes(cv::Mat_<int>{static_cast<int>(colour_input_count), hidden_units, 4});
    parts->network->setActivationFunction(cv::ml::ANN_MLP::SIGMOID_SYM, 1, 1);
    parts->network->setTrainMethod(cv::ml::ANN_MLP::BACKPROP, 0.02, 0.1);
    parts->network->setTermCriteria({cv::TermCriteria::COUNT, options.rounds, 0});
    parts->network->train(inputs, cv::ml::ROW_SAMPLE, outputs);
    return ColourNetwork(std::move(parts));
}

void ColourNetwork::save(const std::filesystem::path& file) const {
    cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage << "mimik_colour_network" << 1 << "made_of" << parts_->made_of << "network"
            << "{";
    parts_->network->write(storage);
    storage << "}";
    base::write_atomically(file, storage.releaseAndGetString());
}

namespace {
cv::Ptr<cv::ml::ANN_MLP> network_in(const std::string& text, const std::string& name, std::string& made_of) {
    try {
        const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
        if (static_cast<int>(storage["mimik_colour_network"]) == 1) {
            made_of = static_cast<std::string>(storage["made_of"]);
            auto network = cv::ml::ANN_MLP::create();
            network->read(storage["network"]);
            const cv::Mat layers = network->getLayerSizes();
            if (network->isTrained() && layers.total() == 3 &&
                layers.at<int>(0) == static_cast<int>(colour_input_count) && layers.at<int>(2) == 4)
                return network;
        }
    } catch (const cv::Exception&) {  // said below
    }
    throw InputError(
        fmt::format("{}: not a colour network of Mimik; make one with `mimik-video train VIDEO LABELS.csv`", name));
}
}  // namespace

ColourNetwork ColourNetwork::load(const std::filesystem::path& file) {
    constexpr std::uintmax_t most_bytes = 1 << 20;
    auto parts = std::make_unique<Parts>();
    parts->network = network_in(base::read_text(file, most_bytes), file.string(), parts->made_of);
    return ColourNetwork(std::move(parts));
}

ColourNetwork ColourNetwork::shipped() {
    auto parts = std::make_unique<Parts>();
    parts->network = network_in(shipped_text, "the network that comes with Mimik", parts->made_of);
    return ColourNetwork(std::move(parts));
}

const std::string& ColourNetwork::made_of() const { return parts_->made_of; }

ColourWeights ColourNetwork::weights(const ColourInputs& inputs) const {
    cv::Mat in(1, static_cast<int>(colour_input_count), CV_32F), out;
    for (std::size_t c = 0; c < inputs.size(); ++c)
        in.at<float>(0, static_cast<int>(c)) = static_cast<float>(inputs[c]);
    parts_->network->predict(in, out);
    return {std::max(0.0F, out.at<float>(0, 0)), std::max(0.0F, out.at<float>(0, 1)),
            std::min(0.0F, out.at<float>(0, 2)), std::max(0.0F, out.at<float>(0, 3))};
}

}  // namespace mimik::video
