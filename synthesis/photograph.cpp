#include "synthesis/photograph.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random_stream.h"
#include "synthesis/builtin_curves.h"
#include "synthesis/depth_raster.h"
#include "synthesis/smooth_field.h"

namespace mimik::synthesis {
namespace {

using geometry::Point;
using geometry::Vector;
using Colour = Complexion::Colour;

struct Palette {
    Colour skin, lip, hair, iris;
};

Palette draw_palette(base::RandomStream random) {
    const double dark = random.uniform(), tint = random.normal();
    Palette palette;
    palette.skin = Colour(236, 196, 172) * (1.0 - 0.3 * dark * dark) + Colour(4, -1, -4) * tint;
    palette.lip = palette.skin.cwiseProduct(Colour(0.82, 0.58, 0.60));
    palette.hair = random.uniform() < 0.25 ? Colour(112, 82, 52) : Colour(52, 38, 30);
    const std::array<Colour, 4> irises = {Colour(84, 56, 34), Colour(92, 72, 44), Colour(84, 108, 84),
                                          Colour(84, 112, 140)};
    palette.iris = irises[static_cast<std::size_t>(random.uniform() * 4.0)];
    return palette;
}

Colour mix(const Colour& a, const Colour& b, double share_of_b) { return a + share_of_b * (b - a); }

/// The colour of an eyeball seen at `offset` (x, y, mm) from the middle of its iris.
Colour eye_colour(const Eigen::Vector2d& offset, const Colour& iris) {
    const double radius = offset.norm();
    if ((offset - Eigen::Vector2d(1.4, 1.6)).norm() < 0.8) return {250, 250, 250};  // reflection of the flash
    Colour colour = mix(Colour(26, 20, 18), iris, smooth_step(2.0, 2.6, radius));
    colour = mix(colour, iris * 0.5, smooth_step(4.6, 5.8, radius));
    colour = mix(colour, Colour(222, 214, 208), smooth_step(5.6, 6.3, radius));
    return colour * (1.0 - 0.35 * smooth_step(6.0, 15.0, radius));
}

}  // namespace

Complexion draw_complexion(const FaceModel& model, const Subject& subject, const FaceWindow& window,
                           std::uint64_t seed) {
    const Palette palette = draw_palette(base::RandomStream(seed, subject.name + "/palette"));
    Complexion complexion;
    complexion.hair = palette.hair;
    complexion.iris = palette.iris;
    // Colours belong to the skin: blotches and hairline are placed on the resting face and move with it.
    const SmoothField blotches(base::stream_seed(seed, subject.name + "/blotches"), 2, 7.0, Point::Constant(-220),
                               Point::Constant(220));
    const auto& regions = model.vertex_regions();
    const double brow_height = subject.resting_mm[model.landmark_vertices().at("brow_middle_left")].y();
    auto& colours = complexion.colours;
    auto& hairiness = complexion.hairiness;
    colours.resize(subject.resting_mm.size());
    hairiness.assign(subject.resting_mm.size(), 0.0);
    complexion.eyeball.assign(subject.resting_mm.size(), 0.0);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const Point& resting = subject.resting_mm[i];
        if (resting.z() < window.centre_mm.z() - 130.0) {
            colours[i] = palette.hair;
            continue;
        }
        const auto blotch = blotches.at(resting);
        Colour colour = palette.skin + Colour(2, -3, -3) * blotch[0] + Colour(3, 3, 3) * blotch[1];
        if (regions[i] == "lip") colour = palette.lip + Colour(3, 2, 2) * blotch[1];
        if (regions[i] == "eye" || regions[i] == "sclera") complexion.eyeball[i] = 1.0;
        if (regions[i] == "brow") hairiness[i] = 0.8;
        if (regions[i] == "nostril") colour *= 0.45;
        if (regions[i] == "lid") colour = mix(colour, palette.hair, 0.18);
        if (resting.y() > brow_height - 5.0)
            hairiness[i] = std::max(hairiness[i], smooth_step(0.97, 1.08, window.level(resting) + 0.02 * blotch[0]));
        colours[i] = colour;
    }
    return complexion;
}

