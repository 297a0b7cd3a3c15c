#include "preprocessing/workspace.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/errors.h"
#include "geometry/file.h"
#include "geometry/parallel.h"
#include "geometry/point_index.h"
#include "geometry/surface_index.h"
#include "preprocessing/json_values.h"
#include "preprocessing/normalisation.h"

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

std::string describe(const PreprocessOptions& o) {
    return fmt::format("clean {} {} {} grid {} {} edge {} {} lattice {} icp {} {} {}", o.cleaning.spike_mm,
                       o.cleaning.max_jump_mm, o.cleaning.min_part, o.gridding.rows, o.gridding.cols,
                       o.gridding.max_edge_mm.value_or(0), o.gridding.max_edge_spacings, o.gridding.use_lattice,
                       o.alignment.trim, o.alignment.max_distance_mm, o.alignment.max_iterations);
}

/// A file that did not change has the same size and time: cheap to ask for thousands of scans.
std::string stamp(const fs::path& file) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    const auto time = fs::last_write_time(file, error);
    return error ? "absent" : fmt::format("{} {}", size, time.time_since_epoch().count());
}

std::string stamp(const ScanEntry& entry) { return stamp(entry.scan_file) + " " + stamp(entry.landmarks_file); }

fs::path fingerprint_file(const fs::path& stem) {
    auto file = stem;
    file += ".done";
    return file;
}

bool finished(const fs::path& stem, const std::string& fingerprint) {
    std::error_code error;
    return fs::exists(fingerprint_file(stem), error) && geometry::read_text(fingerprint_file(stem)) == fingerprint;
}

}  // namespace

std::vector<char> stable_on_every_face(const Face& neutral) {
    const auto& marks = neutral.landmarks;
    const Point left = marks.position_mm("eye_outer_left"), right = marks.position_mm("eye_outer_right");
    const Point middle = 0.5 * (left + right);
    const double eyes_mm = (left - right).norm();
    std::vector<char> stable(neutral.grid.size(), 0);
    for (std::size_t v = 0; v < stable.size(); ++v) {
        if (!neutral.grid.measured(v)) continue;
        const Point& p = neutral.grid.vertices_mm[v];
        const double x = std::abs(p.x() - middle.x()) / eyes_mm, y = (p.y() - middle.y()) / eyes_mm;
        const bool nose_bridge = x < 0.22 && y > -0.30 && y < 0.10;
        const bool temple = x > 0.50 && x < 0.75 && y > -0.15 && y < 0.40;
        stable[v] = nose_bridge || temple ? 1 : 0;
    }
    return stable;
}

Face preprocess_scan(const database::LoadedScan& loaded, const PreprocessOptions& options, CleaningReport* cleaning,
                     GriddingReport* gridding) {
    Face face;
    face.id = loaded.entry.id;
    face.sex = loaded.entry.sex;
    face.texture_file = loaded.entry.texture_file;
    face.landmarks = loaded.landmarks;
    face.remarks = loaded.remarks;
    face.grid = grid_scan(clean(loaded.scan, options.cleaning, cleaning), options.gridding, gridding);

    std::vector<Point> inside;
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        if (face.grid.inside(v)) inside.push_back(face.grid.vertices_mm[v]);
    const geometry::PointIndex index(inside);
    std::vector<geometry::Landmark> snapped(face.landmarks.all().begin(), face.landmarks.all().end());
    std::map<std::size_t, std::string> taken;
    for (auto& mark : snapped) {
        const auto nearest = index.nearest(mark.position_mm);
        const auto [other, fresh] = taken.emplace(nearest.index, mark.name);
        // Closed lips: two landmarks can share a nearest vertex, and a spline through both would be singular.
        if (!fresh)
            face.remarks.push_back(
                fmt::format("landmarks '{}' and '{}' have the same nearest grid vertex", other->second, mark.name));
        mark.position_mm = inside[nearest.index];
    }
    face.snapped_landmarks = geometry::Landmarks(std::move(snapped));
    return face;
}

std::vector<const ScanEntry*> selected_scans(const database::ScanDatabase& database, const PreprocessOptions& options) {
    static const std::set<std::string> groups = {"N", "E", "UFAU", "LFAU", "CAU"};
    std::set<std::string> subjects(options.subjects.begin(), options.subjects.end()), codes;
    for (const auto& code : options.codes) codes.insert(upper(code));
    std::vector<const ScanEntry*> scans;
    for (const auto& entry : database.scans) {
        if (!subjects.empty() && !subjects.contains(entry.id.subject)) continue;
        if (!entry.id.neutral()) {
            if (codes.empty() ? !groups.contains(entry.id.group) : !codes.contains(upper(entry.id.code))) continue;
        }
        scans.push_back(&entry);
    }
    return scans;
}

