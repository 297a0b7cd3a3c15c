#include "report/named_figure.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "report/drawn_face.h"
#include "report/figure_album.h"
#include "report/figure_description.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/workspace_test.h"

namespace mimik::report {
namespace {

using database::message_of;
using testing::HasSubstr;
namespace fs = std::filesystem;

std::set<std::string> all_names() {
    std::set<std::string> names;
    for (const auto& figure : named_figures()) names.insert(figure.name);
    return names;
}

TEST(NamedFigures, every_figure_of_the_thesis_that_shows_data_has_a_name_once) {
    std::set<std::string> wanted = {"4-5", "4-6",  "5-2",  "5-3",  "5-4",       "5-5",       "5-6",       "5-8",
                                    "5-9", "5-10", "5-11", "5-12", "6-1",       "6-2",       "6-3",       "6-4",
                                    "6-5", "6-6",  "7-1",  "7-2",  "table-3-1", "table-3-2", "table-3-3", "table-5-7"};
    for (int k = 1; k <= 9; ++k) wanted.insert("A-" + std::to_string(k));
    const auto names = all_names();
    EXPECT_EQ(names.size(), named_figures().size());
    for (const auto& name : wanted) EXPECT_TRUE(names.contains(name)) << name;
    EXPECT_EQ(named_figures().front().name, "4-5");
}

TEST(NamedFigures, a_name_is_found_however_it_is_typed_and_what_is_left_out_says_why) {
    EXPECT_EQ(named_figure("6-4").name, "6-4");
    EXPECT_EQ(named_figure("fig-6-4").name, "6-4");
    EXPECT_EQ(named_figure("a-1").name, "A-1");
    EXPECT_EQ(file_stem(named_figure("A-1")), "fig-A-1");
    EXPECT_EQ(file_stem(named_figure("table-3-2")), "table-3-2");
    EXPECT_THAT(message_of([] { (void)named_figure("5-1"); }), HasSubstr("a flow chart"));
    for (const auto* name : {"1-1", "2-7", "3-6", "4-1", "fig-4-3", "4-8", "5-7"})
        EXPECT_THAT(message_of([&] { (void)named_figure(name); }), HasSubstr("is not made: ")) << name;
    EXPECT_THAT(message_of([] { (void)named_figure("4-9"); }), HasSubstr("is not known"));
    EXPECT_THAT(message_of([] { (void)named_figure("9-9"); }), HasSubstr("give one of 4-5, 4-6, 5-2"));
}

TEST(DrawnFaces, holes_and_cracks_are_filled_and_the_bays_of_the_rim_are_not) {
    geometry::QuadGrid grid;
    grid.rows = grid.cols = 20;
    for (int row = 0; row < 20; ++row)
        for (int col = 0; col < 20; ++col) grid.vertices_mm.emplace_back(col, row, 0);
    grid.origin.assign(400, geometry::VertexOrigin::measured);
    const auto bridge = [&](int row, int col) { grid.origin[grid.index(row, col)] = geometry::VertexOrigin::bridged; };
    bridge(10, 10);                                      // a hole
    for (int row = 17; row < 20; ++row) bridge(row, 2);  // a crack, one wide
    for (int row = 0; row < 2; ++row)
        for (int col = 3; col < 17; ++col) bridge(row, col);  // a bay, 14 wide
    EXPECT_EQ(drawn_surface(grid, HoleDrawing::fill).vertices_mm.size(), 400U - 28U);
    EXPECT_EQ(drawn_surface(grid, HoleDrawing::gap).vertices_mm.size(), 400U - 28U - 4U);
}

TEST(DrawnFaces, scraps_that_hang_on_nothing_are_left_out_of_the_largest_part) {
    geometry::QuadGrid grid;
    grid.rows = grid.cols = 20;
    for (int row = 0; row < 20; ++row)
        for (int col = 0; col < 20; ++col) grid.vertices_mm.emplace_back(col, row, 0);
    grid.origin.assign(400, geometry::VertexOrigin::measured);
    for (int row = 0; row < 20; ++row) grid.origin[grid.index(row, 3)] = geometry::VertexOrigin::outside;
    const auto whole = drawn_surface(grid, HoleDrawing::fill);
    ASSERT_EQ(whole.vertices_mm.size(), 20U * 19U);  // all but the column outside, which parts a scrap of 3 columns
    const auto part = largest_part(whole);
    EXPECT_EQ(part.vertices_mm.size(), 20U * 16U);
    EXPECT_EQ(part.colours.size(), part.vertices_mm.size());
    EXPECT_EQ(part.faces.size(), 19U * 15U);
    for (const auto& p : part.vertices_mm) EXPECT_GT(p.x(), 3.5);
    EXPECT_TRUE(largest_part(geometry::Mesh{}).vertices_mm.empty());
}

TEST(DrawnFaces, a_photograph_is_dark_in_an_open_mouth_and_untouched_elsewhere) {
    preprocessing::Face face;
    auto& grid = face.grid;
    grid.rows = grid.cols = 20;
    for (int row = 0; row < 20; ++row)
        for (int col = 0; col < 20; ++col) {
            grid.vertices_mm.emplace_back(col, row, 0);
            grid.texture_coordinates.emplace_back((col + 0.5) / 20, (row + 0.5) / 20);
        }
    grid.origin.assign(400, geometry::VertexOrigin::measured);
    const auto hole = [&](int first_row, int rows) {
        for (int row = first_row; row < first_row + rows; ++row)
            for (int col = 7; col < 13; ++col) grid.origin[grid.index(row, col)] = geometry::VertexOrigin::bridged;
    };
    hole(4, 4);   // between the lips
    hole(14, 4);  // an eye
    face.landmarks = geometry::Landmarks({{"mouth_corner_right", {3, 6, 0}, ""},
                                          {"mouth_corner_left", {16, 6, 0}, ""},
                                          {"upper_lip_outer", {10, 10, 0}, ""},
                                          {"lower_lip_outer", {10, 2, 0}, ""}});
    io::Image photograph{20, 20, std::vector<std::uint8_t>(1200, 200)};
    darken_open_mouth(photograph, face);
    // A pixel per vertex, row 0 of the grid is the picture's last; the quads that touch the hole are painted.
    int dark = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            const bool is_dark = photograph.rgb[static_cast<std::size_t>(3 * (20 * y + x))] < 100;
            dark += is_dark ? 1 : 0;
            if (is_dark) {
                EXPECT_TRUE(x >= 6 && x <= 13 && 19 - y >= 3 && 19 - y <= 8) << x << " " << y;
            }
        }
    EXPECT_EQ(dark, 8 * 6);
    for (int row = 5; row < 8; ++row)  // a hole of six vertices is no open mouth
        for (int col = 7; col < 13; ++col) grid.origin[grid.index(row, col)] = geometry::VertexOrigin::measured;
    io::Image closed{20, 20, std::vector<std::uint8_t>(1200, 200)};
    darken_open_mouth(closed, face);
    EXPECT_EQ(closed.rgb, std::vector<std::uint8_t>(1200, 200));
}

class FiguresOfAWorkspace : public test::WorkspaceTest<FiguresOfAWorkspace> {
protected:
    static NamedFigureOptions two_people() {
        NamedFigureOptions options;
        options.source = "bs000";
        options.female = options.male = "bs001";
        options.method = "sparse";  // quicker than the default: no template is bent
        return options;
    }
    static FigureCast cast_of(const NamedFigureOptions& options) {
        return FigureCast(*workspace_, facs::builtin_catalogue(), options);
    }
};

/// Share of the pixels of a rectangle that are not the page's white.
double drawn_share(const io::Image& image, int left, int top, int width, int height) {
    int drawn = 0;
    for (int row = top; row < top + height; ++row)
        for (int col = left; col < left + width; ++col) {
            const auto* rgb = &image.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                              static_cast<std::size_t>(col))];
            drawn += rgb[0] != 255 || rgb[1] != 255 || rgb[2] != 255 ? 1 : 0;
        }
    return static_cast<double>(drawn) / (width * height);
}

