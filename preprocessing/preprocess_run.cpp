#include "preprocessing/preprocess_run.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "base/text.h"
#include "database/database_names.h"
#include "database/hidden_subjects.h"
#include "geometry/landmark_spline.h"
#include "io/json_values.h"
#include "preprocessing/consensus_outliers.h"
#include "preprocessing/finished_face.h"
#include "preprocessing/nearest_on_average.h"
#include "preprocessing/neutral_alignment.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/scan_reading.h"
#include "preprocessing/stable_region.h"
#include "preprocessing/workspace.h"
#include "preprocessing/workspace_layout.h"

namespace mimik::preprocessing {

using database::ScanEntry;
using database::ScanId;
namespace fs = std::filesystem;

namespace {

/// Part of every fingerprint: raise it when the steps give other numbers for the same scan and options.
constexpr int steps_version = 7;

/// " value" of every field of an options struct, as fingerprints have had them from the beginning.
template <base::HasFields Options>
std::string field_values(const Options& options) {
    static const std::map<std::string_view, const char*> words = {{"max_edge_mm", " edge"},
                                                                  {"use_lattice", " lattice"}};
    std::string text;
    base::each_field(options, [&](const std::string_view name, const auto& value) {
        const auto word = words.find(name);
        if (word != words.end()) text += word->second;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, std::optional<double>>)
            text += fmt::format(" {}", value.value_or(0));
        else
            text += fmt::format(" {}", value);
    });
    return text;
}

std::string describe(const PreprocessOptions& options) {
    const auto& steps = options.steps;
    auto text = fmt::format("steps {} crop{} clean{} grid{} icp{}", steps_version, field_values(steps.crop),
                            steps.cleaning_method == CleaningMethod::pcl ? " pcl" + field_values(steps.pcl_cleaning)
                                                                         : field_values(steps.cleaning),
                            field_values(steps.gridding), field_values(options.alignment));
    if (steps.landmark_error.mean_mm > 0) text += " landmark error" + field_values(steps.landmark_error);
    for (const auto& kind : std::set<std::string>(options.accept.begin(), options.accept.end()))
        text += " accept " + kind;
    return text;
}

std::string describe(const AverageFaceOptions& options) { return "average" + field_values(options); }

}  // namespace

void PreprocessOptions::check() const {
    steps.check();
    average.check();
    alignment.check();
    const auto& kinds = kinds_that_refuse();
    for (const auto& kind : accept)
        if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
            throw InputError(fmt::format("accept is {}; give {}", base::in_quotes(kind), fmt::join(kinds, ", ")));
}

std::vector<const ScanEntry*> selected_scans(const database::ScanDatabase& database, const PreprocessOptions& options) {
    static const std::set<std::string> posed = {"YR", "PR", "CR", "O", "IGN"};
    std::map<std::string, std::string> subjects, codes, unseen_subjects, unseen_codes;  // as compared -> as typed
    for (const auto& subject : options.subjects) subjects.emplace(base::lower_case(subject), subject);
    for (const auto& expression : options.expressions)
        codes.emplace(base::lower_case(expression.code()), expression.code());
    unseen_subjects = subjects;
    unseen_codes = codes;
    const auto typed = [](const std::map<std::string, std::string>& words) {
        std::vector<std::string_view> list;
        list.reserve(words.size());
        for (const auto& [compared, word] : words) list.push_back(word);
        return fmt::format("{}", fmt::join(list, ", "));
    };
    std::vector<const ScanEntry*> scans;
    for (const auto& entry : database.scans) {
        const auto subject = base::lower_case(entry.id.subject), code = base::lower_case(entry.id.code);
        unseen_codes.erase(code);
        if (!subjects.empty() && !subjects.contains(subject)) continue;
        unseen_subjects.erase(subject);
        if (!entry.id.neutral() &&
            (codes.empty() ? posed.contains(entry.id.expression().group()) : !codes.contains(code)))
            continue;
        scans.push_back(&entry);
    }
    if (!unseen_subjects.empty())
        throw InputError(fmt::format("{}: no subject {}; 'mimik scans' lists what there is", database.root.string(),
                                     typed(unseen_subjects)));
    if (!unseen_codes.empty())
        throw InputError(fmt::format("{}: no scan of expression {}; 'mimik scans' lists what there is",
                                     database.root.string(), typed(unseen_codes)));
    if (scans.empty())
        throw InputError(
            fmt::format("{}: no scan fits the selection; 'mimik scans' lists what there is", database.root.string()));
    return scans;
}

