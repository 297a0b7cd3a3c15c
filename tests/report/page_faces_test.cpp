#include "report/page_faces.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "evaluation/case_store.h"
#include "evaluation/experiment.h"
#include "report/page_buffers.h"
#include "tests/support/expressions.h"
#include "tests/support/workspace_test.h"

namespace mimik::report {
namespace {

using evaluation::CaseRow;
using nlohmann::json;
using testing::HasSubstr;

/// One experiment on faces in closed form, and its page's faces.
class PageFaces : public test::WorkspaceTest<PageFaces> {
protected:
    static void SetUpTestSuite() {
        test::WorkspaceTest<PageFaces>::SetUpTestSuite();
        evaluation::ExperimentOptions options;
        options.expressions = {test::expression("12")};
        options.methods = {animation::method_by_name("sparse"), animation::method_by_name("sparse-mean")};
        reader_ = new evaluation::PerformanceReader(*workspace_);
        plan_ = new evaluation::ExperimentPlan(
            evaluation::plan_experiment(*workspace_, facs::builtin_catalogue(), options, false));
        store_ = new evaluation::CaseStore;
        (void)evaluation::run_experiment(*reader_, facs::builtin_catalogue(), *plan_, *store_);
    }
    static void TearDownTestSuite() {
        delete store_;
        delete plan_;
        delete reader_;
        test::WorkspaceTest<PageFaces>::TearDownTestSuite();
    }
    static void read(const std::function<void(const CaseRow&)>& visit) { store_->read(visit); }
    static json faces(const PageFacesOptions& options, std::vector<std::string>* told = nullptr) {
        std::vector<std::string> remarks;
        const auto text = page_faces(*reader_, facs::builtin_catalogue(), *plan_, choose_faces(read, *plan_, options),
                                     options, remarks);
        if (told) *told = remarks;
        return json::parse(text);
    }
    static double row_mm(const std::string& source, const std::string& target, const std::string& method) {
        double mm = -1;
        read([&](const CaseRow& row) {
            if (row.key.source == source && row.key.target == target && row.key.method == method &&
                row.estimator == "surface_distance" && row.region == "zone" && row.metric == "mean")
                mm = row.value.value_or(-1);
        });
        return mm;
    }
    static inline evaluation::PerformanceReader* reader_ = nullptr;
    static inline evaluation::ExperimentPlan* plan_ = nullptr;
    static inline evaluation::CaseStore* store_ = nullptr;
};

TEST_F(PageFaces, every_error_is_that_of_the_row_and_the_heat_map_has_it_as_its_mean) {
    PageFacesOptions options;
    options.most_faces = 1;
    const auto document = faces(options);
    const auto& face = document.at("faces").at(0);
    const auto vertices = face.at("neutral").at("vertices").get<std::size_t>();
    const auto& smile = face.at("expressions").at(0);
    const auto zone = unpacked_bytes(smile.at("zone"), vertices);
    ASSERT_EQ(smile.at("shapes").size(), 2U);
    EXPECT_EQ(smile.at("nothing").at("error_mm"), row_mm("", face.at("target"), "nothing"));
    for (const auto& shape : smile.at("shapes")) {
        EXPECT_EQ(shape.at("error_mm"), row_mm(shape.at("source"), face.at("target"), shape.at("method")))
            << shape.at("method");
        const auto steps = unpacked_steps(shape.at("distance"), vertices);
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t v = 0; v < vertices; ++v)
            if (zone[v] != 0) {
                ASSERT_NE(steps[v], page_no_value);
                sum += page_step_mm * steps[v];
                ++count;
            }
        ASSERT_GT(count, 100U);
        // Each value is rounded by half a step at most.
        EXPECT_NEAR(sum / static_cast<double>(count), shape.at("error_mm").get<double>(), page_step_mm / 2);
    }
}

TEST_F(PageFaces, targets_go_from_the_best_to_the_worst_and_say_their_rank) {
    PageFacesOptions options;
    options.most_faces = 2;
    const auto choice = choose_faces(read, *plan_, options);
    ASSERT_EQ(choice.faces.size(), 2U);
    EXPECT_THAT(choice.faces[0].why, testing::StartsWith("rank 1 of 3 by "));
    EXPECT_THAT(choice.faces[1].why, testing::StartsWith("rank 3 of 3 by "));
    const auto judge = choice.faces[0].why.substr(std::string("rank 1 of 3 by ").size());
    const auto explained = [&](const std::string& target) {
        double sum = 0, nothing = 0;
        read([&](const CaseRow& row) {
            if (row.key.target != target || row.estimator != "surface_distance" || row.region != "zone") return;
            if (row.key.method == judge) {
                sum += *row.value;
                nothing += row_mm("", target, "nothing");
            }
        });
        return 1 - sum / nothing;
    };
    EXPECT_GT(explained(choice.faces[0].target), explained(choice.faces[1].target));
    EXPECT_THAT(choice.methods, testing::ElementsAre("sparse", "sparse-mean"));
}

TEST_F(PageFaces, control_points_stand_on_vertices_and_of_both_sides_there_are_as_many) {
    PageFacesOptions options;
    options.targets = {"bs001"};
    const auto document = faces(options);
    const auto& face = document.at("faces").at(0);
    EXPECT_EQ(face.at("target"), "bs001");
    const auto vertices = face.at("neutral").at("vertices").get<std::size_t>();
    const auto x = unpacked_steps(face.at("neutral").at("positions").at(0), vertices);
    int left = 0, right = 0;
    for (const auto& point : face.at("expressions").at(0).at("controls")) {
        const auto v = point.at("vertex").get<std::size_t>();
        ASSERT_LT(v, vertices);
        const auto name = point.at("name").get<std::string>();
        // The face is symmetric about x = 0, which is the middle of the page.
        if (name.ends_with("_left")) left += x[v] > 0 ? 1 : 0;
        if (name.ends_with("_right")) right += x[v] < 0 ? 1 : 0;
    }
    EXPECT_GT(left, 0);
    EXPECT_EQ(left, right);
}

TEST_F(PageFaces, the_first_face_stays_and_one_that_would_make_the_page_too_large_is_left_out_with_a_word) {
    PageFacesOptions options;
    options.most_bytes = 10;
    std::vector<std::string> remarks;
    EXPECT_EQ(faces(options, &remarks).at("faces").size(), 1U);
    EXPECT_THAT(remarks, testing::Each(HasSubstr("would make the page too large")));
    EXPECT_EQ(remarks.size(), 2U);
}

TEST_F(PageFaces, who_has_no_row_is_refused_by_name) {
    PageFacesOptions options;
    options.targets = {"bs009"};
    EXPECT_THROW((void)choose_faces(read, *plan_, options), InputError);
    options.targets.clear();
    options.methods = {"thesis"};
    EXPECT_THROW((void)choose_faces(read, *plan_, options), InputError);
    options.methods.clear();
    options.most_faces = -1;
    EXPECT_THROW((void)choose_faces(read, *plan_, options), InputError);
}

}  // namespace
}  // namespace mimik::report
