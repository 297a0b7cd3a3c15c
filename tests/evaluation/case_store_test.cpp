#include "evaluation/case_store.h"

#include <fstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"

namespace mimik::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const CaseRow whole = {{"bs001", "bs000", "12L", "default", 0.5}, "surface_distance", "zone", "mean", 0.1, "mm", ""};
const CaseRow odd = {{"", "a, b", "SNEER", "own"},       "field", "face", "left_out", std::nullopt, "vertices",
                     "scored as doing nothing: \"x\", y"};

std::vector<CaseRow> rows_of(const CaseStore& store) {
    std::vector<CaseRow> rows;
    store.read([&](const CaseRow& row) { rows.push_back(row); });
    return rows;
}

TEST(CaseStore, gives_back_what_was_appended_to_the_last_digit_and_in_that_order) {
    CaseStore store;
    auto digits = whole;
    digits.value = 0.1 + 0.2;
    store.append("12L bs000", std::vector{whole, digits});
    store.append("SNEER a, b", std::vector{odd});
    EXPECT_THAT(rows_of(store), ElementsAre(whole, digits, odd));
    EXPECT_EQ(store.units(), 2U);
    EXPECT_THROW(store.append("12L bs000", {}), InputError);
}

TEST(CaseStore, takes_its_name_when_it_is_finished_and_leaves_nothing_else) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "deep" / "cases.csv";
    {
        CaseStore store(file);
        store.append("unit", std::vector{whole});
        EXPECT_FALSE(std::filesystem::exists(file));
    }
    EXPECT_TRUE(std::filesystem::is_empty(file.parent_path()));  // an unfinished one goes with its store
    CaseStore store(file);
    store.append("unit", std::vector{whole});
    store.finish();
    std::vector<CaseRow> rows;
    EXPECT_THAT(read_case_rows(file, [&](const CaseRow& row) { rows.push_back(row); }), ElementsAre("unit"));
    EXPECT_THAT(rows, ElementsAre(whole));
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
}

TEST(CaseStore, that_was_cut_short_or_damaged_counts_up_to_the_last_whole_unit) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "cases.csv";
    CaseStore store(file);
    store.append("first", std::vector{whole, odd});
    store.append("second", std::vector{whole});
    store.finish();
    const auto text = base::read_text(file);
    const auto second = text.find("bs001", text.find("# unit first"));
    auto damaged = text;
    damaged[second] = 'x';
    for (const auto& broken : {text.substr(0, text.size() - 5), text.substr(0, second + 3), damaged,
                               text + "bs001,bs000,12L,own,1,field,face,left_out,,vertices,\"cut within"}) {
        base::write_atomically(file, broken);
        std::vector<CaseRow> rows;
        const auto units = read_case_rows(file, [&](const CaseRow& row) { rows.push_back(row); });
        if (broken.size() > text.size())  // a third unit was cut within quotes
            EXPECT_THAT(units, ElementsAre("first", "second"));
        else
            EXPECT_THAT(units, ElementsAre("first"));
        EXPECT_EQ(rows.size(), units.size() + 1);
    }
    base::write_atomically(file, "something else\n");
    EXPECT_THAT(database::message_of<InputError>([&] { (void)read_case_rows(file, [](const CaseRow&) {}); }),
                HasSubstr("is no table of cases"));
}

TEST(CaseStore, that_cannot_be_written_is_refused_by_its_name) {
    const database::TemporaryFolder folder;
    base::write_atomically(folder.path() / "file", "no folder");
    EXPECT_THAT(database::message_of<InputError>([&] { const CaseStore store(folder.path() / "file" / "cases.csv"); }),
                HasSubstr("cases.csv: cannot be written"));
}

TEST(CaseStore, is_gone_on_with_after_its_last_whole_unit_wherever_it_was_cut) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "rows.part";
    const auto fill = [&](CaseStore& store) {
        for (const auto* unit : {"first", "second"})
            if (!store.has(unit)) store.append(unit, std::vector{whole, odd});
    };
    {
        auto store = CaseStore::gone_on_with(file);
        EXPECT_EQ(store.units(), 0U);
        fill(store);
        EXPECT_THAT(rows_of(store), ElementsAre(whole, odd, whole, odd));
    }
    const auto text = base::read_text(file);
    const auto first_line = text.find('\n') + 1;
    const auto end_of_first = text.find('\n', text.find("# unit first")) + 1;
    for (auto length = first_line; length <= text.size(); ++length) {
        base::write_atomically(file, text.substr(0, length));
        auto store = CaseStore::gone_on_with(file);
        const std::size_t whole_units = length == text.size() ? 2 : length >= end_of_first ? 1 : 0;
        ASSERT_EQ(store.units(), whole_units) << length;
        fill(store);
        store.finish();
        ASSERT_EQ(base::read_text(file), text) << length;
    }
}

TEST(CaseStore, that_is_none_is_not_gone_on_with) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "rows.part";
    for (const auto* text : {"", "something else\n", "source,target"}) {
        base::write_atomically(file, text);
        EXPECT_THROW((void)CaseStore::gone_on_with(file), InputError);
        EXPECT_EQ(base::read_text(file), text);
    }
}

TEST(CaseStore, of_several_files_counts_a_unit_where_it_comes_first_and_names_the_file_at_fault) {
    const database::TemporaryFolder folder;
    const auto write = [&](const char* name, const std::vector<std::pair<std::string, CaseRow>>& units) {
        CaseStore store(folder.path() / name);
        for (const auto& [unit, row] : units) store.append(unit, std::vector{row});
        store.finish();
        return folder.path() / name;
    };
    const auto first = write("first", {{"cast", odd}, {"1", whole}});
    const auto second = write("second", {{"cast", odd}, {"2", whole}});
    auto store = CaseStore::of_files({first, second});
    EXPECT_THAT(rows_of(store), ElementsAre(odd, whole, whole));
    EXPECT_EQ(store.units(), 3U);
    EXPECT_TRUE(store.has("2"));
    EXPECT_THAT(database::message_of<InputError>([&] { store.append("3", std::vector{whole}); }),
                HasSubstr("none of the files"));

    const auto other = write("other", {{"cast", whole}});
    EXPECT_THAT(database::message_of<InputError>([&] {
                    (void)CaseStore::of_files({first, other});
                }),
                testing::AllOf(HasSubstr("other: "), HasSubstr("other rows of unit 'cast'")));
    const auto text = base::read_text(second);
    base::write_atomically(second, text.substr(0, text.size() - 4));
    EXPECT_THAT(database::message_of<InputError>([&] {
                    (void)CaseStore::of_files({first, second});
                }),
                testing::AllOf(HasSubstr("second: is damaged after byte"), HasSubstr("make it again")));
}

}  // namespace
}  // namespace mimik::evaluation
