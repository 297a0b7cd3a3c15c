#include "io/texture_atlas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::io {
namespace {

using geometry::TextureCoordinate;

constexpr std::array<std::uint8_t, 3> skin = {204, 158, 135};
// Each image has copies of its border rows around it, so that a viewer that mixes neighbouring pixels stays inside.
constexpr int border = 8;

/// The image in another width, its heights to scale; the nearest pixel is taken.
Image widened(const Image& image, int width) {
    if (image.width == width) return image;
    Image wide;
    wide.width = width;
    wide.height = std::max(1, static_cast<int>(std::lround(static_cast<double>(image.height) * width / image.width)));
    wide.rgb.reserve(3 * static_cast<std::size_t>(wide.width) * static_cast<std::size_t>(wide.height));
    for (int row = 0; row < wide.height; ++row)
        for (int col = 0; col < wide.width; ++col) {
            const auto from = 3 * (static_cast<std::int64_t>(row) * image.height / wide.height * image.width +
                                   static_cast<std::int64_t>(col) * image.width / wide.width);
            wide.rgb.insert(wide.rgb.end(), image.rgb.begin() + from, image.rgb.begin() + from + 3);
        }
    return wide;
}

/// Where an image lies in the picture: rows from above, without its borders.
struct Place {
    int top = 0, height = 0;
};

class Stack {
public:
    explicit Stack(int width) { picture_.width = width; }

    Place add(const Image& image) {
        const Place place{picture_.height + border, image.height};
        for (int row = -border; row < image.height + border; ++row) {
            const auto from =
                image.rgb.begin() + std::ptrdiff_t{3} * image.width * std::clamp(row, 0, image.height - 1);
            picture_.rgb.insert(picture_.rgb.end(), from, from + std::ptrdiff_t{3} * image.width);
        }
        picture_.height += image.height + 2 * border;
        return place;
    }
    Place add_skin() {
        Image plain{picture_.width, 1, {}};
        for (int col = 0; col < plain.width; ++col) plain.rgb.insert(plain.rgb.end(), skin.begin(), skin.end());
        return add(plain);
    }
    Image take() { return std::move(picture_); }

private:
    Image picture_;
};

/// The least whole numbers that a face's positions lie above, as one position for all its corners.
TextureCoordinate square_of(const geometry::Mesh& mesh, std::size_t face) {
    TextureCoordinate sum = TextureCoordinate::Zero();
    const auto& faces = mesh.faces;
    for (auto k = faces.first[face]; k < faces.first[face + 1]; ++k)
        sum += mesh.texture_coordinates[faces.texture_corners[k]];
    return (sum / static_cast<double>(faces[face].size())).array().floor();
}

void check_size(std::span<const std::optional<Image>> images, int width) {
    constexpr double most_pixels = 1e8;
    double pixels = 0;
    for (const auto& image : images)
        if (image) pixels += static_cast<double>(image->height) * width / image->width * width;
    if (pixels > most_pixels)
        throw InputError(
            fmt::format("the images of the mesh have {:.0f} million pixels together, more than the 100 that "
                        "are drawn; scale them down",
                        pixels / 1e6));
}

}  // namespace

Image texture_atlas(geometry::Mesh& mesh, std::span<const std::optional<Image>> images,
                    std::span<const std::uint32_t> face_textures) {
    auto& faces = mesh.faces;
    int width = 1;
    for (const auto& image : images)
        if (image) width = std::max(width, image->width);
    check_size(images, width);
    Stack stack(width);
    const auto plain = stack.add_skin();
    std::vector<Place> places;
    for (const auto& image : images) places.push_back(image ? stack.add(widened(*image, width)) : plain);
    auto picture = stack.take();

    if (faces.texture_corners.empty()) faces.texture_corners = faces.corners;
    std::vector<TextureCoordinate> moved;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto texture = face_textures.empty() ? 0U : face_textures[f];
        const auto& place = texture < places.size() ? places[texture] : plain;
        const auto square = square_of(mesh, f);
        for (auto k = faces.first[f]; k < faces.first[f + 1]; ++k) {
            const TextureCoordinate uv = mesh.texture_coordinates[faces.texture_corners[k]] - square;
            const double v = std::clamp(uv.y(), 0.0, 1.0);
            const double row = place.top + (1.0 - v) * place.height;
            moved.emplace_back(std::clamp(uv.x(), 0.0, 1.0), 1.0 - row / picture.height);
            faces.texture_corners[k] = static_cast<std::uint32_t>(moved.size() - 1);
        }
    }
    mesh.texture_coordinates = std::move(moved);
    return picture;
}

}  // namespace mimik::io
