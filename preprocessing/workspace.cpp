#include "preprocessing/workspace.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "database/hidden_subjects.h"
#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "io/json_values.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "geometry/point_index.h"
#include "geometry/surface_index.h"
#include "base/text.h"
#include "preprocessing/control_pairs.h"
#include "preprocessing/finished_face.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/quality_sheet.h"
#include "preprocessing/workspace_json.h"

namespace mimik::preprocessing {

using database::ScanEntry;
using database::ScanId;
using geometry::Point;
namespace fs = std::filesystem;

namespace {

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

fs::path face_stem(const fs::path& root, const ScanId& id) { return root / "faces" / id.subject / id.name(); }
fs::path average_stem(const fs::path& root) { return root / "average" / "average_face"; }

/// Part of every fingerprint: raise it when the steps give other numbers for the same scan and options.
constexpr int steps_version = 6;

std::string describe(const PreprocessOptions& o) {
    return fmt::format("steps {} clean {} {} {} grid {} {} edge {} {} lattice {} icp {} {} {} {} {} {} {}",
                       steps_version, o.cleaning.spike_mm, o.cleaning.max_jump_mm, o.cleaning.min_part, o.gridding.rows,
                       o.gridding.cols, o.gridding.max_edge_mm.value_or(0), o.gridding.max_edge_spacings,
                       o.gridding.use_lattice, o.alignment.trim, o.alignment.max_distance_mm,
                       o.alignment.max_iterations, o.alignment.max_points, o.alignment.coarse_points,
                       o.alignment.stop_rotation_deg, o.alignment.stop_shift_mm);
}

std::string describe(const AverageFaceOptions& o) {
    return fmt::format("average {} {} {} {} {} {} {}", o.rows, o.cols, o.half_width, o.above_eyes, o.below_chin,
                       o.min_share, o.max_iterations);
}

/// What the shape of a face and its landmarks come from: all that the average face and other scans take of it.
std::string shape_stamp(const ScanEntry& entry) {
    return fmt::format("{} {} unit {}", file_stamp(entry.scan_file), file_stamp(entry.landmarks_file),
                       static_cast<int>(entry.unit));
}

/// Everything that a face takes from an entry. Image and image landmarks together decide how the texture lies; files
/// that only the scan file names stand in `.done`.
std::string entry_stamp(const ScanEntry& entry) {
    return fmt::format("{} sex '{}' texture '{}' {} {}", shape_stamp(entry), entry.sex, entry.texture_file.string(),
                       file_stamp(entry.texture_file), file_stamp(entry.landmarks2d_file));
}

bool inside(const fs::path& inner, const fs::path& outer) {
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
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

std::vector<char> stable_on_every_face(const Face& neutral) {
    const auto marks = geometry::transformed(neutral.landmarks, neutral.average_from_scan);
    const Point &left = marks.position_mm("eye_outer_left"), &right = marks.position_mm("eye_outer_right");
    const Point middle = 0.5 * (left + right);
    const double eyes_mm = (left - right).norm();
    std::vector<char> stable(neutral.grid.size(), 0);
    for (std::size_t v = 0; v < stable.size(); ++v) {
        if (!neutral.grid.measured(v)) continue;
        const Point p = neutral.average_from_scan * neutral.grid.vertices_mm[v];
        const double x = std::abs(p.x() - middle.x()) / eyes_mm, y = (p.y() - middle.y()) / eyes_mm;
        const bool nose_bridge = x < 0.22 && y > -0.30 && y < 0.10;
        const bool temple = x > 0.50 && x < 0.75 && y > -0.15 && y < 0.40;
        stable[v] = nose_bridge || temple ? 1 : 0;
    }
    return stable;
}

void PreprocessOptions::check() const {
    cleaning.check();
    gridding.check();
    average.check();
    alignment.check();
}

Face preprocess_scan(const database::LoadedScan& loaded, const PreprocessOptions& options, CleaningReport* cleaning,
                     GriddingReport* gridding) {
    Face face;
    face.id = loaded.entry.id;
    face.sex = loaded.entry.sex;
    face.landmarks = loaded.landmarks;
    face.remarks = loaded.remarks;
    // A manifest may list meshes that know of no image, and any image of the same name lies beside them.
    if (!loaded.scan.texture_coordinates.empty())
        face.texture_file = loaded.entry.texture_file;
    else if (!loaded.entry.texture_file.empty())
        face.remarks.emplace_back("the image beside it is not used: the scan has no texture coordinates");
    CleaningReport cleaned;
    GriddingReport gridded;
    face.grid = grid_scan(clean(loaded.scan, options.cleaning, &cleaned), options.gridding, &gridded);
    // Of what a scanner sees no more than 0.0002; of whole heads from 0.04 on, however dense their front.
    if (gridded.seen_through > 0.02)
        throw InputError(fmt::format(
            "{}: {:.1f} % of the triangles between neighbouring points join front and back, and a cloud does not say "
            "which is which; give the mesh with its faces, or cut off what lies behind the face",
            loaded.entry.scan_file.string(), 100 * gridded.seen_through));
    if (gridded.seen_through > 0.002)
        face.remarks.push_back(
            fmt::format("{:.1f} % of the triangles between neighbouring points join front and back; the surface there "
                        "counts as bridged",
                        100 * gridded.seen_through));
    if (const auto lost = cleaned.spikes + cleaned.stray_points; 20 * lost > cleaned.points)
        face.remarks.push_back(
            fmt::format("cleaning left out {} of {} points: {} spikes, and {} stray points in {} parts", lost,
                        cleaned.points, cleaned.spikes, cleaned.stray_points, cleaned.stray_parts));
    if (cleaning) *cleaning = cleaned;
    if (gridding) *gridding = gridded;

    std::vector<Point> inside;
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        if (face.grid.inside(v)) inside.push_back(face.grid.vertices_mm[v]);
    const geometry::PointIndex index(inside);
    std::vector<geometry::Landmark> snapped(face.landmarks.all().begin(), face.landmarks.all().end());
    for (auto& mark : snapped) mark.position_mm = inside[index.nearest(mark.position_mm).index];
    face.snapped_landmarks = geometry::Landmarks(std::move(snapped));
    return face;
}

std::vector<const ScanEntry*> selected_scans(const database::ScanDatabase& database, const PreprocessOptions& options) {
    static const std::set<std::string> posed = {"YR", "PR", "CR", "O", "IGN"};
    std::map<std::string, std::string> subjects, codes, unseen_subjects, unseen_codes;  // as compared -> as typed
    for (const auto& subject : options.subjects) subjects.emplace(upper(subject), subject);
    for (const auto& code : options.codes) {
        const auto id = database::parse_expression(code);
        codes.emplace(upper(id ? id->code : code), code);
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
    DatabaseRun(const database::ScanDatabase& database, fs::path root, const PreprocessOptions& options,
                const StableRegion& stable_region, const std::function<void(const std::string&)>& progress)
        : database_(database),
          root_(std::move(root)),
          options_(options),
          stable_region_(stable_region),
          progress_(progress) {
        std::map<std::string, Subject> by_name;
        for (const auto* entry : selected_scans(database, options)) by_name[entry->id.subject].scans.push_back(entry);
        for (auto& [name, subject] : by_name) subjects_.push_back(std::move(subject));
    }

    PreprocessReport run() {
        base::parallel_for(subjects_.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) grid_neutral(subjects_[s]);
        });
        prepare_average();
        base::parallel_for(subjects_.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) tie_scans(subjects_[s]);
        });
        return finish();
    }

