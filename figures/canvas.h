#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "figures/colour_map.h"
#include "io/image.h"

namespace mimik::figures {

/// The flat part of a figure: a picture with text, bars and boxes set on whole pixels. (0, 0) is the upper left corner.
class Canvas {
public:
    Canvas(int width, int height, const Colour& background);

    void fill(int x, int y, int width, int height, const Colour& colour);
    void disc(double centre_x, double centre_y, double radius, const Colour& colour);
    void place(int x, int y, const io::Image& picture);  ///< must lie inside the canvas
    /// One line; `baseline_y` is the row the letters stand on. `anchor` 0: x is the left end, 0.5 the middle, 1 the
    /// right.
    void text(double x, int baseline_y, const std::string& line, int size_px, double anchor, const Colour& colour);
    /// The same with a thin white rim, so that it can be read on dark skin, too.
    void outlined_text(double x, int baseline_y, const std::string& line, int size_px, double anchor,
                       const Colour& colour);

    [[nodiscard]] const io::Image& image() const { return image_; }

private:
    [[nodiscard]] std::uint8_t* at(int x, int y);
    void blend(int x, int y, const Colour& colour, double cover);
    io::Image image_;
};

/// Width in pixels of one line of text.
[[nodiscard]] int text_width(const std::string& line, int size_px);
/// Breaks at spaces (and at '\n') so that no line is wider, except a single word that is wider by itself.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, int size_px, int width_px);

}  // namespace mimik::figures
