#include "base/csv.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::base {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

/// The rows of a table as "name=x" words.
std::vector<std::string> rows_of(const std::string& text) {
    CsvReader rows(text, "t.csv");
    const auto name = rows.column("name"), x = rows.column("x");
    std::vector<std::string> words;
    while (rows.next()) words.push_back(rows.field(name) + "=" + std::to_string(rows.number(x)));
    return words;
}

std::string refused(const std::string& text) {
    return message_of([&] { (void)rows_of(text); });
}

std::string utf16(const std::string& text, bool big, bool mark) {
    std::string out;
    const auto add = [&](char16_t unit) {
        const char low = static_cast<char>(unit & 0xFF), high = static_cast<char>(unit >> 8);
        out += big ? high : low;
        out += big ? low : high;
    };
    if (mark) add(0xFEFF);
    for (const char c : text) add(static_cast<unsigned char>(c));
    return out;
}

TEST(Csv, tables_of_spreadsheets_are_read_whatever_separates_their_columns) {
    const auto as_they_are = ElementsAre("a=1.500000", "b=-20.000000");
    for (const char* text :
         {"name,x\na,1.5\nb,-20\n", "name;x\na;1,5\nb;-20\n", "name\tx\na\t1,5\nb\t-20\n", "name\tx\na\t1.5\nb\t-2e1\n",
          "sep=;\nname;x\na;1,5\nb;-20\n", "\"sep=;\"\nname;x\na;1,5\nb;-20\n", "sep=\t\nname\tx\na\t1.5\nb\t-20\n",
          "sep=,\r\nname,x\r\na,1.5\r\nb,-20\r\n", "name,x\ra,1.5\rb,-20\r", "name,x\na,\"1,5\"\nb,\"-20,0\"\n",
          "name,x,,,\na,1.5,,,\nb,-20,,,\n,,,,\n", "name,x\na,1.5,,\nb,-20\n,,,,\n , \n",
          "name;x;;\na;1,5\nb;-20;;\n;;;\n", "\xEF\xBB\xBFname;x\n\na;1,5\n\"\";\"\"\nb;-20,0\n"})
        EXPECT_THAT(rows_of(text), as_they_are) << text;
    for (const bool big : {false, true})
        for (const bool mark : {false, true})
            EXPECT_THAT(rows_of(utf16("name\tx\r\na\t1,5\r\nb\t-20\r\n", big, mark)), as_they_are);
}

TEST(Csv, a_name_in_utf_16_becomes_utf_8) {
    std::string text("\xFF\xFE", 2);
    for (const char16_t unit : std::u16string(u"name,x\nB\u00E4r\u20AC\U0001F600,1\n")) {
        text += static_cast<char>(unit & 0xFF);
        text += static_cast<char>(unit >> 8);
    }
    EXPECT_THAT(rows_of(text), ElementsAre("B\xC3\xA4r\xE2\x82\xAC\xF0\x9F\x98\x80=1.000000"));
}

TEST(Csv, what_cannot_be_read_is_named) {
    EXPECT_THAT(refused("a,1.5,2\nb,-20,3\n"), HasSubstr("t.csv: line 1: the header line is missing: 'a,1.5,2'"));
    EXPECT_THAT(refused("a;1,5;2,5\n"), HasSubstr("the header line is missing"));
    EXPECT_THAT(refused("0,0,0\n"), HasSubstr("the header line is missing"));  // not: column '0' appears twice
    EXPECT_THAT(refused("name,x\na,1,5\n"), HasSubstr("a number has a decimal point"));
    EXPECT_THAT(refused("name;x\na;1.234,5\n"), HasSubstr("no mark between thousands is read"));
    EXPECT_THAT(refused("name;x\na;1,5\nb;2.5\n"), HasSubstr("numbers before it have a decimal comma"));
    EXPECT_THAT(refused("sep=;\n"), HasSubstr("only a line 'sep=' is in it"));
    EXPECT_THAT(refused("names;x\na;1\n"), HasSubstr("it has 'names', 'x' (separated by semicolons)"));
    EXPECT_THAT(refused("name;x\na;1;7\n"), HasSubstr("t.csv: line 2: 3 fields where the header names 2 columns"));
}

}  // namespace
}  // namespace mimik::base