TEST_F(FiguresOfAWorkspace, two_people_make_a_page_of_six_faces_without_a_hole_in_any) {
    const FigureCast cast(*workspace_, facs::builtin_catalogue(), two_people());
    auto picture = named_figure("6-2").build(cast).picture;
    ASSERT_EQ(picture.panels.size(), 6U);
    EXPECT_EQ(picture.columns, 3);
    EXPECT_EQ(picture.dots_per_inch, 300);
    picture.panel_width_px = 200;  // quick to draw
    picture.panel_height_px = 240;
    picture.font_size_px = 12;
    const auto image = figures::render(picture);
    constexpr int margin = 6, line = 15;  // half a letter of 12 pixels; a line of the caption
    EXPECT_EQ(image.width, 3 * 200 + 4 * margin);
    EXPECT_GT(image.height, 2 * 240 + 2 * line);
    const int rows_end = image.height - 2 * line - margin;  // the second row's captions
    for (int col = 0; col < 3; ++col) {
        const int middle = margin + col * (200 + margin) + 100;
        // The nose and what is about it: a face of 200 pixels fills them, whatever the title's height.
        EXPECT_GT(drawn_share(image, middle - 30, rows_end - 120 - 30, 60, 60), 0.98) << col;
    }
}

TEST_F(FiguresOfAWorkspace, a_control_point_is_greater_than_a_landmark_that_it_may_lie_on) {
    const FigureCast cast(*workspace_, facs::builtin_catalogue(), two_people());
    const auto picture = named_figure("5-8").build(cast).picture;
    ASSERT_EQ(picture.panels.size(), 8U);
    for (const auto& panel : picture.panels) {
        ASSERT_EQ(panel.markers.size(), 2U) << panel.caption;
        EXPECT_EQ(panel.markers[0].name, "landmarks");
        // Both are marked to half a millimetre, so a landmark may stand out by that.
        EXPECT_GT(panel.markers[1].radius_mm, panel.markers[0].radius_mm + 0.5);
    }
}

