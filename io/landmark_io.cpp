#include "io/landmark_io.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "io/formats/landmark_formats.h"
#include "io/points_csv.h"

namespace mimik::io {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Point;

namespace formats {

void add_mark(RawLandmarks& raw, std::string_view label, const Point& position, const std::string& name) {
    if (raw.marks.size() == most_landmarks)
        throw InputError(fmt::format("{}: has more than {} landmarks (the next is {}); is it a list of mesh points?",
                                     name, most_landmarks, base::in_quotes(label)));
    raw.marks.push_back({std::string(label), position, std::string(label)});
}

}  // namespace formats

namespace {

formats::RawLandmarks decode_csv(std::string_view text, const std::string& name) {
    base::CsvReader rows(text, name);
    const auto columns = point_columns(rows);
    // Slicer's table of points names them by 'label'.
    const auto label =
        rows.find_column("label") && !rows.find_column("name") ? *rows.find_column("label") : rows.column("name");
    const auto defined = columns.frame ? rows.find_column("defined") : std::nullopt;
    formats::RawLandmarks raw;
    raw.frame = columns.frame;
    raw.either_frame = columns.frame.has_value();
    while (rows.next()) {
        if (defined && rows.field(*defined) == "0") {
            ++raw.unmarked;
            continue;
        }
        if (rows.field(label).empty()) rows.fail("the name is empty; give every landmark a name");
        formats::add_mark(raw, rows.field(label),
                          {rows.number(columns.x), rows.number(columns.y), rows.number(columns.z)}, name);
    }
    return raw;
}

/// The factors of x, y and z that put the marks on the mesh: LPS or RAS, each in the unit that the file states and in
/// the one asked for (Slicer writes millimetres whatever the unit of the mesh that was marked).
Point factors_onto_mesh(const formats::RawLandmarks& raw, std::span<const Point> mesh_points_mm, LengthUnit asked,
                        const std::string& name) {
    const double scale = millimetres_per(raw.unit.value_or(asked));
    std::vector<Point> mesh_points, marks;
    for (const auto& mark : raw.marks) marks.push_back(mark.position_mm);
    for (const auto& p : mesh_points_mm)
        if (p.allFinite()) mesh_points.push_back(p);
    const double sign_in_lps = raw.frame == BodyFrame::ras ? -1.0 : 1.0;
    if (mesh_points.empty() || raw.marks.empty()) return scale * Point(sign_in_lps, sign_in_lps, 1);
    Eigen::AlignedBox3d box;
    for (const auto& p : mesh_points) box.extend(p);
    const double limit = 0.05 * box.diagonal().norm();

    struct Candidate {
        Point factors;
        double distance_mm;
    };
    std::vector<Candidate> candidates;
    std::string distances;
    const auto add = [&](double unit_mm, const char* unit) {
        for (const double sign : {1.0, -1.0}) {
            const Point factors = unit_mm * Point(sign, sign, 1);
            candidates.push_back({factors, mean_distance_to(mesh_points, marks, factors)});
            distances +=
                fmt::format("{}{:.3g} mm {}{}", distances.empty() ? "mean distance " : ", ",
                            candidates.back().distance_mm, sign > 0 ? "as written" : "with x and y negated", unit);
        }
    };
    add(scale, "");
    if (const double asked_mm = millimetres_per(asked); asked_mm != scale) add(asked_mm, " in the unit of the mesh");
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.distance_mm < b.distance_mm; });
    if (!(candidates[0].distance_mm <= limit))
        throw InputError(
            fmt::format("{}: the landmarks lie on the mesh neither in LPS nor in RAS ({}, at most {:.3g} mm is "
                        "accepted); do they belong to this mesh, and is the unit right?",
                        name, distances, limit));
    if (candidates[0].distance_mm >= 0.5 * candidates[1].distance_mm) {
        const bool same_unit = std::abs(candidates[0].factors.z()) == std::abs(candidates[1].factors.z());
        throw InputError(
            fmt::format("{}: the landmarks lie on the mesh about as well in {} ({}); save them as .csv in "
                        "the mesh's own frame",
                        name, same_unit ? "LPS as in RAS" : "one unit as in another", distances));
    }
    return candidates[0].factors;
}

}  // namespace

