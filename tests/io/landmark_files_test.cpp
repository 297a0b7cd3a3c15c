#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/csv.h"
#include "io/landmark_io.h"
#include "io/points_csv.h"
#include "tests/io/files_testing.h"

namespace mimik::io {

using geometry::Landmarks;
using geometry::Point;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Landmarks decode(LandmarkFormat format, const std::string& text, std::span<const Point> mesh = {},
                 LengthUnit unit = LengthUnit::millimetre) {
    return decode_landmarks(format, text, "marks", mesh, unit);
}

std::string refused(LandmarkFormat format, const std::string& text, std::span<const Point> mesh = {}) {
    return message_of([&] { (void)decode(format, text, mesh); });
}

Landmarks three_marks() {
    return Landmarks({{"nose_tip", {1.0 / 3.0, -std::sqrt(2.0), 1e-17}, ""},
                      {"a \"quoted\", <odd> & 'name'", {0.1, 0.2, 0.3}, ""},
                      {"#3", {-1e5 / 7.0, 25, 1e300}, ""}});
}

TEST(LandmarkFiles, every_format_gives_names_order_and_doubles_back) {
    const TemporaryFolder folder;
    const auto marks = three_marks();
    for (const auto* name : {"m.csv", "m.pp", "m.fcsv", "m.mrk.json", "m.lm3"}) {
        write_landmarks(folder / name, marks);
        const auto read = read_landmarks(folder / name);
        ASSERT_EQ(read.size(), marks.size()) << name;
        for (std::size_t i = 0; i < marks.size(); ++i) {
            EXPECT_EQ(read.all()[i].name, marks.all()[i].name) << name;
            EXPECT_EQ(read.all()[i].original_label, marks.all()[i].name) << name;
            EXPECT_EQ(read.all()[i].position_mm, marks.all()[i].position_mm) << name;
        }
    }
}

TEST(LandmarkFiles, an_unknown_extension_is_refused_with_those_there_are) {
    EXPECT_THAT(message_of([] { (void)landmark_format("a.json"); }),
                HasSubstr("there are .csv, .tsv, .pp, .fcsv, .mrk.json, .lm3, .ljson and .lan"));
    EXPECT_EQ(landmark_format("A.MRK.JSON"), LandmarkFormat::mrk_json);
}

TEST(LandmarkFiles, a_million_landmarks_are_refused_by_file_and_number) {
    std::string csv = "name,x,y,z\n", fcsv, lm3 = "#\n\n1000000 landmarks:\n", pp = "<PickedPoints>";
    for (int i = 0; i < 1'000'000; ++i) {
        csv += fmt::format("p{},1,2,3\n", i);
        fcsv += fmt::format("{},1,2,3\n", i);
        pp += "<point/>";
    }
    EXPECT_THAT(refused(LandmarkFormat::csv, csv),
                HasSubstr("marks: has more than 10000 landmarks (the next is 'p10000')"));
    EXPECT_THAT(refused(LandmarkFormat::fcsv, fcsv), HasSubstr("marks: has more than 10000 landmarks"));
    EXPECT_THAT(refused(LandmarkFormat::lm3, lm3), HasSubstr("marks: line 3: the number of landmarks is 1000000"));
    EXPECT_THAT(refused(LandmarkFormat::pp, pp + "</PickedPoints>"), HasSubstr("marks: has 1000002 XML tags"));
}

// ---- CSV

TEST(LandmarkCsv, columns_are_found_by_name_and_comments_and_quotes_understood) {
    const auto marks = decode(
        LandmarkFormat::csv,
        "\xEF\xBB\xBF# by hand\r\nZ, note ,name,Y,x\r\n3,\"a, b\",chin,2,1\r\n\r\n+6e0,,\"nose \"\"tip\"\"\",5,4\r\n");
    ASSERT_EQ(marks.size(), 2U);
    EXPECT_EQ(marks.at("chin").position_mm, Point(1, 2, 3));
    EXPECT_EQ(marks.at("nose \"tip\"").position_mm, Point(4, 5, 6));
}

TEST(LandmarkCsv, errors_name_line_column_and_value) {
    EXPECT_THAT(refused(LandmarkFormat::csv, ""), HasSubstr("marks: the file is empty"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "mark;x;y;z\nchin;1;2;3\n"),
                HasSubstr("column 'name' is missing from the header line; it has 'mark', 'x', 'y', 'z' (separated by "
                          "semicolons)"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z,X\n"), HasSubstr("column 'x' appears twice"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z\nchin,1,2\n"),
                HasSubstr("marks: line 2: 3 fields where the header names 4 columns"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z\nchin,1,two,3\n"),
                HasSubstr("marks: line 2: y is 'two', not a finite number"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z\nchin,1,nan,3\n"), HasSubstr("y is 'nan'"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z\n,1,2,3\n"), HasSubstr("marks: line 2: the name is empty"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z\na,1,2,3\na,4,5,6\n"),
                HasSubstr("marks: landmark 'a' appears twice"));
    EXPECT_THAT(refused(LandmarkFormat::csv, "name,x,y,z\n\"a,1,2,3\n"),
                HasSubstr("marks: line 2: a double quote is opened and not closed"));
    EXPECT_THAT(refused(LandmarkFormat::csv, std::string(1'000'000, ',')), HasSubstr("more than 10000 columns"));
}

TEST(PointsCsv, names_may_be_absent_or_repeat_and_doubles_come_back) {
    const TemporaryFolder folder;
    for (const bool named : {true, false}) {
        PointTable table;
        table.points = {{1.0 / 3.0, 0.1, -0.0}, {1e-300, 1e300, 5}};
        if (named) table.names = {"same", "same"};
        write_points_csv(folder / "p.csv", table);
        const auto read = read_points_csv(folder / "p.csv");
        EXPECT_EQ(read.points, table.points);
        EXPECT_EQ(read.names, table.names);
    }
    EXPECT_THAT(message_of([] { (void)decode_points_csv("name,x,y\n", "p"); }), HasSubstr("p: column 'z' is missing"));
}

// ---- MeshLab

TEST(PickedPoints, points_that_are_not_active_are_left_out_and_attribute_order_does_not_matter) {
    const auto marks =
        decode(LandmarkFormat::pp,
               "<!DOCTYPE PickedPoints>\n<PickedPoints>\n <DocumentData><User name=\"me\"/></DocumentData>\n"
               " <point y=\"2\" active=\"1\" name=\"chin\" x=\"1\" z=\"3\"/>\n"
               " <point x=\"9\" y=\"9\" z=\"9\" name=\"not set\" active=\"0\"/>\n"
               " <point x=\"4\" y=\"5\" z=\"6\" name=\"nose &amp; tip\"/>\n</PickedPoints>\n");
    ASSERT_EQ(marks.size(), 2U);
    EXPECT_EQ(marks.at("chin").position_mm, Point(1, 2, 3));
    EXPECT_EQ(marks.at("nose & tip").position_mm, Point(4, 5, 6));
}

TEST(PickedPoints, errors_name_byte_point_and_value) {
    EXPECT_THAT(refused(LandmarkFormat::pp, "<html></html>"), HasSubstr("marks: has no element PickedPoints"));
    EXPECT_THAT(refused(LandmarkFormat::pp, "<PickedPoints><point"), HasSubstr("marks: byte 19: the XML is damaged"));
    EXPECT_THAT(
        refused(LandmarkFormat::pp, "<PickedPoints><point x=\"1\" y=\"a\" z=\"3\" name=\"chin\"/></PickedPoints>"),
        HasSubstr("marks: byte 15: point 'chin': y is 'a', not a finite number"));
    EXPECT_THAT(refused(LandmarkFormat::pp, "<PickedPoints><point x=\"1\" y=\"2\" name=\"chin\"/></PickedPoints>"),
                HasSubstr("z is missing"));
}

TEST(PickedPoints, entities_are_not_expanded_and_no_other_file_is_read) {
    const std::string bomb =
        "<!DOCTYPE PickedPoints [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;\"><!ENTITY f SYSTEM "
        "\"/etc/hostname\">]>"
        "<PickedPoints><point x=\"1\" y=\"2\" z=\"3\" name=\"&b;&f;\"/></PickedPoints>";
    EXPECT_EQ(decode(LandmarkFormat::pp, bomb).all()[0].name, "&b;&f;");
}

// ---- Slicer

const std::string fcsv_head =
    "# Markups fiducial file version = 4.10\n# CoordinateSystem = 0\n"
    "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";

/// A lattice that is not symmetric about the z axis.
std::vector<Point> plate() {
    std::vector<Point> points;
    for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j) points.emplace_back(10 + 5 * i, 20 + 5 * j, 0.1 * i);
    points.emplace_back(std::nan(""), 0, 0);
    return points;
}

TEST(Slicer, fcsv_labels_are_the_twelfth_field_and_fall_back_to_the_id) {
    const auto marks = decode(LandmarkFormat::fcsv, fcsv_head +
                                                        "vtk_0,1,2,3,0,0,0,1,1,1,0,chin,,vtkMRML\n"
                                                        "vtk_1,4,5,6,0,0,0,1,1,1,0,,,\n");
    EXPECT_EQ(marks.at("chin").position_mm, Point(-1, -2, 3));  // the file says RAS
    EXPECT_EQ(marks.at("vtk_1").position_mm, Point(-4, -5, 6));
}

TEST(Slicer, the_frame_that_lies_on_the_mesh_is_taken) {
    const auto mesh = plate();
    for (const double sign : {1.0, -1.0}) {
        const auto text = fcsv_head + fmt::format("1,{},{},0,0,0,0,1,1,1,0,a,,\n2,{},{},2,0,0,0,1,1,1,0,b,,\n",
                                                  sign * 10, sign * 20, sign * 110, sign * 120);
        const auto marks = decode(LandmarkFormat::fcsv, text, mesh);
        EXPECT_EQ(marks.at("a").position_mm, Point(10, 20, 0));
        EXPECT_EQ(marks.at("b").position_mm, Point(110, 120, 2));
    }
}

TEST(Slicer, marks_that_lie_on_the_mesh_in_neither_frame_or_in_both_are_refused) {
    const auto mesh = plate();
    EXPECT_THAT(refused(LandmarkFormat::fcsv, fcsv_head + "1,500,20,0,0,0,0,1,1,1,0,a,,\n", mesh),
                HasSubstr("lie on the mesh neither in LPS nor in RAS (mean distance 390 mm as written"));
    const std::vector<Point> both = {{10, 20, 0}, {-10, -20, 0}};
    EXPECT_THAT(refused(LandmarkFormat::fcsv, fcsv_head + "1,10,20,0,0,0,0,1,1,1,0,a,,\n", both),
                HasSubstr("about as well in LPS as in RAS"));
}

TEST(Slicer, fcsv_errors_name_line_point_and_value) {
    EXPECT_THAT(refused(LandmarkFormat::fcsv, "# CoordinateSystem = XYZ\n"),
                HasSubstr("marks: line 1: CoordinateSystem is 'XYZ'"));
    EXPECT_THAT(refused(LandmarkFormat::fcsv, "# columns = id,x,y\n"),
                HasSubstr("marks: line 1: the list of columns has no 'z'"));
    EXPECT_THAT(refused(LandmarkFormat::fcsv, fcsv_head + "1,2\n"), HasSubstr("marks: line 4: has 2 fields"));
    EXPECT_THAT(refused(LandmarkFormat::fcsv, fcsv_head + "1,2,three,4,0,0,0,1,1,1,0,chin,,\n"),
                HasSubstr("marks: line 4: y of point 'chin' is 'three', not a finite number"));
}

std::string mrk(const std::string& points, const std::string& unit = "mm") {
    return R"({"@schema": "s", "markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": ")" +
           unit + R"(", "controlPoints": [)" + points + "]}]}";
}