    /// What run() would do, of scans that it can use; writes nothing.
    PreprocessPlan plan() {
        for (auto& subject : subjects_) expect_neutral(subject);
        name_average();
        const bool average_there = read_average();
        base::parallel_for(subjects_.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s)
                for (const auto* entry : subjects_[s].scans) {
                    if (!subjects_[s].neutral) break;  // left out
                    const bool there = entry == subjects_[s].neutral
                                           ? average_there && tied(*entry)
                                           : finished(face_stem(root_, entry->id), fingerprint(*entry));
                    ++(there ? subjects_[s].up_to_date : subjects_[s].preprocessed);
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
    static void remark(Subject& subject, const Face& face) {
        for (const auto& text : face.remarks) subject.remarks.push_back({face.id.name(), text});
        const ControlPairs pairs(face.snapped_landmarks, face.snapped_landmarks);
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
            base::write_atomically(file,
                                       std::string(mark) + database::hidden_subjects_text(database_.hidden_subjects));
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
                           average_fingerprint_, options_.stable_region_name);
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
                    face = preprocess_scan(loaded, options_);
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
        Face face = preprocess_scan(loaded, options_);
        align_to_neutral(face, neutral,
                         stable_region_ ? stable_region_(face.id, neutral) : stable_on_every_face(neutral),
                         options_.alignment);
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
        remove_hidden_sheets(Workspace(root_));
        return report;
    }

    const database::ScanDatabase& database_;
    fs::path root_;
    const PreprocessOptions& options_;
    const StableRegion& stable_region_;
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
        if (output != taken && !inside(output, home)) continue;
        throw InputError(
            fmt::format("{}: is part of the database {}, into which nothing is written; give another "
                        "folder for the workspace",
                        root.string(), database.root.string()));
    }
}

PreprocessReport preprocess_database(const database::ScanDatabase& database, const fs::path& root,
                                     const PreprocessOptions& options, const StableRegion& stable_region,
                                     const std::function<void(const std::string&)>& progress) {
    options.check();
    check_workspace_place(database, root);
    DatabaseRun run(database, root, options, stable_region, progress);
    base::check_takes_files(root);
    return run.run();
}

PreprocessPlan plan_preprocessing(const database::ScanDatabase& database, const fs::path& root,
                                  const PreprocessOptions& options) {
    options.check();
    check_workspace_place(database, root);
    return DatabaseRun(database, root, options, {}, {}).plan();
}

