#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/random_stream.h"
#include "base/text.h"
#include "synthesis/face_model.h"
#include "synthesis/ict_obj.h"

namespace mimik::synthesis {
namespace {

namespace fs = std::filesystem;
using geometry::Point;
using geometry::Vector;

/// Face (0..9408), head and neck (9409..11247): what lies behind is mouth, eyes and teeth.
constexpr std::uint32_t skin_vertices = 11248;
// Of a shape's file only the skin's vertices are read: 450 kB of 2.5 MB.
constexpr std::size_t head_bytes = std::size_t{1} << 20;
constexpr std::uintmax_t most_mesh_bytes = std::uintmax_t{1} << 26;

/// The 22 landmarks on the subject's own side, as chosen on the mean face.
const std::map<std::string, std::uint32_t>& ict_landmarks() {
    static const std::map<std::string, std::uint32_t> vertices = {
        {"brow_outer_left", 2509},    {"brow_middle_left", 4114},
        {"brow_inner_left", 3615},    {"brow_outer_right", 268},
        {"brow_middle_right", 1914},  {"brow_inner_right", 1401},
        {"eye_outer_left", 3721},     {"eye_inner_left", 3742},
        {"eye_outer_right", 1507},    {"eye_inner_right", 1528},
        {"nose_saddle_left", 3534},   {"nose_saddle_right", 1317},
        {"nose_wing_left", 5325},     {"nose_wing_right", 4867},
        {"nose_tip", 4857},           {"mouth_corner_left", 6213},
        {"mouth_corner_right", 5708}, {"upper_lip_outer", 0},
        {"upper_lip_inner", 5522},    {"lower_lip_inner", 5515},
        {"lower_lip_outer", 5518},    {"chin", 964}};
    return vertices;
}

// Contours of the 68-point scheme, by which lips, lids and brows are found on the mean face.
constexpr std::array<std::uint32_t, 12> outer_lips = {5708, 5695, 2081, 0,    4275, 6200,
                                                      6213, 6346, 6461, 5518, 5957, 5841};
constexpr std::array<std::uint32_t, 6> right_lids = {1507, 1542, 1537, 1528, 1518, 1511};
constexpr std::array<std::uint32_t, 6> left_lids = {3742, 3751, 3756, 3721, 3725, 3732};
constexpr std::array<std::uint32_t, 5> right_brow = {268, 493, 1914, 2044, 1401};
constexpr std::array<std::uint32_t, 5> left_brow = {3615, 4240, 4114, 2734, 2509};

std::vector<Point> read_vertices(const fs::path& file) {
    return decode_ict_vertices(base::read_text_head(file, head_bytes), file.string(), skin_vertices);
}

bool inside_polygon(const Point& p, std::span<const Point> polygon) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Point &a = polygon[i], &b = polygon[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
            inside = !inside;
    }
    return inside;
}

/// Distance in x and y to an open or closed line.
double distance_to_line(const Point& p, std::span<const Point> line, bool closed) {
    double best = 1e300;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < line.size(); ++i) {
        const Eigen::Vector2d a = line[i].head<2>(), b = line[(i + 1) % line.size()].head<2>(), q = p.head<2>();
        const double t = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        best = std::min(best, (q - a - t * (b - a)).norm());
    }
    return best;
}

class IctFaceModel final : public FaceModel {
public:
    explicit IctFaceModel(const fs::path& folder) {
        read_topology(folder / "generic_neutral_mesh.obj");
        read_modes_and_shapes(folder);
        name_regions();
        larger_face_sign_ = size_mm(add(mean_, modes_[0], 1.0)) > size_mm(mean_) ? 1.0 : -1.0;
    }

    std::string name() const override { return "ict-facekit"; }
    const geometry::Faces& faces() const override { return faces_; }
    const std::map<std::string, std::uint32_t>& landmark_vertices() const override { return ict_landmarks(); }
    const std::vector<std::string>& vertex_regions() const override { return regions_; }