TEST(Slicer, json_points_without_a_defined_position_are_left_out) {
    const auto marks = decode(LandmarkFormat::mrk_json,
                              mrk(R"({"id": "1", "label": "chin", "position": [1, 2.5, 3], "positionStatus": "defined"},
                                     {"id": "2", "label": "junk", "position": [9, 9, 9], "positionStatus": "undefined"},
                                     {"id": "3", "label": "", "position": [4, 5, 6]})"));
    ASSERT_EQ(marks.size(), 2U);
    EXPECT_EQ(marks.at("chin").position_mm, Point(1, 2.5, 3));
    EXPECT_EQ(marks.at("3").position_mm, Point(4, 5, 6));
}

TEST(Slicer, the_unit_that_lies_on_the_mesh_is_taken_whatever_the_json_states) {
    const auto mesh = plate();  // in mm already, as decoded from a file in cm
    for (const double sign : {1.0, -1.0})
        for (const double in_file : {1.0, 0.1}) {  // truly mm, and cm that say mm
            const auto text = mrk(fmt::format(
                R"({{"label": "a", "position": [{}, {}, 0]}}, {{"label": "b", "position": [{}, {}, {}]}})",
                sign * in_file * 10, sign * in_file * 20, sign * in_file * 110, sign * in_file * 120, in_file * 2));
            const auto marks = decode(LandmarkFormat::mrk_json, text, mesh, LengthUnit::centimetre);
            EXPECT_LT((marks.at("a").position_mm - Point(10, 20, 0)).norm(), 1e-12);  // 0.1 is not a double
            EXPECT_LT((marks.at("b").position_mm - Point(110, 120, 2)).norm(), 1e-12);
        }
    const std::string off = mrk(R"({"label": "a", "position": [500, 20, 0]})");
    const auto error = message_of([&] { (void)decode(LandmarkFormat::mrk_json, off, mesh, LengthUnit::centimetre); });
    EXPECT_THAT(error, HasSubstr("neither in LPS nor in RAS (mean distance 390 mm as written"));
    EXPECT_THAT(error, HasSubstr("negated in the unit of the mesh, at most"));
    const std::vector<Point> both = {{10, 20, 0}, {100, 200, 0}};
    EXPECT_THAT(message_of([&] {
                    (void)decode(LandmarkFormat::mrk_json, mrk(R"({"label": "a", "position": [10, 20, 0]})"), both,
                                 LengthUnit::centimetre);
                }),
                HasSubstr("about as well in one unit as in another"));
}

TEST(Slicer, without_a_mesh_a_unit_that_the_json_states_goes_before_the_one_asked_for) {
    const std::string point = R"({"label": "chin", "position": [1, 2, 3]})";
    EXPECT_EQ(decode(LandmarkFormat::mrk_json, mrk(point), {}, LengthUnit::metre).all()[0].position_mm, Point(1, 2, 3));
    EXPECT_EQ(decode(LandmarkFormat::mrk_json, mrk(point, "cm")).all()[0].position_mm, Point(10, 20, 30));
    EXPECT_EQ(decode(LandmarkFormat::mrk_json, mrk(point, "inch")).all()[0].position_mm.x(), 25.4);
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, mrk(point, "ell")), HasSubstr("marks: coordinateUnits: unit 'ell'"));
}

