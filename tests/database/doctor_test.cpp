#include "database/doctor.h"

#include <algorithm>
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "database/landmark_distance.h"
#include "database/self_checks.h"
#include "tests/database/made_face.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

LoadedScan loaded(const MadeFace& face, const std::string& name = "bs000_N_N_0") {
    LoadedScan scan;
    scan.entry.id = *parse_scan_name(name);
    scan.entry.scan_file = name + ".bnt";
    scan.entry.landmarks_file = name + ".lm3";
    scan.scan = face.scan;
    scan.scan.texture_file.clear();
    scan.landmarks = from_bosphorus_labels(to_bosphorus_labels(face.landmarks), &scan.checks.sides);
    scan.checks.correlations = frame_correlations(face.scan);
    return scan;
}

/// Every coordinate of scan and landmarks through the map.
MadeFace mapped(MadeFace face, const std::function<geometry::Point(geometry::Point)>& map) {
    for (auto& p : face.scan.points_mm) p = map(p);
    std::vector<geometry::Landmark> marks(face.landmarks.all().begin(), face.landmarks.all().end());
    for (auto& mark : marks) mark.position_mm = map(mark.position_mm);
    face.landmarks = geometry::Landmarks(std::move(marks));
    return face;
}

MadeFace renamed(MadeFace face, const std::map<std::string, std::string>& names) {
    std::vector<geometry::Landmark> marks(face.landmarks.all().begin(), face.landmarks.all().end());
    for (auto& mark : marks)
        if (const auto it = names.find(mark.name); it != names.end()) mark.name = it->second;
    face.landmarks = geometry::Landmarks(std::move(marks));
    return face;
}

MadeFace without(MadeFace face, const std::vector<std::string>& names) {
    std::vector<geometry::Landmark> marks;
    for (const auto& mark : face.landmarks.all())
        if (std::find(names.begin(), names.end(), mark.name) == names.end()) marks.push_back(mark);
    face.landmarks = geometry::Landmarks(std::move(marks));
    return face;
}

/// Findings of one kind as "severity: what -> mend" lines.
std::string found(const std::vector<Finding>& findings, const std::string& kind) {
    std::string text;
    for (const auto& f : findings)
        if (f.kind == kind) text += to_string(f.severity) + ": " + f.what + " -> " + f.mend + "\n";
    return text;
}

TEST(Doctor, a_good_scan_has_no_finding) { EXPECT_THAT(check_scan(loaded(make_face())), IsEmpty()); }

TEST(Doctor, default_options_are_valid_and_a_bad_one_is_named) {
    EXPECT_NO_THROW(DoctorOptions{}.check());
    DoctorOptions options;
    options.spike_mm = 0;
    EXPECT_THAT(message_of<InputError>([&] { options.check(); }), HasSubstr("spike_mm is 0"));
    options = {};
    options.max_size_ratio = 0.1;
    EXPECT_THAT(message_of<InputError>([&] { options.check(); }), HasSubstr("max_size_ratio is 0.1"));
}

TEST(Doctor, a_face_of_the_wrong_size_is_recognised_as_another_unit) {
    for (const auto& [scale, unit, mend] :
         {std::tuple{0.1, "centimetres", "cm"}, {0.001, "metres", "m"}, {1 / 25.4, "inches", "inch"}}) {
        auto scan = loaded(mapped(make_face(), [s = scale](auto p) { return geometry::Point(s * p); }));
        EXPECT_THAT(found(check_scan(scan), "unit"),
                    testing::AllOf(HasSubstr("error"), HasSubstr(unit),
                                   HasSubstr("-> multiply all coordinates of scan and landmarks by")));
        scan.entry.layout = DatabaseLayout::manifest;
        EXPECT_THAT(found(check_scan(scan), "unit"),
                    HasSubstr(std::string("-> put ") + mend + " in the column unit of manifest.csv"));
        // Without landmarks the extent of the scan tells.
        auto cloud = loaded(mapped(make_face(), [s = scale](auto p) { return geometry::Point(s * p); }));
        cloud.landmarks = {};
        EXPECT_THAT(found(check_scan(cloud), "unit"), HasSubstr(unit));
    }
    EXPECT_THAT(found(check_scan(loaded(mapped(make_face(), [](auto p) { return geometry::Point(3 * p); }))), "unit"),
                HasSubstr("convert all coordinates of scan and landmarks to millimetres"));
}