std::vector<const ScanEntry*> scans_to_preprocess(const database::ScanDatabase& database, const fs::path& root,
                                                  const PreprocessOptions& options) {
    auto selected = selected_scans(database, options);
    const auto earlier = earlier_list(root);
    if (!earlier) return selected;
    std::vector<const ScanEntry*> scans;
    auto next = selected.begin();  // both in the order of the database
    for (const auto& entry : database.scans) {
        const bool chosen = next != selected.end() && *next == &entry;
        if (chosen) ++next;
        if (chosen || std::binary_search(earlier->scans.begin(), earlier->scans.end(), entry.id))
            scans.push_back(&entry);
    }
    return scans;
}

namespace {

/// One run of preprocess_database: what its two passes share.
class DatabaseRun {
public:
    DatabaseRun(const database::ScanDatabase& database, fs::path root, const facs::FacsCatalogue& catalogue,
                const PreprocessOptions& options, const std::function<void(const std::string&)>& progress)
        : database_(database), root_(std::move(root)), catalogue_(catalogue), options_(options), progress_(progress) {
        std::map<std::string, Subject> by_name;
        const auto scans = scans_to_preprocess(database, root_, options);
        from_earlier_runs_ = scans.size() - selected_scans(database, options).size();
        for (const auto* entry : scans) by_name[entry->id.subject].scans.push_back(entry);
        for (auto& [name, subject] : by_name) subjects_.push_back(std::move(subject));
    }

    PreprocessReport run() {
        base::parallel_for_each(subjects_.size(), [&](std::size_t s) { grid_neutral(subjects_[s]); });
        prepare_average();
        base::parallel_for_each(subjects_.size(), [&](std::size_t s) { tie_scans(subjects_[s]); });
        return finish();
    }

    /// What run() would do, of scans that it can use; writes nothing.
    PreprocessPlan plan() {
        for (auto& subject : subjects_) expect_neutral(subject);
        name_average();
        const bool average_there = read_average();
        base::parallel_for_each(subjects_.size(), [&](std::size_t s) {
            auto& subject = subjects_[s];
            if (!subject.neutral) return;  // left out
            for (const auto* entry : subject.scans) {
                const bool there = entry == subject.neutral
                                       ? average_there && tied(subject)
                                       : finished(face_stem(root_, entry->id), fingerprint(stamps_of(*entry)));
                ++(there ? subject.up_to_date : subject.preprocessed);
            }
        });
        PreprocessPlan plan;
        for (const auto& subject : subjects_) {
            plan.up_to_date += subject.up_to_date;
            plan.remaining += subject.preprocessed;
            if (subject.preprocessed > 0) plan.unfinished_subjects.push_back(subject.scans.front()->id.subject);
        }
        return plan;
    }

private:
    struct Subject {
        std::vector<const ScanEntry*> scans;
        const ScanEntry* neutral = nullptr;  ///< the first usable one
        ScanStamps neutral_stamps;           ///< as its scan was when its face was made
        geometry::Landmarks neutral_landmarks;
        bool fresh = false;                   ///< its neutral was gridded in this run
        std::set<const ScanEntry*> reported;  ///< neutrals that failed in the first pass
        std::vector<ScanFailure> failures;    ///< written by the one thread that has this subject
        std::vector<ScanRemark> remarks;
        std::vector<std::string> closed_lips;
        std::vector<ScanId> finished;
        std::size_t preprocessed = 0, up_to_date = 0;
    };