PreprocessReport preprocess_database(const database::ScanDatabase& database, const fs::path& root,
                                     const PreprocessOptions& options, const StableRegion& stable_region,
                                     const std::function<void(const std::string&)>& progress) {
    PreprocessReport report;
    std::mutex report_mutex;
    const auto fail = [&](const ScanId& id, const std::string& reason) {
        const std::scoped_lock lock(report_mutex);
        report.failures.push_back({id.name(), reason});
    };
    const auto done = [&](const ScanId& id) {
        if (progress) progress(id.name());
    };

    std::map<std::string, std::vector<const ScanEntry*>> by_subject;
    for (const auto* entry : selected_scans(database, options)) by_subject[entry->id.subject].push_back(entry);
    if (by_subject.empty())
        throw InputError(
            fmt::format("{}: no scan fits the selection; 'mimik scans' lists what there is", database.root.string()));
    std::vector<std::string> subjects;
    subjects.reserve(by_subject.size());
    for (const auto& [subject, entries] : by_subject) subjects.push_back(subject);

    // First pass: one neutral per subject, gridded and written. A neutral that fails gives its place to the next one.
    std::string average_fingerprint =
        describe(options) + fmt::format(" average {} {} {} {} {} {}", options.average.rows, options.average.cols,
                                        options.average.half_width, options.average.above_eyes,
                                        options.average.below_chin, options.average.min_share);
    std::vector<const ScanEntry*> neutral_of(subjects.size(), nullptr);
    std::vector<geometry::Landmarks> neutral_landmarks(subjects.size());
    geometry::parallel_for(subjects.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s)
            for (const auto* entry : by_subject.at(subjects[s])) {
                if (!entry->id.neutral()) continue;
                const auto stem = face_stem(root, entry->id);
                const std::string fingerprint = describe(options) + " neutral " + stamp(*entry);
                try {
                    if (finished(stem, fingerprint)) {
                        neutral_landmarks[s] = read_face(stem).landmarks;
                    } else {
                        Face face = preprocess_scan(database::load(*entry), options);
                        for (const auto name : affine_landmarks) (void)face.landmarks.at(name);
                        write_face(stem, face);
                        geometry::write_atomically(fingerprint_file(stem), fingerprint);
                        neutral_landmarks[s] = face.landmarks;
                    }
                    neutral_of[s] = entry;
                    break;
                } catch (const std::exception& e) {
                    fail(entry->id, e.what());
                    done(entry->id);
                }
            }
    });
    std::vector<geometry::Landmarks> sets;
    std::vector<std::size_t> usable;
    for (std::size_t s = 0; s < subjects.size(); ++s) {
        if (!neutral_of[s]) {
            report.left_out.push_back(subjects[s]);
            continue;
        }
        usable.push_back(s);
        sets.push_back(neutral_landmarks[s]);
        average_fingerprint += " " + neutral_of[s]->id.name() + " " + stamp(*neutral_of[s]);
    }

    AverageFace average;
    std::string found;
    std::error_code error;
    if (fs::exists(root / "average" / "average_face.json", error)) {
        try {
            average = read_average_face(average_stem(root), &found);
        } catch (const InputError&) {
            found.clear();  // damaged: made again below
        }
    }
    if (found != average_fingerprint) {
        double rms_mm = 0;
        const auto consensus = consensus_landmarks(sets, options.average.max_iterations, &rms_mm);
        average = build_average_face(
            usable.size(), [&](std::size_t k) { return read_face(face_stem(root, neutral_of[usable[k]]->id)); },
            consensus, options.average);
        average.consensus_rms_mm = rms_mm;
        write_average_face(average_stem(root), average, average_fingerprint);
        average = read_average_face(average_stem(root));
    }

    std::set<std::string> failed_neutrals;
    for (const auto& failure : report.failures) failed_neutrals.insert(failure.scan);

    // Second pass: every scan, tied to its subject's first neutral and to the average face.
    std::vector<std::vector<ScanId>> finished_ids(subjects.size());
    geometry::parallel_for(usable.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t u = begin; u < end; ++u) {
            const std::size_t s = usable[u];
            const auto neutral_id = neutral_of[s]->id;
            Face neutral = read_face(face_stem(root, neutral_id));
            neutral.average_from_scan = similarity_normalisation(neutral.landmarks, average.landmarks);
            neutral.average_from_scan_affine = affine_normalisation(neutral.snapped_landmarks, average.landmarks);
            for (const auto* entry : by_subject.at(subjects[s])) {
                const auto stem = face_stem(root, entry->id);
                const std::string fingerprint =
                    (entry == neutral_of[s]
                         ? describe(options) + " neutral " + stamp(*entry)
                         : describe(options) + " scan " + stamp(*entry) + " average " + average_fingerprint);
                try {
                    if (entry != neutral_of[s] && finished(stem, fingerprint)) {
                        const std::scoped_lock lock(report_mutex);
                        ++report.up_to_date;
                        finished_ids[s].push_back(entry->id);
                    } else if (entry == neutral_of[s]) {
                        write_face(stem, neutral);
                        const std::scoped_lock lock(report_mutex);
                        ++report.preprocessed;
                        finished_ids[s].push_back(entry->id);
                    } else {
                        if (failed_neutrals.contains(entry->id.name())) continue;  // reported in the first pass
                        Face face = preprocess_scan(database::load(*entry), options);
                        align_to_neutral(
                            face, neutral,
                            stable_region ? stable_region(face.id, neutral) : stable_on_every_face(neutral),
                            options.alignment);
                        face.average_from_scan = neutral.average_from_scan * face.neutral_from_scan;
                        face.average_from_scan_affine = affine_normalisation(face.snapped_landmarks, average.landmarks);
                        write_face(stem, face);
                        geometry::write_atomically(fingerprint_file(stem), fingerprint);
                        const std::scoped_lock lock(report_mutex);
                        ++report.preprocessed;
                        finished_ids[s].push_back(entry->id);
                    }
                } catch (const std::exception& e) {
                    fail(entry->id, e.what());
                }
                done(entry->id);
            }
        }
    });

    std::sort(report.failures.begin(), report.failures.end(),
              [](const ScanFailure& a, const ScanFailure& b) { return a.scan < b.scan; });
    std::vector<std::string> names;
    for (const auto& ids : finished_ids)
        for (const auto& id : ids) names.push_back(id.name());
    std::sort(names.begin(), names.end());
    auto failures = nlohmann::json::array();
    for (const auto& failure : report.failures)
        failures.push_back({{"scan", failure.scan}, {"reason", failure.reason}});
    const nlohmann::json document = {{"schema", 1},
                                     {"kind", "mimik workspace"},
                                     {"database", fs::absolute(database.root).lexically_normal().string()},
                                     {"options", describe(options)},
                                     {"scans", names},
                                     {"failures", failures},
                                     {"hidden_subjects", database.hidden_subjects}};
    geometry::write_atomically(root / "workspace.json", document.dump(1) + "\n");
    return report;
}