TEST(Doctor, where_only_scan_or_landmarks_have_another_unit_that_file_is_named) {
    const auto small = mapped(make_face(), [](auto p) { return geometry::Point(0.1 * p); });
    auto scan = loaded(make_face());
    scan.entry.layout = DatabaseLayout::manifest;
    scan.landmarks = small.landmarks;
    auto findings = check_scan(scan);
    ASSERT_EQ(findings[0].kind, "unit");
    EXPECT_THAT(findings[0].what, HasSubstr("the landmarks look like centimetres"));
    EXPECT_EQ(findings[0].mend, "multiply the coordinates of the landmarks by 10");
    EXPECT_EQ(findings[0].where, "bs000_N_N_0.lm3");
    scan = loaded(small);
    scan.landmarks = make_face().landmarks;
    findings = check_scan(scan);
    ASSERT_EQ(findings[0].kind, "unit");
    EXPECT_EQ(findings[0].mend, "multiply the coordinates of the scan by 10");
    scan = loaded(mapped(make_face(), [](auto p) { return geometry::Point(10 * p); }));  // mm, and the table says cm
    scan.landmarks = make_face().landmarks;
    scan.entry.unit = io::LengthUnit::centimetre;
    EXPECT_THAT(found(check_scan(scan), "unit"),
                HasSubstr("convert the coordinates of the scan to the unit that manifest.csv gives them"));
    scan = loaded(small);
    scan.landmarks = make_face().landmarks;
    findings = check_scan(scan);
    EXPECT_EQ(findings[0].where, "bs000_N_N_0.bnt");
}

TEST(Doctor, a_frame_with_z_away_y_down_or_both_is_named) {
    const auto frame = [](const std::function<geometry::Point(geometry::Point)>& map) {
        auto scan = loaded(mapped(make_face(), map));
        scan.checks.correlations = {};  // landmarks alone
        return found(check_scan(scan), "frame");
    };
    EXPECT_THAT(frame([](auto p) { return geometry::Point(p.x(), p.y(), -p.z()); }),
                HasSubstr("z does not point toward the camera"));
    EXPECT_THAT(frame([](auto p) { return geometry::Point(p.x(), -p.y(), p.z()); }), HasSubstr("y points down"));
    EXPECT_THAT(frame([](auto p) { return geometry::Point(p.x(), -p.y(), -p.z()); }), HasSubstr("180 degrees about x"));
    EXPECT_EQ(frame([](auto p) { return p; }), "");
}

/// As a PLY has it: no lattice.
MadeFace as_mesh(MadeFace face) {
    face.scan.rows = face.scan.cols = 0;
    return face;
}

/// With names of the subject's own side, as a manifest's landmark files have them.
LoadedScan with_own_names(const MadeFace& face) {
    auto scan = loaded(face);
    scan.landmarks = face.landmarks;
    scan.entry.landmarks_file = "bs000_N_N_0.csv";
    scan.checks = {};
    return scan;
}

TEST(Doctor, every_way_to_turn_or_mirror_a_face_is_an_error_whose_mend_is_the_way_back) {
    const auto frame = [](const std::function<geometry::Point(geometry::Point)>& map) {
        return found(check_scan(with_own_names(mapped(as_mesh(make_face()), map))), "frame");
    };
    using P = geometry::Point;
    EXPECT_THAT(frame([](P p) { return P(p.x(), -p.z(), p.y()); }),  // z up
                HasSubstr("error: the head's up is z and it looks along -y, instead of y and z -> turn scan and "
                          "landmarks to y up and z toward the camera: (x, y, z) -> (x, z, -y)"));
    EXPECT_THAT(frame([](P p) { return P(p.z(), p.x(), p.y()); }), HasSubstr("(x, y, z) -> (y, z, x)"));
    EXPECT_THAT(frame([](P p) { return P(p.z(), p.y(), -p.x()); }), HasSubstr("(x, y, z) -> (-z, y, x)"));
    EXPECT_THAT(frame([](P p) { return P(p.y(), -p.x(), p.z()); }), HasSubstr("(x, y, z) -> (-y, x, z)"));
    EXPECT_THAT(frame([](P p) { return P(-p.x(), -p.y(), p.z()); }), HasSubstr("change the signs of x and y\n"));
    EXPECT_THAT(frame([](P p) { return P(-p.x(), p.y(), -p.z()); }), HasSubstr("change the signs of x and z\n"));
    EXPECT_THAT(frame([](P p) { return P(p.x(), -p.y(), -p.z()); }), HasSubstr("change the signs of y and z\n"));
    EXPECT_THAT(frame([](P p) { return P(p.x(), p.y(), -p.z()); }), HasSubstr("change the sign of every z, in"));
    EXPECT_THAT(frame([](P p) { return P(p.x(), -p.y(), p.z()); }), HasSubstr("change the sign of every y, in"));
    EXPECT_EQ(frame([](P p) { return p; }), "");
    // One fault is one finding: a face that looks away is not mirrored, too.
    const auto away =
        check_scan(with_own_names(mapped(as_mesh(make_face()), [](P p) { return P(-p.x(), p.y(), -p.z()); })));
    EXPECT_EQ(std::count_if(away.begin(), away.end(), [](const auto& f) { return f.severity != Severity::note; }), 1);
}

