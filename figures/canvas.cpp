#include "figures/canvas.h"

// VTK 9.1 drops every letter beyond ASCII from plain strings; the class that keeps them is the one it calls deprecated.
#define VTK_DEPRECATION_LEVEL 0

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkTextProperty.h>
#include <vtkUnicodeString.h>

#include "base/file.h"

namespace mimik::figures {
namespace {

constexpr int dots_per_inch = 72;  // a font size of one point is then one pixel

vtkFreeTypeTools& free_type() {
    vtkFreeTypeTools& tools = *vtkFreeTypeTools::GetInstance();
    tools.ScaleToPowerTwoOff();
    return tools;
}

void set_font(vtkTextProperty& property, int size_px) {
    // DejaVu has every letter a caption may need; the font that VTK carries inside itself has few beyond ASCII.
    constexpr const char* dejavu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    static const bool has_dejavu = base::is_there(dejavu);
    property.SetFontFamily(has_dejavu ? VTK_FONT_FILE : VTK_ARIAL);
    if (has_dejavu) property.SetFontFile(dejavu);
    property.SetFontSize(size_px);
    property.SetColor(0, 0, 0);
    property.SetJustificationToLeft();
    property.SetVerticalJustificationToBottom();
}

/// Bytes that are no UTF-8 are shown as '?': a wrong letter in a caption must not cost the figure.
vtkUnicodeString letters_of(const std::string& line) {
    if (vtkUnicodeString::is_utf8(line)) return vtkUnicodeString::from_utf8(line);
    std::string plain = line;
    for (auto& c : plain)
        if (static_cast<unsigned char>(c) > 126) c = '?';
    return vtkUnicodeString::from_utf8(plain);
}

/// Left, right, lowest and highest pixel of a line whose pen starts at (0, 0).
std::array<int, 4> text_box(const std::string& line, int size_px) {
    std::array<int, 4> box{};
    if (line.empty()) return box;
    vtkNew<vtkTextProperty> property;
    set_font(*property, size_px);
    if (!free_type().GetBoundingBox(property, letters_of(line), dots_per_inch, box.data())) return {0, -1, 0, -1};
    return box;
}

}  // namespace

Canvas::Canvas(int width, int height, const Colour& background) {
    image_.width = width;
    image_.height = height;
    image_.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    fill(0, 0, width, height, background);
}

std::uint8_t* Canvas::at(int x, int y) {
    return image_.rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x));
}

void Canvas::blend(int x, int y, const Colour& colour, double cover) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    std::uint8_t* pixel = at(x, y);
    for (std::size_t k = 0; k < 3; ++k)
        pixel[k] = static_cast<std::uint8_t>(std::lround(pixel[k] + cover * (colour[k] - pixel[k])));
}

void Canvas::fill(int x, int y, int width, int height, const Colour& colour) {
    const int left = std::max(x, 0), right = std::min(x + width, image_.width);
    for (int row = std::max(y, 0); row < std::min(y + height, image_.height); ++row)
        for (int col = left; col < right; ++col) std::copy(colour.begin(), colour.end(), at(col, row));
}

void Canvas::disc(double centre_x, double centre_y, double radius, const Colour& colour) {
    for (int row = static_cast<int>(centre_y - radius) - 1; row <= centre_y + radius + 1; ++row)
        for (int col = static_cast<int>(centre_x - radius) - 1; col <= centre_x + radius + 1; ++col)
            blend(col, row, colour,
                  std::clamp(radius + 0.5 - std::hypot(col + 0.5 - centre_x, row + 0.5 - centre_y), 0.0, 1.0));
}

void Canvas::place(int x, int y, const io::Image& picture) {
    for (int row = 0; row < picture.height; ++row) {
        const auto first = picture.rgb.begin() + std::ptrdiff_t{3} * row * picture.width;
        std::copy_n(first, 3 * picture.width, at(x, y + row));
    }
}

void Canvas::text(double x, int baseline_y, const std::string& line, int size_px, double anchor, const Colour& colour) {
    if (line.empty()) return;
    vtkNew<vtkTextProperty> property;
    set_font(*property, size_px);
    vtkNew<vtkImageData> letters;
    std::array<int, 2> size{};
    if (!free_type().RenderString(property, letters_of(line), dots_per_inch, letters, size.data())) return;
    const auto box = text_box(line, size_px);
    std::array<int, 6> extent{};
    letters->GetExtent(extent.data());
    const int left = static_cast<int>(std::lround(x - anchor * (box[1] - box[0] + 1)));
    for (int row = extent[2]; row <= extent[3]; ++row)
        for (int col = extent[0]; col <= extent[1]; ++col) {
            const auto* rgba = static_cast<const unsigned char*>(letters->GetScalarPointer(col, row, 0));
            blend(left + col - extent[0], baseline_y - row, colour, rgba[3] / 255.0);
        }
}

void Canvas::outlined_text(double x, int baseline_y, const std::string& line, int size_px, double anchor,
                           const Colour& colour) {
    constexpr Colour white = {255, 255, 255};
    const int rim_px = std::max(1, size_px / 12);
    for (const int across : {-rim_px, 0, rim_px})
        for (const int up : {-rim_px, 0, rim_px})
            if (across != 0 || up != 0) text(x + across, baseline_y - up, line, size_px, anchor, white);
    text(x, baseline_y, line, size_px, anchor, colour);
}

int text_width(const std::string& line, int size_px) {
    const auto box = text_box(line, size_px);
    return line.empty() ? 0 : box[1] - box[0] + 1;
}

std::vector<std::string> wrapped(const std::string& text, int size_px, int width_px) {
    std::vector<std::string> lines;
    std::istringstream paragraphs(text);
    for (std::string paragraph; std::getline(paragraphs, paragraph);) {
        std::istringstream words(paragraph);
        std::string line;
        for (std::string word; words >> word;) {
            std::string longer = line;
            if (!line.empty()) longer += ' ';
            longer += word;
            if (!line.empty() && text_width(longer, size_px) > width_px) {
                lines.push_back(line);
                line = word;
            } else {
                line = longer;
            }
        }
        lines.push_back(line);
    }
    return lines;
}

}  // namespace mimik::figures
