#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "preprocessing/face.h"
#include "preprocessing/scan_reading.h"

// What tells a face that an earlier run finished from one that has to be made: `<stem>.done` beside its two files.

namespace mimik::preprocessing {

/// Whether `<stem>.done` names this fingerprint, the face's two files are to the last bit as they were written, and the
/// other files that it speaks of are as they were when the scan was read.
[[nodiscard]] bool finished(const std::filesystem::path& stem, const std::string& fingerprint);

/// The face of an earlier run, if it is whole and was made from the same.
[[nodiscard]] std::optional<Face> read_finished(const std::filesystem::path& stem, const std::string& fingerprint);

/// The mark goes first and comes last: a run that ends in between leaves a face that counts as missing.
/// @throws InputError as write_face.
void write_finished(const std::filesystem::path& stem, const Face& face, const std::string& fingerprint,
                    const std::vector<LookedFor>& looked_for);

/// `looked_for` as it was written. @throws InputError if there is no readable `.done`.
[[nodiscard]] std::vector<LookedFor> files_looked_for(const std::filesystem::path& stem);

/// Deletes a face and its mark.
void remove_face(const std::filesystem::path& stem);

}  // namespace mimik::preprocessing