    static void fail(Subject& subject, const ScanEntry& entry, const std::string& reason) {
        subject.failures.push_back({entry.id.name(), reason});
    }
    void remark(Subject& subject, const Face& face) const {
        for (const auto& text : face.remarks) subject.remarks.push_back({face.id.name(), text});
        // Not kept with the face: another average face may have other landmarks.
        if (const auto text = without_partner(face, average_); !text.empty())
            subject.remarks.push_back({face.id.name(), text});
        const geometry::LandmarkPairs pairs(face.snapped_landmarks, face.snapped_landmarks);
        for (const auto& pair : pairs.merged())
            if (pair == "'lower_lip_inner' lies on 'upper_lip_inner'" ||
                pair == "'upper_lip_inner' lies on 'lower_lip_inner'")
                subject.closed_lips.push_back(face.id.name());
            else
                subject.remarks.push_back({face.id.name(), "on one grid vertex: " + pair});
    }
    void done(const ScanEntry& entry) const {
        if (progress_) progress_(entry.id.name());
    }
    /// From the first change of a face on, the folder is no finished workspace until all are done.
    void begin_writing() {
        std::call_once(writing_, [&] {
            std::error_code ignored;
            fs::rename(list_file(root_), list_file_before(root_), ignored);  // what a run that is stopped would hide
            keep_hidden_list();                                              // before the first face that it is about
        });
    }
    /// For commands that take bare files. A list that somebody else put there only grows.
    void keep_hidden_list() const {
        static constexpr std::string_view mark = "# written by 'mimik preprocess'\n";
        const auto file = root_ / "unallowed_subjects.txt";
        std::error_code error;
        const bool there = fs::exists(file, error);
        auto text = there ? base::read_text(file) : std::string();
        if (there && !text.starts_with(mark)) {
            std::vector<std::string> missing;
            for (const auto& subject : database_.hidden_subjects)
                if (("\n" + text + "\n").find("\n" + subject + "\n") == std::string::npos) missing.push_back(subject);
            if (missing.empty()) return;
            if (!text.empty() && text.back() != '\n') text += '\n';
            base::write_atomically(file, text + database::hidden_subjects_text(missing));
        } else if (!database_.hidden_subjects.empty())
            base::write_atomically(file, std::string(mark) + database::hidden_subjects_text(database_.hidden_subjects));
        else if (there && !fs::remove(file, error))
            throw InputError(fmt::format("{}: hides subjects whom the database shows and cannot be removed ({})",
                                         file.string(), error.message()));
    }
    [[nodiscard]] std::string neutral_fingerprint(const ScanStamps& stamps) const {
        return describe(options_) + " neutral " + stamps.whole;
    }

    /// Of scans other than the first neutrals.
    [[nodiscard]] std::string fingerprint(const ScanStamps& stamps) const {
        return fmt::format("{} scan {} average {} stable region {}", describe(options_), stamps.whole,
                           average_fingerprint_, catalogue_.content_hash());
    }

    /// Without reading a scan: the neutral that an earlier run could use, else the first.
    void expect_neutral(Subject& subject) const {
        for (const auto* entry : subject.scans) {
            if (!entry->id.neutral()) continue;
            const auto stamps = stamps_of(*entry);
            const bool there = finished(face_stem(root_, entry->id), neutral_fingerprint(stamps));
            if (subject.neutral && !there) continue;
            subject.neutral = entry;
            subject.neutral_stamps = stamps;
            if (there) return;
        }
    }

    /// First pass: one neutral per subject, gridded and written. One that fails gives its place to the next.
    void grid_neutral(Subject& subject) {
        for (const auto* entry : subject.scans) {
            if (!entry->id.neutral() || subject.reported.contains(entry)) continue;
            const auto stem = face_stem(root_, entry->id);
            try {
                auto stamps = stamps_of(*entry);
                auto face = read_finished(stem, neutral_fingerprint(stamps));
                if (!face) {
                    const auto read = read_scan(*entry, options_.accept);
                    face = preprocess_scan(read.loaded, options_.steps);
                    stamps = read.stamps;
                    // Every later step stands on these four landmarks: now is the time to find them missing or flat.
                    (void)affine_normalisation(face->snapped_landmarks, face->snapped_landmarks);
                    begin_writing();
                    write_finished(stem, *face, neutral_fingerprint(stamps), read.looked_for);
                    subject.fresh = true;
                }
                subject.neutral_landmarks = face->landmarks;
                subject.neutral_stamps = stamps;
                subject.neutral = entry;
                return;
            } catch (const std::exception& e) {
                refuse_neutral(subject, *entry, e.what());
            }
        }
    }
    void refuse_neutral(Subject& subject, const ScanEntry& entry, const std::string& reason) const {
        fail(subject, entry, reason);
        subject.reported.insert(&entry);
        done(entry);
    }

