#include "report/figure_description.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "database/bnt.h"
#include "io/mesh_io.h"
#include "tests/figures/shapes.h"
#include "tests/support/thrown.h"

namespace mimik::report {

using figures::Colour;
using figures::ColourMap;
using figures::Figure;
using figures::Framing;
using figures::muscle_colour;
using figures::Panel;
using figures::wrinkle_colour;

namespace {

using geometry::Point;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

FigureDescription decoded(const std::string& json) { return decode_figure_description(json, "fig.json", "folder"); }
std::string error_in(const std::string& json) {
    return message_of([&] { (void)decoded(json); });
}

TEST(FigureDescription, every_key_reaches_its_field) {
    const auto d = decoded(R"json({
        "schema": 1, "title": "T", "columns": 2, "panel_width_px": 300, "panel_height_px": 310, "font_size_px": 21,
        "background": "#102030", "framing": "common", "height_mm": 180, "scale_bar_mm": 50, "legend": true,
        "supersampling": 2, "view": "left",
        "panels": [
            {"mesh": "a.ply", "unit": "cm", "texture": "a.png", "landmarks": "l.csv", "controls": "c.csv",
             "arrows": "d.csv", "caption": "(a)", "view": {"yaw_deg": 10, "pitch_deg": -5}, "centre_mm": [1, 2, 3],
             "markers": [{"file": "m.csv", "name": "anchors", "colour": "#ff0000", "radius_mm": 3}],
             "scalar": {"attribute": "distance_mm", "label": "distance, mm", "range": [0, 5], "colour_map": "diverging"}},
            {"caption": "gap", "textured": true}]})json");
    EXPECT_EQ(d.page.title, "T");
    EXPECT_EQ(d.page.columns, 2);
    EXPECT_EQ(d.page.panel_width_px, 300);
    EXPECT_EQ(d.page.panel_height_px, 310);
    EXPECT_EQ(d.page.font_size_px, 21);
    EXPECT_EQ(d.page.background, (Colour{16, 32, 48}));
    EXPECT_EQ(d.page.framing, Framing::common);
    EXPECT_EQ(d.page.height_mm, 180);
    EXPECT_EQ(d.page.scale_bar_mm, 50);
    EXPECT_TRUE(d.page.legend);
    EXPECT_EQ(d.page.supersampling, 2);
    ASSERT_EQ(d.panels.size(), 2U);
    const auto& a = d.panels[0];
    EXPECT_EQ(a.mesh, fs::path("folder/a.ply"));
    EXPECT_EQ(a.unit, io::LengthUnit::centimetre);
    EXPECT_EQ(a.texture, fs::path("folder/a.png"));
    EXPECT_EQ(a.landmarks, fs::path("folder/l.csv"));
    EXPECT_EQ(a.controls, fs::path("folder/c.csv"));
    EXPECT_EQ(a.arrows, fs::path("folder/d.csv"));
    EXPECT_EQ(a.caption, "(a)");
    EXPECT_EQ(a.view.yaw_deg, 10);
    EXPECT_EQ(a.view.pitch_deg, -5);
    EXPECT_EQ(a.centre_mm, Point(1, 2, 3));
    ASSERT_EQ(a.markers.size(), 1U);
    EXPECT_EQ(a.markers[0].file, fs::path("folder/m.csv"));
    EXPECT_EQ(a.markers[0].name, "anchors");
    EXPECT_EQ(a.markers[0].colour, (Colour{255, 0, 0}));
    EXPECT_EQ(a.markers[0].radius_mm, 3);
    ASSERT_TRUE(a.scalar);
    EXPECT_EQ(a.scalar->attribute, "distance_mm");
    EXPECT_EQ(a.scalar->label, "distance, mm");
    EXPECT_EQ(a.scalar->range, (std::array{0.0, 5.0}));
    EXPECT_EQ(a.scalar->map, ColourMap::diverging);
    EXPECT_TRUE(d.panels[1].mesh.empty());
    EXPECT_TRUE(d.panels[1].textured);
    EXPECT_EQ(d.panels[1].view.yaw_deg, 90);  // the view of the whole figure
}

TEST(FigureDescription, errors_name_the_file_the_key_and_the_value) {
    EXPECT_THAT(error_in("{"), AllOf(HasSubstr("fig.json"), HasSubstr("byte 2: the JSON is damaged")));
    EXPECT_THAT(error_in("[]"), HasSubstr("fig.json: is not an object"));
    EXPECT_THAT(error_in(R"({"panels": []})"), HasSubstr("'schema' is missing"));
    EXPECT_THAT(error_in(R"({"schema": 2, "panels": []})"), HasSubstr("schema is 2"));
    EXPECT_THAT(error_in(R"({"schema": 1})"), HasSubstr("'panels' is missing"));
    EXPECT_THAT(error_in(R"({"schema": 1, "colums": 2, "panels": []})"),
                AllOf(HasSubstr("'colums' is not known"), HasSubstr("columns")));
    EXPECT_THAT(error_in(R"({"schema": 1, "columns": "two", "panels": []})"),
                AllOf(HasSubstr("fig.json: columns"), HasSubstr("\"two\"")));
    const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [], "title": )" + deep + "}"),
                HasSubstr("fig.json: the JSON nests deeper than 32 levels"));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [], "title": ["a"]})"), HasSubstr("title: a list has the wrong"));
    EXPECT_THAT(error_in(R"({"schema": 1, "columns": 1.5, "panels": []})"), HasSubstr("1.5 is not a whole number"));
    EXPECT_THAT(error_in(R"({"schema": 1, "columns": 5000000000, "panels": []})"), HasSubstr("out of range"));
    EXPECT_THAT(error_in(R"({"schema": 1, "background": "white", "panels": []})"),
                AllOf(HasSubstr("background"), HasSubstr("'white'")));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [{}, {"radius": 3}]})"),
                HasSubstr("fig.json: panels[1]: the key 'radius' is not known"));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [{"view": "above"}]})"),
                AllOf(HasSubstr("panels[0].view"), HasSubstr("'above'")));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [{"centre_mm": [1, 2]}]})"),
                AllOf(HasSubstr("panels[0].centre_mm"), HasSubstr("3 numbers")));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [{"scalar": {"range": [0, 1]}}]})"),
                HasSubstr("panels[0].scalar: 'attribute' is missing"));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [{"markers": [{"name": "x"}]}]})"),
                HasSubstr("panels[0].markers[0]: 'file' is missing"));
    EXPECT_THAT(error_in(R"({"schema": 1, "panels": [{"unit": "ell"}]})"),
                AllOf(HasSubstr("panels[0].unit"), HasSubstr("ell")));
}

