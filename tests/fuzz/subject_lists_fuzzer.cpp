#include <algorithm>

#include "base/text.h"
#include "database/hidden_subjects.h"
#include "database/manifest.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

void hidden_list(std::string_view text, const std::vector<std::string>& subjects) {
    const auto list = database::parse_hidden_subjects(text, "input", subjects);
    require(std::is_sorted(list.subjects.begin(), list.subjects.end()), "subjects are sorted");
    require(std::adjacent_find(list.subjects.begin(), list.subjects.end()) == list.subjects.end(),
            "a subject stands once");
    require(list.remarks.size() <= 50, "remarks do not grow with the file");
    for (const auto& subject : list.subjects)
        require(std::find(subjects.begin(), subjects.end(), subject) != subjects.end() || subject.starts_with("bs"),
                "who is hidden is of the database, or numbered");
    base::LineReader lines(text, "input");
    while (lines.next())
        for (const auto& subject : subjects)
            require(base::trimmed(lines.line()) != subject || database::is_hidden(list.subjects, subject),
                    "a subject with a line of its own is hidden");
}

}  // namespace

/// Behind an 's' a table of subjects, behind an 'n' a hidden list of a database with names, else of one with numbers.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    if (text.starts_with('n')) return hidden_list(text.substr(1), {"anna", "Bo # 2", "d-e", "m\xC3\xBCller"});
    if (!text.starts_with('s')) return hidden_list(text, {"bs000", "bs001", "bs012"});
    for (const auto& [subject, sex] : database::parse_subjects(text.substr(1), "input")) {
        require(!subject.empty() && subject == base::lower_case(subject), "a subject has a name in lower case");
        require(sex.empty() || sex == "m" || sex == "f", "a sex is m, f or nothing");
    }
}

std::vector<std::string> seeds() {
    return {"ssubject,sex,note\nbs000,f,\"a, b\"\nbs001,Male,\nbs002,,x\n", "bs000\n1, BS12;077 # why\n",
            "\xEF\xBB\xBF"
            "bs1.\r\n",
            "nanna (left)\nBo # 2\nD_E\nnobody\n"};
}

}  // namespace mimik::fuzzing
