#include "synthesis/synthesize.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/temporary.h"
#include "database/bnt.h"
#include "database/bosphorus_landmarks.h"
#include "database/scan_id.h"
#include "database/truth.h"
#include "io/image.h"
#include "io/json_values.h"
#include "synthesis/photograph.h"

namespace mimik::synthesis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Task {
    PosedExpression expression;
    int repetition = 0;
};

std::vector<Task> plan_scans(const FaceModel& model, const SynthesizeOptions& options,
                             std::vector<std::string>& skipped) {
    std::vector<Task> tasks;
    tasks.reserve(static_cast<std::size_t>(options.neutrals));
    for (int k = 0; k < options.neutrals; ++k) tasks.push_back({make_expression("N"), k});
    for (const auto& expression : make_expressions(options.expressions, options.emotions)) {
        const auto missing = missing_shapes(expression, model);
        if (!missing.empty()) {
            skipped.push_back(fmt::format("{}_{} (no shape {})", expression.group, expression.code, missing.front()));
            continue;
        }
        for (int k = 0; k < (options.repeat ? 2 : 1); ++k) tasks.push_back({expression, k});
    }
    return tasks;
}

std::string subject_name(int index) { return fmt::format("bs{:03}", index); }

/// FACS steps are not equal; these shares of the full motion are a choice of ours.
char intensity_letter(double share) {
    return share < 0.15 ? 'A' : share < 0.35 ? 'B' : share < 0.6 ? 'C' : share < 0.95 ? 'D' : 'E';
}

std::string facs_line(const database::ScanId& id, const PosedExpression& expression, double amplitude) {
    std::string codes;
    const auto side = id.side();
    for (const auto& [unit, strength] : expression.action_units) {
        if (!codes.empty()) codes += '+';
        if (side == facs::Side::left) codes += 'L';
        if (side == facs::Side::right) codes += 'R';
        codes += std::to_string(unit);
        codes += intensity_letter(0.8 * strength * amplitude);
    }
    return fmt::format("{} -> {}\n", id.name(), codes.empty() ? "0" : codes);
}

std::vector<database::ImageLandmark> image_landmarks(const SyntheticScan& scan, const geometry::Landmarks& labelled,
                                                     double pixels_per_mm) {
    std::vector<database::ImageLandmark> marks;
    for (const auto& mark : labelled.all())
        marks.push_back({mark.name, (mark.position_mm.x() - scan.image_corner_mm.x()) * pixels_per_mm,
                         (scan.image_corner_mm.y() - mark.position_mm.y()) * pixels_per_mm});
    return marks;
}

json model_json(const FaceModel& model) {
    json faces = json::array(), regions = json::object();
    for (std::size_t f = 0; f < model.faces().size(); ++f) faces.push_back(model.faces()[f]);
    const auto& names = model.vertex_regions();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] != "skin") regions[names[i]].push_back(i);
    return {{"name", model.name()},
            {"vertices", names.size()},
            {"faces", faces},
            {"regions", regions},
            {"landmark_vertices", model.landmark_vertices()}};
}

struct MadeSubject {
    json truth;
    std::vector<std::string> scans;
    std::string facs_lines;
};

/// Everything about one scan: performance, exposure, photograph, files.
std::string make_scan(const fs::path& folder, const FaceModel& model, const Subject& subject,
                      const Complexion& complexion, const Task& task, const FaceWindow& window,
                      const SynthesizeOptions& options, SynthesizeReport& report) {
    const database::ScanId id{subject.name, task.expression.group, task.expression.code, task.repetition};
    const std::string name = id.name();
    const auto performance = perform(subject, task.expression, name, options.seed, options.variances);
    auto made = scan_face(model, performance.vertices_mm, window, name, options.seed, options.scanner);
    const auto image = photograph(model, complexion, performance.vertices_mm, made, options.scanner);

    const fs::path stem = folder / subject.name / name;
    made.scan.texture_file = name + ".png";
    const auto labelled = database::to_bosphorus_labels(made.landmarks);
    io::write_png(fs::path(stem).concat(".png"), image);
    database::write_bnt(fs::path(stem).concat(".bnt"), database::to_bnt(made.scan));
    database::write_lm3(fs::path(stem).concat(".lm3"), labelled);
    database::write_lm2(fs::path(stem).concat(".lm2"),
                        image_landmarks(made, labelled, options.scanner.texture_pixels_per_mm));

    database::TrueScan truth;
    truth.id = id;
    truth.faces = model.faces();
    truth.scanner_from_head = made.scanner_from_head;
    for (const auto& vertex : performance.vertices_mm) truth.vertices_mm.emplace_back(made.scanner_from_head * vertex);
    truth.displacement_mm = performance.displacement_mm;
    truth.landmarks = made.true_landmarks;
    truth.shape_weights = performance.weights;
    truth.amplitude = performance.amplitude;
    truth.asymmetry = performance.asymmetry;
    database::write_true_scan(folder / "truth", truth);

    static std::mutex mutex;
    const std::scoped_lock lock(mutex);
    ++report.scans;
    report.valid_points += made.valid_points;
    report.lost_grazing += made.lost_grazing;
    report.lost_holes += made.lost_holes;
    report.landmarks_marked += made.landmarks.size();
    report.landmarks_invisible += made.true_landmarks.size() - made.landmarks.size();
    if (options.on_scan_done) options.on_scan_done(name);
    return facs_line(id, task.expression, performance.amplitude);
}

