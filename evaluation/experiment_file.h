#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/per_vertex.h"
#include "evaluation/plan.h"

namespace mimik::evaluation {

/// Whom an experiment takes.
struct SubjectChoice {
    std::vector<std::string> names = {};  ///< empty: all
    std::string sex = {};                 ///< "f" or "m": of the chosen, those of whom the database says so; empty: all
    int next = 0;                         ///< sources: the next so many after each target; 0: all

    bool operator==(const SubjectChoice&) const = default;
};

/// An experiment as a text file names it (TOML, schema 1; docs/experiments.md has every key). Nothing in it depends on
/// a machine but the two folders, of which it has one or none.
struct ExperimentFile {
    std::string name;                           ///< of the file, for messages
    std::filesystem::path database = {};        ///< still to be preprocessed; relative paths start at the file's folder
    std::filesystem::path workspace = {};       ///< or this, preprocessed already
    std::filesystem::path catalogue = {};       ///< another FACS catalogue; empty: the built-in one
    std::string emotions = {};                  ///< what emotions are made of: "emfacs", "thesis"; empty: as usual
    std::string unit = {};                      ///< of the database's scans; empty: as its files say, else mm
    std::vector<std::string> expressions = {};  ///< as written: "12L", "HAPPY"
    std::vector<animation::MethodPointer> methods = {};
    std::vector<double> magnitudes = {1.0};
    std::uint64_t seed = 1;  ///< of everything that chance decides: resampling
    SubjectChoice targets = {}, sources = {};
    bool on_itself = false;  ///< each source on its own face, and nobody on others
    ZoneSource zones = ZoneSource::automatic;
    bool whole_face = true;
    bool reference = true;                         ///< true fields beside the methods, where there is a truth
    std::vector<EstimatorChoice> estimators = {};  ///< beside the rows that every experiment has
    std::vector<std::string> regions = {"zone"};
    MetricOptions metrics = {};
    Alignment alignment = Alignment::given;
    int resamples = 2000;  ///< of bootstrap and permutations
    double confidence = 0.95;
    std::vector<CaseChoice> per_vertex = {};     ///< cases of which every vertex's error is written
    std::map<std::string, unsigned> lines = {};  ///< of each key that was read: "subjects.targets"

    /// What the file itself says of them: all but expressions and subjects, which a workspace has to know.
    [[nodiscard]] ExperimentOptions options() const;
    /// "thesis.toml:7: subjects.targets": what a fault found later is said of. The file alone where the key is absent.
    [[nodiscard]] std::string place(const std::string& key) const;
};

/// @param name  of the file, for messages. @throws InputError naming file, line, key, value and the mend: the first
/// fault, whatever it is: no TOML, an unknown key, a value of another kind or out of its range.
[[nodiscard]] ExperimentFile parse_experiment(std::string_view text, const std::string& name);
/// Relative folders start at the file's own. @throws InputError as parse_experiment, and if it cannot be read.
[[nodiscard]] ExperimentFile read_experiment_file(const std::filesystem::path& file);

}  // namespace mimik::evaluation
