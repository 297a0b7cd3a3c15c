#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "database/file_origin.h"

namespace mimik::database {

/// unallowed_subjects.txt: one subject a line, or several with blanks, commas or ';' between; names or numbers
/// ("bs001", "bs1" and "1" are the same subject, case is ignored, blanks and '_' count as '-' as in manifests); '#'
/// begins a comment.
struct HiddenSubjects {
    std::vector<std::string> subjects;  ///< sorted; spelled as in the database where its scans are there
    std::vector<std::string> remarks;   ///< entries that match no subject of the database
};

/// 1 MB is some 100,000 subjects.
inline constexpr std::uintmax_t most_hidden_list_bytes = 1 << 20;

/// @param name      of the file, for messages.
/// @param subjects  of the database. A line that is one of them as a whole is that subject, whatever letters it has.
/// An entry of the form bs077 is hidden also where no scan of it is there, provided that the database names its
/// subjects so.
/// @throws InputError naming file and line if there are entries and none of them can be matched (nobody would be hidden
/// though somebody asked for it), or if the file is not text in UTF-8 or the like.
[[nodiscard]] HiddenSubjects parse_hidden_subjects(std::string_view text, const std::string& name,
                                                   std::span<const std::string> subjects);

/// The lists in a folder: everything of that name, case ignored. Usually one file or none; a folder of that name is no
/// list, and who reads it says so.
[[nodiscard]] std::vector<std::filesystem::path> hidden_subjects_files(const std::filesystem::path& folder);

/// Whether the list holds the subject; case ignored.
[[nodiscard]] bool is_hidden(std::span<const std::string> hidden_subjects, std::string_view subject);

/// Whether all subjects of a folder are known, so that an entry that matches none of them is a mistake.
enum class KnownSubjects { all, some };

/// Who is hidden in a database or a workspace: by the lists in its folder and in the two above it, where it lies and
/// where links lead. A list above the folder may be about more than what lies there: it hides whom it names, and its
/// other entries are passed over. So are those of every list if only some subjects are known.
/// @throws InputError as parse_hidden_subjects(), of a list above the folder only where it cannot be read as text.
[[nodiscard]] HiddenSubjects hidden_subjects_of(const std::filesystem::path& folder,
                                                std::span<const std::string> subjects,
                                                KnownSubjects known = KnownSubjects::all);

/// The text of a list of these subjects; empty if there are none.
[[nodiscard]] std::string hidden_subjects_text(std::span<const std::string> hidden_subjects);

/// The gate for every file that a command opens by its name. Looks for lists in the file's folder and the four above it
/// (a subject's folder, truth/ or faces/, the database, and the two above that), where the file lies and where links
/// lead; in the database of a workspace that it lies in; and in the database that the file itself names
/// (database/file_origin.h). Whose face it is, is told by the file's name (bs000_N_N_0, bs000), by the folders between
/// list and file, by a manifest.csv in one of them, or by the file itself. So a list that grows hides at once what was
/// made before. @throws InputError naming the list if that subject is hidden.
void refuse_hidden_file(const std::filesystem::path& file);

/// What a file that is made of these has to say of itself, so that the gate knows it wherever it goes: whose faces they
/// show, by themselves or by their names, and of which database.
[[nodiscard]] FileOrigin origin_to_carry(std::span<const std::filesystem::path> files);

}  // namespace mimik::database