TEST(Doctor, a_wrong_nose_tip_is_no_scan_seen_from_behind) {
    const auto face = make_face();
    auto scan = loaded(face);
    const double nose_mm = face.landmarks.position_mm("nose_tip").z();
    scan.landmarks = moved(scan.landmarks, {{"nose_tip", {0, 0, -2 * nose_mm}}});  // a sign was lost
    const auto findings = check_scan(scan);
    EXPECT_EQ(found(findings, "frame"), "");
    EXPECT_THAT(found(findings, "landmarks-swapped"), HasSubstr("error: 'nose_tip' lies behind eyes and mouth, but"));
    EXPECT_THAT(found(findings, "landmarks-off-scan"), HasSubstr("error: landmarks lie off the scan: nose_tip ("));
    // Landmarks of another frame are off the scan; how they lie says nothing about it.
    scan.landmarks = mapped(face, [](auto p) { return geometry::Point(p.x(), p.y(), -p.z()); }).landmarks;
    EXPECT_EQ(found(check_scan(scan), "frame"), "");
    EXPECT_THAT(found(check_scan(scan), "landmarks-off-scan"), HasSubstr("another scan, frame or unit"));
}

TEST(Doctor, shoulders_a_whole_body_and_a_close_crop_are_no_error_of_unit) {
    const auto face = make_face();
    auto body = loaded(as_mesh(face));
    body.scan.texture_coordinates.clear();
    for (int i = 0; i < 400; ++i) body.scan.points_mm.emplace_back(i % 20 * 25 - 250, -150 - i / 20 * 75, -100);
    EXPECT_EQ(found(check_scan(body), "unit"), "");
    for (auto& p : body.scan.points_mm) p *= 0.1;  // but all of it in cm is
    body.landmarks = mapped(face, [](auto p) { return geometry::Point(0.1 * p); }).landmarks;
    EXPECT_THAT(found(check_scan(body), "unit"),
                HasSubstr("looks like centimetres -> multiply all coordinates of scan and landmarks by 10"));
    auto shoulders = loaded(face);
    shoulders.landmarks = {};
    for (auto& p : shoulders.scan.points_mm) p *= 3;  // as wide as shoulders
    EXPECT_EQ(found(check_scan(shoulders), "unit"), "");
    auto crop = loaded(face);  // eyes and nose alone: 40 mm high
    for (auto& p : crop.scan.points_mm)
        if (std::abs(p.y() - 20) > 20) p.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(found(check_scan(crop), "unit"), "");
}

TEST(Doctor, one_lost_decimal_point_is_a_landmark_off_the_scan_and_no_unit) {
    auto scan = loaded(make_face());
    scan.landmarks = moved(scan.landmarks, {{"eye_outer_left", {400, 0, 0}}});
    const auto findings = check_scan(scan);
    EXPECT_EQ(found(findings, "unit"), "");
    EXPECT_THAT(found(findings, "landmarks-off-scan"), HasSubstr("error: landmarks lie off the scan: eye_outer_left"));
}

TEST(Doctor, a_unit_that_the_table_has_wrong_is_mended_in_the_table) {
    auto scan =
        loaded(mapped(make_face(), [](auto p) { return geometry::Point(10 * p); }));  // mm, and the table says cm
    scan.entry.layout = DatabaseLayout::manifest;
    scan.entry.unit = io::LengthUnit::centimetre;
    EXPECT_THAT(found(check_scan(scan), "unit"),
                HasSubstr("looks like millimetres, though manifest.csv says cm -> put mm in the column unit"));
    scan.entry.unit = io::LengthUnit::millimetre;
    EXPECT_THAT(found(check_scan(scan), "unit"), HasSubstr("looks like tenths of a millimetre"));
}

