#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "database/bosphorus_landmarks.h"
#include "database/facs_codes.h"
#include "database/one_sided_codes.h"
#include "database/scan_id.h"
#include "database/self_checks.h"
#include "geometry/landmarks.h"
#include "geometry/range_scan.h"
#include "io/image.h"
#include "io/mesh_io.h"

namespace mimik::database {

enum class DatabaseLayout { bosphorus, manifest };

/// Where one scan's files are. Paths are absolute; empty where there is none.
struct ScanEntry {
    ScanId id;                               ///< sides are the subject's own, also where the file's name says otherwise
    std::string file_name_stem;              ///< the scan's name as its file has it, such as "bs000_LFAU_12L_0"
    std::filesystem::path scan_file;         ///< .bnt, .ply, .obj, .stl, .pcd
    std::filesystem::path landmarks_file;    ///< .lm3, .pp, .fcsv, .mrk.json, .csv
    std::filesystem::path landmarks2d_file;  ///< .lm2
    std::filesystem::path texture_file;
    DatabaseLayout layout = DatabaseLayout::bosphorus;
    io::LengthUnit unit = io::LengthUnit::millimetre;
    std::string sex;                     ///< "m", "f" or empty
    std::map<int, char> intensities;     ///< AU -> 'A'..'E' (0 where not scored), the stronger side, from facscodes.lst
    std::vector<FacsScore> facs_scores;  ///< the same with sides
    bool unit_is_said = false;           ///< by the manifest
};

/// Whether 12L in the file names is the subject's own left, by the mouth corner that moves. One vote per one-sided
/// scan.
struct CodeSides {
    int own_side = 0;    ///< scans that move the corner their name says
    int other_side = 0;  ///< scans that move the other one
    int undecided = 0;
    /// The names are the viewer's, and ids were mirrored: at least two thirds of the votes say so, and three of them or
    /// those of two subjects, or both sides of one AU of one subject without a vote against.
    bool swapped = false;
};

/// A folder of bsNNN/ folders in Bosphorus layout, or a folder with manifest.csv (database/manifest.h). Scans are
/// opened one at a time with load(); opening the database reads names, the lists beside the scans and the landmarks of
/// one-sided scans.
struct ScanDatabase {
    std::filesystem::path root;
    DatabaseLayout layout = DatabaseLayout::bosphorus;
    std::vector<ScanEntry> scans;              ///< sorted by subject, neutral first, then group, code, repetition
    std::vector<std::string> hidden_subjects;  ///< unallowed_subjects.txt: never in a figure, report or export
    std::vector<std::string> remarks;          ///< files that fit no pattern, and so on
    CodeSides code_sides;

    [[nodiscard]] std::vector<std::string> subjects() const;
    [[nodiscard]] const ScanEntry* find(const ScanId& id) const;
    [[nodiscard]] std::vector<const ScanEntry*> neutrals(const std::string& subject) const;
    [[nodiscard]] bool hidden(const std::string& subject) const;
};

/// @param unit  of the scans of which the manifest says none; files that say their own keep it.
/// @throws InputError if the folder is missing or holds no scan at all, or a list beside the scans is unreadable.
[[nodiscard]] ScanDatabase open_database(const std::filesystem::path& root,
                                         io::LengthUnit unit = io::LengthUnit::millimetre);

/// Part of a database. Empty lists mean "all"; within a list any entry will do, across lists all must hold.
struct Selection {
    std::vector<std::string> subjects = {};  ///< case ignored
    std::vector<std::string> groups = {};    ///< "LFAU"; case ignored
    std::vector<int> action_units = {};
    std::optional<facs::Side> side = {};             ///< the subject's own; both = two-sided scans only
    void check(const ScanDatabase& database) const;  ///< throws InputError naming a subject or group that is not there
};
[[nodiscard]] std::vector<const ScanEntry*> select(const ScanDatabase& database, const Selection& selection);

/// What load() checked on the way, with the figures.
struct SelfChecks {
    SideReport sides;
    FrameCorrelations correlations;
    std::optional<TextureOrientation> texture;
    std::string landmarks2d_error;  ///< why the .lm2 cannot be read
};

/// One scan with its landmarks under our names (subject's own side), mm, scanner frame.
struct LoadedScan {
    ScanEntry entry;
    geometry::RangeScan scan;
    geometry::Landmarks landmarks;
    SelfChecks checks;
    std::vector<std::string> remarks;  ///< what the self-checks found; a defect that forbids use is thrown instead
    /// Files that the scan file names and that say how the scan looks: image, OBJ's material file; there or not.
    std::vector<std::filesystem::path> files_looked_for;
};
/// May be called from many threads. A texture that lies otherwise than expected is turned, with a remark. @throws
/// InputError.
[[nodiscard]] LoadedScan load(const ScanEntry& entry);
[[nodiscard]] std::optional<io::Image> load_texture(const ScanEntry& entry);

}  // namespace mimik::database
