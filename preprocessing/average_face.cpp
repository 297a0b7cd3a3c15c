#include "preprocessing/average_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "geometry/face_axes.h"
#include "geometry/landmark_spline.h"
#include "geometry/surface_index.h"
#include "io/json_values.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/workspace_json.h"

namespace mimik::preprocessing {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Point;
using geometry::Transform;
using geometry::VertexOrigin;

void AverageFaceOptions::check() const {
    if (rows < 10 || cols < 10 || rows > 4000 || cols > 4000)
        throw InputError(fmt::format("average face of {} x {}; give 10 to 4000 each", rows, cols));
    if (!(min_share > 0 && min_share <= 1))
        throw InputError(fmt::format("min_share is {}; give a share above 0 and up to 1", min_share));
    if (!(half_width > 0) || !(above_eyes > 0) || !(below_chin > -0.5))
        throw InputError(
            fmt::format("average face crop of half_width {}, above_eyes {}, below_chin {} outer-eye distances holds no "
                        "face; give positive ones",
                        half_width, above_eyes, below_chin));
    if (max_iterations < 1) throw InputError(fmt::format("max_iterations is {}; give 1 or more", max_iterations));
}

namespace {

Landmarks mean_of(const std::vector<Landmarks>& sets, const std::vector<std::string>& names) {
    std::vector<Landmark> mean;
    for (const auto& name : names) {
        Point sum = Point::Zero();
        int count = 0;
        for (const auto& set : sets)
            if (const auto* mark = set.find(name)) {
                sum += mark->position_mm;
                ++count;
            }
        mean.push_back({name, sum / count, ""});
    }
    return Landmarks(std::move(mean));
}

Landmarks only(const Landmarks& set, const std::vector<std::string>& names) {
    std::vector<Landmark> marks;
    for (const auto& name : names)
        if (const auto* mark = set.find(name)) marks.push_back(*mark);
    return Landmarks(std::move(marks));
}

/// How much larger `set` is than `consensus`, by the root mean square radius of the landmarks that both have.
double size_ratio(const Landmarks& set, const Landmarks& consensus) {
    const auto pairs = geometry::pair_by_name(set, consensus).pairs;
    Point source = Point::Zero(), target = Point::Zero();
    for (const auto& pair : pairs) {
        source += pair.source_mm / static_cast<double>(pairs.size());
        target += pair.target_mm / static_cast<double>(pairs.size());
    }
    double of_set = 0, of_consensus = 0;
    for (const auto& pair : pairs) {
        of_set += (pair.source_mm - source).squaredNorm();
        of_consensus += (pair.target_mm - target).squaredNorm();
    }
    return std::sqrt(of_set / of_consensus);
}

Landmarks mirrored(const Landmarks& marks) {
    std::vector<Landmark> other;
    for (const auto& mark : marks.all())
        other.push_back({geometry::mirrored_name(mark.name),
                         {-mark.position_mm.x(), mark.position_mm.y(), mark.position_mm.z()},
                         ""});
    return Landmarks(std::move(other));
}

/// The cells beside (row, col), at most four.
template <typename Visit>
void visit_neighbours(const geometry::QuadGrid& grid, std::size_t cell, const Visit& visit) {
    const auto cols = static_cast<std::size_t>(grid.cols), col = cell % cols;
    if (col > 0) visit(cell - 1);
    if (col + 1 < cols) visit(cell + 1);
    if (cell >= cols) visit(cell - cols);
    if (cell + cols < grid.size()) visit(cell + cols);
}

/// `from`, and every cell of `among` that can be reached from it through cells of `among`.
std::vector<char> reached(const geometry::QuadGrid& grid, const std::vector<char>& from,
                          const std::vector<char>& among) {
    std::vector<char> seen = from;
    std::vector<std::size_t> waiting;
    for (std::size_t v = 0; v < seen.size(); ++v)
        if (seen[v]) waiting.push_back(v);
    while (!waiting.empty()) {
        const auto cell = waiting.back();
        waiting.pop_back();
        visit_neighbours(grid, cell, [&](std::size_t next) {
            if (seen[next] || !among[next]) return;
            seen[next] = 1;
            waiting.push_back(next);
        });
    }
    return seen;
}

/// What the faces say of a cell: their depths, and how the depth changes towards the next cell of the row and of the
/// column, each summed over the faces that were measured there.
struct Sum {
    double total_mm = 0;
    int count = 0;