TEST(Doctor, what_forbids_the_use_of_a_scan_is_found_alone_in_the_same_words) {
    EXPECT_THAT(reasons_to_refuse(loaded(make_face())), IsEmpty());
    auto scan = loaded(mapped(make_face(), [](auto p) { return geometry::Point(0.1 * p); }));
    scan.landmarks = moved(scan.landmarks, {{"chin", {0, 0, 12}}});
    const auto all = check_scan(scan), reasons = reasons_to_refuse(scan);
    ASSERT_EQ(reasons.size(), 2U);
    EXPECT_EQ(reasons[0].kind, "unit");
    EXPECT_EQ(reasons[1].kind, "landmarks-off-scan");
    for (const auto& reason : reasons) EXPECT_THAT(all, testing::Contains(reason));
}

TEST(Doctor, a_turned_head_is_fine_in_a_pose_scan) {
    const Eigen::AngleAxisd turn(0.785, geometry::Vector::UnitY());
    const auto face = mapped(make_face(), [&](auto p) { return geometry::Point(turn * p); });
    EXPECT_THAT(found(check_scan(loaded(face)), "frame"), HasSubstr("warning: the head is turned by 4"));
    EXPECT_EQ(found(check_scan(loaded(face, "bs000_YR_R45_0")), "frame"), "");
}

TEST(Doctor, a_mirrored_scan_is_seen_by_its_texture_and_by_names_of_the_subjects_own_side) {
    const auto face = mapped(make_face(), [](auto p) { return geometry::Point(-p.x(), p.y(), p.z()); });
    auto scan = loaded(face);
    EXPECT_THAT(found(check_scan(scan), "frame"), HasSubstr("x is mirrored"));
    scan.landmarks = face.landmarks;  // names that claim the subject's own side
    scan.entry.landmarks_file = "bs000_N_N_0.csv";
    EXPECT_THAT(found(check_scan(scan), "sides"), HasSubstr("named left lie at smaller x"));
}

TEST(Doctor, a_flipped_texture_on_an_upright_face_is_a_warning_about_the_texture) {
    for (const bool lattice : {false, true}) {
        auto v_down = lattice ? make_face() : as_mesh(make_face());
        auto u_left = v_down;
        for (auto& t : v_down.scan.texture_coordinates) t.y() = 1 - t.y();
        for (auto& t : u_left.scan.texture_coordinates) t.x() = 1 - t.x();
        auto findings = check_scan(loaded(v_down));
        EXPECT_EQ(found(findings, "frame"), "") << lattice;
        EXPECT_THAT(found(findings, "texture"),
                    testing::AllOf(HasSubstr("warning: y falls while the texture goes up"), HasSubstr("v -> 1 - v")));
        findings = check_scan(loaded(u_left));
        EXPECT_EQ(found(findings, "frame"), "") << lattice;
        EXPECT_THAT(found(findings, "texture"),
                    testing::AllOf(HasSubstr("warning: x falls while the texture's u grows"), HasSubstr("u -> 1 - u")));
    }
}

TEST(Doctor, a_texture_and_a_lattice_both_against_an_upright_head_are_each_said_to_be) {
    MadeFace face = make_face();
    std::reverse(face.scan.points_mm.begin(), face.scan.points_mm.end());
    std::reverse(face.scan.texture_coordinates.begin(), face.scan.texture_coordinates.end());
    for (auto& t : face.scan.texture_coordinates) t.y() = 1 - t.y();
    const auto findings = check_scan(loaded(face));
    EXPECT_THAT(
        found(findings, "texture"),
        testing::AllOf(HasSubstr("warning: y falls while the texture goes up"),
                       HasSubstr(", though the head stands upright: the texture coordinates are mirrored -> turn v")));
    EXPECT_THAT(found(findings, "frame"),
                testing::AllOf(HasSubstr("warning: y falls while the row goes up"),
                               HasSubstr(", though the head stands upright: the lattice is stored the other way")));
    EXPECT_THAT(found(findings, "texture") + found(findings, "frame"), testing::Not(HasSubstr("though nothing else")));
}

TEST(Doctor, a_mesh_upside_down_is_an_error_where_texture_and_landmarks_agree) {
    const auto face = mapped(as_mesh(make_face()), [](auto p) { return geometry::Point(p.x(), -p.y(), p.z()); });
    EXPECT_THAT(found(check_scan(loaded(face)), "frame"),
                testing::AllOf(HasSubstr("error: y falls while the texture goes up"), HasSubstr("y is mirrored")));
    auto unmarked = loaded(face);  // now the texture stands alone
    unmarked.landmarks = {};
    const auto findings = check_scan(unmarked);
    EXPECT_EQ(found(findings, "frame"), "");
    EXPECT_THAT(found(findings, "texture"), HasSubstr("warning: y falls"));
}

