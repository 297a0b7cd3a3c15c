#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::synthesis {

enum class Sex { female, male };

/// Who a made face is: everything a model needs to build the same person again.
struct Identity {
    Sex sex = Sex::female;
    std::uint64_t seed = 0;            ///< what it was drawn from
    std::vector<double> coefficients;  ///< the model's own (standard deviations for a PCA, measurements for a builder)
    std::map<std::string, double> measurements_mm;  ///< for truth.json: face height, mouth width, ...
};

/// What touches what when an expression is done.
struct Contact {
    bool left_eye_closed = false, right_eye_closed = false;
};

/// A face with fixed topology whose identity can be drawn and whose skin can be moved. Frame and units as everywhere:
/// mm, +x subject's left, +y up, +z out of the face.
///
/// Elementary motions ("shapes") carry the ARKit names in ICT-FaceKit spelling, sides on the subject's own:
///   browInnerUp_L/_R browOuterUp_L/_R browDown_L/_R eyeWide_L/_R cheekSquint_L/_R eyeSquint_L/_R eyeBlink_L/_R
///   noseSneer_L/_R mouthUpperUp_L/_R mouthSmile_L/_R mouthDimple_L/_R mouthFrown_L/_R mouthLowerDown_L/_R
///   mouthShrugLower mouthShrugUpper mouthPucker mouthStretch_L/_R mouthFunnel mouthPress_L/_R jawOpen
///   mouthRollLower mouthRollUpper cheekPuff_L/_R ...
class FaceModel {
public:
    virtual ~FaceModel() = default;

    [[nodiscard]] virtual std::string name() const = 0;              ///< "built-in", "ict-facekit"
    [[nodiscard]] virtual const geometry::Faces& faces() const = 0;  ///< of the skin that a scanner can see
    /// Landmark name (geometry::standard_landmark_names()) -> vertex index.
    [[nodiscard]] virtual const std::map<std::string, std::uint32_t>& landmark_vertices() const = 0;
    /// Per vertex: a word for what skin it is ("skin", "lip", "brow", "eye" for the dark middle of the ball, "sclera"
    /// for its white, "lid" for its rim, "nostril"), for texture and scanner holes.
    [[nodiscard]] virtual const std::vector<std::string>& vertex_regions() const = 0;

    /// `spread` scales the identity variance: 1 = the population, 0 = the mean face.
    [[nodiscard]] virtual Identity draw_identity(std::uint64_t seed, Sex sex, double spread) const = 0;
    [[nodiscard]] virtual std::vector<geometry::Point> neutral_mm(const Identity& identity) const = 0;
    [[nodiscard]] virtual std::vector<std::string> shapes() const = 0;
    /// Displacement of every vertex at full strength (weight 1) on this person's neutral face.
    [[nodiscard]] virtual std::vector<geometry::Vector> shape_displacement_mm(const Identity& identity,
                                                                              const std::string& shape) const = 0;
    /// The same for several shapes of one person, where a model can share work among them.
    [[nodiscard]] virtual std::vector<std::vector<geometry::Vector>> shape_displacements_mm(
        const Identity& identity, const std::vector<std::string>& shapes) const {
        std::vector<std::vector<geometry::Vector>> displacements;
        displacements.reserve(shapes.size());
        for (const auto& shape : shapes) displacements.push_back(shape_displacement_mm(identity, shape));
        return displacements;
    }
    /// What a sum of shapes does and no shape alone may do: lips or lids through each other, skin folded over itself.
    /// Mends `displacement_mm` (of a performance on `resting_mm`) in place; an eye that `contact` closes ends closed.
    /// A model whose shapes were scanned rather than built leaves it as it is.
    virtual void settle(const std::vector<geometry::Point>& resting_mm, const Contact& contact,
                        std::vector<geometry::Vector>& displacement_mm) const {
        (void)resting_mm, (void)contact, (void)displacement_mm;
    }
};

/// The procedural model: needs no file.
[[nodiscard]] std::unique_ptr<FaceModel> make_builtin_face_model();
/// ICT-FaceKit in the layout of its public repository (folder FaceXModel, or its parent). @throws InputError.
[[nodiscard]] std::unique_ptr<FaceModel> load_ict_face_model(const std::string& folder);

}  // namespace mimik::synthesis
