#include "figures/panel_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

#include "base/errors.h"
#include "figures/offscreen.h"
#include "geometry/polygon_triangles.h"

namespace mimik::figures {
namespace {

using geometry::Mesh;
using geometry::Point;
using geometry::Vector;

constexpr Colour wire = {132, 122, 118};
constexpr Colour inside_of_skin = {150, 130, 118};

/// A surface in the renderer's form. Everything is per vertex.
struct Surface {
    vtkNew<vtkPoints> points;
    vtkNew<vtkFloatArray> normals;
    vtkNew<vtkCellArray> polygons;
    vtkNew<vtkPolyData> data;

    Surface() {
        points->SetDataTypeToFloat();
        normals->SetName("Normals");
        normals->SetNumberOfComponents(3);
    }
    void add(const Point& position, const Vector& normal) {
        points->InsertNextPoint(position.data());
        normals->InsertNextTuple(normal.data());
    }
    vtkPolyData& finish() {
        data->SetPoints(points);
        data->GetPointData()->SetNormals(normals);
        data->SetPolys(polygons);
        return *data;
    }
};

std::array<double, 3> unit_rgb(const Colour& c) { return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}; }

vtkSmartPointer<vtkActor> make_actor(vtkPolyData& data, const Colour& colour) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(&data);
    mapper->SetScalarVisibility(data.GetPointData()->GetScalars() != nullptr);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    vtkProperty& look = *actor->GetProperty();
    look.SetInterpolationToPhong();
    look.SetColor(unit_rgb(colour).data());
    return actor;
}

/// Directions are in the camera's axes (right, up, towards the viewer): every view of a face is lit alike.
void light_the_scene(vtkRenderer& renderer) {
    struct Lamp {
        std::array<double, 3> direction;
        double intensity;
    };
    // The key light stands above on the image's left and steep enough to draw lids, nose wings, lips and folds; the
    // others only keep its shadows open.
    constexpr std::array<Lamp, 4> lamps = {
        {{{-0.75, 0.95, 1.0}, 0.62}, {{1.0, 0.25, 0.8}, 0.30}, {{0.0, 0.0, 1.0}, 0.17}, {{0.2, -1.0, 0.5}, 0.06}}};
    for (const auto& lamp : lamps) {
        vtkNew<vtkLight> light;
        light->SetLightTypeToCameraLight();
        light->SetPosition(lamp.direction.data());
        light->SetFocalPoint(0, 0, 0);
        light->SetIntensity(lamp.intensity);
        renderer.AddLight(light);
    }
}

bool whole(const Mesh& mesh, std::span<const std::uint32_t> face) {
    return std::all_of(face.begin(), face.end(), [&](std::uint32_t v) { return mesh.vertices_mm[v].allFinite(); });
}

/// Vertices that have several texture positions (seams) are doubled: the renderer knows one per vertex.
struct Corners {
    std::vector<std::uint32_t> vertex, texture;  ///< per drawn vertex
    std::vector<std::uint32_t> drawn;            ///< per entry of Faces::corners
};

Corners split_at_seams(const Mesh& mesh, bool textured) {
    Corners corners;
    const auto& faces = mesh.faces;
    const bool own_indices = textured && !faces.texture_corners.empty();
    corners.vertex.resize(mesh.vertices_mm.size());
    for (std::size_t v = 0; v < corners.vertex.size(); ++v) corners.vertex[v] = static_cast<std::uint32_t>(v);
    corners.texture = corners.vertex;
    corners.drawn = faces.corners;
    if (!own_indices) return corners;
    constexpr auto unset = ~std::uint32_t{0};
    std::fill(corners.texture.begin(), corners.texture.end(), unset);
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> doubles;
    for (std::size_t c = 0; c < faces.corners.size(); ++c) {
        const auto vertex = faces.corners[c], texture = faces.texture_corners[c];
        if (corners.texture[vertex] == unset) corners.texture[vertex] = texture;
        if (corners.texture[vertex] == texture) continue;
        const auto [place, is_new] =
            doubles.try_emplace({vertex, texture}, static_cast<std::uint32_t>(corners.vertex.size()));
        if (is_new) {
            corners.vertex.push_back(vertex);
            corners.texture.push_back(texture);
        }
        corners.drawn[c] = place->second;
    }
    for (auto& texture : corners.texture)
        if (texture == unset) texture = 0;
    return corners;
}

