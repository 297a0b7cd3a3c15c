#include "report/comparison_panels.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "geometry/surface_index.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/expressions.h"
#include "tests/support/workspace_test.h"

namespace mimik::report {
namespace {

using database::message_of;
using geometry::Point;
using nlohmann::json;
using preprocessing::Workspace;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

const facs::FacsCatalogue& catalogue() { return facs::builtin_catalogue(); }

ComparisonRequest smile(const std::string& source, const std::string& target) {
    ComparisonRequest request;
    request.source = source;
    request.target = target;
    request.expression = test::expression("12");
    return request;
}

void use_thesis(ComparisonRequest& request) {
    request.method_name = "thesis";
    request.model = modeling::ModelOptions::thesis();
    request.animation = animation::AnimationOptions::thesis();
}

json description_of(const ComparisonFigure& figure) { return json::parse(base::read_text(figure.description)); }

std::vector<double> attribute(const geometry::Mesh& mesh, const std::string& name) {
    for (const auto& candidate : mesh.attributes)
        if (candidate.name == name) return candidate.values;
    throw std::runtime_error("no attribute " + name);
}

double mean_of_finite(const std::vector<double>& values) {
    double sum = 0, count = 0;
    for (const double value : values)
        if (std::isfinite(value)) {
            sum += value;
            ++count;
        }
    return sum / count;
}

class ComparisonPanels : public test::WorkspaceTest<ComparisonPanels> {
protected:
    [[nodiscard]] static fs::path out(const std::string& name) { return folder_->path() / name; }
    [[nodiscard]] static ComparisonFigure panels(const ComparisonRequest& request, const std::string& name) {
        return write_comparison_panels(*workspace_, catalogue(), request, out(name));
    }
};

TEST_F(ComparisonPanels, two_people_have_five_panels_each_and_every_file_that_is_named_is_there) {
    const auto figure = panels(smile("bs000", "bs001"), "two");
    EXPECT_EQ(figure.panels, 10U);
    const auto description = description_of(figure);
    EXPECT_EQ(description.at("columns"), 5);
    ASSERT_EQ(description.at("panels").size(), 10U);
    for (const auto& panel : description.at("panels"))
        for (const char* key : {"mesh", "landmarks", "controls"})
            if (panel.contains(key)) {
                EXPECT_TRUE(fs::exists(out("two") / panel.at(key).get<std::string>())) << panel;
            }
    EXPECT_EQ(description.at("panels")[0].at("caption"), "(a) Neutral source bs000");
    EXPECT_EQ(description.at("panels")[7].at("caption"), "(h) Scan of the target");
}

TEST_F(ComparisonPanels, a_face_that_is_worse_than_doing_nothing_is_said_to_be) {
    auto request = smile("bs000", "bs001");
    EXPECT_EQ(description_of(panels(request, "good")).dump().find("worse than doing nothing"), std::string::npos);
    request.magnitude = 6;
    const auto figure = panels(request, "bad");
    EXPECT_THAT(description_of(figure).at("panels")[8].at("caption").get<std::string>(),
                testing::EndsWith("in the zone:\nworse than doing nothing"));
    EXPECT_THAT(figure.remarks, testing::Contains(testing::HasSubstr("AU12 on bs001: worse than doing nothing (")));
    // Doing nothing itself is not.
    EXPECT_THAT(description_of(figure).at("panels")[9].at("caption").get<std::string>(),
                testing::EndsWith("mm in the zone"));
}

TEST_F(ComparisonPanels, all_panels_of_a_person_share_one_centre_and_the_coloured_ones_one_scale) {
    const auto description = description_of(panels(smile("bs000", "bs001"), "centre"));
    std::set<json> centres, ranges;
    for (const auto& panel : description.at("panels")) {
        centres.insert(panel.at("centre_mm"));
        if (panel.contains("scalar")) ranges.insert(panel.at("scalar").at("range"));
    }
    EXPECT_EQ(centres.size(), 2U);
    EXPECT_EQ(ranges.size(), 1U);
    EXPECT_EQ(description.at("panels")[0].at("centre_mm"), description.at("panels")[4].at("centre_mm"));
}

TEST_F(ComparisonPanels, the_real_scan_lies_in_the_frame_of_its_neutral_where_the_smile_does_not_reach) {
    auto request = smile("bs000", "bs001");
    request.holes = HoleDrawing::gap;  // a hole is bridged otherwise on either scan
    (void)panels(request, "frame");
    const auto neutral = io::read_mesh(out("frame") / "target_neutral.ply");
    const auto real = io::read_mesh(out("frame") / "target_real.ply");
    // The two poses of bs001 put the forehead 5 mm apart; after the alignment what is left is the chord error of
    // cells 1.9 mm wide, and of the ICP, together below 0.15 mm.
    double lowest = 1e9, highest = -1e9;
    for (const auto& p : neutral.vertices_mm) {
        lowest = std::min(lowest, p.y());
        highest = std::max(highest, p.y());
    }
    const geometry::SurfaceIndex surface(real.vertices_mm, geometry::triangulate(real.faces));
    std::size_t asked = 0;
    for (const auto& p : neutral.vertices_mm) {
        if (p.y() < lowest + 0.75 * (highest - lowest)) continue;
        const auto hit = surface.closest(p);
        if (surface.on_border(hit)) continue;
        ++asked;
        EXPECT_LT(hit.distance_mm, 0.15);
    }
    EXPECT_GT(asked, 200U);
}

TEST_F(ComparisonPanels, controls_lie_on_the_surfaces_that_they_are_drawn_on) {
    (void)panels(smile("bs000", "bs001"), "controls");
    const std::pair<const char*, const char*> pairs[] = {{"source_controls.csv", "source_neutral.ply"},
                                                         {"source_real_controls.csv", "source_real.ply"},
                                                         {"target_controls.csv", "target_neutral.ply"}};
    for (const auto& [controls, mesh] : pairs) {
        const auto surface_mesh = io::read_mesh(out("controls") / mesh);
        const geometry::SurfaceIndex surface(surface_mesh.vertices_mm, geometry::triangulate(surface_mesh.faces));
        const auto marks = io::read_landmarks(out("controls") / controls);
        EXPECT_GT(marks.size(), 10U) << controls;
        for (const auto& mark : marks.all())
            // They were moved to the nearest surface point: rounding is all that is left.
            EXPECT_LT(surface.closest(mark.position_mm).distance_mm, 1e-9) << controls << ' ' << mark.name;
    }
}

TEST_F(ComparisonPanels, colours_are_the_distances_that_the_captions_sum_up) {
    const auto figure = panels(smile("bs000", "bs001"), "colours");
    ASSERT_EQ(figure.people.size(), 2U);
    EXPECT_EQ(figure.people[1].subject, "bs001");
    const auto& distances = figure.people[1];
    const auto neutral = attribute(io::read_mesh(out("colours") / "target_neutral.ply"), "distance_mm");
    const auto animated = attribute(io::read_mesh(out("colours") / "target_animated.ply"), "distance_mm");
    // The same numbers added up in another order.
    EXPECT_NEAR(mean_of_finite(neutral), distances.face_nothing_mm.value(), 1e-9);
    EXPECT_NEAR(mean_of_finite(animated), distances.face_mm.value(), 1e-9);
    EXPECT_LT(distances.zone_mm, distances.zone_nothing_mm);
    EXPECT_DOUBLE_EQ(*figure.people[1].explained(), 1 - distances.zone_mm / distances.zone_nothing_mm);
    // The scale is the 99th percentile of doing nothing: at most one vertex in a hundred lies above it.
    std::size_t above = 0, finite = 0;
    for (const double value : neutral) {
        finite += std::isfinite(value) ? 1 : 0;
        above += value > figure.scale_mm ? 1 : 0;
    }
    EXPECT_LE(above, finite / 100 + 1);
}

TEST_F(ComparisonPanels, magnitude_nought_is_doing_nothing) {
    auto request = smile("bs000", "bs001");
    request.magnitude = 0;
    const auto figure = panels(request, "nought");
    const auto& distances = figure.people[1];
    EXPECT_EQ(distances.zone_mm, distances.zone_nothing_mm);
    EXPECT_EQ(io::read_mesh(out("nought") / "target_animated.ply").vertices_mm,
              io::read_mesh(out("nought") / "target_neutral.ply").vertices_mm);
    EXPECT_EQ(comparison_name(request), "AU12_m0_bs000_on_bs001_default");
}

TEST_F(ComparisonPanels, a_person_who_is_source_and_target_has_one_row) {
    const auto figure = panels(smile("bs002", "bs002"), "self");
    EXPECT_EQ(figure.panels, 5U);
    EXPECT_EQ(figure.people.size(), 1U);
}

TEST_F(ComparisonPanels, a_mean_shows_the_average_face_neutral_and_moved_before_the_target) {
    const auto figure = panels(smile("mean", "bs001"), "mean");
    EXPECT_EQ(figure.panels, 7U);
    const auto list = description_of(figure).at("panels");
    EXPECT_EQ(list[0].at("mesh"), "average_neutral.ply");
    EXPECT_EQ(list[1].at("mesh"), "average_animated.ply");
    EXPECT_EQ(list[2].at("mesh"), "target_neutral.ply");
    EXPECT_NE(io::read_mesh(out("mean") / "average_neutral.ply").vertices_mm,
              io::read_mesh(out("mean") / "average_animated.ply").vertices_mm);
    ASSERT_EQ(figure.people.size(), 1U);
    EXPECT_EQ(figure.people[0].subject, "bs001");
}

TEST_F(ComparisonPanels, the_thesis_method_draws_its_own_points_and_no_coverage) {
    auto request = smile("bs000", "bs001");
    use_thesis(request);
    (void)panels(request, "thesis");
    EXPECT_TRUE(fs::exists(out("thesis") / "source_controls.csv"));
    EXPECT_FALSE(fs::exists(out("thesis") / "source_controls_coverage.csv"));
    EXPECT_EQ(comparison_name(request), "AU12_bs000_on_bs001_thesis");
}

TEST_F(ComparisonPanels, a_note_on_a_point_begins_with_the_expression_and_none_tells_of_the_lattices_rim) {
    auto units = catalogue().action_units();
    for (auto& unit : units)
        if (unit.number == 12) unit.points.front().placement.up += 3;  // outer-eye distances: above every head
    const facs::FacsCatalogue beyond(catalogue().sampling(), units, {});
    const auto note = "AU12_L: AU12." + beyond.find(12)->points.front().name + "_left: off the face";
    auto request = smile("bs000", "bs001");
    request.expression = test::expression("12L");
    for (const auto* method : {"default", "thesis"}) {
        if (std::string_view(method) == "thesis") use_thesis(request);
        auto remarks = write_comparison_panels(*workspace_, beyond, request, out("notes")).remarks;
        std::erase_if(remarks,
                      [](const auto& remark) { return remark.find("worse than doing nothing") != remark.npos; });
        EXPECT_THAT(remarks, testing::UnorderedElementsAre(note, HasSubstr("was taken from one side of"),
                                                           HasSubstr("has no scan of expression")))
            << method;
        const auto expressions = test::expressions({"12L"});
        const std::vector<double> magnitudes = {1};
        EXPECT_THAT(write_magnitude_series(*workspace_, beyond, request, expressions, magnitudes, out("notes")).remarks,
                    ElementsAre(note))
            << method;
    }
}

TEST_F(ComparisonPanels, a_target_without_that_scan_is_shown_without_comparison_and_a_word_about_it) {
    const database::TemporaryFolder folder;
    test::write_analytic_scan(folder.path() / "db", "bs003_N_N_0", {1.02, 0}, test::analytic_pose(1));
    const auto workspace = test::analytic_workspace(folder.path());
    const auto figure = write_comparison_panels(workspace, catalogue(), smile("bs000", "bs003"), folder.path() / "out");
    EXPECT_EQ(figure.panels, 7U);
    ASSERT_EQ(figure.people.size(), 1U);
    EXPECT_EQ(figure.people[0].subject, "bs000");
    EXPECT_THAT(figure.remarks, testing::Contains(HasSubstr("'bs003' has no scan of expression '12'")));
}

TEST_F(ComparisonPanels, a_series_has_a_row_per_expression_whose_displacements_grow_with_the_magnitude) {
    const auto expressions = test::expressions({"12", "12L"});
    const std::vector<double> magnitudes = {0, 0.5, 1};
    const auto request = smile("bs000", "bs001");
    const auto figure =
        write_magnitude_series(*workspace_, catalogue(), request, expressions, magnitudes, out("series"));
    EXPECT_EQ(figure.panels, 6U);
    EXPECT_EQ(description_of(figure).at("columns"), 3);
    EXPECT_EQ(series_name(request, expressions), "AU12_AU12_L_series_bs000_on_bs001_default");
    const auto none = io::read_mesh(out("series") / "AU12_m0.ply").vertices_mm;
    const auto half = io::read_mesh(out("series") / "AU12_m0.5.ply").vertices_mm;
    const auto whole = io::read_mesh(out("series") / "AU12_m1.ply").vertices_mm;
    ASSERT_EQ(none.size(), whole.size());
    double largest = 0;
    for (std::size_t v = 0; v < none.size(); ++v) {
        largest = std::max(largest, (whole[v] - none[v]).norm());
        // Displacements are linear in the magnitude; doubles of some 100 mm round at 1e-14.
        EXPECT_LT((whole[v] - none[v] - 2 * (half[v] - none[v])).norm(), 1e-11);
    }
    EXPECT_GT(largest, 3.0);  // the source's mouth corners move by 6 mm x 0.95
}

TEST_F(ComparisonPanels, more_panels_than_letters_go_on_with_two) {
    std::vector<double> magnitudes;
    for (int k = 0; k < 28; ++k) magnitudes.push_back(0.03 * k);
    const auto expressions = test::expressions({"12"});
    const auto list = description_of(write_magnitude_series(*workspace_, catalogue(), smile("bs000", "bs001"),
                                                            expressions, magnitudes, out("letters")))
                          .at("panels");
    EXPECT_THAT(list[25].at("caption").get<std::string>(), testing::StartsWith("(z) "));
    EXPECT_THAT(list[26].at("caption").get<std::string>(), testing::StartsWith("(aa) "));
    EXPECT_THAT(list[27].at("caption").get<std::string>(), testing::StartsWith("(ab) "));
}

TEST_F(ComparisonPanels, what_differs_from_the_method_and_the_view_stands_in_the_name) {
    const auto usual = smile("bs000", "bs001");
    const std::string name = "AU12_bs000_on_bs001_default";
    EXPECT_EQ(comparison_name(usual), name);
    auto view = usual, kernel = usual, anchors = usual, gaps = usual;
    view.view = "three-quarter-left";
    kernel.model.kernel = kernel.animation.kernel = geometry::SplineKernel::r2_log_r2;
    anchors.model.anchors = anchors.animation.anchors = false;
    gaps.holes = HoleDrawing::gap;
    EXPECT_EQ(comparison_name(view), name + "_three-quarter-left");
    EXPECT_EQ(comparison_name(kernel), name + "_r2logr");
    EXPECT_EQ(comparison_name(anchors), name + "_no-anchors");
    EXPECT_EQ(comparison_name(gaps), name + "_holes-gap");
    EXPECT_EQ(series_name(view, test::expressions({"12"})), "AU12_series_bs000_on_bs001_default_three-quarter-left");
}

TEST_F(ComparisonPanels, a_series_refuses_what_is_no_magnitude_or_would_share_a_file_and_writes_nothing) {
    const auto one = test::expressions({"12"}), twice = test::expressions({"12", "12"});
    const std::vector<double> near = {0.5, 0.5000001}, apart = {0.5, 1};
    const auto series = [&](const std::vector<facs::Expression>& expressions, const std::vector<double>& magnitudes) {
        return message_of<InputError>([&] {
            (void)write_magnitude_series(*workspace_, catalogue(), smile("bs000", "bs001"), expressions, magnitudes,
                                         out("shared"));
        });
    };
    EXPECT_THAT(series(one, near), HasSubstr("'12' at magnitude 0.5000001 stands twice"));
    EXPECT_THAT(series(twice, apart), HasSubstr("'12' at magnitude 0.5 stands twice"));
    EXPECT_THAT(series(one, {0, -1}), HasSubstr("magnitude -1 of the series"));
    EXPECT_THAT(series(one, {2, std::nan("")}), HasSubstr("magnitude nan of the series"));
    EXPECT_THAT(series(one, {2, std::numeric_limits<double>::infinity()}), HasSubstr("magnitude inf of the series"));
    EXPECT_FALSE(fs::exists(out("shared")));
}

TEST_F(ComparisonPanels, files_of_an_earlier_figure_go_and_what_it_does_not_name_stays) {
    const auto expressions = test::expressions({"12"});
    const auto series = [&](const std::vector<double>& magnitudes) {
        (void)write_magnitude_series(*workspace_, catalogue(), smile("bs000", "bs001"), expressions, magnitudes,
                                     out("again/figure"));
    };
    series({0.25, 1});
    base::write_atomically(out("again/figure/AU12_mine.ply"), "mine");
    base::write_atomically(out("again/other.ply"), "other");
    auto description = json::parse(base::read_text(out("again/figure/figure.json")));
    description["panels"][1]["controls"] = "../other.ply";
    base::write_atomically(out("again/figure/figure.json"), description.dump());
    series({0.5});
    EXPECT_FALSE(fs::exists(out("again/figure/AU12_m0.25.ply")));
    EXPECT_TRUE(fs::exists(out("again/figure/AU12_m0.5.ply")));
    EXPECT_TRUE(fs::exists(out("again/figure/AU12_mine.ply")));
    EXPECT_TRUE(fs::exists(out("again/other.ply")));
}

TEST_F(ComparisonPanels, what_cannot_be_shown_is_refused_by_name_before_any_file_is_written) {
    const auto refused = [&](const ComparisonRequest& request) {
        return message_of<InputError>([&] { (void)panels(request, "refused"); });
    };
    EXPECT_THAT(refused(smile("bs009", "bs001")), HasSubstr("there are: bs000, bs001, bs002"));
    EXPECT_THAT(refused(smile("bs000", "bs009")), HasSubstr("there are: bs000, bs001, bs002"));
    auto frown = smile("bs000", "bs001");
    frown.expression = test::expression("4");
    EXPECT_THAT(refused(frown), HasSubstr("'bs000' has no scan of expression '4'; there are: 12"));
    frown.source = "mean";
    EXPECT_THAT(refused(frown), HasSubstr("no other subject shows expression '4'"));
    auto thesis = smile("mean", "bs001");
    use_thesis(thesis);
    EXPECT_THAT(refused(thesis), HasSubstr("the thesis method has no mean"));
    EXPECT_FALSE(fs::exists(out("refused")));
    EXPECT_THAT(message_of<InputError>([&] {
                    (void)write_magnitude_series(*workspace_, catalogue(), smile("bs000", "bs001"), {}, {}, out("no"));
                }),
                HasSubstr("0 expressions at 0 magnitudes"));
}

TEST_F(ComparisonPanels, a_scan_that_a_mean_cannot_use_is_a_failure_beside_the_picture_of_the_rest) {
    const database::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    base::write_atomically(workspace.root() / "faces" / "bs000" / "bs000_LFAU_12_0.json", "{}");
    const auto one = test::expressions({"12"});
    const std::vector<double> whole = {1};
    const auto panels =
        write_comparison_panels(workspace, catalogue(), smile("mean", "bs001"), folder.path() / "panels");
    const auto series =
        write_magnitude_series(workspace, catalogue(), smile("mean", "bs001"), one, whole, folder.path() / "series");
    for (const auto* figure : {&panels, &series}) {
        EXPECT_THAT(figure->failures, ElementsAre(HasSubstr("AU12: left out of the mean: bs000_LFAU_12_0")));
        EXPECT_TRUE(fs::exists(figure->description));
    }
}

TEST_F(ComparisonPanels, a_scan_that_was_aligned_beside_its_neutral_is_named) {
    const database::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    auto smiling = workspace.face(*workspace.scan_of("bs001", test::expression("12")));
    smiling.neutral_from_scan.pretranslate(Point(1000, 0, 0));
    preprocessing::write_face(workspace.stem(smiling.id), smiling);
    EXPECT_THAT(message_of<InputError>([&] {
                    (void)write_comparison_panels(workspace, catalogue(), smile("bs000", "bs001"),
                                                  folder.path() / "out");
                }),
                HasSubstr("bs001_LFAU_12_0 does not lie on bs001_N_N_0"));
}

TEST_F(ComparisonPanels, subjects_who_must_not_be_shown_are_refused_and_stand_in_no_file) {
    const database::TemporaryFolder folder;
    base::write_atomically(folder.path() / "db" / "unallowed_subjects.txt", "BS000\n");
    const auto workspace = test::analytic_workspace(folder.path());
    for (const auto& request : {smile("bs000", "bs001"), smile("bs001", "bs000")})
        EXPECT_THAT(message_of<InputError>(
                        [&] { (void)write_comparison_panels(workspace, catalogue(), request, folder.path() / "out"); }),
                    HasSubstr("'bs000' stands in unallowed_subjects.txt"));
    EXPECT_FALSE(fs::exists(folder.path() / "out"));
    const auto figure = write_comparison_panels(workspace, catalogue(), smile("mean", "bs001"), folder.path() / "out");
    EXPECT_THAT(base::read_text(figure.description), testing::Not(HasSubstr("bs000")));
}

}  // namespace
}  // namespace mimik::report