    Identity draw_identity(std::uint64_t seed, Sex sex, double spread) const override {
        base::RandomStream random(seed);
        Identity identity;
        identity.sex = sex;
        identity.seed = seed;
        for (std::size_t i = 0; i < modes_.size(); ++i) identity.coefficients.push_back(random.normal());
        // The first mode is size. With the two sexes in equal number it stays N(0, 1) as a whole, and 0.85 makes the
        // sexes differ by 1.3 standard deviations, as face width and height do (Kesterke et al. 2016).
        const bool usual = random.uniform() < 0.85;
        const double sign = ((sex == Sex::male) == usual ? 1.0 : -1.0) * larger_face_sign_;
        identity.coefficients[0] = sign * std::abs(identity.coefficients[0]);
        for (double& c : identity.coefficients) c *= spread;
        const auto face = neutral_mm(identity);
        const auto distance = [&](const char* a, const char* b) {
            return (face[ict_landmarks().at(a)] - face[ict_landmarks().at(b)]).norm();
        };
        identity.measurements_mm = {{"outer_eye_distance", distance("eye_outer_left", "eye_outer_right")},
                                    {"inner_eye_distance", distance("eye_inner_left", "eye_inner_right")},
                                    {"mouth_width", distance("mouth_corner_left", "mouth_corner_right")},
                                    {"nose_width", distance("nose_wing_left", "nose_wing_right")},
                                    {"nose_tip_to_chin", distance("nose_tip", "chin")},
                                    {"face_size", size_mm(face)}};
        return identity;
    }

    std::vector<Point> neutral_mm(const Identity& identity) const override {
        if (identity.coefficients.size() != modes_.size())
            throw InputError(fmt::format("identity has {}, the face model {} modes",
                                         base::counted(identity.coefficients.size(), "coefficient"), modes_.size()));
        std::vector<Point> face = mean_;
        for (std::size_t m = 0; m < modes_.size(); ++m)
            for (std::size_t i = 0; i < face.size(); ++i) face[i] += identity.coefficients[m] * modes_[m][i];
        return face;
    }

    std::vector<std::string> shapes() const override {
        std::vector<std::string> names;
        for (const auto& [shape, displacement] : shapes_) names.push_back(shape);
        return names;
    }

    std::vector<Vector> shape_displacement_mm(const Identity&, const std::string& shape) const override {
        const auto found = shapes_.find(shape);
        if (found == shapes_.end())
            throw InputError(fmt::format("the ICT-FaceKit folder has no shape '{}' ({}.obj)", shape, shape));
        return found->second;
    }

private:
    void read_topology(const fs::path& file) {
        auto skin = decode_ict_skin(base::read_bytes(file, most_mesh_bytes), file.string(), skin_vertices);
        mean_ = std::move(skin.vertices_mm);
        faces_ = std::move(skin.faces);
    }

    void read_modes_and_shapes(const fs::path& folder) {
        std::vector<fs::path> files;
        std::vector<std::string> names;
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
            if (entry->path().extension() == ".obj") files.push_back(entry->path());
        if (error)
            throw InputError(
                fmt::format("{}: cannot be listed ({}); make the folder readable", folder.string(), error.message()));
        std::sort(files.begin(), files.end());
        // Gaze and pupils do not move skin that a scanner measures; the mean face is read already.
        std::erase_if(files, [](const fs::path& file) {
            const std::string stem = file.stem().string();
            return stem == "generic_neutral_mesh" || stem.starts_with("eyeLook") || stem.starts_with("PupilDilate");
        });
        std::vector<std::vector<Vector>> deltas(files.size());
        base::parallel_for_each(files.size(), [&](std::size_t i) {
            deltas[i] = read_vertices(files[i]);
            for (std::size_t v = 0; v < skin_vertices; ++v) deltas[i][v] -= mean_[v];
        });
        for (std::size_t i = 0; i < files.size(); ++i) {
            const std::string stem = files[i].stem().string();
            if (stem.starts_with("identity"))
                modes_.push_back(std::move(deltas[i]));
            else
                shapes_.emplace(stem, std::move(deltas[i]));
        }
        if (modes_.empty())
            throw InputError(
                fmt::format("{}: no identity000.obj; give the folder FaceXModel of ICT-FaceKit", folder.string()));
        if (!shapes_.contains("mouthSmile_L"))
            throw InputError(
                fmt::format("{}: no mouthSmile_L.obj; give the folder FaceXModel of ICT-FaceKit", folder.string()));
    }

