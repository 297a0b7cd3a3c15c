#include "synthesis/scanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/random_stream.h"
#include "geometry/point_index.h"
#include "synthesis/depth_raster.h"
#include "synthesis/smooth_field.h"

namespace mimik::synthesis {
namespace {

using geometry::Point;
using geometry::Vector;

void range(const char* field, double value, double low, double high) {
    if (!(value >= low && value <= high))
        throw InputError(fmt::format("{} is {}; give {} to {}", field, value, low, high));
}

geometry::Transform draw_pose(base::RandomStream random, const ScannerOptions& options) {
    const double degree = std::numbers::pi / 180.0;
    const double pitch = options.pitch_deg * degree * random.normal();
    const double yaw = options.yaw_deg * degree * random.normal();
    const double roll = options.roll_deg * degree * random.normal();
    Vector shift;
    for (int axis = 0; axis < 3; ++axis) shift[axis] = options.translation_mm * random.normal();
    geometry::Transform pose = geometry::Transform::Identity();
    pose.translate(shift);
    pose.rotate(Eigen::AngleAxisd(roll, Vector::UnitZ()) * Eigen::AngleAxisd(yaw, Vector::UnitY()) *
                Eigen::AngleAxisd(pitch, Vector::UnitX()));
    return pose;
}

/// Root mean square marking error in mm: sharp corners are marked better than soft ridges.
double marking_error_mm(const std::string& landmark) {
    if (landmark.starts_with("eye_")) return 0.5;
    if (landmark.starts_with("mouth_corner") || landmark.find("lip") != std::string::npos) return 0.65;
    if (landmark.starts_with("nose_tip") || landmark.starts_with("nose_wing")) return 0.75;
    return 1.0;
}

double lost_share(const std::string& region, const ScannerOptions& options) {
    if (region == "eye" || region == "lid") return options.eye_hole_share;
    if (region == "nostril") return options.nostril_hole_share;
    if (region == "brow") return options.brow_hole_share;
    return 0.0;
}

/// The value that a standard normal field exceeds on `share` of the area.
double exceeded_on(double share) {
    if (share <= 0) return std::numeric_limits<double>::infinity();
    if (share >= 1) return -std::numeric_limits<double>::infinity();
    double low = -8, high = 8;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(middle / std::numbers::sqrt2) > share ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

void add_spikes(geometry::RangeScan& scan, base::RandomStream random, int count) {
    std::vector<std::size_t> valid;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) valid.push_back(i);
    for (int s = 0; s < count && !valid.empty(); ++s) {
        const auto index = valid[static_cast<std::size_t>(random.uniform() * static_cast<double>(valid.size()))];
        const double height = 5.0 + 35.0 * random.uniform();
        scan.points_mm[index].z() += random.uniform() < 0.5 ? -height : height;
    }
}

/// Round patches that lie behind the face and do not touch it, at the lower or side border of the lattice.
void add_stray_parts(geometry::RangeScan& scan, const RasterLattice& lattice, base::RandomStream random, int count) {
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) lowest = std::min(lowest, scan.points_mm[i].z());
    for (int part = 0; part < count; ++part) {
        const double radius = 4.0 + 4.0 * random.uniform(), depth = lowest - 15.0 - 30.0 * random.uniform();
        const double col0 = random.uniform() < 0.5 ? 0.08 * lattice.cols : 0.92 * lattice.cols;
        const double row0 = (0.05 + 0.1 * random.uniform()) * lattice.rows;
        const double slope_x = 0.5 * random.normal(), slope_y = 0.5 * random.normal();
        for (int row = 0; row < lattice.rows; ++row)
            for (int col = 0; col < lattice.cols; ++col) {
                const double dx = (col - col0) * lattice.spacing_mm, dy = (row - row0) * lattice.spacing_mm;
                auto& point = scan.points_mm[static_cast<std::size_t>(row) * static_cast<std::size_t>(lattice.cols) +
                                             static_cast<std::size_t>(col)];
                if (dx * dx + dy * dy > radius * radius || std::isfinite(point.x())) continue;
                point = {lattice.x0_mm + col * lattice.spacing_mm, lattice.y0_mm + row * lattice.spacing_mm,
                         depth + slope_x * dx + slope_y * dy};
            }
    }
}

/// Drops what a jaw parts from the face: in the lattice rows below `below_y_mm`, neck that is not reached from the
/// chin's column without a gap or a step in depth. Returns how many points.
std::size_t trim_neck(geometry::RangeScan& scan, const RasterLattice& lattice, double below_y_mm, const Point& chin) {
    constexpr double joined_mm = 6;  // in depth, between neighbours: a surface turned by 80 degrees
    constexpr int widest_gap = 3;    // cells
    const int middle = std::clamp(static_cast<int>((chin.x() - lattice.x0_mm) / lattice.spacing_mm), 0, scan.cols - 1);
    const int rows = std::clamp(static_cast<int>((below_y_mm - lattice.y0_mm) / lattice.spacing_mm), 0, scan.rows);
    std::size_t dropped = 0;
    double last_middle_z = chin.z();
    bool below_chin = false;
    for (int row = rows; row-- > 0;) {
        const auto at = [&](int col) {
            return static_cast<std::size_t>(row) * static_cast<std::size_t>(scan.cols) + static_cast<std::size_t>(col);
        };
        // Once the middle column is behind the chin, all that follows is neck.
        if (lattice.y0_mm + row * lattice.spacing_mm > chin.y())
            last_middle_z = chin.z();
        else if (!scan.valid(at(middle)) || last_middle_z - scan.points_mm[at(middle)].z() > joined_mm)
            below_chin = true;
        else
            last_middle_z = scan.points_mm[at(middle)].z();
        for (const int step : {-1, 1}) {
            bool parted = below_chin;
            int gap = 0;
            double z = std::numeric_limits<double>::quiet_NaN();
            for (int col = step < 0 ? middle - 1 : middle; col >= 0 && col < scan.cols; col += step) {
                auto& point = scan.points_mm[at(col)];
                if (!scan.valid(at(col))) {
                    parted = parted || ++gap > widest_gap;
                    continue;
                }
                parted = parted || std::abs(z - point.z()) > joined_mm;  // never with the first, whose z is NaN
                if (!parted) {
                    z = point.z();
                    gap = 0;
                    continue;
                }
                point = Point::Constant(std::numeric_limits<double>::quiet_NaN());
                ++dropped;
            }
        }
    }
    return dropped;
}

geometry::Landmarks mark(const geometry::RangeScan& scan, const geometry::Landmarks& truth,
                         const std::map<std::string, Vector>& normals, const std::string& scan_name, std::uint64_t seed,
                         double scale) {
    // A landmark whose nearest measured point is farther than this lies in a hole that a marker would see as one.
    constexpr double invisible_mm = 6.0;
    std::vector<geometry::Landmark> marks;
    for (const auto& landmark : truth.all()) {
        base::RandomStream random(seed, fmt::format("{}/mark/{}", scan_name, landmark.name));
        const Vector& normal = normals.at(landmark.name);
        const Vector across = normal.unitOrthogonal(), along = normal.cross(across);
        const double each = scale * marking_error_mm(landmark.name) / std::numbers::sqrt2;
        const double a = each * random.normal(), b = each * random.normal();
        const Point meant = landmark.position_mm + a * across + b * along;
        const auto nearest =
            geometry::nearest_point(scan.points_mm, meant, [&](std::size_t i) { return scan.valid(i); });
        if (nearest && (scan.points_mm[*nearest] - meant).squaredNorm() < invisible_mm * invisible_mm)
            marks.push_back({landmark.name, scan.points_mm[*nearest], ""});
    }
    return geometry::Landmarks(std::move(marks));
}

/// One exposure: the posed head, the lattice over it, and what the camera measures of it.
class Exposure {
public:
    Exposure(const FaceModel& model, const std::vector<Point>& vertices_mm, const FaceWindow& window,
             std::string scan_name, std::uint64_t seed, const ScannerOptions& options)
        : model_(model), window_(window), name_(std::move(scan_name)), seed_(seed), options_(options) {
        result_.scanner_from_head = draw_pose(stream("pose"), options);
        vertices_.resize(vertices_mm.size());
        for (std::size_t i = 0; i < vertices_.size(); ++i) vertices_[i] = result_.scanner_from_head * vertices_mm[i];
        triangles_ = geometry::triangulate(model.faces());
        normals_ = geometry::vertex_normals(vertices_, triangles_);
        lay_lattice();
    }

