#include "database/scan_database.h"

#include <algorithm>
#include <exception>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "database/bnt.h"
#include "database/database_names.h"
#include "database/hidden_subjects.h"
#include "database/manifest.h"
#include "io/landmark_io.h"
#include "io/range_scan_io.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_list_bytes = 16 << 20;  // facscodes.lst of the whole database has 0.2 MB

using base::lower_case;

bool same(std::string_view a, std::string_view b) { return base::equal_ignoring_case(a, b); }

/// What systems leave beside the files of others: ".DS_Store", "._NAME" and "__MACOSX" (macOS), and hidden files.
bool is_of_the_system(const fs::path& path) {
    const auto name = path.filename().string();
    return name.starts_with('.') || name == "__MACOSX";
}

/// Names and kinds of what is in a folder, in the order of their names: the order of a folder is nobody's promise.
std::vector<fs::path> listing(const fs::path& folder, std::vector<std::string>& remarks) {
    std::vector<fs::path> entries;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (!is_of_the_system(it->path())) entries.push_back(it->path());
    if (error)
        remarks.push_back(
            fmt::format("{}: cannot be listed ({}); its scans are left out", folder.string(), error.message()));
    std::sort(entries.begin(), entries.end());
    return entries;
}

/// The name without its extension, ".mrk.json" taken as one.
std::string stem_of(const fs::path& file) {
    const std::string name = file.filename().string();
    constexpr std::string_view markups = ".mrk.json";
    if (lower_case(name).ends_with(markups)) return name.substr(0, name.size() - markups.size());
    return file.stem().string();
}

/// Where an extension stands among those that may hold the same thing, the one that is preferred first.
std::size_t rank(const std::vector<std::string_view>& extensions, const fs::path& file) {
    std::string extension = lower_case(file.extension().string());
    if (extension == ".json" && stem_of(file) != file.stem()) extension = ".mrk.json";
    return static_cast<std::size_t>(std::find(extensions.begin(), extensions.end(), extension) - extensions.begin());
}

/// What lies in one folder, by the name without its extension.
std::map<std::string, ScanEntry> by_stem(const std::vector<fs::path>& entries) {
    static const std::vector<std::string_view> scans = {".bnt", ".ply", ".pcd", ".obj", ".stl"};
    static const std::vector<std::string_view> landmarks = {".lm3", ".pp",  ".fcsv", ".mrk.json",
                                                            ".csv", ".tsv", ".ljson"};
    static const std::vector<std::string_view> textures = {".png", ".jpg", ".jpeg", ".bmp"};
    const auto prefer = [](fs::path& kept, const fs::path& candidate, const std::vector<std::string_view>& extensions) {
        const auto place = rank(extensions, candidate);
        if (place < extensions.size() && (kept.empty() || place < rank(extensions, kept))) kept = candidate;
    };
    std::map<std::string, ScanEntry> found;
    for (const auto& path : entries) {
        ScanEntry& entry = found[stem_of(path)];
        const std::string extension = lower_case(path.extension().string());
        prefer(entry.scan_file, path, scans);
        prefer(entry.landmarks_file, path, landmarks);
        if (extension == ".lm2") entry.landmarks2d_file = path;
        prefer(entry.texture_file, path, textures);
    }
    return found;
}

/// Adds the scans of one folder.
void add_scans(const fs::path& folder, const std::vector<fs::path>& entries, ScanDatabase& database) {
    for (auto& [stem, entry] : by_stem(entries)) {
        const auto id = parse_scan_name(stem);
        if (entry.scan_file.empty()) {
            if (id && !(entry.landmarks_file.empty() && entry.landmarks2d_file.empty() && entry.texture_file.empty()))
                database.remarks.push_back(
                    fmt::format("{}: there is no {}.bnt beside it; copy the scan too", (folder / stem).string(), stem));
            continue;
        }
        if (!id) {
            database.remarks.push_back(
                fmt::format("{}: the name is not of the form bs000_LFAU_12_0.bnt; rename it to have it read",
                            entry.scan_file.string()));
            continue;
        }
        entry.id = *id;
        entry.file_name_stem = stem;
        const std::string folder_name = folder.filename().string();
        if (folder != database.root && !same(folder_name, id->subject))
            database.remarks.push_back(fmt::format("{}: lies in the folder '{}' though its subject is '{}'",
                                                   entry.scan_file.string(), folder_name, id->subject));
        database.scans.push_back(std::move(entry));
    }
}