    void add(double value_mm) {
        if (!std::isfinite(value_mm)) return;
        total_mm += value_mm;
        ++count;
    }
    [[nodiscard]] double mean_mm() const { return total_mm / count; }
};
struct DepthSums {
    std::vector<Sum> depth, to_next_col, to_next_row;

    explicit DepthSums(std::size_t cells) : depth(cells), to_next_col(cells), to_next_row(cells) {}
    /// A face's depths, NaN where it was not measured.
    void add(const std::vector<double>& depth_mm, std::size_t cols) {
        for (std::size_t v = 0; v < depth_mm.size(); ++v) {
            depth[v].add(depth_mm[v]);
            if ((v + 1) % cols != 0) to_next_col[v].add(depth_mm[v + 1] - depth_mm[v]);
            if (v + cols < depth_mm.size()) to_next_row[v].add(depth_mm[v + cols] - depth_mm[v]);
        }
    }
};

/// Depth of every cell inside. Where all `faces` were measured it is their mean. Where some are missing, the mean of
/// the rest would leave a step (they lie higher or lower than all together), so there it is the surface whose slopes
/// come closest to the mean slopes, in the least squares; across holes, where fewer than `fewest` faces have a slope, a
/// membrane.
void integrate_depths(geometry::QuadGrid& grid, const DepthSums& sums, std::size_t faces, double fewest) {
    constexpr double membrane = 1e-3;  // of the weight of one face's slope
    constexpr double pull = 1e-3;      // towards the mean depth, per face: bends over some 30 cells
    std::vector<Eigen::Index> unknown(grid.size(), -1);
    Eigen::Index count = 0;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.inside(v)) continue;
        if (static_cast<std::size_t>(sums.depth[v].count) == faces)
            grid.vertices_mm[v].z() = sums.depth[v].mean_mm();
        else
            unknown[v] = count++;
    }
    if (count == 0) return;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(count), right_side = Eigen::VectorXd::Zero(count);
    /// `rise_mm` from one end to the other; a known end goes to the right side.
    const auto add_end = [&](std::size_t from, std::size_t to, double weight, double rise_mm) {
        if (unknown[to] < 0) return;
        diagonal[unknown[to]] += weight;
        right_side[unknown[to]] += weight * rise_mm;
        if (unknown[from] < 0)
            right_side[unknown[to]] += weight * grid.vertices_mm[from].z();
        else
            entries.emplace_back(unknown[to], unknown[from], -weight);
    };
    const auto add_slope = [&](std::size_t from, std::size_t to, const Sum& slope) {
        if (!grid.inside(to)) return;
        const bool known = slope.count > 0 && slope.count >= fewest;
        const double weight = known ? slope.count : membrane;
        const double rise_mm = known ? slope.mean_mm() : 0.0;
        add_end(from, to, weight, rise_mm);
        add_end(to, from, weight, -rise_mm);
    };
    const auto cols = static_cast<std::size_t>(grid.cols);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.inside(v)) continue;
        if ((v + 1) % cols != 0) add_slope(v, v + 1, sums.to_next_col[v]);
        if (v + cols < grid.size()) add_slope(v, v + cols, sums.to_next_row[v]);
        if (unknown[v] < 0 || sums.depth[v].count == 0 || sums.depth[v].count < fewest) continue;
        const double weight = pull * sums.depth[v].count;
        diagonal[unknown[v]] += weight;
        right_side[unknown[v]] += weight * sums.depth[v].mean_mm();
    }
    for (Eigen::Index k = 0; k < count; ++k) entries.emplace_back(k, k, diagonal[k]);
    Eigen::SparseMatrix<double> system(count, count);
    system.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd depths = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(system).solve(right_side);
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (unknown[v] >= 0) grid.vertices_mm[v].z() = depths[unknown[v]];
}

