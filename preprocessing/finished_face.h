#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "preprocessing/face.h"

// What tells a face that an earlier run finished from one that has to be made: `<stem>.done` beside its two files.

namespace mimik::preprocessing {

/// A file that did not change has the same size and time: cheap to ask for thousands of scans.
[[nodiscard]] std::string file_stamp(const std::filesystem::path& file);

/// Whether `<stem>.done` names this fingerprint, and all files that it speaks of are as they were then.
[[nodiscard]] bool finished(const std::filesystem::path& stem, const std::string& fingerprint);

/// The face of an earlier run, if it is whole and was made from the same.
[[nodiscard]] std::optional<Face> read_finished(const std::filesystem::path& stem, const std::string& fingerprint);

/// The mark goes first and comes last: a run that ends in between leaves a face that counts as missing.
/// @param looked_for  files that the scan's own file names; there or not. @throws InputError as write_face.
void write_finished(const std::filesystem::path& stem, const Face& face, const std::string& fingerprint,
                    const std::vector<std::filesystem::path>& looked_for);

/// `looked_for` as it was written. @throws InputError if there is no readable `.done`.
[[nodiscard]] std::vector<std::filesystem::path> files_looked_for(const std::filesystem::path& stem);

}  // namespace mimik::preprocessing
