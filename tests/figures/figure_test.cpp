#include "figures/figure.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/figures/shapes.h"
#include "tests/support/thrown.h"

namespace mimik::figures {
namespace {

using io::Image;
using test::message_of;
using testing::HasSubstr;

std::size_t pixels_unlike(const Image& image, const Colour& colour) {
    std::size_t count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += pixel(image, x, y) != colour;
    return count;
}

TEST(Render, a_square_covers_its_own_pixels_and_no_others) {
    SKIP_WITHOUT_RENDERER();
    const Figure figure = figure_of({.mesh = square(100)});
    const Image image = render(figure);
    EXPECT_EQ(image.width, 200 + 2 * margin_px(figure));
    EXPECT_EQ(image.height, 200 + 2 * margin_px(figure));
    for (const double side : {-49.0, 0.0, 48.0}) {
        EXPECT_NE(at_mm(image, figure, side, 48), white);
        EXPECT_NE(at_mm(image, figure, 48, side), white);
    }
    for (const double side : {-60.0, 0.0, 60.0}) {
        EXPECT_EQ(at_mm(image, figure, side, 52), white);
        EXPECT_EQ(at_mm(image, figure, -52, side), white);
    }
    // The edges lie on pixel borders; a renderer may count one row of border pixels in or out.
    EXPECT_NEAR(static_cast<double>(pixels_unlike(image, white)), 100.0 * 100.0, 202);
}

TEST(Render, the_light_comes_from_above_on_the_left_of_the_image) {
    SKIP_WITHOUT_RENDERER();
    const Figure figure = figure_of({.mesh = sphere(90)});
    const Image image = render(figure);
    const double lit = lightness(at_mm(image, figure, -40, 45)), unlit = lightness(at_mm(image, figure, 45, -50));
    EXPECT_GT(lit, unlit + 0.15);
    EXPECT_EQ(at_mm(image, figure, 66, 66), white);  // 93 mm from the middle of a ball of 90 mm
    EXPECT_NE(at_mm(image, figure, 61, 61), white);  // 86 mm
}

TEST(Render, the_subjects_left_is_on_the_right_of_a_front_view) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(100)};
    panel.markers.push_back({"left", {0, 160, 0}, 8, {{30, 20, 0}}});
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    const Colour marked = at_mm(image, figure, 30, 20), plain = at_mm(image, figure, -30, 20);
    EXPECT_GT(marked[1], marked[0] + 60);
    EXPECT_LT(plain[1], plain[0]);
}

TEST(Render, a_profile_from_the_subjects_left_looks_to_the_left_of_the_image) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(60), .view = parse_view("left")};
    panel.markers.push_back({"nose", {0, 0, 220}, 8, {{0, 0, 40}}});  // in front of the face
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    EXPECT_NE(at_mm(image, figure, -40, 0), white);
    EXPECT_EQ(at_mm(image, figure, 40, 0), white);
    EXPECT_EQ(at_mm(image, figure, 20, 0), white);  // the square itself is seen edge on
}

TEST(Render, a_marker_behind_the_face_is_hidden) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(100)};
    const Image bare = render(figure_of(panel));
    panel.markers.push_back({"behind", {0, 160, 0}, 8, {{0, 0, -30}}});
    EXPECT_EQ(render(figure_of(panel)).rgb, bare.rgb);
}

TEST(Render, an_arrow_is_drawn_from_its_foot_to_its_tip) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(10)};
    panel.arrows.push_back({"displacement", {200, 0, 0}, 3, {{{-80, 60, 0}, {80, 60, 0}}}});
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    for (const double x : {-78.0, 0.0, 77.0}) EXPECT_NE(at_mm(image, figure, x, 60), white) << x;
    EXPECT_EQ(at_mm(image, figure, -83, 60), white);
    EXPECT_EQ(at_mm(image, figure, 83, 60), white);
    EXPECT_NE(at_mm(image, figure, 67, 64), white);  // the head is wider than the shaft
    EXPECT_EQ(at_mm(image, figure, 0, 64), white);
}