    /// What the average face is made from. @return the neutrals
    std::vector<const ScanEntry*> name_average() {
        std::vector<const ScanEntry*> neutrals;
        base::ContentHash made_from;  // its length must not grow with the subjects: every mark repeats it
        made_from.add(describe(options_) + " " + describe(options_.average));
        std::vector<std::string> reasons;
        for (const auto& subject : subjects_) {
            if (!subject.neutral) {
                for (const auto& failure : subject.failures) reasons.push_back(failure.scan + ": " + failure.reason);
                continue;
            }
            neutrals.push_back(subject.neutral);
            made_from.add(" " + subject.neutral->id.name() + " " + subject.neutral_stamps.shape);
        }
        average_fingerprint_ = made_from.text();
        if (neutrals.size() >= 2) return neutrals;
        std::string mend = "; select more subjects";
        if (neutrals.size() < subjects_.size())
            mend =
                fmt::format(" (the first that has none: {}{})", reasons.empty() ? "no neutral scan" : reasons.front(),
                            reasons.size() > 1 ? fmt::format("; and {} more", reasons.size() - 1) : "");
        throw InputError(
            fmt::format("{}: {} of {} selected subjects have a usable neutral face, and the average face needs two{}",
                        database_.root.string(), neutrals.size(), subjects_.size(), mend));
    }

    /// Whether an earlier run made it from the same.
    bool read_average() {
        std::error_code error;
        if (!fs::exists(average_stem(root_) += ".json", error)) return false;
        try {
            std::string found;
            average_ = read_average_face(average_stem(root_), &found);
            return found == average_fingerprint_ && average_face_is_whole(average_stem(root_));
        } catch (const InputError&) {
            return false;  // damaged: made again
        }
    }

    void prepare_average() {
        std::vector<const ScanEntry*> neutrals;
        do {
            neutrals = name_average();
            if (read_average()) return;
        } while (leave_out_neutrals());
        begin_writing();
        average_ = build_average_face(
            neutrals.size(), [&](std::size_t k) { return read_face(face_stem(root_, neutrals[k]->id)); }, consensus_,
            options_.average);
        average_.consensus_rms_mm = consensus_rms_mm_;
        write_average_face(average_stem(root_), average_, average_fingerprint_);
        average_ = read_average_face(average_stem(root_));
    }

    /// Finds the consensus, and neutrals that would spoil it or cannot be carried to it: each gives its place to the
    /// subject's next one. @return whether there were any
    bool leave_out_neutrals() {
        std::vector<Subject*> subjects;
        std::vector<geometry::Landmarks> sets;
        std::vector<std::string> names;
        for (auto& subject : subjects_) {
            if (!subject.neutral) continue;
            subjects.push_back(&subject);
            sets.push_back(subject.neutral_landmarks);
            names.push_back(subject.neutral->id.name());
        }
        auto refused = sets_far_off(sets);
        if (refused.empty()) {
            try {
                consensus_ = consensus_landmarks(sets, options_.average.max_iterations, &consensus_rms_mm_);
            } catch (const std::exception& e) {  // too little that all have: nobody's fault alone
                throw InputError(fmt::format("{}: no average face can be made of {}: {}", database_.root.string(),
                                             fmt::join(names, ", "), e.what()));
            }
            for (std::size_t k = 0; k < sets.size(); ++k) {
                try {
                    (void)geometry::landmark_spline(sets[k], consensus_);
                } catch (const std::exception& e) {
                    refused.push_back({k, fmt::format("cannot be carried to the average face: {}", e.what())});
                }
            }
        }
        for (const auto& [k, reason] : refused) {
            auto& subject = *subjects[k];
            begin_writing();
            remove_face(face_stem(root_, subject.neutral->id));  // of no use, and it would be found finished
            refuse_neutral(subject, *subject.neutral, reason);
            subject.neutral = nullptr;
            subject.fresh = false;
            grid_neutral(subject);
        }
        return !refused.empty();
    }