/// What is not measured and hangs together with no cell at the edge of the grid.
std::vector<char> holes(const geometry::QuadGrid& grid) {
    std::vector<char> open(grid.size()), edge(grid.size(), 0);
    const auto cols = static_cast<std::size_t>(grid.cols);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        open[v] = grid.inside(v) ? 0 : 1;
        const bool at_edge = v < cols || v + cols >= grid.size() || v % cols == 0 || v % cols + 1 == cols;
        edge[v] = open[v] && at_edge ? 1 : 0;
    }
    const auto around = reached(grid, edge, open);
    for (std::size_t v = 0; v < grid.size(); ++v) open[v] = open[v] && !around[v] ? 1 : 0;
    return open;
}

/// Cheeks to cheeks and hairline to chin; depths are still to come.
geometry::QuadGrid empty_grid(const Landmarks& consensus, const AverageFaceOptions& options) {
    geometry::QuadGrid grid;
    grid.rows = options.rows;
    grid.cols = options.cols;
    const Point &left = consensus.position_mm("eye_outer_left"), &right = consensus.position_mm("eye_outer_right");
    const double eyes_mm = geometry::outer_eye_distance_mm(consensus);
    const double x_max = options.half_width * eyes_mm;
    const double y_max = 0.5 * (left.y() + right.y()) + options.above_eyes * eyes_mm;
    const double y_min = consensus.position_mm("chin").y() - options.below_chin * eyes_mm;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            grid.vertices_mm.emplace_back(-x_max + 2 * x_max * col / (grid.cols - 1),
                                          y_min + (y_max - y_min) * row / (grid.rows - 1),
                                          std::numeric_limits<double>::quiet_NaN());
    return grid;
}

constexpr double in_front_mm = 500.0;  // rays start there and go backwards

/// Depths of a face, warped onto the consensus, at the vertices of the grid; NaN where it has none.
std::vector<double> depths_of(const Face& face, const Landmarks& consensus, const geometry::QuadGrid& grid) {
    const auto consensus_from_scan = geometry::landmark_spline(face.landmarks, consensus);
    std::vector<Point> warped(face.grid.size(), Point::Zero());
    for (std::size_t v = 0; v < warped.size(); ++v)
        if (face.grid.inside(v)) warped[v] = face.grid.vertices_mm[v];
    consensus_from_scan.apply(warped, warped);
    const geometry::SurfaceIndex surface(warped, geometry::triangles(face.grid, geometry::BridgedVertices::leave_out));
    std::vector<double> depths(grid.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t v = 0; v < depths.size(); ++v) {
        geometry::SurfacePoint hit;
        const Point from(grid.vertices_mm[v].x(), grid.vertices_mm[v].y(), in_front_mm);
        if (surface.first_hit(from, -geometry::Vector::UnitZ(), hit)) depths[v] = hit.position_mm.z();
    }
    return depths;
}

/// Faces in batches: memory stays bounded, and depths are added in the order of the subjects.
DepthSums sum_depths(std::size_t count, const std::function<Face(std::size_t)>& load, const Landmarks& consensus,
                     const geometry::QuadGrid& grid, std::vector<std::string>& scans) {
    DepthSums sums(grid.size());
    struct Carried {
        std::string name;
        std::vector<double> depths;
    };
    base::in_batches(
        count,
        [&](std::size_t k) -> Carried {
            const Face face = load(k);
            auto name = face.id.name();
            try {
                return {std::move(name), depths_of(face, consensus, grid)};
            } catch (const std::exception& e) {
                throw InputError(
                    fmt::format("{}: cannot be carried to the average face: {}", face.id.name(), e.what()));
            }
        },
        [&](Carried& carried) {
            scans.push_back(std::move(carried.name));
            sums.add(carried.depths, static_cast<std::size_t>(grid.cols));
        });
    return sums;
}

std::size_t mirrored_vertex(const geometry::QuadGrid& grid, std::size_t v) {
    const auto cols = static_cast<std::size_t>(grid.cols);
    return v - v % cols + (cols - 1 - v % cols);
}

/// Measured is what `needed` faces measured. A cell that just misses that stands all the same if its mirror image makes
/// up for it. Holes are bridged.
void mark_origins(geometry::QuadGrid& grid, const DepthSums& sums, double needed) {
    grid.origin.assign(grid.size(), VertexOrigin::outside);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const int here = sums.depth[v].count, there = sums.depth[mirrored_vertex(grid, v)].count;
        const bool together = here + there >= 2 * needed && here >= 0.5 * needed;
        if (here > 0 && (here >= needed || together)) grid.origin[v] = VertexOrigin::measured;
    }
    const auto hole = holes(grid);
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (hole[v]) grid.origin[v] = VertexOrigin::bridged;
}

