#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "synthesis/builtin_muscles.h"
#include "synthesis/builtin_surface.h"
#include "synthesis/face_model.h"

namespace mimik::synthesis {
namespace {

class BuiltinFaceModel final : public FaceModel {
public:
    [[nodiscard]] std::string name() const override { return "built-in"; }
    [[nodiscard]] const geometry::Faces& faces() const override { return sheet_.faces; }
    [[nodiscard]] const std::map<std::string, std::uint32_t>& landmark_vertices() const override {
        return sheet_.landmarks;
    }
    [[nodiscard]] const std::vector<std::string>& vertex_regions() const override { return sheet_.regions; }

    [[nodiscard]] Identity draw_identity(std::uint64_t seed, Sex sex, double spread) const override {
        Identity identity{sex, seed, draw_scores(seed, spread), {}};
        const auto numbers = face_numbers(identity);
        for (std::size_t i = 0; i < measurement_count; ++i)
            identity.measurements_mm[std::string(population_measurements()[i].name)] = numbers.mm[i];
        return identity;
    }
    [[nodiscard]] std::vector<geometry::Point> neutral_mm(const Identity& identity) const override {
        return build_neutral_mm(sheet_, face_numbers(identity));
    }
    [[nodiscard]] std::vector<std::string> shapes() const override {
        std::vector<std::string> names;
        for (const auto& [name, motion] : facial_motions()) {
            if (motion.central) {
                names.push_back(name);
            } else {
                names.push_back(name + "_L");
                names.push_back(name + "_R");
            }
        }
        return names;
    }
    [[nodiscard]] std::vector<geometry::Vector> shape_displacement_mm(const Identity& identity,
                                                                      const std::string& shape) const override {
        return shape_displacements_mm(identity, {shape}).front();
    }
    /// One neutral face for all; a right shape is its left one mirrored.
    [[nodiscard]] std::vector<std::vector<geometry::Vector>> shape_displacements_mm(
        const Identity& identity, const std::vector<std::string>& names) const override {
        const auto neutral = neutral_mm(identity);
        std::map<const Motion*, std::vector<geometry::Vector>> left;
        std::vector<std::vector<geometry::Vector>> displacements;
        displacements.reserve(names.size());
        for (const auto& name : names) {
            const Motion& motion = find_motion(name);
            auto& moved = left[&motion];
            if (moved.empty()) moved = muscles_.displacement_mm(motion, neutral);
            displacements.push_back(name.ends_with("_R") ? mirrored(moved) : moved);
        }
        return displacements;
    }

    void settle(const std::vector<geometry::Point>& resting_mm, const Contact& contact,
                std::vector<geometry::Vector>& displacement_mm) const override {
        muscles_.settle(resting_mm, contact, displacement_mm);
    }

private:
    [[nodiscard]] const Motion& find_motion(const std::string& shape) const {
        const bool sided = shape.ends_with("_L") || shape.ends_with("_R");
        const auto found = facial_motions().find(sided ? shape.substr(0, shape.size() - 2) : shape);
        if (found == facial_motions().end() || found->second.central == sided)
            throw InputError(
                fmt::format("the built-in face has no shape '{}'; it has: {}", shape, fmt::join(shapes(), ", ")));
        return found->second;
    }
    [[nodiscard]] std::vector<geometry::Vector> mirrored(const std::vector<geometry::Vector>& moved) const {
        std::vector<geometry::Vector> other(moved.size());
        for (std::size_t i = 0; i < moved.size(); ++i) {
            other[i] = moved[sheet_.mirror[i]];
            other[i].x() = -other[i].x();
        }
        return other;
    }
    /// Halfway between the mean woman and the mean man: the face on which amplitudes are stated.
    [[nodiscard]] static FaceNumbers mean_numbers() {
        const Identity woman{Sex::female, 0, draw_scores(0, 0), {}}, man{Sex::male, 0, draw_scores(0, 0), {}};
        auto mean = face_numbers(woman);
        const auto other = face_numbers(man);
        for (std::size_t i = 0; i < measurement_count; ++i) mean.mm[i] = 0.5 * (mean.mm[i] + other.mm[i]);
        for (std::size_t i = 0; i < form_count; ++i) mean.form[i] = 0.5 * (mean.form[i] + other.form[i]);
        return mean;
    }

    Sheet sheet_ = make_sheet();
    MuscleModel muscles_{sheet_, build_neutral_mm(sheet_, mean_numbers())};
};

}  // namespace

std::unique_ptr<FaceModel> make_builtin_face_model() { return std::make_unique<BuiltinFaceModel>(); }

}  // namespace mimik::synthesis
