#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/folder_lock.h"
#include "database/scan_database.h"
#include "facs/expression.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/average_face.h"
#include "preprocessing/preprocess_scan.h"
#include "preprocessing/rigid_alignment.h"

namespace mimik::preprocessing {

struct PreprocessOptions {
    ScanSteps steps;
    AverageFaceOptions average;
    RigidAlignmentOptions alignment;
    std::vector<std::string> subjects;          ///< empty: all; case ignored
    std::vector<facs::Expression> expressions;  ///< to take beside the neutrals; empty: all but head rotations and
                                                ///< occlusions (groups YR, PR, CR, O, IGN)
    std::vector<std::string> accept;  ///< kinds of the doctor's errors that refuse no scan (kinds_that_refuse())

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("steps", self.steps);
        visit("average", self.average);
        visit("alignment", self.alignment);
        visit("subjects", self.subjects);
        visit("expressions", self.expressions);
        visit("accept", self.accept);
    }
    void check() const;  ///< throws InputError
};

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
    std::size_t from_earlier_runs = 0;     ///< scans beside the selected ones, since the workspace had them already
};

/// @throws InputError if `root` is empty, a file, a link that goes round in circles, the database's folder or anywhere
/// in it, or a folder of its scans: a database is never written into.
void check_workspace_place(const database::ScanDatabase& database, const std::filesystem::path& root);

/// Preprocesses a whole database, in parallel over subjects, one scan in memory per thread. What an earlier run
/// finished with the same options on the same file is not done again; a face that was deleted or damaged since is. From
/// the first face that a run writes to its end there is no workspace.json, so that nobody takes a half-made folder for
/// a finished one. A scan that fails is reported and the rest goes on.
/// A workspace only grows: what an earlier run with a wider selection left in it is kept up to date, too, so that all
/// its faces are of one kind. It has one writer at a time (base/folder_lock.h). Files that a killed run left half
/// written are deleted.
/// The doctor's errors of unit, frame and landmarks off the scan refuse a scan. A neutral whose landmarks lie far off
/// those of the others (preprocessing/consensus_outliers.h) gives its place to the subject's next one.
/// Scans are aligned by what the catalogue says their expression leaves alone; of an expression that it lacks, by what
/// no expression moves, with a remark.
/// @param progress  called once per scan, from any thread; may be empty.
/// @param lock  of a caller who goes on writing there; null: the run takes its own.
/// @throws InputError for bad options, a `root` in the database, one that takes no files or that another process uses,
/// an empty selection, or fewer than two subjects with a usable neutral.
PreprocessReport preprocess_database(const database::ScanDatabase& database, const std::filesystem::path& root,
                                     const facs::FacsCatalogue& catalogue, const PreprocessOptions& options = {},
                                     const std::function<void(const std::string& scan)>& progress = {},
                                     const base::FolderLock* lock = nullptr);

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
                                                const std::filesystem::path& root, const facs::FacsCatalogue& catalogue,
                                                const PreprocessOptions& options = {});

/// The scans that `options` select, neutrals first within each subject. @throws InputError naming the subjects or
/// expressions that the database does not have.
[[nodiscard]] std::vector<const database::ScanEntry*> selected_scans(const database::ScanDatabase& database,
                                                                     const PreprocessOptions& options);
/// Those, and what an earlier run left in the workspace of other scans that are still in the database.
[[nodiscard]] std::vector<const database::ScanEntry*> scans_to_preprocess(const database::ScanDatabase& database,
                                                                          const std::filesystem::path& root,
                                                                          const PreprocessOptions& options);

}  // namespace mimik::preprocessing
