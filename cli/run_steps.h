#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/experiment_folder.h"
#include "evaluation/case_store.h"
#include "evaluation/experiment.h"
#include "evaluation/experiment_file.h"
#include "facs/facs_catalogue.h"

namespace mimik::cli {

/// What `mimik run` was told.
struct RunArguments {
    Common common;
    std::string file, output, database, workspace, shard;
    bool dry_run = false, anew = false, only_preprocess = false;
};

// Steps of a run that is done at once (run_command.cpp) and of one in shards (run_shards.cpp, merge_command.cpp).

/// What the command line says wins over the file.
[[nodiscard]] evaluation::ExperimentFile experiment_of(const RunArguments& arguments);

/// What was left to do of the database's scans. @return scans and subjects that could not be used, with the reason
std::vector<std::string> preprocess(const RunArguments& arguments, const evaluation::ExperimentFile& file,
                                    const facs::FacsCatalogue& catalogue, const std::filesystem::path& workspace);

/// Command, host and time, as JSON.
[[nodiscard]] std::string provenance(const RunArguments& arguments, const evaluation::ExperimentFile& file,
                                     const std::filesystem::path& workspace, double seconds);

/// Every file of the results but experiment.json, from the rows.
void write_results(const ExperimentFolder& folder, const evaluation::CaseStore& store,
                   const evaluation::ExperimentFile& file, const evaluation::ExperimentReport& report);

/// Prints the summary. @return what main returns
int say_result(const RunArguments& arguments, const ExperimentFolder& folder);

/// `mimik run --only-preprocess`: everything that shards have in common, once.
int run_only_preprocess(const RunArguments& arguments);
/// `mimik run --shard i/n`.
int run_shard(const RunArguments& arguments);
/// Scans and subjects that --only-preprocess could not use. @throws InputError if it was not run, or for other
/// expressions.
[[nodiscard]] std::vector<std::string> unusable_of_preprocessing(const ExperimentFolder& folder,
                                                                 const evaluation::ExperimentFile& file);

}  // namespace mimik::cli