    void name_regions() {
        const auto line = [&](std::span<const std::uint32_t> vertices) {
            std::vector<Point> points;
            for (const auto v : vertices) points.push_back(mean_[v]);
            return points;
        };
        const auto lips = line(outer_lips);
        const std::array lids = {line(right_lids), line(left_lids)};
        const std::array brows = {line(right_brow), line(left_brow)};
        const auto normals = geometry::vertex_normals(mean_, geometry::triangulate(faces_));
        const Point nose = mean_[ict_landmarks().at("nose_tip")];
        regions_.assign(skin_vertices, "skin");
        for (std::size_t i = 0; i < skin_vertices; ++i) {
            const Point& p = mean_[i];
            if (p.z() < nose.z() - 65.0) continue;
            const Vector from_nose = p - nose;
            if (inside_polygon(p, lips) && p.z() > nose.z() - 40.0) {
                regions_[i] = "lip";
            } else if (inside_polygon(p, lids[0]) || inside_polygon(p, lids[1]) ||
                       distance_to_line(p, lids[0], true) < 1.5 || distance_to_line(p, lids[1], true) < 1.5) {
                regions_[i] = "lid";
            } else if (distance_to_line(p, brows[0], false) < 4.5 || distance_to_line(p, brows[1], false) < 4.5) {
                regions_[i] = "brow";
            } else if (std::abs(from_nose.x()) > 2.5 && std::abs(from_nose.x()) < 14.0 && from_nose.y() < -4.0 &&
                       from_nose.y() > -16.0 && from_nose.z() > -32.0 && normals[i].y() < -0.75) {
                regions_[i] = "nostril";
            }
        }
    }

    static std::vector<Point> add(std::vector<Point> face, const std::vector<Vector>& delta, double weight) {
        for (std::size_t i = 0; i < face.size(); ++i) face[i] += weight * delta[i];
        return face;
    }
    /// Root mean square distance of the landmarks from their centre.
    static double size_mm(const std::vector<Point>& face) {
        Point centre = Point::Zero();
        for (const auto& [name, v] : ict_landmarks()) centre += face[v] / static_cast<double>(ict_landmarks().size());
        double sum = 0;
        for (const auto& [name, v] : ict_landmarks()) sum += (face[v] - centre).squaredNorm();
        return std::sqrt(sum / static_cast<double>(ict_landmarks().size()));
    }

    std::vector<Point> mean_;
    std::vector<std::vector<Vector>> modes_;
    std::map<std::string, std::vector<Vector>> shapes_;
    geometry::Faces faces_;
    std::vector<std::string> regions_;
    double larger_face_sign_ = 1.0;
};

}  // namespace

std::unique_ptr<FaceModel> load_ict_face_model(const std::string& folder) {
    for (const fs::path& candidate : {fs::path(folder), fs::path(folder) / "FaceXModel"})
        if (base::is_there(candidate / "generic_neutral_mesh.obj")) return std::make_unique<IctFaceModel>(candidate);
    throw InputError(
        fmt::format("{}: no generic_neutral_mesh.obj there or in FaceXModel below; give a clone of the public "
                    "repository ICT-VGL/ICT-FaceKit",
                    folder));
}

}  // namespace mimik::synthesis