TEST_F(FiguresOfAWorkspace, what_differs_is_captioned_otherwise_and_nobody_is_called_real) {
    const FigureCast cast = cast_of(two_people());
    const auto normalised = named_figure("5-6").build(cast).picture;
    std::set<std::string> captions;
    std::size_t panels = 0;
    for (const auto& panel : normalised.panels) {
        if (panel.mesh.vertices_mm.empty()) continue;
        captions.insert(panel.caption);
        ++panels;
    }
    EXPECT_EQ(captions.size(), panels);
    EXPECT_NE(named_figure("heat-map").build(cast).picture.title,
              named_figure("heat-map-signed").build(cast).picture.title);
    // A database that says nothing of its faces may hold modelled heads.
    const auto page = named_figure("6-2").build(cast);
    EXPECT_EQ(page.picture.panels[2].caption, "(c) Scan of the source face bs000");
    EXPECT_THAT(page.caption, testing::Not(HasSubstr("real")));
}

TEST_F(FiguresOfAWorkspace, landmarks_are_numbered_in_the_order_of_the_list) {
    const auto caption = named_figure("5-2").build(cast_of(two_people())).caption;
    std::size_t last = 0;
    for (const auto name : geometry::standard_landmark_names()) {
        const auto at = caption.find(std::string(" ") + std::string(name));
        if (at == std::string::npos) continue;
        EXPECT_GT(at, last) << name;
        last = at;
    }
    EXPECT_GT(last, 0U);
}

TEST_F(FiguresOfAWorkspace, an_expression_that_nobody_has_is_named_and_the_rest_is_made) {
    const FigureCast cast(*workspace_, facs::builtin_catalogue(), two_people());
    const fs::path folder = folder_->path() / "album";
    fs::create_directories(folder);
    const AlbumTools tools{.draw = [](const fs::path& description, const fs::path& picture) {
        (void)read_figure_description(description);  // whole, and everything that it names can be read
        base::write_atomically(picture, "drawn");
        return std::string();
    }};
    const auto entries =
        make_album(cast, {&named_figure("A-1"), &named_figure("6-2"), &named_figure("table-3-3")}, folder, tools);
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_THAT(entries[0].failure, HasSubstr("'1'"));
    EXPECT_TRUE(entries[0].files.empty());
    EXPECT_EQ(entries[1].failure, "");
    EXPECT_TRUE(fs::is_regular_file(folder / "fig-6-2.png"));
    EXPECT_TRUE(fs::is_regular_file(folder / "table-3-3.csv"));
    EXPECT_TRUE(fs::is_regular_file(folder / "table-3-3.tex"));
    EXPECT_FALSE(fs::exists(folder / "parts"));
    const auto captions = base::read_text(folder / "captions.md", 1 << 20);
    EXPECT_THAT(captions, HasSubstr("## A-1: Animation of AU1\n\nNot made: "));
    EXPECT_THAT(captions, HasSubstr("[fig-6-2.png](fig-6-2.png)"));
    const auto page = base::read_text(folder / "index.html", 1 << 20);
    EXPECT_THAT(page, HasSubstr("<img src=\"fig-6-2.png\""));
    EXPECT_THAT(page, HasSubstr("<a href=\"captions.md\">"));
    EXPECT_THAT(page, HasSubstr("<td>HAPPY</td><td>AU6 + AU12</td>"));
    EXPECT_THAT(page, testing::Not(HasSubstr("http")));  // nothing is asked of a network
}