    /// Second pass: every scan, tied to its subject's first neutral and to the average face.
    void tie_scans(Subject& subject) {
        Face neutral;
        if (subject.neutral) {
            try {
                neutral = tie_neutral(subject);
                subject.finished.push_back(subject.neutral->id);
            } catch (const std::exception& e) {
                refuse_neutral(subject, *subject.neutral, e.what());
                subject.neutral = nullptr;
            }
        }
        for (const auto* entry : subject.scans) {
            if (subject.reported.contains(entry)) continue;
            if (subject.neutral && entry != subject.neutral) {
                try {
                    tie_scan(subject, neutral, *entry);
                    subject.finished.push_back(entry->id);
                } catch (const std::exception& e) {
                    fail(subject, *entry, e.what());
                }
            }
            done(*entry);
        }
    }

    /// @return whether it was not tied to this average before
    bool tie(Face& neutral) const {
        const auto similarity = similarity_normalisation(neutral.landmarks, average_.landmarks);
        const auto affine = affine_normalisation(neutral.snapped_landmarks, average_.landmarks);
        const bool changed = neutral.average_from_scan.matrix() != similarity.matrix() ||
                             neutral.average_from_scan_affine.matrix() != affine.matrix();
        neutral.average_from_scan = similarity;
        neutral.average_from_scan_affine = affine;
        return changed;
    }
    /// Whether the face of a first neutral is there as tie_neutral() would leave it.
    [[nodiscard]] bool tied(const Subject& subject) const {
        auto face = read_finished(face_stem(root_, subject.neutral->id), neutral_fingerprint(subject.neutral_stamps));
        try {
            return face && !tie(*face);
        } catch (const std::exception&) {
            return false;  // the run will say why
        }
    }

    Face tie_neutral(Subject& subject) {
        const auto stem = face_stem(root_, subject.neutral->id);
        Face neutral = read_face(stem);
        if (!tie(neutral) && !subject.fresh) {
            ++subject.up_to_date;
            return neutral;
        }
        begin_writing();
        write_finished(stem, neutral, neutral_fingerprint(subject.neutral_stamps), files_looked_for(stem));
        remark(subject, neutral);  // here, not where it was gridded: it may have been in an earlier run
        ++subject.preprocessed;
        return neutral;
    }

    void tie_scan(Subject& subject, const Face& neutral, const ScanEntry& entry) {
        const auto stem = face_stem(root_, entry.id);
        if (finished(stem, fingerprint(stamps_of(entry)))) {
            ++subject.up_to_date;
            return;
        }
        const auto read = read_scan(entry, options_.accept);
        Face face = preprocess_scan(read.loaded, options_.steps);
        align_to_neutral(face, neutral, stable_region(face, neutral), options_.alignment);
        face.average_from_scan = neutral.average_from_scan * face.neutral_from_scan;
        try {
            face.average_from_scan_affine = affine_normalisation(face.snapped_landmarks, average_.landmarks);
        } catch (const std::exception& e) {  // a chin that dropped out of the scanner's sight, or four marks in a plane
            face.average_from_scan_affine = neutral.average_from_scan_affine * face.neutral_from_scan;
            face.remarks.push_back(fmt::format("Eqs 5.1-5.4: {}; those of the neutral were taken", e.what()));
        }
        begin_writing();
        write_finished(stem, face, fingerprint(read.stamps), read.looked_for);
        remark(subject, face);
        ++subject.preprocessed;
    }

    /// What of the neutral the scan's expression leaves alone.
    [[nodiscard]] geometry::VertexMask stable_region(Face& face, const Face& neutral) const {
        if (face.id.neutral()) return stable_on_every_face(neutral);
        if (const auto expression = face.id.expression(); catalogue_.knows(expression))
            return stable_vertices(catalogue_, expression, neutral);
        face.remarks.push_back(fmt::format(
            "expression {} is not in the catalogue: aligned by nose bridge and temples alone", face.id.code));
        return stable_on_every_face(neutral);
    }