    SyntheticScan take() {
        find_true_landmarks();
        place_photograph();
        measure_cells();
        const auto& marks = model_.landmark_vertices();
        result_.valid_points -=
            trim_neck(result_.scan, lattice_, vertices_[marks.at("lower_lip_outer")].y(), vertices_[marks.at("chin")]);
        // Marked on the clean scan: nobody puts a mark on a spike or on a piece of cloth.
        result_.landmarks =
            mark(result_.scan, result_.true_landmarks, landmark_normals_, name_, seed_, options_.marking_jitter);
        add_spikes(result_.scan, stream("spikes"), options_.spikes);
        add_stray_parts(result_.scan, lattice_, stream("stray"), options_.stray_parts);
        see_photograph();
        return std::move(result_);
    }

private:
    [[nodiscard]] base::RandomStream stream(const char* of) const { return {seed_, name_ + "/" + of}; }

    /// Over the window with a rim of background; it stands anywhere against the head.
    void lay_lattice() {
        const Point centre = result_.scanner_from_head * window_.centre_mm;
        auto phase = stream("lattice");
        const double rim_mm = 6.0, spacing = options_.spacing_mm;
        lattice_.spacing_mm = spacing;
        lattice_.cols = 2 * static_cast<int>((window_.half_width_mm + rim_mm) / spacing) + 1;
        lattice_.rows = 2 * static_cast<int>((window_.half_height_mm + rim_mm) / spacing) + 1;
        lattice_.x0_mm = centre.x() - spacing * (0.5 * lattice_.cols + phase.uniform());
        lattice_.y0_mm = centre.y() - spacing * (0.5 * lattice_.rows + phase.uniform());
    }
    [[nodiscard]] double width_mm() const { return lattice_.cols * lattice_.spacing_mm; }
    [[nodiscard]] double height_mm() const { return lattice_.rows * lattice_.spacing_mm; }