LandmarkFormat landmark_format(const std::filesystem::path& file) {
    const auto name = base::lower_case(file.filename().string());
    if (name.ends_with(".csv") || name.ends_with(".tsv")) return LandmarkFormat::csv;
    if (name.ends_with(".pp")) return LandmarkFormat::pp;
    if (name.ends_with(".fcsv")) return LandmarkFormat::fcsv;
    if (name.ends_with(".mrk.json")) return LandmarkFormat::mrk_json;
    if (name.ends_with(".lm3")) return LandmarkFormat::lm3;
    if (name.ends_with(".ljson")) return LandmarkFormat::ljson;
    if (name.ends_with(".lan")) return LandmarkFormat::lan;
    throw InputError(
        fmt::format("{}: extension {} is no landmark format; there are .csv, .tsv, .pp, .fcsv, .mrk.json, .lm3, .ljson "
                    "and .lan",
                    file.string(), base::in_quotes(file.extension().string())));
}

namespace {

formats::RawLandmarks decode_raw(LandmarkFormat format, std::string_view text, const std::string& name) {
    if (format == LandmarkFormat::lan) return formats::decode_lan(text, name);
    if (format == LandmarkFormat::csv) return decode_csv(text, name);
    const auto utf8 = base::from_utf16(text);
    if (utf8) text = *utf8;
    switch (format) {
        case LandmarkFormat::pp:
            return formats::decode_pp(text, name);
        case LandmarkFormat::fcsv:
            return formats::decode_fcsv(text, name);
        case LandmarkFormat::mrk_json:
            return formats::decode_mrk_json(text, name);
        case LandmarkFormat::ljson:
            return formats::decode_ljson(text, name);
        default:
            return formats::decode_lm3(text, name);
    }
}

Landmarks scaled(formats::RawLandmarks raw, const Point& factors, const std::string& name) {
    for (auto& mark : raw.marks) mark.position_mm = (mark.position_mm.cwiseProduct(factors).array() + 0.0).matrix();
    try {
        return Landmarks(std::move(raw.marks));
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", name, e.what()));
    }
}

}  // namespace

Landmarks decode_landmarks(LandmarkFormat format, std::string_view text, const std::string& name,
                           std::span<const Point> mesh_points_mm, LengthUnit unit) {
    auto raw = decode_raw(format, text, name);
    const Point factors = raw.either_frame ? factors_onto_mesh(raw, mesh_points_mm, unit, name)
                                           : Point::Constant(millimetres_per(raw.unit.value_or(unit)));
    return scaled(std::move(raw), factors, name);
}

LandmarkFile read_landmark_file(const std::filesystem::path& file) {
    auto raw = decode_raw(landmark_format(file), base::read_text(file), file.string());
    LandmarkFile result;
    result.frame = raw.frame;
    if (raw.unmarked > 0)
        result.remarks.push_back(
            fmt::format("{}: {} left out", file.string(),
                        base::counted(raw.unmarked, "point without a position is", "points without a position are")));
    const Point factors = Point::Constant(millimetres_per(raw.unit.value_or(LengthUnit::millimetre)));
    result.landmarks = scaled(std::move(raw), factors, file.string());
    return result;
}

Landmarks read_landmarks(const std::filesystem::path& file, std::span<const Point> mesh_points_mm, LengthUnit unit) {
    const auto format = landmark_format(file);
    return decode_landmarks(format, base::read_text(file), file.string(), mesh_points_mm, unit);
}

std::string encode_landmarks(LandmarkFormat format, const Landmarks& landmarks) {
    switch (format) {
        case LandmarkFormat::pp:
            return formats::encode_pp(landmarks);
        case LandmarkFormat::fcsv:
            return formats::encode_fcsv(landmarks);
        case LandmarkFormat::mrk_json:
            return formats::encode_mrk_json(landmarks);
        case LandmarkFormat::lm3:
            return formats::encode_lm3(landmarks);
        case LandmarkFormat::ljson:
        case LandmarkFormat::lan:
            throw InputError(".ljson and .lan are read but not written; write .csv, .pp, .fcsv, .mrk.json or .lm3");
        case LandmarkFormat::csv:
            break;
    }
    PointTable table;
    for (const auto& mark : landmarks.all()) {
        table.names.push_back(mark.name);
        table.points.push_back(mark.position_mm);
    }
    return landmarks.empty() ? "name,x,y,z\n" : encode_points_csv(table);
}

void write_landmarks(const std::filesystem::path& file, const Landmarks& landmarks) {
    try {
        base::write_atomically(file, encode_landmarks(landmark_format(file), landmarks));
    } catch (const InputError& e) {
        const std::string message = e.what();
        throw InputError(message.starts_with(file.string()) ? message : fmt::format("{}: {}", file.string(), message));
    }
}

}  // namespace mimik::io