void align_to_neutral(Face& face, const Face& neutral, const std::vector<char>& stable,
                      const RigidAlignmentOptions& options) {
    std::vector<Point> still;
    for (std::size_t v = 0; v < stable.size(); ++v)
        if (stable[v] && neutral.grid.measured(v)) still.push_back(neutral.grid.vertices_mm[v]);
    const geometry::SurfaceIndex surface(face.grid.vertices_mm,
                                         geometry::triangles(face.grid, geometry::BridgedVertices::leave_out));
    const auto start = rigid_by_landmarks(neutral.landmarks, face.landmarks);
    const auto alignment = align_rigidly(still, surface, start, options);
    face.neutral_from_scan = alignment.target_from_source.inverse();
    face.alignment_rms_mm = alignment.rms_mm;
    if (!alignment.converged)
        face.remarks.push_back(fmt::format("alignment to the neutral did not settle in {} steps (rms {:.3f} mm)",
                                           alignment.iterations, alignment.rms_mm));
}

Workspace::Workspace(fs::path root) : root_(std::move(root)) {
    const auto file = root_ / "workspace.json";
    if (!fs::exists(file))
        throw InputError(fmt::format("{}: no workspace.json there; make one with 'mimik preprocess DB -o {}'",
                                     root_.string(), root_.string()));
    from_json_file<int>(file, [&](const nlohmann::json& document) {
        database_root_ = document.at("database").get<std::string>();
        hidden_subjects_ = document.at("hidden_subjects").get<std::vector<std::string>>();
        for (const auto& name : document.at("scans")) {
            const auto id = database::parse_scan_name(name.get<std::string>());
            if (!id)
                throw InputError(fmt::format("{}: '{}' is not a scan name", file.string(), name.get<std::string>()));
            scans_.push_back(*id);
        }
        return 0;
    });
    std::sort(scans_.begin(), scans_.end());
    average_ = read_average_face(average_stem(root_));
}

std::vector<std::string> Workspace::subjects() const {
    std::set<std::string> names;
    for (const auto& id : scans_) names.insert(id.subject);
    return {names.begin(), names.end()};
}

bool Workspace::hidden(const std::string& subject) const {
    return std::find(hidden_subjects_.begin(), hidden_subjects_.end(), subject) != hidden_subjects_.end();
}

bool Workspace::has(const ScanId& id) const { return std::binary_search(scans_.begin(), scans_.end(), id); }

ScanId Workspace::neutral(const std::string& subject) const {
    for (const auto& id : scans_)
        if (id.subject == subject && id.neutral()) return id;
    throw InputError(fmt::format("{}: subject '{}' has no neutral face there; there are: {}", root_.string(), subject,
                                 fmt::join(subjects(), ", ")));
}

std::optional<ScanId> Workspace::expression(const std::string& subject, const std::string& code) const {
    for (const auto& id : scans_)
        if (id.subject == subject && !id.neutral() && upper(id.code) == upper(code)) return id;
    return std::nullopt;
}

Face Workspace::face(const ScanId& id) const { return read_face(face_stem(root_, id)); }

}  // namespace mimik::preprocessing