TEST_F(FiguresOfAWorkspace, holes_are_filled_in_another_tone_marked_or_left) {
    auto grid = workspace_->face(workspace_->neutral("bs000")).grid;
    const auto middle = static_cast<std::size_t>(grid.index(grid.rows / 2, grid.cols / 2));
    ASSERT_TRUE(grid.measured(middle));
    const auto whole = drawn_surface(grid, HoleDrawing::gap);
    grid.origin[middle] = geometry::VertexOrigin::bridged;
    std::vector<std::uint32_t> kept;
    const auto filled = drawn_surface(grid, HoleDrawing::fill, geometry::Transform::Identity(), &kept);
    const auto place = static_cast<std::size_t>(
        std::find(kept.begin(), kept.end(), static_cast<std::uint32_t>(middle)) - kept.begin());
    ASSERT_LT(place, kept.size());
    EXPECT_NE(filled.colours[place], figures::skin);
    EXPECT_GT(figures::lightness(filled.colours[place]), figures::lightness(figures::skin));
    const auto marked = drawn_surface(grid, HoleDrawing::mark);
    EXPECT_NE(marked.colours[place], filled.colours[place]);
    const auto gap = drawn_surface(grid, HoleDrawing::gap);
    EXPECT_EQ(whole.faces.size(), gap.faces.size() + 4);  // the four cells about the vertex
}

TEST_F(FiguresOfAWorkspace, who_is_not_named_is_chosen_and_that_is_said) {
    NamedFigureOptions options;
    options.method = "sparse";
    const FigureCast cast(*workspace_, facs::builtin_catalogue(), options);
    EXPECT_NE(cast.source(), cast.female());
    EXPECT_NE(cast.source(), cast.male());
    EXPECT_THAT(cast.remarks(), testing::Contains(HasSubstr("the source is " + cast.source())));
    options.method = "mean";
    EXPECT_THAT(message_of([&] { (void)cast_of(options); }), HasSubstr("method is 'mean'"));
    options.method = "sparse";
    options.source = "nobody";
    EXPECT_THAT(message_of([&] { (void)cast_of(options); }), HasSubstr("nobody"));
}

TEST_F(FiguresOfAWorkspace, tables_have_the_rows_of_the_thesis) {
    const FigureCast cast(*workspace_, facs::builtin_catalogue(), two_people());
    const auto lines = [&](const std::string& name) {
        const auto csv = table_csv(named_figure(name).build(cast).table);
        return std::count(csv.begin(), csv.end(), '\n');
    };
    EXPECT_EQ(lines("table-3-1"), 1 + 23);  // 4 of the scalp, 4 of the eyelid, 5 of the nose, 9 of the mouth, the neck
    EXPECT_EQ(lines("table-3-2"), 1 + 33);
    EXPECT_EQ(lines("table-3-3"), 1 + 6);
    const auto csv = table_csv(named_figure("table-5-7").build(cast).table);
    EXPECT_THAT(csv, HasSubstr("AU,FACS name,muscular basis\n1,Inner Brow Raiser,\"frontalis, pars medialis\"\n"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 8);
    const auto latex = table_latex(named_figure("table-3-3").build(cast).table);
    EXPECT_THAT(latex, HasSubstr("ANGER & AU4 + AU5 + AU7 + AU23 + AU25 \\\\\n"));
}

}  // namespace
}  // namespace mimik::report