/// One outline for both halves: what stands on the left has its place on the right.
void make_outline_symmetric(geometry::QuadGrid& grid) {
    const auto whole = grid.origin;
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (whole[mirrored_vertex(grid, v)] == VertexOrigin::outside) {
            grid.origin[v] = VertexOrigin::outside;
            grid.vertices_mm[v].z() = std::numeric_limits<double>::quiet_NaN();
        }
}

/// Nose tip of the surface itself at the origin: straight behind the consensus' own.
void put_nose_at_origin(AverageFace& average, const Landmarks& consensus) {
    auto& grid = average.grid;
    geometry::SurfacePoint nose;
    const geometry::SurfaceIndex surface(grid.vertices_mm, geometry::triangles(grid));
    const Point& tip = consensus.position_mm("nose_tip");
    if (!surface.first_hit({tip.x(), tip.y(), in_front_mm}, -geometry::Vector::UnitZ(), nose)) return;
    const Transform shift(Eigen::Translation3d(-nose.position_mm));
    for (auto& p : grid.vertices_mm) p -= nose.position_mm;  // not shift * p: 0 * NaN would spread from z
    // Average landmarks lie on the average surface.
    std::vector<Landmark> marks;
    for (const auto& mark : consensus.all()) marks.push_back({mark.name, shift * mark.position_mm, ""});
    average.landmarks = Landmarks(std::move(marks));
}

}  // namespace

Landmarks consensus_landmarks(std::span<const Landmarks> sets, int max_iterations, double* rms_mm) {
    if (sets.size() < 2)
        throw InputError(
            fmt::format("{} neutral face(s) with landmarks; an average face needs two or more", sets.size()));
    std::map<std::string, std::size_t> seen;
    for (const auto& set : sets)
        for (const auto& mark : set.all()) ++seen[mark.name];
    std::vector<std::string> names;
    for (const auto name : geometry::standard_landmark_names())
        if (2 * seen[std::string(name)] >= sets.size() && seen[std::string(name)] > 0) names.emplace_back(name);
    if (names.size() < 4)
        throw InputError(fmt::format(
            "only {} in at least half of the neutral faces; four are needed (docs/formats.md lists the names)",
            base::counted(names.size(), "standard landmark stands", "standard landmarks stand")));

    // Further marks (ear lobes) and missing ones must shift neither the centre nor the size.
    std::vector<Landmarks> as_marked, aligned;
    for (const auto& set : sets) {
        as_marked.push_back(only(set, names));
        if (as_marked.back().size() < 3)
            throw InputError(
                fmt::format("a neutral face has {} of the {} landmarks that the average is made of; three are needed",
                            as_marked.back().size(), names.size()));
        Point centre = Point::Zero();
        for (const auto& mark : as_marked.back().all()) centre += mark.position_mm;
        centre /= static_cast<double>(as_marked.back().size());
        aligned.push_back(geometry::transformed(as_marked.back(), Transform(Eigen::Translation3d(-centre))));
    }
    // Orientation to end with: that of the input on average.
    const Landmarks upright = mean_of(aligned, names);

    Landmarks consensus = upright;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        for (auto& set : aligned) set = geometry::transformed(set, similarity_normalisation(set, consensus));
        Landmarks next = mean_of(aligned, names);
        double ratio = 0;  // mean size of the input over that of the mean shape, which shrinks without it
        for (const auto& set : as_marked) ratio += size_ratio(set, next) / static_cast<double>(as_marked.size());
        next = geometry::transformed(next, Transform(Eigen::Scaling(ratio)));
        double change = 0;
        for (const auto& name : names)
            change = std::max(change, (next.position_mm(name) - consensus.position_mm(name)).norm());
        consensus = std::move(next);
        if (change < 1e-9) break;
    }
    if (rms_mm) {
        double sum = 0;
        std::size_t count = 0;
        for (const auto& set : aligned)
            for (const auto& pair : geometry::pair_by_name(set, consensus).pairs) {
                sum += (pair.source_mm - pair.target_mm).squaredNorm();
                ++count;
            }
        *rms_mm = std::sqrt(sum / static_cast<double>(count));
    }
    consensus = geometry::transformed(consensus, rigid_by_landmarks(consensus, upright));

    // Frontal: turn until the mirror image lies on the face, then make it exactly symmetric.
    for (int k = 0; k < 20; ++k) {
        const auto mirror = mirrored(consensus);
        const auto half_way = mean_of({consensus, mirror}, names);
        consensus = geometry::transformed(consensus, rigid_by_landmarks(consensus, half_way));
    }
    consensus = mean_of({consensus, mirrored(consensus)}, names);
    return geometry::transformed(consensus, Transform(Eigen::Translation3d(-consensus.position_mm("nose_tip"))));
}