TEST(Doctor, labels_that_say_the_subjects_left_get_a_warning_in_a_bosphorus_file) {
    auto scan = loaded(make_face());
    scan.checks.sides.left_label_is_subject_right = false;
    EXPECT_THAT(found(check_scan(scan), "sides"), HasSubstr("warning: labels say left where +x is"));
}

TEST(Doctor, a_swapped_pair_of_labels_is_named) {
    const auto face = renamed(
        make_face(), {{"mouth_corner_left", "mouth_corner_right"}, {"mouth_corner_right", "mouth_corner_left"}});
    EXPECT_THAT(found(check_scan(loaded(face)), "sides"), HasSubstr("left and right 'mouth_corner' are swapped"));
}

TEST(Doctor, a_lattice_stored_top_down_is_seen_though_texture_and_landmarks_are_right) {
    MadeFace face = make_face();
    const auto rows = static_cast<std::size_t>(face.scan.rows), cols = static_cast<std::size_t>(face.scan.cols);
    const auto turned = [&](const auto& values) {
        auto result = values;
        for (std::size_t i = 0; i < values.size(); ++i) result[i] = values[(rows - 1 - i / cols) * cols + i % cols];
        return result;
    };
    face.scan.points_mm = turned(face.scan.points_mm);
    face.scan.texture_coordinates = turned(face.scan.texture_coordinates);
    EXPECT_THAT(found(check_scan(loaded(face)), "frame"),
                testing::AllOf(HasSubstr("warning: y falls while the row goes up"), HasSubstr("row 0 is the lowest")));
}

TEST(Doctor, damaged_landmarks_of_the_image_are_a_warning_at_their_file) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    base::write_atomically(folder.path() / "bs000/bs000_N_N_0.lm2", "# x\n");
    for (const bool textured : {true, false}) {
        if (!textured) std::filesystem::remove(folder.path() / "bs000/bs000_N_N_0.png");
        const auto findings = check_scan(open_database(folder.path()).scans[0]);
        EXPECT_THAT(found(findings, "unreadable"), HasSubstr("warning: ")) << textured;
        EXPECT_THAT(findings[0].where, testing::EndsWith("bs000_N_N_0.lm2")) << textured;
    }
}

TEST(Doctor, two_landmarks_that_changed_places_are_named) {
    const auto eyes =
        renamed(make_face(), {{"eye_outer_left", "eye_inner_left"}, {"eye_inner_left", "eye_outer_left"}});
    EXPECT_THAT(found(check_scan(loaded(eyes)), "landmarks-swapped"),
                HasSubstr("'eye_outer_left' should lie outside of 'eye_inner_left'"));
    const auto lips = renamed(make_face(), {{"lower_lip_outer", "chin"}, {"chin", "lower_lip_outer"}});
    EXPECT_THAT(found(check_scan(loaded(lips)), "landmarks-swapped"),
                HasSubstr("'lower_lip_outer' should lie above 'chin', but lies"));
}

TEST(Doctor, missing_landmarks_are_an_error_if_alignment_needs_them) {
    const auto findings = check_scan(loaded(without(make_face(), {"nose_tip", "brow_inner_left"})));
    EXPECT_THAT(found(findings, "landmarks-missing"),
                testing::AllOf(HasSubstr("error: landmarks needed for alignment are missing: nose_tip"),
                               HasSubstr("note: landmarks are missing: brow_inner_left")));
    EXPECT_EQ(findings.front().severity, Severity::error);  // worst first
    EXPECT_THAT(found(check_scan(loaded(without(make_face(), {"nose_tip"}), "bs000_YR_R90_0")), "landmarks-missing"),
                HasSubstr("note: "));
    auto none = loaded(make_face());
    none.landmarks = {};
    none.entry.landmarks_file.clear();
    EXPECT_THAT(found(check_scan(none), "landmarks-missing"), HasSubstr("there is no landmark file"));
}

TEST(Doctor, landmarks_off_the_surface_are_named_with_their_distance) {
    MadeFace face = make_face();
    face.landmarks = moved(face.landmarks, {{"chin", {0, 0, 5}}});
    EXPECT_THAT(found(check_scan(loaded(face)), "landmarks-off-scan"),
                HasSubstr("warning: landmarks lie off the scan: chin (4."));
    std::map<std::string, geometry::Vector> all;
    for (const auto name : geometry::standard_landmark_names()) all[std::string(name)] = {0, 0, 40};
    face.landmarks = moved(make_face().landmarks, all);
    EXPECT_THAT(found(check_scan(loaded(face)), "landmarks-off-scan"), HasSubstr("pair the files again"));
}