/// Whether texture positions leave the image, which repeats then.
bool repeats_texture(const Mesh& mesh) {
    constexpr double slack = 1e-3;
    return std::any_of(mesh.texture_coordinates.begin(), mesh.texture_coordinates.end(),
                       [](const auto& uv) { return uv.minCoeff() < -slack || uv.maxCoeff() > 1 + slack; });
}

vtkSmartPointer<vtkTexture> make_texture(const io::Image& image, bool repeats) {
    vtkNew<vtkImageData> data;
    data->SetDimensions(image.width, image.height, 1);
    data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width);
    for (int row = 0; row < image.height; ++row)
        std::copy_n(image.rgb.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * row_bytes),
                    row_bytes, static_cast<unsigned char*>(data->GetScalarPointer(0, image.height - 1 - row, 0)));
    auto texture = vtkSmartPointer<vtkTexture>::New();
    texture->SetInputData(data);
    texture->InterpolateOn();
    texture->MipmapOn();
    texture->SetRepeat(repeats ? 1 : 0);  // else the left edge of a photograph would bleed into its right edge
    texture->SetEdgeClamp(repeats ? 0 : 1);
    return texture;
}

vtkSmartPointer<vtkUnsignedCharArray> vertex_colours(const Panel& panel, const std::array<double, 2>& range,
                                                     const Corners& corners) {
    const Mesh& mesh = panel.mesh;
    if (!panel.scalar && (panel.texture || mesh.colours.empty())) return nullptr;
    auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
    colours->SetName("Colours");
    colours->SetNumberOfComponents(3);
    colours->SetNumberOfTuples(static_cast<vtkIdType>(corners.vertex.size()));
    const auto values = panel.scalar ? scalar_values(mesh, panel.scalar->attribute) : std::vector<double>();
    const double width = range[1] - range[0];
    for (std::size_t v = 0; v < corners.vertex.size(); ++v) {
        const auto vertex = corners.vertex[v];
        const Colour colour =
            panel.scalar ? map_colour(panel.scalar->map, (values[vertex] - range[0]) / width) : mesh.colours[vertex];
        colours->SetTypedTuple(static_cast<vtkIdType>(v), colour.data());
    }
    return colours;
}

/// A polygon as one cell, so that its edges are drawn without diagonals; one that is no fan as triangles, since the
/// renderer would fill its notch. `drawn` are its corners in the renderer's numbers.
void add_polygon(const Mesh& mesh, std::span<const std::uint32_t> face, std::span<const std::uint32_t> drawn,
                 vtkCellArray& cells, std::vector<geometry::Triangle>& triangles) {
    const auto add_cell = [&](std::span<const std::uint32_t> cell_corners) {
        cells.InsertNextCell(static_cast<int>(cell_corners.size()));
        for (const auto corner : cell_corners) cells.InsertCellPoint(corner);
    };
    if (geometry::is_fan(face, mesh.vertices_mm)) {
        for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
        add_cell(drawn);
        return;
    }
    std::vector<Point> polygon;
    for (const auto v : face) polygon.push_back(mesh.vertices_mm[v]);
    for (const auto& t : geometry::cut_polygon(polygon)) {
        triangles.push_back({face[t[0]], face[t[1]], face[t[2]]});
        add_cell(std::array{drawn[t[0]], drawn[t[1]], drawn[t[2]]});
    }
}