TEST(FigureTables, errors_name_file_line_column_and_value) {
    const auto controls = [](const std::string& text) {
        return message_of([&] { (void)decode_controls(text, "c.csv", io::LengthUnit::millimetre); });
    };
    EXPECT_EQ(controls("x,y,z,kind\n1,2,3,muscle\n"), "nothing was thrown");
    EXPECT_THAT(controls("x,y,z,kind\n1,nan,3,muscle\n"), HasSubstr("c.csv: line 2: y is 'nan'"));
    EXPECT_THAT(controls("x,y,z,kind\n1,2,3,bone\n"), HasSubstr("c.csv: line 2: kind is 'bone'"));
    std::string arrows = "x,y,z,to_x,to_y,to_z\n";
    for (int k = 0; k < 100'001; ++k) arrows += "0,0,0,1,1,1\n";
    EXPECT_THAT(message_of([&] { (void)decode_arrows(arrows, "a.csv", io::LengthUnit::millimetre); }),
                HasSubstr("a.csv: line 100002: more than 100000 lines"));
}

/// A folder of its own that goes away with the test.
class LoadFigure : public testing::Test {
protected:
    LoadFigure() { fs::create_directories(folder_); }
    ~LoadFigure() override { fs::remove_all(folder_); }
    fs::path written(const std::string& name, const std::string& text) const {
        base::write_atomically(folder_ / name, text);
        return folder_ / name;
    }
    fs::path folder_ = fs::path(testing::TempDir()) /
                       ("mimik_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(LoadFigure, reads_what_the_description_names_beside_it) {
    io::write_mesh(folder_ / "face.ply", figures::square(10));
    io::write_png(folder_ / "skin.png", io::Image{1, 1, {200, 150, 120}});
    (void)written("marks.csv", "name,x,y,z\nnose_tip,0.1,0.2,0.3\n");
    (void)written("controls.csv", "name,x,y,z,kind\na,1,0,0,muscle\nb,0,1,0,wrinkle\nc,0,0,1,muscle\n");
    (void)written("moves.csv", "x,y,z,to_x,to_y,to_z\n0,0,0,0.5,0,0\n");
    const auto file = written("fig.json", R"({"schema": 1, "panels": [{"mesh": "face.ply", "unit": "cm",
        "texture": "skin.png", "landmarks": "marks.csv", "controls": "controls.csv", "arrows": "moves.csv"}, {}]})");
    const Figure figure = load_figure(read_figure_description(file));
    ASSERT_EQ(figure.panels.size(), 2U);
    const Panel& panel = figure.panels[0];
    EXPECT_EQ(panel.mesh.vertices_mm.at(3), Point(50, 50, 0));  // centimetres became millimetres
    ASSERT_TRUE(panel.texture);
    EXPECT_EQ(panel.texture->rgb, (std::vector<std::uint8_t>{200, 150, 120}));
    ASSERT_EQ(panel.markers.size(), 3U);
    EXPECT_EQ(panel.markers[0].name, "landmarks");
    EXPECT_TRUE(panel.markers[0].positions_mm.at(0).isApprox(Point(1, 2, 3)));
    EXPECT_EQ(panel.markers[1].colour, muscle_colour);
    EXPECT_EQ(panel.markers[1].positions_mm, (std::vector<Point>{{10, 0, 0}, {0, 0, 10}}));
    EXPECT_EQ(panel.markers[2].colour, wrinkle_colour);
    EXPECT_EQ(panel.markers[2].positions_mm, (std::vector<Point>{{0, 10, 0}}));
    ASSERT_EQ(panel.arrows.size(), 1U);
    EXPECT_EQ(panel.arrows[0].arrows.at(0).to_mm, Point(5, 0, 0));
    EXPECT_TRUE(figure.panels[1].mesh.vertices_mm.empty());
}

