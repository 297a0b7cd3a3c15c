#include "preprocessing/preprocess_run.h"

#include <algorithm>
#include <map>
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
#include "base/output_folder.h"
#include "base/parallel.h"
#include "database/bnt.h"
#include "database/hidden_subjects.h"
#include "geometry/landmark_spline.h"
#include "io/json_values.h"
#include "preprocessing/finished_face.h"
#include "preprocessing/neutral_alignment.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/stable_region.h"
#include "preprocessing/workspace.h"
#include "preprocessing/workspace_layout.h"

namespace mimik::preprocessing {

using database::ScanEntry;
using database::ScanId;
namespace fs = std::filesystem;

namespace {

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

/// Part of every fingerprint: raise it when the steps give other numbers for the same scan and options.
constexpr int steps_version = 6;

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
    return fmt::format("steps {} clean{} grid{} icp{}", steps_version, field_values(options.steps.cleaning),
                       field_values(options.steps.gridding), field_values(options.alignment));
}

std::string describe(const AverageFaceOptions& options) { return "average" + field_values(options); }

/// What the shape of a face and its landmarks come from: all that the average face and other scans take of it.
std::string shape_stamp(const ScanEntry& entry) {
    return fmt::format("{} {} unit {}", file_stamp(entry.scan_file), file_stamp(entry.landmarks_file),
                       static_cast<int>(entry.unit));
}

/// Everything that a face takes from an entry. Image and image landmarks together decide how the texture lies; files
/// that only the scan file names stand in `.done`.
std::string entry_stamp(const ScanEntry& entry) {
    // Of meshes alone, whose pictures may be painted anew: raise it when they come out otherwise.
    const char* const pictures = database::is_bnt(entry.scan_file) ? "" : " pictures 1";
    return fmt::format("{} sex '{}' texture '{}' {} {}{}", shape_stamp(entry), entry.sex, entry.texture_file.string(),
                       file_stamp(entry.texture_file), file_stamp(entry.landmarks2d_file), pictures);
}

/// Nothing can be done with a scan without landmarks, or with some on the other side: found out before it is gridded.
database::LoadedScan load_marked(const ScanEntry& entry) {
    auto loaded = database::load(entry);
    if (const auto& swapped = loaded.checks.sides.swapped_pairs; !swapped.empty())
        throw InputError(fmt::format("{}: left and right of {} are exchanged against the rest; exchange the labels",
                                     entry.landmarks_file.string(), fmt::join(swapped, ", ")));
    if (!loaded.landmarks.all().empty()) return loaded;
    if (!entry.landmarks_file.empty())
        throw InputError(fmt::format("{}: there is no landmark in it; mark the face", entry.landmarks_file.string()));
    throw InputError(fmt::format("no landmark file beside {}; put {} there", entry.scan_file.string(),
                                 entry.scan_file.stem().string() + ".lm3"));
}

}  // namespace

void PreprocessOptions::check() const {
    steps.check();
    average.check();
    alignment.check();
}