    PreprocessReport finish() {
        PreprocessReport report;
        report.from_earlier_runs = from_earlier_runs_;
        std::vector<ScanId> ids;
        for (const auto& subject : subjects_) {
            report.preprocessed += subject.preprocessed;
            report.up_to_date += subject.up_to_date;
            report.failures.insert(report.failures.end(), subject.failures.begin(), subject.failures.end());
            report.remarks.insert(report.remarks.end(), subject.remarks.begin(), subject.remarks.end());
            report.closed_lips.insert(report.closed_lips.end(), subject.closed_lips.begin(), subject.closed_lips.end());
            ids.insert(ids.end(), subject.finished.begin(), subject.finished.end());
            if (!subject.neutral) report.left_out.push_back(subject.scans.front()->id.subject);
        }
        std::sort(ids.begin(), ids.end());
        std::vector<std::string> names;
        names.reserve(ids.size());
        for (const auto& id : ids) names.push_back(id.name());
        auto failures = nlohmann::json::array();
        for (const auto& failure : report.failures)
            failures.push_back({{"scan", failure.scan}, {"reason", failure.reason}});
        const nlohmann::json document = {{"schema", 1},
                                         {"kind", "mimik workspace"},
                                         {"database", fs::absolute(database_.root).lexically_normal().string()},
                                         {"truth", fs::exists(database_.root / "truth" / "truth.json")},
                                         {"options", describe(options_)},
                                         {"scans", names},
                                         {"failures", failures},
                                         {"subjects_left_out", report.left_out},
                                         {"hidden_subjects", database_.hidden_subjects}};
        keep_hidden_list();
        base::write_atomically(list_file(root_), io::json_text(document));
        std::error_code ignored;
        fs::remove(list_file_before(root_), ignored);
        remove_sheets_of_hidden(Workspace(root_));
        return report;
    }

    const database::ScanDatabase& database_;
    fs::path root_;
    const facs::FacsCatalogue& catalogue_;
    const PreprocessOptions& options_;
    const std::function<void(const std::string&)>& progress_;
    std::vector<Subject> subjects_;  // by name
    std::size_t from_earlier_runs_ = 0;
    geometry::Landmarks consensus_;
    double consensus_rms_mm_ = 0;
    AverageFace average_;
    std::string average_fingerprint_;
    std::once_flag writing_;
};

}  // namespace

void check_workspace_place(const database::ScanDatabase& database, const fs::path& root) {
    const auto place = [](const fs::path& path) {
        std::error_code error;
        auto canonical = fs::absolute(path, error);
        if (!error) canonical = fs::weakly_canonical(canonical, error);
        if (error)
            throw InputError(fmt::format("'{}': cannot be used ({}); give another folder for the workspace",
                                         path.string(), error.message()));
        return canonical.has_filename() ? canonical : canonical.parent_path();  // "folder/" is "folder"
    };
    std::error_code ignored;
    if (fs::exists(root, ignored) && !fs::is_directory(root, ignored))
        throw InputError(fmt::format("{}: is a file; give a folder for the workspace", root.string()));
    const auto output = place(root), home = place(database.root);
    database::check_path_is_utf8(output, "the workspace");
    std::set<fs::path> folders = {database.root};
    for (const auto& entry : database.scans) folders.insert(entry.scan_file.parent_path());
    for (const auto& folder : folders) {
        const auto taken = place(folder);
        // A manifest's scans may lie elsewhere, in a folder that holds other things, too.
        if (output != taken && !lies_in(output, home)) continue;
        throw InputError(
            fmt::format("{}: is part of the database {}, into which nothing is written; give another "
                        "folder for the workspace",
                        root.string(), database.root.string()));
    }
}

PreprocessReport preprocess_database(const database::ScanDatabase& database, const fs::path& root,
                                     const facs::FacsCatalogue& catalogue, const PreprocessOptions& options,
                                     const std::function<void(const std::string&)>& progress,
                                     const base::FolderLock* lock) {
    options.check();
    check_workspace_place(database, root);
    (void)selected_scans(database, options);  // nothing is made for a selection that is none
    base::check_takes_files(root);
    const auto own = lock ? nullptr : std::make_unique<base::FolderLock>(root, base::FolderLock::Use::write);
    remove_leftovers(root);
    return DatabaseRun(database, root, catalogue, options, progress).run();
}

PreprocessPlan plan_preprocessing(const database::ScanDatabase& database, const fs::path& root,
                                  const facs::FacsCatalogue& catalogue, const PreprocessOptions& options) {
    options.check();
    check_workspace_place(database, root);
    const auto lock =
        base::is_there(root) ? std::make_unique<base::FolderLock>(root, base::FolderLock::Use::read) : nullptr;
    return DatabaseRun(database, root, catalogue, options, {}).plan();
}

}  // namespace mimik::preprocessing