vtkSmartPointer<vtkActor> face_actor(const Panel& panel, const std::array<double, 2>& scalar_range) {
    const Mesh& mesh = panel.mesh;
    const bool textured = panel.texture && !panel.scalar;
    std::vector<geometry::Triangle> triangles;
    const Corners corners = split_at_seams(mesh, textured);
    Surface surface;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto face = mesh.faces[f];
        if (!whole(mesh, face)) continue;
        add_polygon(mesh, face, std::span(corners.drawn).subspan(mesh.faces.first[f], face.size()), *surface.polygons,
                    triangles);
    }
    const auto normals = geometry::vertex_normals(mesh.vertices_mm, triangles);
    for (const auto v : corners.vertex) {
        const bool finite =
            mesh.vertices_mm[v].allFinite();  // no drawn face has the others, but the renderer's box would
        surface.add(finite ? mesh.vertices_mm[v] : Point(Point::Zero()), finite ? normals[v] : Vector(Vector::Zero()));
    }
    vtkPolyData& data = surface.finish();
    const bool dots = mesh.faces.size() == 0;
    if (dots) {
        vtkNew<vtkCellArray> verts;
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
            if (!mesh.vertices_mm[v].allFinite()) continue;
            const auto id = static_cast<vtkIdType>(v);
            verts->InsertNextCell(1, &id);
        }
        data.SetVerts(verts);
        data.GetPointData()->SetNormals(nullptr);
    }
    if (const auto colours = vertex_colours(panel, scalar_range, corners)) data.GetPointData()->SetScalars(colours);
    if (textured) {
        vtkNew<vtkFloatArray> coordinates;
        coordinates->SetName("TextureCoordinates");
        coordinates->SetNumberOfComponents(2);
        for (const auto t : corners.texture) coordinates->InsertNextTuple(mesh.texture_coordinates[t].data());
        data.GetPointData()->SetTCoords(coordinates);
    }

    const bool coloured = data.GetPointData()->GetScalars() != nullptr;
    const bool plain = !textured && (!coloured || (panel.lit_as_skin && !panel.scalar));
    auto actor = make_actor(data, plain && !coloured ? skin : Colour{255, 255, 255});
    vtkProperty& look = *actor->GetProperty();
    // A photograph has light in it already and a colour map must stay readable: both are shaded more gently.
    look.SetAmbient(plain ? 0.14 : 0.35);
    look.SetDiffuse(plain ? 0.95 : 0.80);
    look.SetSpecular(textured || !plain ? 0.0 : 0.10);
    look.SetSpecularPower(18);
    if (dots) {
        look.LightingOff();
        look.SetPointSize(2.0F);
        if (plain) look.SetColor(unit_rgb(inside_of_skin).data());
    }
    if (plain && !coloured && !dots) {
        vtkNew<vtkProperty> back;
        back->DeepCopy(&look);
        back->SetColor(unit_rgb(inside_of_skin).data());
        back->SetSpecular(0);
        actor->SetBackfaceProperty(back);
    }
    if (panel.wire_frame && !dots) {
        look.EdgeVisibilityOn();
        look.SetEdgeColor(unit_rgb(wire).data());
        look.SetLineWidth(1.0F);
    }
    if (textured) actor->SetTexture(make_texture(*panel.texture, repeats_texture(mesh)));
    return actor;
}

/// Appends a body of revolution: rings of `profile` (distance along the axis, radius, slope of the normal along it).
struct Ring {
    double along, radius, normal_along;
};
void add_revolution(Surface& surface, const Point& base, const Vector& axis, std::span<const Ring> profile) {
    constexpr int sides = 24;
    const Vector side = axis.unitOrthogonal(), other = axis.cross(side);
    const auto first = surface.points->GetNumberOfPoints();
    for (const auto& ring : profile)
        for (int k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * k / sides;
            const Vector out = std::cos(angle) * side + std::sin(angle) * other;
            const double across = std::sqrt(std::max(0.0, 1 - ring.normal_along * ring.normal_along));
            surface.add(base + ring.along * axis + ring.radius * out, across * out + ring.normal_along * axis);
        }
    for (std::size_t ring = 1; ring < profile.size(); ++ring)
        for (int k = 0; k < sides; ++k) {
            const auto low = first + static_cast<vtkIdType>(ring - 1) * sides, high = low + sides;
            const int next = (k + 1) % sides;
            const std::array<vtkIdType, 4> quad = {low + k, low + next, high + next, high + k};
            surface.polygons->InsertNextCell(4, quad.data());
        }
}

vtkSmartPointer<vtkActor> marker_actor(const MarkerSet& set) {
    constexpr int steps = 12;
    std::vector<Ring> ball;
    for (int k = 0; k <= steps; ++k) {
        const double angle = std::numbers::pi * (static_cast<double>(k) / steps - 0.5);
        ball.push_back({set.radius_mm * std::sin(angle), set.radius_mm * std::cos(angle), std::sin(angle)});
    }
    Surface surface;
    for (const auto& position : set.positions_mm) add_revolution(surface, position, Vector::UnitY(), ball);
    return make_actor(surface.finish(), set.colour);
}

vtkSmartPointer<vtkActor> arrow_actor(const ArrowSet& set) {
    Surface surface;
    for (const auto& arrow : set.arrows) {
        const Vector way = arrow.to_mm - arrow.from_mm;
        const double length = way.norm();
        if (!(length > 0)) continue;
        const double head = std::min(length, 5 * set.radius_mm), neck = length - head, wide = 2.4 * set.radius_mm;
        const double slope = wide / std::hypot(wide, head);
        const std::array<Ring, 7> profile = {{{0, 0, -1},
                                              {0, set.radius_mm, -1},
                                              {0, set.radius_mm, 0},
                                              {neck, set.radius_mm, 0},
                                              {neck, wide, -1},
                                              {neck, wide, slope},
                                              {length, 0, slope}}};
        add_revolution(surface, arrow.from_mm, way / length, profile);
    }
    return make_actor(surface.finish(), set.colour);
}