/// A manifest names scan and 3D landmarks; image and image landmarks are found beside the scan, by its name.
void add_images(std::vector<ScanEntry>& scans) {
    std::map<fs::path, std::map<std::string, ScanEntry>> folders;
    std::vector<std::string> unlisted;  // such a scan is refused when it is read
    for (auto& entry : scans) {
        const auto [files, is_new] = folders.try_emplace(entry.scan_file.parent_path());
        if (is_new) files->second = by_stem(listing(files->first, unlisted));
        const auto beside = files->second.find(entry.file_name_stem);
        if (beside == files->second.end()) continue;
        entry.landmarks2d_file = beside->second.landmarks2d_file;
        entry.texture_file = beside->second.texture_file;
    }
}

/// The first of these files that is there.
fs::path first_file(const fs::path& root, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        std::error_code ignored;
        if (fs::is_regular_file(root / name, ignored)) return root / name;
    }
    return {};
}

void read_lists(ScanDatabase& database, const fs::path& named_root) {
    if (const auto file = first_file(database.root, {"facscodes.lst", "facscodes/facscodes.lst"}); !file.empty()) {
        auto codes = parse_facs_codes(base::read_text(file, max_list_bytes), file.string());
        std::move(codes.remarks.begin(), codes.remarks.end(), std::back_inserter(database.remarks));
        for (auto& entry : database.scans) {
            const auto id = parse_scan_name(entry.file_name_stem);
            const auto it = id ? codes.scores.find(*id) : codes.scores.end();
            if (it == codes.scores.end()) continue;
            entry.facs_scores = it->second;
            for (const auto& score : it->second) {
                char& strongest = entry.intensities[score.action_unit];
                strongest = std::max(strongest, score.intensity);
            }
        }
    }
    if (const auto file = first_file(database.root, {"subjects.csv"}); !file.empty()) {
        const auto sexes = parse_subjects(base::read_text(file, max_list_bytes), file.string());
        for (auto& entry : database.scans)
            if (const auto it = sexes.find(lower_case(entry.id.subject)); it != sexes.end() && entry.sex.empty())
                entry.sex = it->second;
    }
    // The folder as it was named: a list may lie beside a link to the database.
    auto hidden = hidden_subjects_of(named_root, database.subjects());
    database.hidden_subjects = std::move(hidden.subjects);
    std::move(hidden.remarks.begin(), hidden.remarks.end(), std::back_inserter(database.remarks));
}