TEST(Slicer, json_errors_name_the_byte_or_the_point) {
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, "{\"markups\": [}"),
                HasSubstr("marks: byte 14: the JSON is damaged"));
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, "{}"), HasSubstr("marks: has no list 'markups'"));
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, mrk(R"({"label": "chin", "position": [1, 2]})")),
                HasSubstr("marks: controlPoints[0] ('chin'): position is not a list of 3 numbers"));
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, mrk(R"({"label": "chin", "position": [1, null, 2]})")),
                HasSubstr("controlPoints[0] ('chin'): position[1] is 'null'"));
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, mrk(R"({"label": "chin", "position": [1, 1e999, 2]})")),
                HasSubstr("marks: "));
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, std::string(10'000'000, '[')),
                HasSubstr("nests deeper than 32 levels"));
    std::string wide = "[";
    for (int i = 0; i < 2'000'000; ++i) wide += "1,";
    EXPECT_THAT(refused(LandmarkFormat::mrk_json, wide + "1]"), HasSubstr("more than 1000000 values"));
}

// ---- Bosphorus

TEST(Lm3, labels_stay_as_written_with_crlf_and_free_text_before_the_count) {
    const auto marks = decode(LandmarkFormat::lm3,
                              "# 3D landmarks\r\n* some text\r\n* more\r\n\r\n2 landmarks:\r\nOuter left eyebrow\r\n"
                              "-25.3 -24.0 48.1\r\nChin middle\r\n1 2 3\r\n");
    ASSERT_EQ(marks.size(), 2U);
    EXPECT_EQ(marks.all()[0].name, "Outer left eyebrow");
    EXPECT_EQ(marks.all()[0].position_mm, Point(-25.3, -24.0, 48.1));
}