TEST_F(LoadFigure, joins_the_lattice_of_a_scan_but_not_across_holes_and_jumps) {
    geometry::RangeScan scan;
    scan.rows = scan.cols = 4;
    for (int row = 0; row < 4; ++row)
        for (int col = 0; col < 4; ++col) {
            scan.points_mm.emplace_back(col, row, col == 3 ? -40 : 0);  // the last column lies far behind
            scan.texture_coordinates.emplace_back(col / 3.0, row / 3.0);
        }
    scan.points_mm[0] = Point::Constant(std::numeric_limits<double>::quiet_NaN());
    database::write_bnt(folder_ / "scan.bnt", database::to_bnt(scan));
    const Figure figure = load_figure({.panels = {{.mesh = folder_ / "scan.bnt"}}});
    // 9 cells, less 3 at the jump, less the one with the hole.
    EXPECT_EQ(figure.panels[0].mesh.faces.size(), 5U);
    EXPECT_NO_THROW(figure.check());
}

TEST_F(LoadFigure, a_unit_scales_a_scan_as_it_scales_a_mesh_and_faults_name_the_file) {
    geometry::RangeScan scan;
    scan.rows = scan.cols = 2;
    scan.points_mm = {Point(0, 0, 0), Point(0.1, 0, 0), Point(0, 0.2, 0), Point(0.1, 0.2, 0.3)};
    database::write_bnt(folder_ / "scan.bnt", database::to_bnt(scan));
    const PanelDescription in_cm{.mesh = folder_ / "scan.bnt", .unit = io::LengthUnit::centimetre};
    EXPECT_EQ(load_figure({.panels = {in_cm}}).panels[0].mesh.vertices_mm[3], 10 * scan.points_mm[3]);
    scan.points_mm[3].z() = 1e300;
    database::write_bnt(folder_ / "far.bnt", database::to_bnt(scan));
    EXPECT_THAT(message_of([&] { (void)load_figure({.panels = {{.mesh = folder_ / "far.bnt"}}}); }),
                HasSubstr("far.bnt: z of row 1, column 1"));
}

