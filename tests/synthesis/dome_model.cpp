#include "tests/synthesis/dome_model.h"

#include <array>
#include <cmath>

#include "base/random_stream.h"

namespace mimik::synthesis {
namespace {

constexpr int cols = 61, rows = 81;
constexpr double step_mm = 3.0;

struct Place {
    const char* name;
    double x, y;
    bool paired;
};
constexpr std::array<Place, 14> places = {{{"brow_outer", 48, 54, true},
                                           {"brow_middle", 33, 57, true},
                                           {"brow_inner", 15, 54, true},
                                           {"eye_outer", 45, 36, true},
                                           {"eye_inner", 18, 36, true},
                                           {"nose_saddle", 9, 33, true},
                                           {"nose_wing", 18, -3, true},
                                           {"nose_tip", 0, 3, false},
                                           {"mouth_corner", 27, -36, true},
                                           {"upper_lip_outer", 0, -24, false},
                                           {"upper_lip_inner", 0, -33, false},
                                           {"lower_lip_inner", 0, -36, false},
                                           {"lower_lip_outer", 0, -42, false},
                                           {"chin", 0, -63, false}}};

std::uint32_t vertex_at(double x, double y) {
    return static_cast<std::uint32_t>((static_cast<int>(y / step_mm) + rows / 2) * cols +
                                      static_cast<int>(x / step_mm) + cols / 2);
}

class DomeModel final : public FaceModel {
public:
    DomeModel() {
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < cols; ++c) {
                const double x = (c - cols / 2) * step_mm, y = (r - rows / 2) * step_mm;
                mean_.emplace_back(x, y, 100.0 - (x * x + y * y) / 100.0);
                const bool eye = std::abs(std::abs(x) - 31) < 12 && std::abs(y - 36) < 5;
                regions_.emplace_back(eye ? "eye" : "skin");
                if (r + 1 == rows || c + 1 == cols) continue;
                const auto i = static_cast<std::uint32_t>(r * cols + c);
                const std::array<std::uint32_t, 4> quad = {i, i + 1, i + cols + 1, i + cols};
                faces_.add(quad);
            }
        for (const auto& place : places) {
            if (!place.paired) {
                marks_[place.name] = vertex_at(place.x, place.y);
                continue;
            }
            marks_[std::string(place.name) + "_left"] = vertex_at(place.x, place.y);
            marks_[std::string(place.name) + "_right"] = vertex_at(-place.x, place.y);
        }
    }
    std::string name() const override { return "dome"; }
    const geometry::Faces& faces() const override { return faces_; }
    const std::map<std::string, std::uint32_t>& landmark_vertices() const override { return marks_; }
    const std::vector<std::string>& vertex_regions() const override { return regions_; }
    Identity draw_identity(std::uint64_t seed, Sex sex, double spread) const override {
        return {sex, seed, {spread * base::RandomStream(seed).normal()}, {}};
    }
    std::vector<geometry::Point> neutral_mm(const Identity& identity) const override {
        auto face = mean_;
        for (auto& p : face) p.x() *= 1.0 + 0.03 * identity.coefficients[0];
        return face;
    }
    std::vector<std::string> shapes() const override {
        return {"browInnerUp_L", "browInnerUp_R", "mouthSmile_L", "mouthSmile_R", "mouthShrugLower"};
    }
    std::vector<geometry::Vector> shape_displacement_mm(const Identity&, const std::string& shape) const override {
        const double side = shape.ends_with("_L") ? 1.0 : shape.ends_with("_R") ? -1.0 : 0.0;
        const geometry::Point centre(side * 27.0, shape.starts_with("brow") ? 54.0 : -36.0, 0.0);
        std::vector<geometry::Vector> displacement;
        for (const auto& p : mean_) {
            const double d2 = (p - centre).head<2>().squaredNorm();
            displacement.push_back(10.0 * std::exp(-d2 / 200.0) * geometry::Vector(0.5 * side, 0.8, 0.2));
        }
        return displacement;
    }

private:
    std::vector<geometry::Point> mean_;
    std::vector<std::string> regions_;
    geometry::Faces faces_;
    std::map<std::string, std::uint32_t> marks_;
};

}  // namespace

std::unique_ptr<FaceModel> make_dome_model() { return std::make_unique<DomeModel>(); }

}  // namespace mimik::synthesis
