#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mimik::database {

/// unallowed_subjects.txt: one subject a line, or several with blanks, commas or ';' between; names or numbers
/// ("bs001", "bs1" and "1" are the same subject, case is ignored, blanks and '_' count as '-' as in manifests); '#'
/// begins a comment.
struct HiddenSubjects {
    std::vector<std::string> subjects;  ///< sorted; spelled as in the database where its scans are there
    std::vector<std::string> remarks;   ///< entries that match no subject of the database
};

/// @param name      of the file, for messages.
/// @param subjects  of the database. A line that is one of them as a whole is that subject, whatever letters it has.
/// An entry of the form bs077 is hidden also where no scan of it is there, provided that the database names its
/// subjects so.
/// @throws InputError naming file and line if there are entries and none of them can be matched (nobody would be hidden
/// though somebody asked for it), or if the file is not text in UTF-8 or the like.
[[nodiscard]] HiddenSubjects parse_hidden_subjects(std::string_view text, const std::string& name,
                                                   std::span<const std::string> subjects);

/// The lists in a folder: every file of that name, case ignored. Usually one or none.
[[nodiscard]] std::vector<std::filesystem::path> hidden_subjects_files(const std::filesystem::path& folder);

/// Whether the list holds the subject; case ignored.
[[nodiscard]] bool is_hidden(std::span<const std::string> hidden_subjects, std::string_view subject);

/// For commands that take bare files: looks for a list in the file's folder and the two above it, where the file lies
/// and where links lead. Whose face it is, is told by the file's name (bs000_N_N_0), by the folders between list and
/// file, or by manifest.csv beside the list. @throws InputError naming the list if that subject is hidden.
void refuse_hidden_file(const std::filesystem::path& file);

}  // namespace mimik::database