    void find_true_landmarks() {
        std::vector<geometry::Landmark> truth;
        for (const auto name : geometry::standard_landmark_names()) {
            const auto found = model_.landmark_vertices().find(std::string(name));
            if (found == model_.landmark_vertices().end()) continue;
            truth.push_back({found->first, vertices_[found->second], ""});
            landmark_normals_[found->first] = normals_[found->second];
        }
        result_.true_landmarks = geometry::Landmarks(std::move(truth));
    }

    void place_photograph() {
        const double rim_mm = 12.0, pixels_per_mm = options_.texture_pixels_per_mm;
        result_.image_corner_mm = {lattice_.x0_mm - rim_mm, lattice_.y0_mm + height_mm() + rim_mm, 0};
        result_.image_width = static_cast<int>((width_mm() + 2 * rim_mm) * pixels_per_mm);
        result_.image_height = static_cast<int>((height_mm() + 2 * rim_mm) * pixels_per_mm);
    }

    /// Above which value of a standard normal field a vertex is lost.
    [[nodiscard]] std::vector<double> hole_thresholds() const {
        std::map<std::string, double> by_region;
        std::vector<double> thresholds;
        for (const auto& region : model_.vertex_regions()) {
            const auto [entry, added] = by_region.try_emplace(region);
            if (added) entry->second = exceeded_on(lost_share(region, options_));
            thresholds.push_back(entry->second);
        }
        return thresholds;
    }

    void measure_cells() {
        const auto hits = depth_raster(vertices_, triangles_, lattice_);
        auto& scan = result_.scan;
        scan.rows = lattice_.rows;
        scan.cols = lattice_.cols;
        scan.points_mm.assign(hits.size(), Point::Constant(std::numeric_limits<double>::quiet_NaN()));
        scan.texture_coordinates.assign(hits.size(), geometry::TextureCoordinate::Zero());

        const Point low(lattice_.x0_mm, lattice_.y0_mm, 0);
        const Point high(lattice_.x0_mm + width_mm(), lattice_.y0_mm + height_mm(), 0);
        const auto field = [&](const char* of, double length_mm) {
            return SmoothField(base::stream_seed(seed_, name_ + "/" + of), 1, length_mm, low, high);
        };
        const auto smooth = field("smooth_noise", options_.smooth_noise_length_mm);
        const auto patches = field("holes", 1.6), border = field("border", 9.0);
        const auto thresholds = hole_thresholds();
        const auto head_from_scanner = result_.scanner_from_head.inverse();
        auto noise = stream("noise");
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const auto& hit = hits[i];
            // Drawn for every cell, so that a hole more or less leaves the other cells' noise as it was.
            const Vector drawn(noise.normal(), noise.normal(), noise.normal());
            if (!hit.hit() || !hit.front) continue;
            const auto cols = static_cast<std::size_t>(lattice_.cols);
            const Point seen(lattice_.x0_mm + static_cast<double>(i % cols) * lattice_.spacing_mm,
                             lattice_.y0_mm + static_cast<double>(i / cols) * lattice_.spacing_mm, hit.z_mm);
            const double level = window_.level(head_from_scanner * seen);
            // Farther from the border than ten standard deviations its raggedness decides nothing.
            if (level > 1.15 || (level > 0.85 && level > 1.0 + 0.015 * border.at(seen)[0])) continue;
            if (is_lost(hit, seen, thresholds, patches)) continue;
            Point measured = seen;
            measured.x() += options_.noise_xy_mm * drawn.x();
            measured.y() += options_.noise_xy_mm * drawn.y();
            measured.z() += options_.noise_z_mm * drawn.z() + options_.smooth_noise_z_mm * smooth.at(seen)[0];
            scan.points_mm[i] = measured;
            ++result_.valid_points;
        }
    }