void align_to_neutral(Face& face, const Face& neutral, const std::vector<char>& stable,
                      const RigidAlignmentOptions& options) {
    // Of 1, 0.4, 0.2, 0.1 and 0 for what the jaw carries, 0.2 came closest to true poses.
    constexpr double skull_weight = 1.0, jaw_weight = 0.2, below_nose_tip = 0.05;  // the last in outer-eye distances
    const auto marks = geometry::transformed(neutral.landmarks, neutral.average_from_scan);
    const double jaw_below_mm =
        marks.position_mm("nose_tip").y() -
        below_nose_tip * (marks.position_mm("eye_outer_left") - marks.position_mm("eye_outer_right")).norm();
    std::vector<Point> still;
    std::vector<double> weights;
    for (std::size_t v = 0; v < stable.size(); ++v) {
        if (!stable[v] || !neutral.grid.measured(v)) continue;
        still.push_back(neutral.grid.vertices_mm[v]);
        const double y_mm = (neutral.average_from_scan * still.back()).y();
        weights.push_back(y_mm < jaw_below_mm ? jaw_weight : skull_weight);
    }
    const geometry::SurfaceIndex surface(face.grid.vertices_mm,
                                         geometry::triangles(face.grid, geometry::BridgedVertices::leave_out));
    const auto start = rigid_by_landmarks(neutral.landmarks, face.landmarks);
    const auto alignment = align_rigidly(still, surface, start, options, weights);
    face.neutral_from_scan = alignment.target_from_source.inverse();
    face.alignment_rms_mm = alignment.rms_mm;
    if (!alignment.converged)
        face.remarks.push_back(fmt::format("alignment to the neutral did not settle in {} steps (rms {:.3f} mm)",
                                           alignment.iterations, alignment.rms_mm));
}

WorkspaceList decode_workspace(std::string_view text, const std::string& name) {
    return io::read_json_document(text, name, damaged_file_mend, [](const nlohmann::json& document) {
        WorkspaceList list;
        list.database_root = io::read_field<std::string>(document, "database");
        list.made_with_truth = document.contains("truth") && io::read_field<bool>(document, "truth");
        list.hidden_subjects = io::read_field<std::vector<std::string>>(document, "hidden_subjects");
        io::read_list(document, "scans", [&](const nlohmann::json& entry) {
            list.scans.push_back(database::scan_id_from(entry.get<std::string>()));
        });
        std::sort(list.scans.begin(), list.scans.end());
        return list;
    });
}

Workspace::Workspace(fs::path root) : root_(std::move(root)) {
    const auto file = root_ / "workspace.json";
    if (!fs::exists(file))
        throw InputError(
            fmt::format("{}: no finished workspace there; make or finish one with 'mimik preprocess DB -o {}'",
                        root_.string(), root_.string()));
    list_ = decode_workspace(base::read_text(file, io::most_json_bytes), file.string());
    // Who asked to be hidden since then is hidden at once, not from the next preprocessing on.
    for (const auto& folder : {list_.database_root, root_})
        for (auto& subject : database::hidden_subjects_of(folder, subjects(), database::KnownSubjects::some).subjects)
            if (!hidden(subject)) list_.hidden_subjects.push_back(std::move(subject));
    average_ = read_average_face(average_stem(root_));
}

std::vector<std::string> Workspace::subjects() const {
    std::set<std::string> names;
    for (const auto& id : list_.scans) names.insert(id.subject);
    return {names.begin(), names.end()};
}

bool Workspace::hidden(const std::string& subject) const { return database::is_hidden(list_.hidden_subjects, subject); }

void Workspace::refuse_hidden(const std::string& subject) const {
    if (hidden(subject))
        throw InputError(
            fmt::format("subject '{}' stands in unallowed_subjects.txt and must not be shown; choose "
                        "another",
                        subject));
}

bool Workspace::has(const ScanId& id) const { return std::binary_search(list_.scans.begin(), list_.scans.end(), id); }

ScanId Workspace::neutral(const std::string& subject) const {
    for (const auto& id : list_.scans)
        if (id.subject == subject && id.neutral()) return id;
    throw InputError(fmt::format("{}: subject '{}' has no neutral face there; there are: {}", root_.string(), subject,
                                 fmt::join(subjects(), ", ")));
}

std::optional<ScanId> Workspace::expression(const std::string& subject, const std::string& code) const {
    for (const auto& id : list_.scans)
        if (id.subject == subject && !id.neutral() && upper(id.code) == upper(code)) return id;
    return std::nullopt;
}

Face Workspace::face(const ScanId& id) const {
    auto face = read_face(stem(id));
    const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("{}.json: {}; run 'mimik preprocess' again", stem(id).string(), what));
    };
    if (face.id != id) refuse(fmt::format("scan is {}", base::in_quotes(face.id.name())));
    // A workspace that came from elsewhere shall not reach other files.
    if (const auto& texture = face.texture_file;
        !texture.empty() && !inside(texture.lexically_normal(), database_root()))
        refuse(fmt::format("texture_file {} does not lie in the database {}", base::in_quotes(texture.string()),
                           database_root().string()));
    return face;
}

fs::path Workspace::stem(const ScanId& id) const { return face_stem(root_, id); }

}  // namespace mimik::preprocessing