TEST(Lm3, errors_name_line_and_landmark) {
    EXPECT_THAT(refused(LandmarkFormat::lm3, "# nothing\n"), HasSubstr("marks: has no line '<N> landmarks:'"));
    EXPECT_THAT(refused(LandmarkFormat::lm3, "#\n\nmany landmarks:\n"),
                HasSubstr("marks: line 3: the number of landmarks is 'many'"));
    EXPECT_THAT(refused(LandmarkFormat::lm3, "#\n\n2 landmarks:\nChin middle\n1 2 3\n"),
                HasSubstr("marks: has 1 of the 2 landmarks"));
    EXPECT_THAT(refused(LandmarkFormat::lm3, "#\n\n1 landmarks:\nChin middle\n"),
                HasSubstr("landmark 'Chin middle' has no position"));
    EXPECT_THAT(refused(LandmarkFormat::lm3, "#\n\n1 landmarks:\nChin middle\n1 x 3\n"),
                HasSubstr("marks: line 5: coordinate of landmark 'Chin middle' is 'x'"));
    EXPECT_THAT(refused(LandmarkFormat::lm3, "#\n\n1 landmarks:\nChin middle\n1 2 3\nNose tip\n4 5 6\n"),
                HasSubstr("marks: line 6: 'Nose tip' stands after the 1 landmark that"));
}

}  // namespace
}  // namespace mimik::io
