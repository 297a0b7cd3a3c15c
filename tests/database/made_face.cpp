#include "tests/database/made_face.h"

#include <cmath>

#include "io/image.h"

namespace mimik::database {
namespace {

constexpr int rows = 81, cols = 61;
constexpr double spacing_mm = 2.0;

// Not symmetric top to bottom: turned by 180 degrees about z it must not lie on itself.
double height_mm(double x, double y) {
    const double dome = 45 * (1 - (x / 75) * (x / 75) - ((y + 20) / 110) * ((y + 20) / 110));
    return dome + 18 * std::exp(-(x * x) / 128 - (y * y) / 288);  // the nose: 18 mm high at the origin
}

}  // namespace

MadeFace make_face(const std::string& texture_file) {
    MadeFace face;
    face.scan.rows = rows;
    face.scan.cols = cols;
    face.scan.texture_file = texture_file;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const double x = (col - cols / 2) * spacing_mm, y = (row - rows / 2) * spacing_mm;
            face.scan.points_mm.emplace_back(x, y, height_mm(x, y));
            face.scan.texture_coordinates.emplace_back(col / (cols - 1.0), row / (rows - 1.0));
        }
    struct Place {
        const char* name;
        double x, y;  // of the subject's left side
        bool paired;
    };
    constexpr Place places[] = {{"brow_outer", 48, 52, true},       {"brow_middle", 32, 56, true},
                                {"brow_inner", 14, 52, true},       {"eye_outer", 44, 36, true},
                                {"eye_inner", 16, 36, true},        {"nose_saddle", 10, 32, true},
                                {"nose_wing", 18, -2, true},        {"nose_tip", 0, 0, false},
                                {"mouth_corner", 26, -34, true},    {"upper_lip_outer", 0, -24, false},
                                {"upper_lip_inner", 0, -32, false}, {"lower_lip_inner", 0, -34, false},
                                {"lower_lip_outer", 0, -42, false}, {"chin", 0, -64, false}};
    std::vector<geometry::Landmark> marks;
    for (const auto& place : places) {
        if (!place.paired) {
            marks.push_back({place.name, {place.x, place.y, height_mm(place.x, place.y)}, ""});
            continue;
        }
        for (const int side : {1, -1})
            marks.push_back({std::string(place.name) + (side > 0 ? "_left" : "_right"),
                             {side * place.x, place.y, height_mm(side * place.x, place.y)},
                             ""});
    }
    face.landmarks = geometry::Landmarks(std::move(marks));
    const double half_width = spacing_mm * (cols / 2), half_height = spacing_mm * (rows / 2);
    const auto labelled = to_bosphorus_labels(face.landmarks);
    for (const auto& mark : labelled.all())
        face.image_landmarks.push_back(
            {mark.name, (mark.position_mm.x() + half_width) / (2 * half_width) * face.image_size,
             (1 - (mark.position_mm.y() + half_height) / (2 * half_height)) * face.image_size});
    return face;
}

geometry::Landmarks moved(const geometry::Landmarks& landmarks, const std::map<std::string, geometry::Vector>& by_mm) {
    std::vector<geometry::Landmark> marks(landmarks.all().begin(), landmarks.all().end());
    for (auto& mark : marks)
        if (const auto it = by_mm.find(mark.name); it != by_mm.end()) mark.position_mm += it->second;
    return geometry::Landmarks(std::move(marks));
}

void write_scan(const std::filesystem::path& root, const std::string& name, const MadeFace& face) {
    const auto folder = root / name.substr(0, name.find('_'));
    MadeFace named = face;
    if (named.scan.texture_file.empty()) named.scan.texture_file = name + ".png";
    write_bnt(folder / (name + ".bnt"), to_bnt(named.scan));
    const io::Image grey{
        face.image_size, face.image_size,
        std::vector<std::uint8_t>(3 * static_cast<std::size_t>(face.image_size * face.image_size), 128)};
    io::write_png(folder / (name + ".png"), grey);
    write_lm3(folder / (name + ".lm3"), to_bosphorus_labels(face.landmarks));
    write_lm2(folder / (name + ".lm2"), face.image_landmarks);
}

}  // namespace mimik::database