/// The made face with every fourth point of every fourth row: 8 mm apart.
MadeFace thinned(const MadeFace& face, bool faces) {
    MadeFace thin = face;
    thin.scan = {};
    const int cols = (face.scan.cols + 3) / 4;
    for (int row = 0; row < face.scan.rows; row += 4)
        for (int col = 0; col < face.scan.cols; col += 4)
            thin.scan.points_mm.push_back(face.scan.points_mm[static_cast<std::size_t>(row * face.scan.cols + col)]);
    for (int i = 0; faces && i + cols < static_cast<int>(thin.scan.points_mm.size()); ++i)
        if (i % cols + 1 < cols) {
            const auto a = static_cast<std::uint32_t>(i), up = a + static_cast<std::uint32_t>(cols);
            thin.scan.faces.add(std::array{a, a + 1, up + 1, up});
        }
    return thin;
}

TEST(Doctor, landmarks_are_measured_to_the_surface_and_not_to_its_points) {
    for (const bool faces : {true, false}) {  // of a mesh and of a cloud
        auto face = thinned(make_face(), faces);
        // In the middle of a cell: 5.7 mm from every vertex, on the cheek, where the surface is nearly flat.
        const auto cols = static_cast<std::size_t>(16);
        const auto& p = face.scan.points_mm;
        const std::size_t a = 8 * cols + 12;
        const geometry::Point middle = (p[a] + p[a + cols + 1]) / 2;
        const geometry::Landmarks on({{"cheek", middle, ""}});
        const geometry::Landmarks off({{"cheek", middle + geometry::Vector(0, 0, 6), ""}});
        EXPECT_GT(nearest_scan_points(face.scan, on)[0].distance_mm, 5);
        EXPECT_LT(landmark_distances_mm(face.scan, on)[0], faces ? 1e-9 : 1.0);
        EXPECT_NEAR(landmark_distances_mm(face.scan, off)[0], 5, 1);  // the surface slopes there
        EXPECT_GE(landmark_distances_mm(face.scan, on, 20)[0], 5);    // near enough to be told by a point
        auto scan = loaded(face);
        scan.landmarks = on;
        EXPECT_EQ(found(check_scan(scan), "landmarks-off-scan"), "");
    }
    auto lattice = make_face();
    const geometry::Landmarks between(
        {{"cheek", (lattice.scan.points_mm[1000] + lattice.scan.points_mm[1062]) / 2, ""}});
    EXPECT_LT(landmark_distances_mm(lattice.scan, between)[0], 1e-9);
    for (std::size_t i = 0; i < lattice.scan.points_mm.size(); ++i)  // half of it stands a metre behind
        if (i % 61 >= 1062 % 61) lattice.scan.points_mm[i].z() -= 1000;
    const geometry::Point edge = lattice.scan.points_mm[1061];
    const geometry::Landmarks jump({{"cheek", edge - geometry::Vector(-1, 0, 500), ""}});
    EXPECT_GT(landmark_distances_mm(lattice.scan, jump)[0], 400);  // nothing was measured in between
}

TEST(Doctor, a_one_sided_scan_that_moves_the_other_corner_is_an_error) {
    MadeFace face = make_face();
    const auto neutral = face.landmarks;
    face.landmarks = moved(neutral, {{"mouth_corner_right", {-5, 6, -2}}});
    EXPECT_THAT(found(check_scan(loaded(face, "bs000_LFAU_12L_0"), &neutral), "one-sided"),
                testing::AllOf(HasSubstr("taken as the subject's left side, but the right mouth corner moves"),
                               HasSubstr("LFAU_12R")));
    EXPECT_EQ(found(check_scan(loaded(face, "bs000_LFAU_12R_0"), &neutral), "one-sided"), "");
    // A wink: what the mouth does beside it says nothing about the code.
    EXPECT_EQ(found(check_scan(loaded(face, "bs000_UFAU_46L_0"), &neutral), "one-sided"), "");
}

