#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "database/scan_database.h"
#include "preprocessing/average_face.h"
#include "preprocessing/cleaning.h"
#include "preprocessing/face.h"
#include "preprocessing/gridding.h"
#include "preprocessing/rigid_alignment.h"

namespace mimik::preprocessing {

/// Which vertices of a neutral face's grid the expression of `scan` leaves where they are (1) or may move (0). The
/// layers that know about Action Units supply it; without one stable_on_every_face() is taken.
using StableRegion = std::function<std::vector<char>(const database::ScanId& scan, const Face& neutral)>;
/// Nose bridge, inner eye corners and temples, measured vertices only; upright by `neutral.average_from_scan`.
[[nodiscard]] std::vector<char> stable_on_every_face(const Face& neutral);

struct PreprocessOptions {
    CleaningOptions cleaning;
    GriddingOptions gridding;
    AverageFaceOptions average;
    RigidAlignmentOptions alignment;
    std::string stable_region_name;  ///< what the StableRegion rests on, e.g. a catalogue's hash: with another, scans
                                     ///< are aligned anew
    std::vector<std::string> subjects;  ///< empty: all; case ignored
    std::vector<std::string> codes;     ///< expressions to take beside the neutrals, e.g. "12", "AU12", "HAPPY"; empty:
                                        ///< all but head rotations and occlusions (groups YR, PR, CR, O, IGN)
    void check() const;                 ///< throws InputError
};

/// One scan to a face in the scanner's frame: cleaned, gridded, landmarks snapped; transforms still identity.
[[nodiscard]] Face preprocess_scan(const database::LoadedScan& loaded, const PreprocessOptions& options,
                                   CleaningReport* cleaning = nullptr, GriddingReport* gridding = nullptr);

/// Fills face.neutral_from_scan by trimmed ICP of the neutral's stable vertices onto the scan. What is below the nose
/// counts less than the rest: jaw and lips rest in another place in every scan, even where the expression is elsewhere.
void align_to_neutral(Face& face, const Face& neutral, const std::vector<char>& stable,
                      const RigidAlignmentOptions& options = {});

struct ScanFailure {
    std::string scan;
    std::string reason;
};

struct ScanRemark {
    std::string scan;
    std::string remark;
};

struct PreprocessReport {
    std::size_t preprocessed = 0;          ///< written in this run
    std::size_t up_to_date = 0;            ///< found finished from an earlier run
    std::vector<ScanFailure> failures;     ///< by subject
    std::vector<ScanRemark> remarks;       ///< of the faces written in this run
    std::vector<std::string> closed_lips;  ///< scans among them whose inner lips lie on one grid vertex
    std::vector<std::string> left_out;     ///< subjects without a usable neutral
};

/// What workspace.json says.
struct WorkspaceList {
    std::filesystem::path database_root;
    bool made_with_truth = false;
    std::vector<database::ScanId> scans;  ///< sorted
    std::vector<std::string> hidden_subjects;
};
/// `name` stands for the file. @throws InputError naming file, field and value.
[[nodiscard]] WorkspaceList decode_workspace(std::string_view text, const std::string& name);

/// A folder of preprocessed faces:
///   workspace.json               database, whether it has a truth, options, list of faces, hidden subjects (schema 1)
///   average/average_face.{ply,json}
///   faces/bs000/bs000_N_N_0.{ply,json}
///   unallowed_subjects.txt       the hidden subjects, so that a bare file of the workspace is refused too; if any
/// Hidden is who was when the folder was made, and who stands now in a list of the workspace's or the database's
/// (database::hidden_subjects_of), if that folder is still there.
class Workspace {
public:
    /// @throws InputError if the folder is no finished workspace.
    explicit Workspace(std::filesystem::path root);

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] const std::filesystem::path& database_root() const { return list_.database_root; }
    /// Whether the database had a truth (truth/truth.json) when the workspace was made.
    [[nodiscard]] bool made_with_truth() const { return list_.made_with_truth; }
    [[nodiscard]] const AverageFace& average() const { return average_; }
    [[nodiscard]] const std::vector<database::ScanId>& scans() const { return list_.scans; }
    [[nodiscard]] std::vector<std::string> subjects() const;
    [[nodiscard]] bool hidden(const std::string& subject) const;
    /// @throws InputError if the subject must not be shown.
    void refuse_hidden(const std::string& subject) const;
    [[nodiscard]] bool has(const database::ScanId& id) const;
    /// First neutral of a subject. @throws InputError naming the subjects there are.
    [[nodiscard]] database::ScanId neutral(const std::string& subject) const;
    /// First scan of an AU (or emotion) of a subject: code without regard to case; empty if there is none.
    [[nodiscard]] std::optional<database::ScanId> expression(const std::string& subject, const std::string& code) const;
    [[nodiscard]] Face face(const database::ScanId& id) const;  ///< read from disk
    /// Path of a face's files without .ply, .json, .done.
    [[nodiscard]] std::filesystem::path stem(const database::ScanId& id) const;

private:
    std::filesystem::path root_;
    WorkspaceList list_;
    AverageFace average_;
};

/// @throws InputError if `root` is empty, a file, a link that goes round in circles, the database's folder or anywhere
/// in it, or a folder of its scans: a database is never written into.
void check_workspace_place(const database::ScanDatabase& database, const std::filesystem::path& root);

/// Preprocesses a whole database, in parallel over subjects, one scan in memory per thread. What an earlier run
/// finished with the same options on the same file is not done again; a face that was deleted or damaged since is. From
/// the first face that a run writes to its end there is no workspace.json, so that nobody takes a half-made folder for
/// a finished one. A scan that fails is reported and the rest goes on.
/// @param progress  called once per scan, from any thread; may be empty.
/// @throws InputError for bad options, a `root` in the database or one that takes no files, an empty selection, or
/// fewer than two subjects with a usable neutral.
PreprocessReport preprocess_database(const database::ScanDatabase& database, const std::filesystem::path& root,
                                     const PreprocessOptions& options = {}, const StableRegion& stable_region = {},
                                     const std::function<void(const std::string& scan)>& progress = {});

/// How far an earlier run got.
struct PreprocessPlan {
    std::size_t up_to_date = 0;
    std::size_t remaining = 0;
    std::vector<std::string> unfinished_subjects;  ///< of whom a scan remains
};
/// What preprocess_database would do with the same arguments, found out without reading a scan; nothing is written. A
/// scan that failed remains; the other scans of a neutral that failed count as if it could be used.
/// @throws InputError as preprocess_database, but for what only the scans or writing can tell.
[[nodiscard]] PreprocessPlan plan_preprocessing(const database::ScanDatabase& database,
                                                const std::filesystem::path& root,
                                                const PreprocessOptions& options = {});

/// The scans that `options` select, neutrals first within each subject. @throws InputError naming the subjects or
/// expressions that the database does not have.
[[nodiscard]] std::vector<const database::ScanEntry*> selected_scans(const database::ScanDatabase& database,
                                                                     const PreprocessOptions& options);

}  // namespace mimik::preprocessing