AverageFace build_average_face(std::size_t count, const std::function<Face(std::size_t)>& load,
                               const Landmarks& consensus, const AverageFaceOptions& options) {
    options.check();
    AverageFace average;
    average.landmarks = consensus;
    average.grid = empty_grid(consensus, options);
    const auto sums = sum_depths(count, load, consensus, average.grid, average.scans);
    const double needed = options.min_share * static_cast<double>(count);
    mark_origins(average.grid, sums, needed);
    integrate_depths(average.grid, sums, count, 0.5 * needed);
    make_outline_symmetric(average.grid);
    put_nose_at_origin(average, consensus);
    return average;
}

namespace {

/// Of the document without its digest, and of the mesh beside it.
std::string digest_of_average(const nlohmann::json& document, const base::FileDigest& mesh) {
    return fmt::format("{} {}", base::digest_of(io::json_text(document)).text(), mesh.text());
}

}  // namespace

void write_average_face(const std::filesystem::path& stem, const AverageFace& average, const std::string& fingerprint) {
    auto mesh_file = stem, json_file = stem;
    mesh_file += ".ply";
    json_file += ".json";
    // The .json says that both are whole: a run that ends in between must not leave that of another surface.
    std::error_code ignored;
    std::filesystem::remove(json_file, ignored);
    const auto mesh = write_grid(mesh_file, average.grid);
    nlohmann::json document = {
        {"schema", 1},
        {"kind", "mimik average face"},
        {"rows", average.grid.rows},
        {"cols", average.grid.cols},
        {"units", "mm"},
        {"frame", "average: nose tip at the origin, +x subject's left, +y up, +z out of the face"},
        {"landmarks", io::to_json(average.landmarks)},
        {"scans", average.scans},
        {"consensus_rms_mm", average.consensus_rms_mm},
        {"fingerprint", fingerprint}};
    document["digest"] = digest_of_average(document, mesh);
    base::write_atomically(json_file, io::json_text(document));
}

bool average_face_is_whole(const std::filesystem::path& stem) {
    auto mesh_file = stem, json_file = stem;
    mesh_file += ".ply";
    json_file += ".json";
    try {
        const auto text = base::read_text(json_file, io::most_json_bytes);
        auto document = io::parse_json(text, json_file.string());
        const auto digest = io::read_field<std::string>(document, "digest");
        document.erase("digest");
        return digest == digest_of_average(document, base::digest_of_file(mesh_file));
    } catch (const InputError&) {
        return false;
    }
}

AverageFace decode_average_face(std::string_view text, const std::string& name, std::string* fingerprint) {
    return io::read_json_document(text, name, damaged_file_mend, [&](const nlohmann::json& document) {
        AverageFace average;
        average.landmarks = io::landmarks_from_json(document, "landmarks");
        average.scans = io::read_field<std::vector<std::string>>(document, "scans");
        average.consensus_rms_mm = io::read_field<double>(document, "consensus_rms_mm");
        if (fingerprint) *fingerprint = io::read_field<std::string>(document, "fingerprint");
        average.grid = grid_size_from_json(document);
        return average;
    });
}

AverageFace read_average_face(const std::filesystem::path& stem, std::string* fingerprint) {
    auto mesh_file = stem, json_file = stem;
    mesh_file += ".ply";
    json_file += ".json";
    auto average =
        decode_average_face(base::read_text(json_file, io::most_json_bytes), json_file.string(), fingerprint);
    average.grid = read_grid(mesh_file, average.grid.rows, average.grid.cols);
    return average;
}

}  // namespace mimik::preprocessing