io::Image photograph(const FaceModel& model, const Complexion& complexion, const std::vector<Point>& vertices_mm,
                     const SyntheticScan& scan, const ScannerOptions& options) {
    std::vector<Point> vertices(vertices_mm.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = scan.scanner_from_head * vertices_mm[i];
    const auto triangles = geometry::triangulate(model.faces());
    const auto normals = geometry::vertex_normals(vertices, triangles);

    const auto& marks = model.landmark_vertices();
    const auto& colours = complexion.colours;
    const auto& hairiness = complexion.hairiness;

    RasterLattice lattice;
    lattice.spacing_mm = 1.0 / options.texture_pixels_per_mm;
    lattice.cols = scan.image_width;
    lattice.rows = scan.image_height;
    lattice.x0_mm = scan.image_corner_mm.x() + 0.5 * lattice.spacing_mm;
    lattice.y0_mm = scan.image_corner_mm.y() - (lattice.rows - 0.5) * lattice.spacing_mm;
    const auto hits = depth_raster(vertices, triangles, lattice);

    const std::array<Point, 2> eyes = {
        0.5 * (vertices[marks.at("eye_outer_left")] + vertices[marks.at("eye_inner_left")]),
        0.5 * (vertices[marks.at("eye_outer_right")] + vertices[marks.at("eye_inner_right")])};
    const Vector light = Vector(0.25, 0.45, 0.86).normalized(), second_light = Vector(-0.6, 0.1, 0.79).normalized();
    io::Image image;
    image.width = lattice.cols;
    image.height = lattice.rows;
    image.rgb.resize(3 * hits.size());
    for (int row = 0; row < image.height; ++row)
        for (int col = 0; col < image.width; ++col) {
            const auto& hit =
                hits[static_cast<std::size_t>(image.height - 1 - row) * static_cast<std::size_t>(lattice.cols) +
                     static_cast<std::size_t>(col)];
            const double x = lattice.x0_mm + col * lattice.spacing_mm;
            const double y = lattice.y0_mm + (image.height - 1 - row) * lattice.spacing_mm;
            Colour colour(96, 104, 112);  // the studio's wall
            const auto eye = std::find_if(eyes.begin(), eyes.end(), [&](const Point& e) {
                return std::abs(x - e.x()) < 19.0 && std::abs(y - e.y()) < 13.0;
            });
            double eyeball = 0;
            for (int c = 0; hit.hit() && c < 3; ++c)
                eyeball +=
                    hit.barycentric[c] * complexion.eyeball[triangles[hit.triangle][static_cast<std::size_t>(c)]];
            const bool skin =
                hit.hit() && hit.front && (eye == eyes.end() || (hit.z_mm > eye->z() - 9.0 && eyeball < 0.5));
            if (skin) {
                const auto& corners = triangles[hit.triangle];
                Colour albedo = Colour::Zero();
                Vector normal = Vector::Zero();
                double hair = 0;
                for (int c = 0; c < 3; ++c) {
                    const auto vertex = corners[static_cast<std::size_t>(c)];
                    albedo += hit.barycentric[c] * colours[vertex];
                    normal += hit.barycentric[c] * normals[vertex];
                    hair += hit.barycentric[c] * hairiness[vertex];
                }
                normal.normalize();
                // Strands: two crossing waves of about a millimetre.
                if (hair > 0) {
                    const double strands =
                        0.8 + 0.2 * std::sin(5.0 * x + 1.8 * y + 2.0 * std::sin(0.7 * y)) * std::sin(2.1 * y - 1.3 * x);
                    albedo = mix(albedo, complexion.hair, std::clamp(hair * strands, 0.0, 1.0));
                }
                const double shade =
                    0.34 + 0.52 * std::max(0.0, normal.dot(light)) + 0.2 * std::max(0.0, normal.dot(second_light));
                colour = albedo * shade;
            } else if (eye != eyes.end()) {
                colour = eye_colour(Eigen::Vector2d(x - eye->x(), y - eye->y() - 0.5), complexion.iris);
            } else if (hit.hit()) {
                colour = {48, 18, 18};  // inside the mouth
            }
            const std::size_t pixel = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                           static_cast<std::size_t>(col));
            for (int c = 0; c < 3; ++c)
                image.rgb[pixel + static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::clamp(colour[c] + 0.5, 0.0, 255.0));
        }
    return image;
}

}  // namespace mimik::synthesis
