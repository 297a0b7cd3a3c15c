#include "video/onnx_tracker.h"

#include "video/face_finder.h"
#include "video/landmark_net.h"
#include "video/points_tracker.h"

namespace mimik::video {
namespace {

constexpr double crop_of_box = 1.2;  ///< the finder's square ends above the chin

class NetSource final : public PointSource {
public:
    explicit NetSource(const std::filesystem::path& onnx) : net_(onnx) {}
    [[nodiscard]] std::string name() const override { return "onnx"; }
    [[nodiscard]] std::vector<FaceBox> find(const io::Image& frame) override {
        std::vector<FaceBox> boxes;
        for (const auto& face : finder_.find(frame)) {
            const double more_px = 0.5 * (crop_of_box - 1) * face.size_px;
            boxes.push_back({face.corner - Pixel(more_px, more_px), crop_of_box * face.size_px});
        }
        return boxes;
    }
    [[nodiscard]] std::optional<Points68> points(const io::Image& frame, const FaceBox& face) override {
        return net_.points(frame, face);
    }

private:
    LandmarkNet net_;
    FaceFinder finder_;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_onnx_tracker(const std::filesystem::path& onnx, const FaceChoiceOptions& choice) {
    return make_points_tracker(std::make_unique<NetSource>(onnx), choice);
}

}  // namespace mimik::video