TEST(Render, a_texture_lies_with_u_to_the_right_and_v_up) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(160)};
    panel.texture = Image{2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};  // red green / blue white
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    const Colour red = at_mm(image, figure, -60, 60), green = at_mm(image, figure, 60, 60),
                 blue = at_mm(image, figure, -60, -60), bright = at_mm(image, figure, 60, -60);
    EXPECT_GT(red[0], 150);
    EXPECT_LT(red[1], 40);
    EXPECT_GT(green[1], 150);
    EXPECT_LT(green[2], 40);
    EXPECT_GT(blue[2], 150);
    EXPECT_LT(blue[0], 40);
    EXPECT_GT(std::min({bright[0], bright[1], bright[2]}), 150);
}

TEST(Render, a_texture_seam_is_cut_where_corners_have_their_own_coordinates) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(160, 3)};
    auto& mesh = panel.mesh;
    // Two colours: faces left of x = 0 take the picture's left half, those on the right its right half.
    panel.texture = Image{8, 1, {}};
    for (int k = 0; k < 8; ++k)
        for (const int value : {k < 4 ? 255 : 0, 0, k < 4 ? 0 : 255})
            panel.texture->rgb.push_back(static_cast<std::uint8_t>(value));
    mesh.texture_coordinates = {{0.25, 0.5}, {0.75, 0.5}};
    for (const std::uint32_t half : {0U, 1U, 0U, 1U})
        for (int corner = 0; corner < 4; ++corner) mesh.faces.texture_corners.push_back(half);
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    const Colour left = at_mm(image, figure, -3, 30), right = at_mm(image, figure, 3, 30);
    EXPECT_GT(left[0], left[2] + 100);
    EXPECT_GT(right[2], right[0] + 100);
}

TEST(Render, a_scalar_colours_the_face_and_gets_one_bar) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(160, 21)};
    geometry::VertexAttribute rise{"rise_mm", 1, {}};
    for (const auto& p : panel.mesh.vertices_mm) rise.values.push_back(p.x());
    panel.mesh.attributes.push_back(rise);
    const Image plain = render(figure_of(panel));
    panel.scalar = Scalar{.attribute = "rise_mm", .range = {{-80, 80}}};
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    EXPECT_GT(image.width, plain.width + 30);  // the bar
    EXPECT_GT(lightness(at_mm(image, figure, 70, 0)), lightness(at_mm(image, figure, 0, 0)) + 0.15);
    EXPECT_GT(lightness(at_mm(image, figure, 0, 0)), lightness(at_mm(image, figure, -70, 0)) + 0.15);

    Figure two = figure;
    two.panels.push_back(panel);
    EXPECT_EQ(render(two).width, image.width + 200 + margin_px(figure));
    two.panels[1].scalar->range = {{-10, 10}};  // another scale: each panel needs a bar
    EXPECT_GT(render(two).width, image.width + 200 + 40);
}

TEST(Render, a_vertex_without_a_value_is_grey) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(160)};
    panel.mesh.attributes.push_back({"d", 1, std::vector<double>(4, std::numeric_limits<double>::quiet_NaN())});
    panel.scalar = Scalar{.attribute = "d"};
    const Figure figure = figure_of(panel);
    const Colour middle = at_mm(render(figure), figure, 0, 0);
    EXPECT_EQ(middle[0], middle[1]);
    EXPECT_EQ(middle[1], middle[2]);
}

TEST(Render, faces_with_a_corner_that_is_not_finite_are_left_out) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(100, 3)};
    panel.mesh.vertices_mm[0].z() = std::numeric_limits<double>::quiet_NaN();  // lower corner on the image's left
    const Figure figure = figure_of(panel);
    const Image image = render(figure);
    EXPECT_EQ(at_mm(image, figure, -25, -25), white);
    EXPECT_NE(at_mm(image, figure, 25, -25), white);
    EXPECT_NE(at_mm(image, figure, -25, 25), white);
}

TEST(Render, a_cloud_without_faces_is_drawn_as_dots) {
    SKIP_WITHOUT_RENDERER();
    geometry::Mesh cloud;
    cloud.vertices_mm = {{-50, 0, 0}, {50, 0, 0}, {0, 0, std::numeric_limits<double>::infinity()}};
    const std::size_t drawn = pixels_unlike(render(figure_of({.mesh = cloud})), white);
    EXPECT_GE(drawn, 2U);
    EXPECT_LE(drawn, 2U * 16U);  // a dot of two pixels, not on the pixel grid
}