MadeSubject make_subject(const fs::path& folder, const FaceModel& model, const std::string& name,
                         const std::vector<Task>& tasks, const SynthesizeOptions& options, SynthesizeReport& report) {
    const Subject subject = draw_subject(model, name, options.seed, options.variances);
    const FaceWindow window = face_window(model, subject.resting_mm);
    const Complexion complexion = draw_complexion(model, subject, window, options.seed);
    std::vector<std::string> lines(tasks.size());
    base::parallel_for_each(tasks.size(), [&](std::size_t t) {
        lines[t] = make_scan(folder, model, subject, complexion, tasks[t], window, options, report);
    });
    MadeSubject made;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        made.scans.push_back(
            database::ScanId{name, tasks[t].expression.group, tasks[t].expression.code, tasks[t].repetition}.name());
        made.facs_lines += lines[t];
    }
    made.truth = {{"name", name},
                  {"sex", subject.identity.sex == Sex::male ? "m" : "f"},
                  {"identity_seed", subject.identity.seed},
                  {"identity_coefficients", subject.identity.coefficients},
                  {"measurements_mm", subject.identity.measurements_mm},
                  {"amplitude", subject.amplitude},
                  {"asymmetry", subject.asymmetry},
                  {"mouth_width_ratio", subject.mouth_width_ratio},
                  {"eye_distance_ratio", subject.eye_distance_ratio}};
    return made;
}

/// Where links lead, also one to a folder that is not there yet: the database is made there and the link stays.
fs::path resolved(const fs::path& out) {
    if (out.empty()) throw InputError("OUT is empty; give the name of a new folder for the database");
    std::error_code error, absent;
    fs::path place = fs::absolute(out, error);
    if (!place.has_filename()) place = place.parent_path();
    constexpr int most_links = 40;  // as the system itself follows
    for (int k = 0; !error && k < most_links && fs::is_symlink(fs::symlink_status(place, absent)); ++k)
        place = place.parent_path() / fs::read_symlink(place, error);
    if (!error) place = fs::weakly_canonical(place, error);
    const bool exists = !error && fs::exists(place, error);
    if (error)
        throw InputError(fmt::format("{}: cannot be used ({}); give a new folder", out.string(), error.message()));
    if (exists && (!fs::is_directory(place, error) || !fs::is_empty(place, error)))
        throw InputError(fmt::format("{}: exists already; give a new folder or remove this one", out.string()));
    return place;
}

/// A new folder beside the place where the database is to be; gone, with what is in it, unless it got there.
class UnfinishedFolder {
public:
    explicit UnfinishedFolder(fs::path place) : place_(std::move(place)) {
        try {
            fs::create_directories(place_.parent_path());
            folder_.emplace(place_.parent_path());
        } catch (const std::system_error& e) {
            throw InputError(fmt::format("{}: no folder can be made there ({}); write elsewhere", place_.string(),
                                         e.code().message()));
        }
    }
    [[nodiscard]] const fs::path& path() const { return folder_->path(); }
    void finish() {
        try {
            folder_->become(place_);  // an empty folder is replaced, one that was filled meanwhile is not
        } catch (const std::system_error& e) {
            throw InputError(fmt::format("{}: the database cannot be put there ({}); give another folder",
                                         place_.string(), e.code().message()));
        }
    }

private:
    fs::path place_;
    std::optional<base::TemporaryFolder> folder_;
};

}  // namespace

void SynthesizeOptions::check() const {
    if (subjects < 1 || subjects > 1000) throw InputError(fmt::format("subjects is {}; give 1 to 1000", subjects));
    if (neutrals < 1 || neutrals > 10) throw InputError(fmt::format("neutrals is {}; give 1 to 10", neutrals));
    variances.check();
    scanner.check();
    // Neutral scans alone are asked for with "N" or nothing at all, not by a slip of the pen.
    if (!expressions.empty() && expressions.find_first_not_of(", ") == std::string::npos)
        throw InputError(
            fmt::format("expressions is '{}', which names none; give thesis, emotions, further, all, N or "
                        "codes such as 12,12L,HAPPY",
                        expressions));
    if (!is_emotion_set(emotions)) throw InputError(fmt::format("emotions is '{}'; give emfacs or thesis", emotions));
    (void)make_expressions(expressions, emotions);
}