TEST(Doctor, holes_are_counted_and_the_largest_measured) {
    MadeFace face = mapped(make_face(), [](auto p) { return geometry::Point(p.x(), p.y(), 0); });  // flat: known spans
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const auto open = [&](int row, int col) {
        face.scan.points_mm[static_cast<std::size_t>(row * face.scan.cols + col)].setConstant(nothing);
    };
    open(20, 20);
    for (int row = 60; row < 63; ++row)
        for (int col = 30; col < 33; ++col) open(row, col);
    for (int row = 0; row < 10; ++row) open(row, 5);  // reaches the edge of the lattice: outline, no hole
    const auto holes = find_holes(face.scan);
    EXPECT_TRUE(holes.judged);
    EXPECT_EQ(holes.count, 2);
    // The rim of 3 x 3 missing cells spans 4 cells of 2 mm in x and in y.
    EXPECT_NEAR(holes.largest_mm, std::sqrt(64.0 + 64.0), 1e-9);  // rounding
    EXPECT_NEAR(holes.largest_at_mm.y(), (61 - 40) * 2.0, 1e-9);
    EXPECT_THAT(found(check_scan(loaded(face)), "holes"), HasSubstr("note: 2 holes, the largest 11.3 mm"));
    DoctorOptions strict;
    strict.max_hole_mm = 5;
    EXPECT_THAT(found(check_scan(loaded(face), nullptr, strict), "holes"), HasSubstr("warning: 2 holes"));
}

TEST(Doctor, a_hole_in_the_cheek_is_a_warning_and_holes_where_scanners_lose_points_are_a_note) {
    const auto with_hole = [](double left, double right, double low, double high) {  // mm, of the made face
        MadeFace face = make_face();
        for (auto& p : face.scan.points_mm)
            if (p.x() > left && p.x() < right && p.y() > low && p.y() < high)
                p.setConstant(std::numeric_limits<double>::quiet_NaN());
        return found(check_scan(loaded(face)), "holes");
    };
    EXPECT_THAT(with_hole(31, 47, -21, -5), HasSubstr("warning: 1 hole, one of them"));  // cheek
    EXPECT_THAT(with_hole(-9, 9, 57, 75), HasSubstr("warning: 1 hole, one of them"));    // forehead
    EXPECT_THAT(with_hole(17, 43, 29, 43), HasSubstr("note: 1 hole, the largest"));      // eye
    EXPECT_THAT(with_hole(-47, -15, 47, 57), HasSubstr("note: 1 hole, the largest"));    // brow
    EXPECT_THAT(with_hole(-17, 17, -9, 3), HasSubstr("note: 1 hole, the largest"));      // nostrils
    EXPECT_THAT(with_hole(-25, 25, -41, -27), HasSubstr("note: 1 hole, the largest"));   // lips
    EXPECT_THAT(with_hole(-15, 15, -77, -67), HasSubstr("note: 1 hole, the largest"));   // under the chin
    EXPECT_THAT(with_hole(35, 41, -15, -9), HasSubstr("note: 1 hole, the largest"));     // cheek, but small
}

TEST(Doctor, holes_of_a_mesh_are_its_inner_rims) {
    const MadeFace face = mapped(make_face(), [](auto p) { return geometry::Point(p.x(), p.y(), 0); });
    geometry::RangeScan mesh;
    mesh.points_mm = face.scan.points_mm;
    for (int row = 0; row + 1 < face.scan.rows; ++row)
        for (int col = 0; col + 1 < face.scan.cols; ++col) {
            if (row >= 40 && row < 43 && col == 30) continue;  // 3 quads
            const auto a = static_cast<std::uint32_t>(row * face.scan.cols + col),
                       up = a + static_cast<std::uint32_t>(face.scan.cols);
            mesh.faces.add(std::array{a, a + 1, up + 1, up});
        }
    const auto holes = find_holes(mesh);
    EXPECT_EQ(holes.count, 1);
    EXPECT_NEAR(holes.largest_mm, std::sqrt(4.0 + 36.0), 1e-9);  // 2 x 6 mm; rounding
    mesh.faces = {};
    EXPECT_FALSE(find_holes(mesh).judged);
}

TEST(Doctor, spikes_are_told_with_their_share_and_many_of_them_as_a_warning) {
    MadeFace face = make_face();
    EXPECT_EQ(found(check_scan(loaded(face)), "spikes"), "");
    face.scan.points_mm[25 * 61 + 30].z() += 12;
    EXPECT_THAT(found(check_scan(loaded(face)), "spikes"), HasSubstr("note: 1 point (0.02 %) more than 4 mm off"));
    for (std::size_t i = 0; i < 20; ++i) face.scan.points_mm[(10 + 3 * i) * 61 + 10].z() += 12;
    EXPECT_THAT(found(check_scan(loaded(face)), "spikes"), HasSubstr("warning: 21 points"));
}