/// Landmarks under our names; nothing if there are none or they cannot be read (load() says why).
std::optional<geometry::Landmarks> landmarks_if_readable(const ScanEntry& entry) {
    const auto& file = entry.landmarks_file;
    const std::string extension = lower_case(file.extension().string());
    try {
        if (file.empty()) return std::nullopt;
        if (extension == ".lm3") return from_bosphorus_labels(read_lm3(file));
        // Slicer's files need the scan: it tells which of two frames they are in.
        if (extension == ".fcsv" || extension == ".json") return load(entry).landmarks;
        return from_any_labels(io::read_landmarks(file, {}, entry.unit));
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// Neither Bosphorus nor anyone else says whose left 12L is (docs/formats.md): the mouth corners do.
void decide_code_sides(ScanDatabase& database) {
    auto& sides = database.code_sides;
    std::map<std::string, std::optional<geometry::Landmarks>> neutrals;  // by subject, in lower case
    std::set<std::string> other_subjects;
    std::map<std::pair<std::string, std::optional<int>>, std::set<facs::Side>>
        contradicted;  // by subject and action unit
    for (const auto& entry : database.scans) {
        if (!side_shows_at_mouth(entry.id)) continue;
        const auto subject = lower_case(entry.id.subject);
        const auto [it, is_new] = neutrals.try_emplace(subject);
        if (is_new)
            for (const auto* neutral : database.neutrals(entry.id.subject))
                if (!it->second) it->second = landmarks_if_readable(*neutral);
        const auto expression = it->second ? landmarks_if_readable(entry) : std::nullopt;
        const facs::Side moved = expression ? decide_side(*it->second, *expression).side : facs::Side::both;
        ++(moved == facs::Side::both ? sides.undecided : moved == entry.id.side() ? sides.own_side : sides.other_side);
        if (moved == facs::opposite(entry.id.side())) {
            other_subjects.insert(subject);
            contradicted[{subject, entry.id.action_unit()}].insert(entry.id.side());
        }
    }
    // Two scans of one subject may be two slips of one hand; not so 12L and 12R, where nothing speaks against it.
    constexpr int enough_votes = 3;
    const bool both_ways = sides.own_side == 0 && std::any_of(contradicted.begin(), contradicted.end(),
                                                              [](const auto& unit) { return unit.second.size() == 2; });
    const bool most = sides.other_side > 0 && sides.other_side >= 2 * sides.own_side;
    sides.swapped = most && (sides.other_side >= enough_votes || other_subjects.size() >= 2 || both_ways);
    if (sides.swapped) {
        for (auto& entry : database.scans) entry.id = entry.id.mirrored();
        std::sort(database.scans.begin(), database.scans.end(),
                  [](const auto& a, const auto& b) { return a.id < b.id; });
    }
    const bool unknown = sides.undecided > 0 && sides.own_side == 0;
    if (sides.other_side == 0 && !unknown) return;
    database.remarks.push_back(fmt::format(
        "one-sided codes: {} the subject's own side, {} the other, {} are undecided; 12L in file names is taken as the "
        "subject's {}{}",
        base::counted(sides.own_side, "scan moves", "scans move"), sides.other_side, sides.undecided,
        sides.swapped ? "right" : "left",
        most && !sides.swapped
            ? fmt::format(": to turn all names takes {} scans, two subjects or 12L and 12R of one", enough_votes)
            : ""));
}

geometry::RangeScan read_scan(const ScanEntry& entry) {
    try {
        return is_bnt(entry.scan_file) ? read_bnt_scan(entry.scan_file, entry.unit, io::BadTexture::report)
                                       : io::read_range_scan(entry.scan_file, entry.unit);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {  // memory that the system refused, say
        throw InputError(
            fmt::format("{}: cannot be read ({}); mend or replace the file", entry.scan_file.string(), e.what()));
    }
}

geometry::Landmarks read_named_landmarks(const ScanEntry& entry, const geometry::RangeScan& scan, SideReport& sides) {
    const auto raw = io::read_landmarks(entry.landmarks_file, scan.points_mm, entry.unit);
    try {
        return same(entry.landmarks_file.extension().string(), ".lm3") ? from_bosphorus_labels(raw, &sides)
                                                                       : from_any_labels(raw, &sides);
    } catch (const InputError& e) {  // two labels that mean the same point
        throw InputError(fmt::format("{}: {}", entry.landmarks_file.string(), e.what()));
    }
}

/// Words with commas; a long list is cut, with the number left out.
std::string joined(const std::vector<std::string>& words) {
    constexpr std::size_t most = 12;
    const std::vector<std::string> shown(words.begin(),
                                         words.begin() + static_cast<std::ptrdiff_t>(std::min(most, words.size())));
    return fmt::format("{}{}", fmt::join(shown, ", "),
                       words.size() > most ? fmt::format(" and {} more", words.size() - most) : "");
}

void check_frame(const FrameCorrelations& correlations, std::vector<std::string>& remarks) {
    const auto expect_positive = [&](const std::optional<double>& value, const char* what, const char* other) {
        if (value && *value <= 0)
            remarks.push_back(fmt::format("{} (correlation {:.2f}): {} the other way round, or the scan is mirrored",
                                          what, *value, other));
    };
    const char* const texture = "its texture coordinates lie";
    const char* const lattice = "its lattice is stored";
    expect_positive(correlations.x_u, "x falls as the texture's u grows", texture);
    expect_positive(correlations.y_v, "y falls as the texture's rows go up", texture);
    expect_positive(correlations.y_row, "y falls as the row grows", lattice);
    expect_positive(correlations.x_column, "x falls as the column grows", lattice);
}

/// Finds the image, compares it with the landmarks' pixels, turns texture coordinates that lie otherwise.
void check_texture(LoadedScan& loaded, const std::vector<NearestScanPoint>& nearest) {
    ScanEntry& entry = loaded.entry;
    std::error_code ignored;
    loaded.remarks.insert(loaded.remarks.end(), loaded.scan.remarks.begin(), loaded.scan.remarks.end());
    if (!loaded.scan.texture_error.empty()) loaded.remarks.push_back(loaded.scan.texture_error);
    if (auto words = texture_charts(loaded.scan); !words.empty()) loaded.remarks.push_back(std::move(words));
    for (const auto& named : loaded.scan.material_files)
        loaded.files_looked_for.push_back(entry.scan_file.parent_path() / named);
    const auto& charts = loaded.scan.charts;
    auto images = charts ? charts->images : std::vector<std::string>{};
    if (images.empty() && !loaded.scan.texture_file.empty()) images = {loaded.scan.texture_file};
    for (std::size_t k = images.size(); k-- > 0;) {  // the first is the scan's in the end
        if (!base::is_utf8(images[k])) {             // JSON files, which keep it, could not
            loaded.remarks.push_back(
                fmt::format("the name of its texture image {} has bytes that are no UTF-8; the "
                            "scan goes without it; rename the image and the scan's reference",
                            base::in_quotes(images[k])));
            continue;
        }
        const auto beside = entry.scan_file.parent_path() / images[k];
        loaded.files_looked_for.push_back(beside);
        if (fs::is_regular_file(beside, ignored))
            entry.texture_file = beside;
        else if (entry.texture_file.empty() || images.size() > 1)
            loaded.remarks.push_back(fmt::format("its texture image '{}' is not beside it", images[k]));
    }
    if (images.size() > 1) return;  // the marks are in one image, and nobody says in which
    if (entry.landmarks2d_file.empty()) return;
    std::vector<ImageLandmark> marks;
    try {
        marks = read_lm2(entry.landmarks2d_file);
    } catch (const InputError& e) {
        loaded.checks.landmarks2d_error = e.what();
        loaded.remarks.emplace_back(e.what());
        return;
    }
    if (entry.texture_file.empty()) return;
    try {
        const auto size = io::image_size(entry.texture_file);
        loaded.checks.texture = texture_orientation(loaded.scan, loaded.landmarks, nearest, marks, size);
    } catch (const InputError& e) {
        loaded.remarks.emplace_back(e.what());  // the surface can be used without its picture
        return;
    }
    const auto& found = loaded.checks.texture;
    if (!found || found->as_expected()) return;
    if (!found->fits) {
        loaded.remarks.push_back(
            fmt::format("the texture image does not fit the scan: landmarks are off by {:.0f} pixels at best",
                        *std::min_element(found->median_error_px.begin(), found->median_error_px.end())));
        return;
    }
    reorient_texture(loaded.scan, found->best);
    loaded.remarks.push_back(
        fmt::format("texture coordinates lie {} and were turned", to_string(found->best, is_bnt(entry.scan_file))));
}

void set_unit(ScanDatabase& database, io::LengthUnit unit) {
    for (auto& entry : database.scans)
        if (!entry.unit_is_said) entry.unit = unit;
}

}  // namespace

std::optional<io::Image> load_texture(const ScanEntry& entry) {
    if (entry.texture_file.empty()) return std::nullopt;
    return io::read_image(entry.texture_file);
}

std::vector<std::string> ScanDatabase::subjects() const {
    std::vector<std::string> names;
    for (const auto& entry : scans)
        if (names.empty() || !same(names.back(), entry.id.subject)) names.push_back(entry.id.subject);
    return names;
}

const ScanEntry* ScanDatabase::find(const ScanId& id) const {
    const auto it =
        std::lower_bound(scans.begin(), scans.end(), id, [](const ScanEntry& e, const ScanId& i) { return e.id < i; });
    return it != scans.end() && it->id == id ? &*it : nullptr;
}

std::vector<const ScanEntry*> ScanDatabase::neutrals(const std::string& subject) const {
    std::vector<const ScanEntry*> result;
    for (const auto& entry : scans)
        if (entry.id.neutral() && same(entry.id.subject, subject)) result.push_back(&entry);
    return result;
}

bool ScanDatabase::hidden(const std::string& subject) const { return is_hidden(hidden_subjects, subject); }

ScanDatabase open_database(const std::filesystem::path& root, io::LengthUnit unit) {
    std::error_code error;
    if (!fs::is_directory(root, error))
        throw InputError(
            fmt::format("{}: is not a folder; give the folder that holds bs000, bs001, ...", root.string()));
    ScanDatabase database;
    database.root = fs::canonical(root, error);
    if (error) throw InputError(fmt::format("{}: cannot be opened ({})", root.string(), error.message()));

    if (const auto file = first_file(database.root, {"manifest.csv"}); !file.empty()) {
        auto manifest = parse_manifest(base::read_text(file, max_list_bytes), file);
        database.layout = DatabaseLayout::manifest;
        database.scans = std::move(manifest.scans);
        for (auto& entry : database.scans) entry.layout = DatabaseLayout::manifest;
        set_unit(database, unit);
        add_images(database.scans);
        std::move(manifest.remarks.begin(), manifest.remarks.end(), std::back_inserter(database.remarks));
        if (database.scans.empty())
            throw InputError(fmt::format("{}: lists no scan; add one line per scan", file.string()));
        std::stable_sort(database.scans.begin(), database.scans.end(),
                         [](const auto& a, const auto& b) { return a.id < b.id; });
        check_names(database);
        read_lists(database, root);
        return database;
    }
    const auto entries = listing(database.root, database.remarks);
    add_scans(database.root, entries, database);
    for (const auto& entry : entries)
        if (fs::is_directory(entry, error)) add_scans(entry, listing(entry, database.remarks), database);
    if (database.scans.empty())
        throw InputError(fmt::format("{}: no scan found; expected bs000/bs000_N_N_0.bnt and so on, or manifest.csv{}",
                                     root.string(),
                                     database.remarks.empty() ? "" : " (" + database.remarks.front() + ")"));
    std::stable_sort(database.scans.begin(), database.scans.end(),
                     [](const auto& a, const auto& b) { return a.id < b.id; });
    const auto twin = std::adjacent_find(database.scans.begin(), database.scans.end(),
                                         [](const auto& a, const auto& b) { return a.id == b.id; });
    if (twin != database.scans.end())
        throw InputError(fmt::format("{} and {}: two scans of one name; rename one or move it out of the database",
                                     twin->scan_file.string(), std::next(twin)->scan_file.string()));
    set_unit(database, unit);
    check_names(database);
    read_lists(database, root);
    decide_code_sides(database);
    return database;
}

void Selection::check(const ScanDatabase& database) const {
    for (const auto& subject : subjects)
        if (database.find({subject, "N", "N", 0}) == nullptr &&
            std::none_of(database.scans.begin(), database.scans.end(),
                         [&](const auto& e) { return same(e.id.subject, subject); }))
            throw InputError(fmt::format("subject '{}' is not in {}; there are {}", subject, database.root.string(),
                                         joined(database.subjects())));
    for (const auto& group : groups) {
        std::vector<std::string> there;
        for (const auto& entry : database.scans)
            if (std::none_of(there.begin(), there.end(), [&](const auto& g) { return same(g, entry.id.group); }))
                there.push_back(entry.id.group);
        if (std::none_of(there.begin(), there.end(), [&](const auto& g) { return same(g, group); }))
            throw InputError(
                fmt::format("group '{}' is not in {}; there are {}", group, database.root.string(), joined(there)));
    }
}

std::vector<const ScanEntry*> select(const ScanDatabase& database, const Selection& selection) {
    selection.check(database);
    const auto in = [](const std::vector<std::string>& list, const std::string& value) {
        return list.empty() ||
               std::any_of(list.begin(), list.end(), [&](const auto& item) { return same(item, value); });
    };
    std::vector<const ScanEntry*> result;
    for (const auto& entry : database.scans) {
        const auto unit = entry.id.action_unit();
        const bool unit_fits = selection.action_units.empty() ||
                               (unit && std::find(selection.action_units.begin(), selection.action_units.end(),
                                                  *unit) != selection.action_units.end());
        const bool side_fits = !selection.side || entry.id.side() == *selection.side;
        if (in(selection.subjects, entry.id.subject) && in(selection.groups, entry.id.group) && unit_fits && side_fits)
            result.push_back(&entry);
    }
    return result;
}

LoadedScan load(const ScanEntry& entry) {
    LoadedScan loaded{entry, read_scan(entry), {}, {}, {}, {}};
    if (std::none_of(loaded.scan.points_mm.begin(), loaded.scan.points_mm.end(),
                     [](const auto& p) { return p.allFinite(); }))
        throw InputError(fmt::format("{}: holds no measured point; scan again or remove it", entry.scan_file.string()));

    if (entry.landmarks_file.empty()) {
        loaded.remarks.push_back("there is no landmark file beside the scan");
    } else {
        loaded.landmarks = read_named_landmarks(entry, loaded.scan, loaded.checks.sides);
    }
    if (!loaded.checks.sides.swapped_pairs.empty())
        loaded.remarks.push_back(fmt::format("left and right labels are swapped against the rest: {}",
                                             joined(loaded.checks.sides.swapped_pairs)));

    const auto nearest = nearest_scan_points(loaded.scan, loaded.landmarks);
    check_texture(loaded, nearest);
    loaded.checks.correlations = frame_correlations(loaded.scan);
    check_frame(loaded.checks.correlations, loaded.remarks);
    return loaded;
}

}  // namespace mimik::database