SynthesizeEstimate estimate_database(const FaceModel& model, const SynthesizeOptions& options) {
    options.check();
    SynthesizeEstimate estimate;
    const auto tasks = plan_scans(model, options, estimate.skipped_expressions);
    estimate.scans = tasks.size() * static_cast<std::size_t>(options.subjects);
    const auto mean = model.neutral_mm(model.draw_identity(0, Sex::female, 0.0));
    const auto window = face_window(model, mean);
    const double area_mm2 = 4.0 * (window.half_width_mm + 6.0) * (window.half_height_mm + 6.0);
    const double cells = area_mm2 / (options.scanner.spacing_mm * options.scanner.spacing_mm);
    const double pixels =
        1.3 * area_mm2 * options.scanner.texture_pixels_per_mm * options.scanner.texture_pixels_per_mm;
    const double truth = 48.0 * static_cast<double>(mean.size()) + 17.0 * static_cast<double>(model.faces().size());
    // 40 bytes per cell in the .bnt; PNG takes about 1.1 bytes per pixel of these pictures.
    estimate.bytes =
        static_cast<std::uintmax_t>(static_cast<double>(estimate.scans) * (40.0 * cells + 1.1 * pixels + truth));
    estimate.core_seconds = static_cast<double>(estimate.scans) *
                            (4e-7 * cells + 1.5e-7 * pixels + 1e-6 * static_cast<double>(mean.size()));
    return estimate;
}

void check_database_place(const fs::path& out, std::uintmax_t bytes) {
    auto folder = resolved(out);
    std::error_code error;
    while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
    if (!fs::is_directory(folder, error))
        throw InputError(
            fmt::format("{}: {} is no folder; give a new folder in one that is there", out.string(), folder.string()));
    const auto disk = fs::space(folder, error);
    if (!error && disk.available < bytes)
        throw InputError(
            fmt::format("{}: the database takes about {:.0f} MB, but its disk has {:.0f} MB free; make "
                        "fewer subjects or expressions, or write elsewhere",
                        out.string(), static_cast<double>(bytes) / 1e6, static_cast<double>(disk.available) / 1e6));
}

SynthesizeReport synthesize_database(const fs::path& out, const FaceModel& model, const SynthesizeOptions& options) {
    options.check();
    const fs::path place = resolved(out);
    SynthesizeReport report;
    const auto tasks = plan_scans(model, options, report.skipped_expressions);
    UnfinishedFolder unfinished(place);
    const fs::path& folder = unfinished.path();

    std::vector<MadeSubject> subjects(static_cast<std::size_t>(options.subjects));
    // A subject in the making takes up to 80 MB. So many at a time, whatever the number of threads: within a subject
    // the scans are spread over all of them.
    constexpr std::size_t most_at_a_time = 8;
    for (std::size_t first = 0; first < subjects.size(); first += most_at_a_time)
        base::parallel_for_each(std::min(most_at_a_time, subjects.size() - first), [&](std::size_t k) {
            const auto name = subject_name(static_cast<int>(first + k));
            subjects[first + k] = make_subject(folder, model, name, tasks, options, report);
        });
    report.subjects = subjects.size();

    json subject_list = json::array(), scan_list = json::array();
    std::string facs = "Synthetic FACS scores, from the strengths that were asked for\nname -> code+code+...\n";
    std::string sexes = "subject,sex\n";
    for (const auto& subject : subjects) {
        sexes += fmt::format("{},{}\n", subject.truth.at("name").get<std::string>(),
                             subject.truth.at("sex").get<std::string>());
        subject_list.push_back(subject.truth);
        for (const auto& scan : subject.scans) scan_list.push_back(scan);
        facs += subject.facs_lines;
    }
    json truth = {{"schema", 1},
                  {"frame", "mm; +x subject's left, +y up, +z out of the face"},
                  {"seed", options.seed},
                  {"expressions", options.expressions},
                  {"variances", io::fields_to_json(options.variances)},
                  {"scanner", io::fields_to_json(options.scanner)},
                  {"face_model", model_json(model)},
                  {"subjects", subject_list},
                  {"scans", scan_list}};
    if (options.emotions != SynthesizeOptions().emotions) truth["emotions"] = options.emotions;
    base::write_atomically(folder / "truth" / "truth.json", truth.dump() + "\n");
    base::write_atomically(folder / "subjects.csv", sexes);
    if (options.facs_codes) base::write_atomically(folder / "facscodes.lst", facs);
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) report.bytes += entry.file_size();
    unfinished.finish();
    return report;
}

}  // namespace mimik::synthesis