TEST(Doctor, unreadable_landmarks_do_not_hide_what_is_wrong_with_the_scan) {
    const TemporaryFolder folder;
    MadeFace face = make_face();
    face.scan.points_mm[25 * 61 + 30].z() += 12;
    write_scan(folder.path(), "bs000_N_N_0", face);
    base::write_atomically(folder.path() / "bs000/bs000_N_N_0.lm3", "damaged");
    const auto findings = check_scan(open_database(folder.path()).scans[0]);
    EXPECT_THAT(found(findings, "unreadable"), HasSubstr("bs000_N_N_0.lm3"));
    EXPECT_THAT(found(findings, "spikes"), HasSubstr("1 point"));
    EXPECT_EQ(found(findings, "landmarks-missing"), "");
    EXPECT_THAT(findings[0].where, testing::EndsWith("bs000_N_N_0.lm3"));
    EXPECT_EQ(findings[0].mend, "mend, replace or restore the landmark file");
}

TEST(Doctor, an_unreadable_scan_and_unreadable_landmarks_are_two_findings_each_at_its_file) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    std::filesystem::resize_file(folder.path() / "bs000/bs000_N_N_0.bnt", 1000);
    base::write_atomically(folder.path() / "bs000/bs000_N_N_0.lm3", "damaged");
    const auto findings = check_scan(open_database(folder.path()).scans[0]);
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_THAT(findings[0].where, testing::EndsWith(".bnt"));
    EXPECT_THAT(findings[1].where, testing::EndsWith(".lm3"));
}

TEST(Doctor, a_truncated_scan_is_one_finding) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    std::filesystem::resize_file(folder.path() / "bs000/bs000_N_N_0.bnt", 1000);
    const auto findings = check_scan(open_database(folder.path()).scans[0]);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_THAT(findings[0].what, HasSubstr("bs000_N_N_0.bnt: has 1000 bytes"));
}

TEST(Doctor, a_texture_that_is_missing_damaged_or_turned_is_named) {
    const TemporaryFolder folder;
    MadeFace face = make_face();
    write_scan(folder.path(), "bs000_N_N_0", face);
    write_scan(folder.path(), "bs000_N_N_1", face);
    for (auto& t : face.scan.texture_coordinates) t.y() = 1 - t.y();
    write_scan(folder.path(), "bs000_N_N_2", face);
    std::filesystem::remove(folder.path() / "bs000/bs000_N_N_0.png");
    std::filesystem::resize_file(folder.path() / "bs000/bs000_N_N_1.png", 60);
    const auto database = open_database(folder.path());
    EXPECT_THAT(found(check_scan(database.scans[0]), "texture"), HasSubstr("'bs000_N_N_0.png' is not beside it"));
    EXPECT_THAT(found(check_scan(database.scans[1]), "texture"), HasSubstr("bs000_N_N_1.png"));
    EXPECT_THAT(found(check_scan(database.scans[2]), "texture"),
                HasSubstr("texture coordinates lie u to the right, v up"));  // a .bnt counts v from the top
}

TEST(Doctor, a_turned_texture_and_its_mend_are_said_as_the_format_counts_v) {
    auto scan = loaded(make_face());
    scan.entry.texture_file = "image.png";
    scan.checks.texture = {TextureAxes::u_right_v_down, {40, 1, 50, 50}, 22, true};
    EXPECT_THAT(found(check_scan(scan), "texture"), testing::AllOf(HasSubstr("lie u to the right, v up ("),
                                                                   HasSubstr("-> write the scan again with u to "
                                                                             "the right and v down from the top")));
    scan.entry.scan_file = "scan.PLY";
    EXPECT_THAT(found(check_scan(scan), "texture"), testing::AllOf(HasSubstr("lie u to the right, v down ("),
                                                                   HasSubstr("-> write the scan again with u to "
                                                                             "the right and v up from the bottom")));
}

TEST(Doctor, a_texture_of_several_charts_is_a_note) {
    auto scan = loaded(as_mesh(make_face()));
    scan.scan.texture_seam_points = 61;
    EXPECT_THAT(
        found(check_scan(scan), "texture"),
        testing::AllOf(testing::StartsWith("note: its texture has several charts (61 points lie in more than one)"),
                       HasSubstr("-> nothing need be done")));
}

TEST(Doctor, findings_survive_json) {
    const std::vector<Finding> findings = {{Severity::error, "unit", "a \"quoted\" \xC3\xA4", "file", "mend"},
                                           {Severity::note, "holes", "", "", ""}};
    EXPECT_EQ(findings_from_json(to_json(findings)), findings);
    EXPECT_THAT(message_of<InputError>([] { (void)findings_from_json("[{}]"); }), HasSubstr("findings: not the JSON"));
}

}  // namespace
}  // namespace mimik::database