TEST(Render, a_caption_leaves_dark_letters_under_the_panel_and_only_there) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = square(100)});
    const Image bare = render(figure);
    figure.panels[0].caption = "(a) Neutral \xC3\xBC";
    const Image image = render(figure);
    ASSERT_GT(image.height, bare.height);
    const auto dark_in_row = [&](int y) {
        int dark = 0;
        for (int x = 0; x < image.width; ++x) dark += pixel(image, x, y)[0] < 100;
        return dark;
    };
    int dark = 0;
    for (int y = margin_px(figure) + 200; y < image.height; ++y) dark += dark_in_row(y);
    EXPECT_GT(dark, 100);
    for (int y = image.height - margin_px(figure) / 2; y < image.height; ++y) EXPECT_EQ(dark_in_row(y), 0);  // not cut
}

TEST(Render, a_long_caption_is_wrapped_and_not_cut_at_the_sides) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = square(100), .caption = "one line"});
    const int one_line = render(figure).height;
    figure.panels[0].caption = "a caption that is far too long for a panel of two hundred pixels";
    const Image image = render(figure);
    EXPECT_GT(image.height, one_line + figure.font_size_px);
    EXPECT_EQ(image.width, 200 + 2 * margin_px(figure));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < margin_px(figure); ++x) {
            ASSERT_EQ(pixel(image, x, y), white);
            ASSERT_EQ(pixel(image, image.width - 1 - x, y), white);
        }
}

TEST(Render, all_panels_have_one_scale) {
    SKIP_WITHOUT_RENDERER();
    Figure figure;
    figure.panels = {{.mesh = square(100)}, {.mesh = square(50)}};
    figure.panel_width_px = figure.panel_height_px = 208;  // 100 mm and 4 % of air: two pixels for each millimetre
    const Image image = render(figure);
    const int y = margin_px(figure) + 104;
    int first = 0, second = 0;
    for (int x = 0; x < image.width; ++x) (x < margin_px(figure) + 208 ? first : second) += pixel(image, x, y) != white;
    EXPECT_NEAR(first, 200, 2);
    EXPECT_NEAR(second, 100, 2);
}

TEST(Render, common_framing_keeps_a_motion_that_own_framing_takes_out) {
    SKIP_WITHOUT_RENDERER();
    auto moved = square(50);
    for (auto& p : moved.vertices_mm) p.y() += 40;
    Figure figure;
    figure.panels = {{.mesh = square(50)}, {.mesh = moved}};
    figure.panel_width_px = figure.panel_height_px = 100;
    const auto top_row = [&](const Image& image, int panel) {
        for (int y = 0; y < image.height; ++y)
            if (pixel(image, margin_px(figure) + 50 + panel * (100 + margin_px(figure)), y) != white) return y;
        return -1;
    };
    Image image = render(figure);
    EXPECT_EQ(top_row(image, 0), top_row(image, 1));
    figure.framing = Framing::common;
    image = render(figure);
    EXPECT_GT(top_row(image, 0), top_row(image, 1) + 30);  // 40 mm where 93.6 mm are 100 pixels
}

TEST(Render, a_scale_bar_has_its_length) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = square(20)});
    figure.scale_bar_mm = 50;
    const Image image = render(figure);
    int longest = 0;
    for (int y = margin_px(figure) + 200; y < image.height; ++y) {
        int dark = 0;
        for (int x = 2 * margin_px(figure); x < image.width && pixel(image, x, y)[0] < 60; ++x) ++dark;
        longest = std::max(longest, dark);
    }
    EXPECT_EQ(longest, 50);
}

TEST(Render, a_scale_bar_and_its_label_touch_no_face_however_wide) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = square(190), .caption = "face"});
    const Image without = render(figure);
    figure.scale_bar_mm = 50;
    const Image with = render(figure);
    const int foot = margin_px(figure) + 200, added = with.height - without.height;
    ASSERT_GT(added, 8);  // the strip: the letters are 9 pixels high at least
    for (int y = 0; y < without.height; ++y)
        for (int x = 0; x < without.width; ++x)
            ASSERT_EQ(pixel(with, x, y < foot ? y : y + added), pixel(without, x, y)) << x << ", " << y;
}