    /// Whether it turns away too far, or is in a hole; counts it.
    bool is_lost(const RasterHit& hit, const Point& seen, const std::vector<double>& thresholds,
                 const SmoothField& patches) {
        const auto& corners = triangles_[hit.triangle];
        Vector normal = Vector::Zero();
        for (int c = 0; c < 3; ++c) normal += hit.barycentric[c] * normals_[corners[static_cast<std::size_t>(c)]];
        if (normal.z() < options_.min_normal_z * normal.norm()) {
            ++result_.lost_grazing;
            return true;
        }
        int nearest = 0;
        hit.barycentric.maxCoeff(&nearest);
        const double threshold = thresholds[corners[static_cast<std::size_t>(nearest)]];
        if (std::isfinite(threshold) ? patches.at(seen)[0] > threshold : threshold < 0) {
            ++result_.lost_holes;
            return true;
        }
        return false;
    }

    void see_photograph() {
        auto& scan = result_.scan;
        for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
            if (!scan.valid(i)) continue;
            const Point& p = scan.points_mm[i];
            const double u =
                (p.x() - result_.image_corner_mm.x()) * options_.texture_pixels_per_mm / result_.image_width;
            const double down =
                (result_.image_corner_mm.y() - p.y()) * options_.texture_pixels_per_mm / result_.image_height;
            scan.texture_coordinates[i] = {std::clamp(u, 0.0, 1.0), std::clamp(1.0 - down, 0.0, 1.0)};
        }
    }

    const FaceModel& model_;
    const FaceWindow& window_;
    std::string name_;
    std::uint64_t seed_;
    const ScannerOptions& options_;
    SyntheticScan result_;
    std::vector<Point> vertices_;  // scanner frame
    std::vector<geometry::Triangle> triangles_;
    std::vector<Vector> normals_;
    RasterLattice lattice_;
    std::map<std::string, Vector> landmark_normals_;
};

}  // namespace

void ScannerOptions::check() const {
    range("spacing_mm", spacing_mm, 0.2, 5);
    range("noise_z_mm", noise_z_mm, 0, 5);
    range("smooth_noise_z_mm", smooth_noise_z_mm, 0, 5);
    range("smooth_noise_length_mm", smooth_noise_length_mm, 1, 100);
    range("noise_xy_mm", noise_xy_mm, 0, 1);
    range("min_normal_z", min_normal_z, 0, 0.9);
    range("pitch_deg", pitch_deg, 0, 30);
    range("yaw_deg", yaw_deg, 0, 30);
    range("roll_deg", roll_deg, 0, 30);
    range("translation_mm", translation_mm, 0, 200);
    range("eye_hole_share", eye_hole_share, 0, 1);
    range("nostril_hole_share", nostril_hole_share, 0, 1);
    range("brow_hole_share", brow_hole_share, 0, 1);
    range("spikes", spikes, 0, 10000);
    range("stray_parts", stray_parts, 0, 100);
    range("marking_jitter", marking_jitter, 0, 20);
    range("texture_pixels_per_mm", texture_pixels_per_mm, 0.5, 10);
}

double FaceWindow::level(const Point& head_mm) const {
    const double x = std::abs(head_mm.x() - centre_mm.x()) / half_width_mm;
    const double y = std::abs(head_mm.y() - centre_mm.y()) / half_height_mm;
    return std::pow(std::pow(x, 2.3) + std::pow(y, 2.3), 1.0 / 2.3);
}

FaceWindow FaceWindow::following_chin(double moved_chin_y_mm) const {
    FaceWindow moved = *this;
    const double down = std::max(0.0, chin_y_mm - moved_chin_y_mm);
    moved.centre_mm.y() -= 0.5 * down;
    moved.half_height_mm += 0.5 * down;
    return moved;
}

FaceWindow face_window(const FaceModel& model, const std::vector<Point>& resting_mm) {
    const auto at = [&](const char* name) { return resting_mm[model.landmark_vertices().at(name)]; };
    const Point eyes = 0.5 * (at("eye_outer_left") + at("eye_outer_right"));
    const double height = eyes.y() - at("chin").y();
    const double top = eyes.y() + 0.65 * height, bottom = at("chin").y() - 0.27 * height;
    FaceWindow window;
    window.centre_mm = {eyes.x(), 0.5 * (top + bottom), eyes.z()};
    window.half_height_mm = 0.5 * (top - bottom);
    window.chin_y_mm = at("chin").y();
    window.half_width_mm = 0.85 * (at("eye_outer_left") - at("eye_outer_right")).norm();
    return window;
}

SyntheticScan scan_face(const FaceModel& model, const std::vector<Point>& vertices_mm, const FaceWindow& resting_window,
                        const std::string& scan_name, std::uint64_t seed, const ScannerOptions& options) {
    options.check();
    const auto window = resting_window.following_chin(vertices_mm[model.landmark_vertices().at("chin")].y());
    return Exposure(model, vertices_mm, window, scan_name, seed, options).take();
}

}  // namespace mimik::synthesis
