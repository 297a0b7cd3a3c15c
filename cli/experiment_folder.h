#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/input_digests.h"
#include "evaluation/experiment_file.h"
#include "evaluation/performance.h"
#include "evaluation/plan.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/workspace.h"

namespace mimik::cli {

/// The folder of an experiment's results:
///   workspace/        preprocessed faces, where the experiment names a database
///   rows.part         while it runs: rows as they come, to go on with (evaluation/case_store.h)
///   preprocessed.json, faces.json, shards/   where it is run in shards (cli/shard_files.h)
///   experiment.json   what was run: configuration, inputs by hash, versions; the same bytes for the same experiment
///   rows.csv, rows.sqlite, scores.json, scores.csv, summary.md, statistics/*.csv, tables/*.tex
///   manifest.json     digests of all those: it is there when the run is whole
///   provenance.json   command, host and time: the one file that differs from run to run
///   report.html       the page of all that; it can be made again, so the manifest does not list it
class ExperimentFolder {
public:
    explicit ExperimentFolder(std::filesystem::path root) : root_(std::move(root)) {}

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] std::filesystem::path workspace() const { return root_ / "workspace"; }
    [[nodiscard]] std::filesystem::path part() const { return root_ / "rows.part"; }
    [[nodiscard]] std::filesystem::path identity() const { return root_ / "experiment.json"; }
    [[nodiscard]] std::filesystem::path rows() const { return root_ / "rows.csv"; }
    [[nodiscard]] std::filesystem::path summary() const { return root_ / "summary.md"; }
    [[nodiscard]] std::filesystem::path provenance() const { return root_ / "provenance.json"; }
    [[nodiscard]] std::filesystem::path face_digests() const { return root_ / "faces.json"; }
    [[nodiscard]] std::filesystem::path preprocessing_mark() const { return root_ / "preprocessed.json"; }
    [[nodiscard]] std::filesystem::path manifest() const { return root_ / "manifest.json"; }
    [[nodiscard]] std::filesystem::path page() const { return root_ / "report.html"; }

    [[nodiscard]] bool whole() const;
    /// Takes the experiment's identity as its own. @throws InputError if another one's is there, saying what differs.
    void claim(const std::string& identity) const;
    /// @throws InputError if the identity is not there, or another one, saying what differs.
    void require(const std::string& identity) const;
    /// Removes what a run of any experiment wrote, but the workspace; files of other names stay.
    void clear() const;
    /// Lists the results with their digests: the run is whole.
    void seal() const;
    /// What is not as it was sealed, "rows.csv: changed since"; empty: nothing.
    [[nodiscard]] std::vector<std::string> damage() const;

private:
    std::filesystem::path root_;
};

/// A file's experiment on a workspace: what it does, and what it is by.
struct PlannedExperiment {
    evaluation::ExperimentPlan plan;
    std::string identity;  ///< content of experiment.json
};

/// Of every face that the experiment may read.
[[nodiscard]] InputDigests digests_of_faces(const preprocessing::Workspace& workspace,
                                            const evaluation::ExperimentPlan& plan);

/// @param known  faces that need not be read again to tell them from others
/// @throws InputError naming line and key of the experiment file where a choice does not fit the workspace.
[[nodiscard]] PlannedExperiment planned(const evaluation::ExperimentFile& file,
                                        const evaluation::PerformanceReader& reader,
                                        const facs::FacsCatalogue& catalogue, const InputDigests& known = {});

/// The built-in catalogue or the file's own, with the emotions that it asks for. @throws InputError as read_catalogue.
[[nodiscard]] facs::FacsCatalogue catalogue_of(const evaluation::ExperimentFile& file);

/// The workspace of a file's experiment: its own, or the one in the results' folder.
[[nodiscard]] std::filesystem::path workspace_of(const evaluation::ExperimentFile& file,
                                                 const ExperimentFolder& folder);

}  // namespace mimik::cli