TEST(Render, a_scale_bar_and_its_label_stay_on_the_page_and_a_longer_bar_is_refused) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = square(190)});
    double longest_mm = 0;
    for (const double length_mm : {20.0, 150.0, 180.0}) {
        figure.scale_bar_mm = length_mm;
        const Image image = render(figure);
        const int margin = margin_px(figure);
        for (int y = margin + 200; y < image.height; ++y)
            for (int x = image.width - margin; x < image.width; ++x)
                ASSERT_EQ(pixel(image, x, y), pixel(image, 0, 0)) << length_mm << ": " << x << ", " << y;
        longest_mm = length_mm;
    }
    figure.scale_bar_mm = 2 * longest_mm;
    EXPECT_THAT([&] { (void)render(figure); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("scale_bar_mm is 360"), HasSubstr("give a shorter bar"))));
}

TEST(Render, a_legend_adds_a_line_with_the_colours_of_the_sets) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(100)};
    panel.markers = {{"landmarks", landmark_colour, 2, {}}, {"muscle controls", muscle_colour, 2, {}}};
    Figure figure = figure_of(panel);
    const Image without = render(figure);
    figure.legend = true;
    const Image with = render(figure);
    EXPECT_GT(with.height, without.height);
    std::size_t blue = 0, red = 0;
    for (int y = without.height; y < with.height; ++y)
        for (int x = 0; x < with.width; ++x) {
            blue += pixel(with, x, y) == landmark_colour;
            red += pixel(with, x, y) == muscle_colour;
        }
    EXPECT_GT(blue, 20U);
    EXPECT_GT(red, 20U);
}

TEST(Render, a_number_beside_a_marker_has_a_white_rim_on_dark_skin) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = square(100)};
    panel.mesh.colours.assign(4, {40, 30, 30});
    panel.markers = {{"landmarks", landmark_colour, 2, {geometry::Point(10, 10, 1)}}};
    const auto whites = [](const Figure& figure) {
        const Image image = render(figure);
        int count = 0;
        for (int side = -40; side < 40; ++side)
            for (int up = -40; up < 40; ++up) count += at_mm(image, figure, side, up) == white;
        return count;
    };
    EXPECT_EQ(whites(figure_of(panel)), 0);
    panel.markers[0].numbered = true;
    EXPECT_GT(whites(figure_of(panel)), 10);  // the rim of a '1' of 13 pixels
}

TEST(Render, an_empty_panel_is_a_gap) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = square(100)});
    figure.panels.insert(figure.panels.begin(), Panel{});
    const Image image = render(figure);
    EXPECT_EQ(image.width, 400 + 3 * margin_px(figure));
    for (int x = 0; x < margin_px(figure) + 200; ++x) ASSERT_EQ(pixel(image, x, image.height / 2), white);
    EXPECT_NE(pixel(image, 300 + 2 * margin_px(figure), image.height / 2), white);
}

TEST(Render, the_same_figure_gives_the_same_bytes_from_any_thread) {
    SKIP_WITHOUT_RENDERER();
    Panel panel{.mesh = sphere(80), .caption = "ball", .view = parse_view("three-quarter")};
    panel.markers.push_back({"pole", muscle_colour, 4, {{0, 80, 0}}});
    Figure figure = figure_of(panel);
    figure.supersampling = 2;
    const Image first = render(figure);
    EXPECT_EQ(render(figure).rgb, first.rgb);
    Image from_thread;
    std::thread([&] { from_thread = render(figure); }).join();
    EXPECT_EQ(from_thread.rgb, first.rgb);
}

TEST(Render, what_was_drawn_before_leaves_no_trace) {
    SKIP_WITHOUT_RENDERER();
    const Figure small = figure_of({.mesh = square(100)});
    const Image first = render(small);
    Figure other = figure_of({.mesh = sphere(90)});
    other.panel_width_px = 333;
    other.background = {0, 0, 0};
    (void)render(other);
    EXPECT_EQ(render(small).rgb, first.rgb);
}