TEST_F(LoadFigure, the_scan_and_the_photograph_of_a_hidden_subject_are_refused) {
    fs::create_directories(folder_ / "bs000");
    io::write_mesh(folder_ / "bs000" / "face.ply", figures::square(10));
    io::write_mesh(folder_ / "face.ply", figures::square(10));
    EXPECT_NO_THROW((void)load_figure({.panels = {{.mesh = folder_ / "bs000" / "face.ply"}}}));
    (void)written("Unallowed_subjects.txt", "BS000\n");
    EXPECT_THAT(message_of([&] { (void)load_figure({.panels = {{.mesh = folder_ / "bs000" / "face.ply"}}}); }),
                HasSubstr("subject 'bs000' stands in"));
    EXPECT_THAT(
        message_of([&] {
            (void)load_figure({.panels = {{.mesh = folder_ / "face.ply", .texture = folder_ / "bs000" / "face.png"}}});
        }),
        HasSubstr("subject 'bs000' stands in"));
    EXPECT_NO_THROW((void)load_figure({.panels = {{.mesh = folder_ / "face.ply"}}}));
}

TEST_F(LoadFigure, an_unknown_kind_of_control_is_refused_with_its_line) {
    io::write_mesh(folder_ / "face.ply", figures::square(10));
    const auto controls = written("controls.csv", "name,x,y,z,kind\na,1,0,0,muscle\nb,0,1,0,bone\n");
    const std::string error =
        message_of([&] { (void)load_figure({.panels = {{.mesh = folder_ / "face.ply", .controls = controls}}}); });
    EXPECT_THAT(error, AllOf(HasSubstr("controls.csv"), HasSubstr("3"), HasSubstr("'bone'")));
}

TEST_F(LoadFigure, a_missing_file_and_a_missing_texture_are_named) {
    EXPECT_THAT(message_of([&] { (void)load_figure({.panels = {{.mesh = folder_ / "none.ply"}}}); }),
                HasSubstr("none.ply"));
    io::write_mesh(folder_ / "face.ply", figures::square(10));
    EXPECT_THAT(message_of([&] { (void)load_figure({.panels = {{.mesh = folder_ / "face.ply", .textured = true}}}); }),
                AllOf(HasSubstr("face.ply"), HasSubstr("no texture")));
}

TEST_F(LoadFigure, a_texture_name_that_cannot_be_used_is_an_error_only_where_it_is_used) {
    (void)written("face.obj", "mtllib face.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    (void)written("face.mtl", "newmtl skin\nmap_Kd C:\\scans\\face.jpg\n");
    geometry::RangeScan scan;
    scan.rows = scan.cols = 2;
    scan.points_mm = {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(1, 1, 0)};
    auto bnt = database::to_bnt(scan);
    bnt.texture_file = "../x.png";
    database::write_bnt(folder_ / "face.bnt", bnt);
    io::write_png(folder_ / "skin.png", io::Image{1, 1, {200, 150, 120}});
    for (const auto& [name, texture] : {std::pair{"face.obj", "'C:"}, {"face.bnt", "'../x.png'"}}) {
        PanelDescription panel{.mesh = folder_ / name};
        EXPECT_NO_THROW((void)load_figure({.panels = {panel}})) << name;
        panel.textured = true;
        EXPECT_THAT(message_of([&] { (void)load_figure({.panels = {panel}}); }),
                    AllOf(HasSubstr("texture name is "), HasSubstr(texture)));
        panel.texture = folder_ / "skin.png";
        EXPECT_NO_THROW((void)load_figure({.panels = {panel}})) << name;
    }
}

}  // namespace
}  // namespace mimik::report