std::vector<const ScanEntry*> selected_scans(const database::ScanDatabase& database, const PreprocessOptions& options) {
    static const std::set<std::string> posed = {"YR", "PR", "CR", "O", "IGN"};
    std::map<std::string, std::string> subjects, codes, unseen_subjects, unseen_codes;  // as compared -> as typed
    for (const auto& subject : options.subjects) subjects.emplace(upper(subject), subject);
    for (const auto& code : options.codes) {
        const auto id = facs::parse_expression(code);
        codes.emplace(upper(id ? id->code() : code), code);
    }
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
        const auto subject = upper(entry.id.subject), code = upper(entry.id.code);
        unseen_codes.erase(code);
        if (!subjects.empty() && !subjects.contains(subject)) continue;
        unseen_subjects.erase(subject);
        if (!entry.id.neutral() && (codes.empty() ? posed.contains(upper(entry.id.group)) : !codes.contains(code)))
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

namespace {

/// One run of preprocess_database: what its two passes share.
class DatabaseRun {
public:
    DatabaseRun(const database::ScanDatabase& database, fs::path root, const facs::FacsCatalogue& catalogue,
                const PreprocessOptions& options, const std::function<void(const std::string&)>& progress)
        : database_(database), root_(std::move(root)), catalogue_(catalogue), options_(options), progress_(progress) {
        std::map<std::string, Subject> by_name;
        for (const auto* entry : selected_scans(database, options)) by_name[entry->id.subject].scans.push_back(entry);
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
                                       ? average_there && tied(*entry)
                                       : finished(face_stem(root_, entry->id), fingerprint(*entry));
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
        if (const auto text = without_partner(face); !text.empty()) subject.remarks.push_back({face.id.name(), text});
        const geometry::LandmarkPairs pairs(face.snapped_landmarks, face.snapped_landmarks);
        for (const auto& pair : pairs.merged())
            if (pair == "'lower_lip_inner' lies on 'upper_lip_inner'" ||
                pair == "'upper_lip_inner' lies on 'lower_lip_inner'")
                subject.closed_lips.push_back(face.id.name());
            else
                subject.remarks.push_back({face.id.name(), "on one grid vertex: " + pair});
    }
    /// Not kept with the face: another average face may have other landmarks.
    [[nodiscard]] std::string without_partner(const Face& face) const {
        const geometry::LandmarkPairs pairs(face.landmarks, average_.landmarks);
        std::vector<std::string> parts;
        if (const auto names = pairs.only_in_to(); !names.empty())
            parts.push_back(fmt::format("the scan lacks {} of the average face", fmt::join(names, ", ")));
        if (const auto names = pairs.only_in_from(); !names.empty())
            parts.push_back(fmt::format("the average face lacks {} of the scan", fmt::join(names, ", ")));
        if (parts.empty()) return {};
        return fmt::format("landmarks without a partner: {}; what is learned between the two goes without them",
                           fmt::join(parts, "; "));
    }
    void done(const ScanEntry& entry) const {
        if (progress_) progress_(entry.id.name());
    }
    /// From the first change of a face on, the folder is no finished workspace until all are done.
    void begin_writing() {
        std::call_once(writing_, [&] {
            std::error_code ignored;
            fs::remove(root_ / "workspace.json", ignored);
            keep_hidden_list();  // before the first face that it is about
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
    [[nodiscard]] std::string neutral_fingerprint(const ScanEntry& entry) const {
        return describe(options_) + " neutral " + entry_stamp(entry);
    }

    /// Of scans other than the first neutrals.
    [[nodiscard]] std::string fingerprint(const ScanEntry& entry) const {
        return fmt::format("{} scan {} average {} stable region {}", describe(options_), entry_stamp(entry),
                           average_fingerprint_, catalogue_.content_hash());
    }

    /// Without reading a scan: the neutral that an earlier run could use, else the first.
    void expect_neutral(Subject& subject) const {
        for (const auto* entry : subject.scans) {
            if (!entry->id.neutral()) continue;
            if (!subject.neutral) subject.neutral = entry;
            if (!finished(face_stem(root_, entry->id), neutral_fingerprint(*entry))) continue;
            subject.neutral = entry;
            return;
        }
    }

    /// First pass: one neutral per subject, gridded and written. One that fails gives its place to the next.
    void grid_neutral(Subject& subject) {
        for (const auto* entry : subject.scans) {
            if (!entry->id.neutral()) continue;
            const auto stem = face_stem(root_, entry->id);
            try {
                auto face = read_finished(stem, neutral_fingerprint(*entry));
                if (!face) {
                    const auto loaded = load_marked(*entry);
                    face = preprocess_scan(loaded, options_.steps);
                    // Every later step stands on these four landmarks: now is the time to find them missing or flat.
                    (void)affine_normalisation(face->snapped_landmarks, face->snapped_landmarks);
                    begin_writing();
                    write_finished(stem, *face, neutral_fingerprint(*entry), loaded.files_looked_for);
                    subject.fresh = true;
                }
                subject.neutral_landmarks = face->landmarks;
                subject.neutral = entry;
                return;
            } catch (const std::exception& e) {
                fail(subject, *entry, e.what());
                subject.reported.insert(entry);
                done(*entry);
            }
        }
    }

    /// What the average face is made from. @return the neutrals
    std::vector<const ScanEntry*> name_average() {
        std::vector<const ScanEntry*> neutrals;
        base::ContentHash made_from;  // its length must not grow with the subjects: every mark repeats it
        made_from.add(describe(options_) + " " + describe(options_.average));
        std::string first_reason = "no neutral scan";
        for (const auto& subject : subjects_) {
            if (!subject.neutral) {
                if (!subject.failures.empty() && first_reason == "no neutral scan")
                    first_reason = subject.failures.front().scan + ": " + subject.failures.front().reason;
                continue;
            }
            neutrals.push_back(subject.neutral);
            made_from.add(" " + subject.neutral->id.name() + " " + shape_stamp(*subject.neutral));
        }
        average_fingerprint_ = made_from.text();
        if (neutrals.size() < 2)
            throw InputError(fmt::format(
                "{}: {} of {} selected subjects have a usable neutral face, and the average face needs two{}",
                database_.root.string(), neutrals.size(), subjects_.size(),
                neutrals.size() == subjects_.size() ? std::string("; select more subjects")
                                                    : fmt::format(" (the first that has none: {})", first_reason)));
        return neutrals;
    }

    /// Whether an earlier run made it from the same.
    bool read_average() {
        std::error_code error;
        if (!fs::exists(average_stem(root_) += ".json", error)) return false;
        try {
            std::string found;
            average_ = read_average_face(average_stem(root_), &found);
            return found == average_fingerprint_;
        } catch (const InputError&) {
            return false;  // damaged: made again
        }
    }

    void prepare_average() {
        const auto neutrals = name_average();
        if (read_average()) return;
        std::vector<geometry::Landmarks> sets;
        for (const auto& subject : subjects_)
            if (subject.neutral) sets.push_back(subject.neutral_landmarks);
        begin_writing();
        double rms_mm = 0;
        const auto consensus = consensus_landmarks(sets, options_.average.max_iterations, &rms_mm);
        average_ = build_average_face(
            neutrals.size(), [&](std::size_t k) { return read_face(face_stem(root_, neutrals[k]->id)); }, consensus,
            options_.average);
        average_.consensus_rms_mm = rms_mm;
        write_average_face(average_stem(root_), average_, average_fingerprint_);
        average_ = read_average_face(average_stem(root_));
    }

    /// Second pass: every scan, tied to its subject's first neutral and to the average face.
    void tie_scans(Subject& subject) {
        Face neutral;
        if (subject.neutral) {
            try {
                neutral = tie_neutral(subject);
                subject.finished.push_back(subject.neutral->id);
            } catch (const std::exception& e) {
                fail(subject, *subject.neutral, e.what());
                subject.reported.insert(subject.neutral);
                done(*subject.neutral);
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
    [[nodiscard]] bool tied(const ScanEntry& entry) const {
        auto face = read_finished(face_stem(root_, entry.id), neutral_fingerprint(entry));
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
        write_finished(stem, neutral, neutral_fingerprint(*subject.neutral), files_looked_for(stem));
        remark(subject, neutral);  // here, not where it was gridded: it may have been in an earlier run
        ++subject.preprocessed;
        return neutral;
    }

    void tie_scan(Subject& subject, const Face& neutral, const ScanEntry& entry) {
        const auto stem = face_stem(root_, entry.id);
        if (finished(stem, fingerprint(entry))) {
            ++subject.up_to_date;
            return;
        }
        const auto loaded = load_marked(entry);
        Face face = preprocess_scan(loaded, options_.steps);
        align_to_neutral(face, neutral, stable_region(face, neutral), options_.alignment);
        face.average_from_scan = neutral.average_from_scan * face.neutral_from_scan;
        try {
            face.average_from_scan_affine = affine_normalisation(face.snapped_landmarks, average_.landmarks);
        } catch (const std::exception& e) {  // a chin that dropped out of the scanner's sight, or four marks in a plane
            face.average_from_scan_affine = neutral.average_from_scan_affine * face.neutral_from_scan;
            face.remarks.push_back(fmt::format("Eqs 5.1-5.4: {}; those of the neutral were taken", e.what()));
        }
        begin_writing();
        write_finished(stem, face, fingerprint(entry), loaded.files_looked_for);
        remark(subject, face);
        ++subject.preprocessed;
    }

    /// What of the neutral the scan's expression leaves alone.
    [[nodiscard]] geometry::VertexMask stable_region(Face& face, const Face& neutral) const {
        if (face.id.neutral()) return stable_on_every_face(neutral);
        if (const auto expression = catalogue_.find_expression(face.id.code))
            return stable_vertices(catalogue_, *expression, neutral);
        face.remarks.push_back(fmt::format(
            "expression {} is not in the catalogue: aligned by nose bridge and temples alone", face.id.code));
        return stable_on_every_face(neutral);
    }

    PreprocessReport finish() {
        PreprocessReport report;
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
        base::write_atomically(root_ / "workspace.json", io::json_text(document));
        remove_sheets_of_hidden(Workspace(root_));
        return report;
    }

    const database::ScanDatabase& database_;
    fs::path root_;
    const facs::FacsCatalogue& catalogue_;
    const PreprocessOptions& options_;
    const std::function<void(const std::string&)>& progress_;
    std::vector<Subject> subjects_;  // by name
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
                                     const std::function<void(const std::string&)>& progress) {
    options.check();
    check_workspace_place(database, root);
    DatabaseRun run(database, root, catalogue, options, progress);
    base::check_takes_files(root);
    return run.run();
}

PreprocessPlan plan_preprocessing(const database::ScanDatabase& database, const fs::path& root,
                                  const facs::FacsCatalogue& catalogue, const PreprocessOptions& options) {
    options.check();
    check_workspace_place(database, root);
    return DatabaseRun(database, root, catalogue, options, {}).plan();
}

}  // namespace mimik::preprocessing