TEST(Render, supersampling_smooths_an_edge_and_keeps_the_size) {
    SKIP_WITHOUT_RENDERER();
    Figure figure = figure_of({.mesh = sphere(90)});
    const Image plain = render(figure);
    figure.supersampling = 3;
    const Image smooth = render(figure);
    EXPECT_EQ(smooth.width, plain.width);
    EXPECT_EQ(smooth.height, plain.height);
    EXPECT_NE(smooth.rgb, plain.rgb);
}

TEST(FigureCheck, errors_name_the_panel_and_the_value) {
    Figure figure;
    EXPECT_THAT(message_of([&] { figure.check(); }), HasSubstr("no panel"));
    figure.panels = {{.mesh = square(10)}, {.mesh = square(10), .caption = "second"}};
    EXPECT_EQ(message_of([&] { figure.check(); }), "nothing was thrown");

    const auto broken = [&](const auto& break_it) {
        Figure bad = figure;
        break_it(bad);
        return message_of([&] { bad.check(); });
    };
    EXPECT_THAT(broken([](Figure& f) { f.panels[1].mesh.faces.corners[0] = 77; }),
                AllOf(HasSubstr("panel 2 ('second')"), HasSubstr("corner 77"), HasSubstr("4 vertices")));
    EXPECT_THAT(broken([](Figure& f) { f.panel_width_px = 5; }), HasSubstr("panel_width_px is 5"));
    EXPECT_THAT(broken([](Figure& f) { f.supersampling = 9; }), HasSubstr("supersampling is 9"));
    EXPECT_THAT(broken([](Figure& f) { f.panels[0].view.pitch_deg = 90; }), HasSubstr("pitch_deg is 90"));
    EXPECT_THAT(broken([](Figure& f) {
                    f.panels[0].markers = {{"marks", landmark_colour, -1, {}}};
                }),
                HasSubstr("'marks': radius_mm is -1"));
    EXPECT_THAT(broken([](Figure& f) {
                    f.panels[0].texture = io::Image{1, 1, {0, 0, 0}};
                    f.panels[0].mesh.texture_coordinates.clear();
                }),
                HasSubstr("no texture coordinates"));
    EXPECT_THAT(broken([](Figure& f) {
                    f.panels[0].scalar = Scalar{.attribute = "d", .range = {{2, 2}}};
                }),
                HasSubstr("range is 2 to 2"));
}

TEST(FigureCheck, a_missing_attribute_is_reported_with_those_there_are) {
    Figure figure = figure_of({.mesh = square(10)});
    figure.panels[0].mesh.attributes.push_back({"distance_mm", 1, {0, 0, 0, 0}});
    figure.panels[0].scalar = Scalar{.attribute = "distance"};
    EXPECT_THAT(message_of([&] { (void)render(figure); }),
                AllOf(HasSubstr("no attribute 'distance'"), HasSubstr("it has: distance_mm")));
}

TEST(FigureCheck, a_page_too_large_to_keep_is_refused_before_it_is_drawn) {
    Figure figure = figure_of({.mesh = square(10)});
    figure.panel_width_px = figure.panel_height_px = 8000;
    figure.panels.push_back(figure.panels[0]);
    EXPECT_THAT(message_of([&] { (void)render(figure); }), HasSubstr("pixels; give smaller or fewer panels"));
}

TEST(View, an_unknown_name_is_refused_with_the_names_there_are) {
    EXPECT_THAT(message_of([] { (void)parse_view("above"); }),
                AllOf(HasSubstr("'above'"), HasSubstr("three-quarter-left")));
    EXPECT_EQ(parse_view("front").yaw_deg, 0);
    EXPECT_EQ(parse_view("right").yaw_deg, -90);
    EXPECT_GT(parse_view("three-quarter").yaw_deg, 0);
    EXPECT_THAT(message_of([] { (void)parse_framing("tight"); }), HasSubstr("'tight'"));
}

TEST(DrawingRoute, is_named) {
    SKIP_WITHOUT_RENDERER();
    EXPECT_THAT(drawing_route(), testing::AnyOf(HasSubstr("EGL"), HasSubstr("X display"), HasSubstr("Xvfb")));
}

}  // namespace
}  // namespace mimik::figures