io::Image read_back(vtkRenderWindow& window, int width, int height, int supersampling) {
    vtkNew<vtkUnsignedCharArray> pixels;
    window.GetPixelData(0, 0, width * supersampling - 1, height * supersampling - 1, 0, pixels);
    io::Image image{width, height, {}};
    image.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const unsigned char* drawn = pixels->GetPointer(0);
    const auto s = static_cast<std::size_t>(supersampling);
    const std::size_t row_values = 3 * s * static_cast<std::size_t>(width);
    const unsigned count = static_cast<unsigned>(supersampling * supersampling);
    std::size_t out = 0;
    for (int row = height - 1; row >= 0; --row)  // OpenGL counts rows from below
        for (int col = 0; col < width; ++col)
            for (std::size_t channel = 0; channel < 3; ++channel) {
                unsigned sum = 0;
                for (std::size_t dy = 0; dy < s; ++dy)
                    for (std::size_t dx = 0; dx < s; ++dx)
                        sum += drawn[(static_cast<std::size_t>(row) * s + dy) * row_values +
                                     3 * (static_cast<std::size_t>(col) * s + dx) + channel];
                image.rgb[out++] = static_cast<std::uint8_t>((sum + count / 2) / count);
            }
    return image;
}

}  // namespace

Eigen::Matrix3d view_axes(const View& view) {
    const double yaw = view.yaw_deg * std::numbers::pi / 180, pitch = view.pitch_deg * std::numbers::pi / 180;
    const Vector towards(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
    const Vector right(std::cos(yaw), 0, -std::sin(yaw));
    Eigen::Matrix3d axes;
    axes << right.transpose(), towards.cross(right).transpose(), towards.transpose();
    return axes;
}

io::Image draw_panel(const Panel& panel, const PanelCamera& camera, const Figure& figure,
                     const std::array<double, 2>& scalar_range) {
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(unit_rgb(figure.background).data());
    renderer->AutomaticLightCreationOff();
    light_the_scene(*renderer);
    renderer->AddActor(face_actor(panel, scalar_range));
    const auto add_marks = [&](const vtkSmartPointer<vtkActor>& actor) {
        actor->GetProperty()->SetAmbient(0.35);
        actor->GetProperty()->SetDiffuse(0.75);
        actor->GetProperty()->SetSpecular(0.2);
        actor->GetProperty()->SetSpecularPower(25);
        renderer->AddActor(actor);
    };
    for (const auto& set : panel.markers) add_marks(marker_actor(set));
    for (const auto& set : panel.arrows) add_marks(arrow_actor(set));

    const Eigen::Matrix3d axes = view_axes(camera.view);
    constexpr double far_mm = 5000;  // orthographic: any distance beyond the face gives the same picture
    const Point eye = camera.centre_mm + far_mm * axes.row(2).transpose();
    vtkCamera& lens = *renderer->GetActiveCamera();
    lens.ParallelProjectionOn();
    lens.SetPosition(eye.x(), eye.y(), eye.z());
    lens.SetFocalPoint(camera.centre_mm.x(), camera.centre_mm.y(), camera.centre_mm.z());
    lens.SetViewUp(axes(1, 0), axes(1, 1), axes(1, 2));
    lens.SetParallelScale(0.5 * camera.mm_per_px * figure.panel_height_px);
    renderer->ResetCameraClippingRange();

    io::Image image;
    with_offscreen_window([&](vtkRenderWindow& window, const std::string&) {
        constexpr int samples_per_pixel = 8;  // the driver takes what it has; Mesa's software renderer gives 4
        window.SetMultiSamples(samples_per_pixel);
        window.SetSize(figure.panel_width_px * figure.supersampling, figure.panel_height_px * figure.supersampling);
        window.AddRenderer(renderer);
        window.Render();
        image = read_back(window, figure.panel_width_px, figure.panel_height_px, figure.supersampling);
        window.RemoveRenderer(renderer);
        renderer->ReleaseGraphicsResources(&window);
    });
    return image;
}

}  // namespace mimik::figures
