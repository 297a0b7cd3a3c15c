#include "modeling/region_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "modeling/average_fingerprint.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/thrown.h"

namespace mimik::modeling {
namespace {

using geometry::Point;
using testing::HasSubstr;

class Regions : public testing::Test {
protected:
    Regions() : average(test::analytic_average()), labels(label_regions(average.grid, average.landmarks)) {}
    [[nodiscard]] std::string at(double x, double y) const {
        std::size_t best = 0;
        double nearest = 1e9;
        for (std::size_t v = 0; v < average.grid.size(); ++v) {
            const double d = std::hypot(average.grid.vertices_mm[v].x() - x, average.grid.vertices_mm[v].y() - y);
            if (average.grid.inside(v) && d < nearest) {
                nearest = d;
                best = v;
            }
        }
        return labels.label[best];
    }
    preprocessing::AverageFace average;
    RegionLabels labels;
};

TEST_F(Regions, lie_where_their_names_say) {
    EXPECT_EQ(at(0, 0), "nose");
    EXPECT_EQ(at(0, 75), "forehead");
    EXPECT_EQ(at(32, 53), "brow_left");
    EXPECT_EQ(at(-32, 53), "brow_right");
    EXPECT_EQ(at(32, 35), "eye_left");
    EXPECT_EQ(at(-45, -10), "cheek_right");
    EXPECT_EQ(at(0, -26), "upper_lip");
    EXPECT_EQ(at(5, -38), "lower_lip");
    EXPECT_EQ(at(0, -62), "chin");
}

TEST_F(Regions, every_vertex_of_the_inside_has_one_and_the_halves_mirror_each_other) {
    const auto& grid = average.grid;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const auto v = grid.index(row, col), mirror = grid.index(row, grid.cols - 1 - col);
            ASSERT_EQ(labels.label[v].empty(), !grid.inside(v));
            if (grid.inside(v) && grid.inside(mirror)) {
                ASSERT_EQ(labels.label[mirror], geometry::mirrored_name(labels.label[v])) << row << " " << col;
            }
        }
}

TEST_F(Regions, a_label_file_comes_back_as_it_was_and_says_which_vertex_is_off_the_grid) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "regions.csv";
    base::write_atomically(file, encode_region_labels(labels, average_fingerprint(average)));
    EXPECT_EQ(read_region_labels(file, average).label, labels.label);
    EXPECT_EQ(read_region_labels(file, labels.rows, labels.cols).label, labels.label);
    base::write_atomically(file, "row,col,region\n3,999,nose\n");
    EXPECT_THAT(database::message_of<InputError>([&] { (void)read_region_labels(file, average); }),
                HasSubstr("(3, 999)"));
}

TEST_F(Regions, labels_of_another_average_face_or_schema_are_refused) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "regions.csv";
    auto other = average;
    other.landmarks = geometry::transformed(average.landmarks, geometry::Transform(Eigen::Translation3d(0, 0, 1e-6)));
    const auto refused = [&](const std::string& text) {
        base::write_atomically(file, text);
        return database::message_of<InputError>([&] { (void)read_region_labels(file, average); });
    };
    EXPECT_THAT(refused(encode_region_labels(labels, average_fingerprint(other))),
                testing::AllOf(HasSubstr("regions.csv: line 1"), HasSubstr(average_fingerprint(average))));
    EXPECT_THAT(refused("# mimik regions, schema 2, average face 0\nrow,col,region\n"), HasSubstr("schema is '2'"));
    base::write_atomically(file, "# drawn by hand\nrow,col,region\n0,0,mine\n");
    EXPECT_EQ(read_region_labels(file, average).label[0], "mine");
}

TEST_F(Regions, a_hostile_label_file_is_refused_with_line_column_and_value) {
    const auto error = [](const std::string& text) {
        return test::message_of([&] { (void)decode_region_labels(text, "l.csv", 4, 5); });
    };
    EXPECT_EQ(error("row,col,region\n3,4,nose\n"), "nothing was thrown");
    for (const char* row : {"nan", "1e999", "-1", "0.5", "4", "2147483648"})
        EXPECT_THAT(error("row,col,region\n0,0,nose\n" + std::string(row) + ",0,nose\n"), HasSubstr("l.csv: line 3: "))
            << row;
    EXPECT_THAT(error("row,col\n0,0\n"), HasSubstr("l.csv: column 'region' is missing"));
    EXPECT_THAT(error("row,col,region\n0,0\n"), HasSubstr("l.csv: line 2: 2 fields"));
}

TEST_F(Regions, a_name_with_a_comma_comes_back_from_its_file) {
    RegionLabels named{1, 2, {"nose, left", ""}};
    EXPECT_EQ(decode_region_labels(encode_region_labels(named, "0123456789abcdef"), "l.csv", 1, 2).label, named.label);
}

TEST_F(Regions, a_list_is_split_at_commas_unless_it_is_a_regions_own_name) {
    const RegionLabels named{1, 3, {"nose, left", "chin", "jaw"}};
    const std::vector<std::string> lists = {"chin,jaw", "nose, left", "jaw, ear"};
    EXPECT_THAT(listed_regions(named, lists), testing::ElementsAre("chin", "jaw", "nose, left", "jaw", "ear"));
}

TEST_F(Regions, a_held_region_keeps_nothing_and_the_face_far_from_it_everything) {
    const auto subject = test::analytic_subject(average, 1.0, 0.0);
    const std::vector<std::string> held = {"nose"};
    const auto weights = held_weights(labels, average, subject.neutral, held, 10.0);
    const Point nose = subject.neutral.landmarks.position_mm("nose_tip"),
                chin = subject.neutral.landmarks.position_mm("chin");
    for (std::size_t v = 0; v < weights.size(); ++v) {
        if (!subject.neutral.grid.inside(v)) continue;
        if ((subject.neutral.grid.vertices_mm[v] - nose).norm() < 4) {
            ASSERT_EQ(weights[v], 0.0);
        }
        if ((subject.neutral.grid.vertices_mm[v] - chin).norm() < 10) {
            ASSERT_EQ(weights[v], 1.0);
        }
    }
}

TEST_F(Regions, an_unknown_region_is_named_with_those_there_are) {
    const auto subject = test::analytic_subject(average, 1.0, 0.0);
    const std::vector<std::string> held = {"ear"};
    try {
        (void)held_weights(labels, average, subject.neutral, held, 10.0);
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::AllOf(HasSubstr("'ear'"), HasSubstr("upper_lip")));
    }
}

}  // namespace
}  // namespace mimik::modeling
