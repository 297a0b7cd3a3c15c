#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "database/scan_id.h"
#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::database {

/// Who a synthetic subject is, as truth.json has it.
struct TrueSubject {
    std::string name;  ///< "bs003"
    std::string sex;   ///< "m" or "f"
    double amplitude = 1.0;
    double asymmetry = 0.0;
    std::map<std::string, double> measurements_mm;
};

/// What is known about a synthetic database: OUT/truth/truth.json.
struct Truth {
    std::filesystem::path root;  ///< of the database (the folder that holds bs000 ... and truth)
    std::uint64_t seed = 0;
    std::string face_model;
    std::string expressions;                  ///< as 'mimik synthesize --expressions' was told
    std::map<std::string, double> variances;  ///< how far people and performances spread, by name of the option
    std::map<std::string, double> scanner;    ///< what scanned and marked them, likewise
    std::vector<TrueSubject> subjects;
    std::vector<database::ScanId> scans;
    geometry::Faces faces;                                   ///< of every true surface
    std::vector<std::string> vertex_regions;                 ///< "skin", "lip", "brow", "eye", "sclera", ... per vertex
    std::map<std::string, std::uint32_t> landmark_vertices;  ///< name -> vertex of every true surface

    [[nodiscard]] bool has(const database::ScanId& id) const;
};

/// The truth of one scan. The same vertex is the same material point in all scans of all subjects.
struct TrueScan {
    database::ScanId id;
    std::vector<geometry::Point> vertices_mm;  ///< scanner frame of this scan
    geometry::Faces faces;
    geometry::Transform scanner_from_head = geometry::Transform::Identity();
    std::vector<geometry::Vector> displacement_mm;  ///< head frame, from the subject's resting face (which has no
                                                    ///< micro-expression: a neutral scan's displacement is its own)
    geometry::Landmarks landmarks;                  ///< scanner frame, free of jitter
    std::map<std::string, double> shape_weights;
    double amplitude = 1.0, asymmetry = 0.0;
};

/// Where points lie on a true surface. A vertex is the same material point in all true scans, so these carry a field of
/// any of them.
struct MaterialPoints {
    std::vector<geometry::Triangle> triangles;
    std::vector<Eigen::Vector3d> barycentric;

    /// What a field on the vertices does at point k, in the frame of the field.
    [[nodiscard]] geometry::Vector at(std::span<const geometry::Vector> field, std::size_t k) const;
};
/// The nearest place on the surface for each point. @param points_mm  scanner frame of the scan
[[nodiscard]] MaterialPoints material_points(const TrueScan& scan, std::span<const geometry::Point> points_mm);

/// @throws InputError naming the file if the folder is not a synthetic database or its truth is of another schema.
[[nodiscard]] Truth open_truth(const std::filesystem::path& database_root);
/// truth.json from memory; `name` stands for the file in messages, the root stays empty. @throws InputError.
[[nodiscard]] Truth decode_truth(std::string_view text, const std::string& name);
/// What stands in a scan's .json: everything but vertices, faces and displacements. @throws InputError.
[[nodiscard]] TrueScan decode_true_scan(std::string_view text, const std::string& name);
/// @throws InputError naming the file and what does not fit.
[[nodiscard]] TrueScan load_true_scan(const Truth& truth, const database::ScanId& id);

/// Writes <truth_folder>/<subject>/<scan>.ply and .json.
void write_true_scan(const std::filesystem::path& truth_folder, const TrueScan& scan);

}  // namespace mimik::database
