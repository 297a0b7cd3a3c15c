#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "database/scan_id.h"
#include "geometry/image.h"
#include "geometry/landmarks.h"
#include "geometry/mesh_io.h"
#include "geometry/range_scan.h"

namespace mimik::database {

/// Where one scan's files are. Paths are absolute; empty where there is none.
struct ScanEntry {
    ScanId id;
    std::filesystem::path scan_file;         ///< .bnt, .ply, .obj, .stl, .pcd
    std::filesystem::path landmarks_file;    ///< .lm3, .pp, .fcsv, .mrk.json, .csv
    std::filesystem::path landmarks2d_file;  ///< .lm2
    std::filesystem::path texture_file;
    geometry::LengthUnit unit = geometry::LengthUnit::millimetre;
    std::string sex;                  ///< "m", "f" or empty
    std::map<int, char> intensities;  ///< AU -> 'A'..'E' (0 where not scored) from facscodes.lst
};

/// A folder of bsNNN/ folders in Bosphorus layout, or a folder with manifest.csv
/// (subject,expression,scan,landmarks,sex,unit). Only names are read; scans are opened one at a time with load().
struct ScanDatabase {
    std::filesystem::path root;
    std::vector<ScanEntry> scans;              ///< sorted by subject, neutral first, then group, code, repetition
    std::vector<std::string> hidden_subjects;  ///< unallowed_subjects.txt: never in a figure, report or export
    std::vector<std::string> remarks;          ///< files that fit no pattern, and so on

    [[nodiscard]] std::vector<std::string> subjects() const;
    [[nodiscard]] const ScanEntry* find(const ScanId& id) const;
    [[nodiscard]] std::vector<const ScanEntry*> neutrals(const std::string& subject) const;
    [[nodiscard]] bool hidden(const std::string& subject) const;
};

/// @throws InputError if the folder is missing or holds no scan at all.
[[nodiscard]] ScanDatabase open_database(const std::filesystem::path& root);

/// One scan with its landmarks under our names (subject's own side), mm, scanner frame.
struct LoadedScan {
    ScanEntry entry;
    geometry::RangeScan scan;
    geometry::Landmarks landmarks;
    std::vector<std::string> remarks;  ///< what the self-checks found; a defect that forbids use is thrown instead
};
/// @throws InputError.
[[nodiscard]] LoadedScan load(const ScanEntry& entry);
[[nodiscard]] std::optional<geometry::Image> load_texture(const ScanEntry& entry);

}  // namespace mimik::database
