#include "capture/landmark_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/quantile.h"
#include "base/text.h"
#include "capture/plain_table.h"

namespace mimik::capture {

void LandmarkTableOptions::check() const {
    if (rate_hz && !(*rate_hz > 0 && *rate_hz <= 1e5))
        throw InputError(fmt::format("rate_hz is {}; give frames a second, above 0 and up to 100000", *rate_hz));
    if (!(outer_eye_mm >= 10 && outer_eye_mm <= 500))
        throw InputError(fmt::format("outer_eye_mm is {}; give 10 to 500 mm", outer_eye_mm));
}

namespace {

constexpr std::size_t point_count = 68;
constexpr double most_pixels = 1e6;
const Eigen::Vector2d half_pixel(0.5, 0.5);  // tables have the first pixel's middle at (0, 0), a motion at (0.5, 0.5)
using Pixels = std::array<Eigen::Vector2d, point_count>;

/// Corners of the eyes, bridge, tip, wings and base of the nose: what expressions move least.
constexpr std::array<std::size_t, 11> stable = {36, 39, 42, 45, 27, 28, 29, 30, 31, 33, 35};
constexpr std::size_t right_eye = 36, left_eye = 45;

struct Row {
    double time_s = 0, confidence = 0;
    bool tracked = false;
    Pixels pixels{};
};

Eigen::Vector2d turned_up(const Eigen::Vector2d& pixel) { return {pixel.x(), -pixel.y()}; }

/// In the frame of the eyes: origin between the outer corners, x to the subject's left, in shares of their distance.
Pixels in_eye_frame(const Pixels& pixels) {
    const Eigen::Vector2d right = turned_up(pixels[right_eye]), left = turned_up(pixels[left_eye]);
    const Eigen::Vector2d across = left - right, middle = 0.5 * (left + right);
    const double squared = across.squaredNorm();
    Pixels placed;
    for (std::size_t k = 0; k < point_count; ++k) {
        const Eigen::Vector2d d = turned_up(pixels[k]) - middle;
        placed[k] = Eigen::Vector2d(across.dot(d), across.x() * d.y() - across.y() * d.x()) / squared;
    }
    return placed;
}

/// The similarity that brings the stable points of `from` nearest to those of `to`, applied to all.
Pixels laid_on(const Pixels& from, const Pixels& to) {
    Eigen::Vector2d from_mean = Eigen::Vector2d::Zero(), to_mean = from_mean;
    for (const auto k : stable) {
        from_mean += from[k] / stable.size();
        to_mean += to[k] / stable.size();
    }
    double same = 0, turned = 0, size = 0;
    for (const auto k : stable) {
        const Eigen::Vector2d a = from[k] - from_mean, b = to[k] - to_mean;
        same += a.dot(b);
        turned += a.x() * b.y() - a.y() * b.x();
        size += a.squaredNorm();
    }
    Eigen::Matrix2d similarity;
    similarity << same, -turned, turned, same;
    similarity /= size;
    Pixels placed;
    for (std::size_t k = 0; k < point_count; ++k) placed[k] = similarity * (from[k] - from_mean) + to_mean;
    return placed;
}

std::vector<std::string> feature_names() {
    std::vector<std::string> names;
    for (const auto& feature : face_features()) names.emplace_back(feature.name);
    return names;
}

/// Positions in the head's frame of rows of pixels: flat, and free of place, roll and size.
void place_flat(const std::vector<Row>& rows, double outer_eye_mm, FeatureMotion& motion) {
    std::vector<Pixels> in_eyes;
    for (const auto& row : rows)
        if (row.tracked) in_eyes.push_back(in_eye_frame(row.pixels));
    Pixels usual{};
    std::vector<double> values(in_eyes.size());
    for (std::size_t k = 0; k < point_count && !in_eyes.empty(); ++k)
        for (int axis = 0; axis < 2; ++axis) {
            for (std::size_t f = 0; f < in_eyes.size(); ++f) values[f] = in_eyes[f][k][axis];
            usual[k][axis] = base::median(values);
        }
    std::size_t next = 0;
    for (std::size_t f = 0; f < rows.size(); ++f) {
        if (!rows[f].tracked) continue;
        const auto placed = laid_on(in_eyes[next++], usual);
        for (std::size_t k = 0; k < motion.names.size(); ++k) {
            const auto& p = placed[static_cast<std::size_t>(face_features()[k].point68)];
            auto& sample = motion.frames[f].features[k];
            sample.valid = true;
            sample.head_mm = {outer_eye_mm * p.x(), outer_eye_mm * p.y(), 0.0};
        }
    }
}

/// What both kinds of tables become before positions are known.
FeatureMotion begun(const std::vector<Row>& rows, double rate_hz) {
    FeatureMotion motion{feature_names(), rate_hz, {}};
    for (const auto& row : rows) {
        FeatureFrame frame;
        frame.time_s = row.time_s;
        frame.state = row.tracked ? TrackState::tracked : TrackState::lost;
        frame.confidence = row.confidence;
        frame.features.resize(motion.names.size());
        for (std::size_t k = 0; k < motion.names.size() && row.tracked; ++k) {
            frame.features[k].in_image = true;
            frame.features[k].pixel = row.pixels[static_cast<std::size_t>(face_features()[k].point68)] + half_pixel;
        }
        motion.frames.push_back(std::move(frame));
    }
    return motion;
}

/// Checks what every step after this takes for granted.
template <class Rows>
void check_pixels(const Rows& rows, const Pixels& pixels) {
    for (const auto& p : pixels)
        if (!(p.cwiseAbs().maxCoeff() <= most_pixels))
            rows.fail(
                fmt::format("a point is farther than {:g} pixels from the image's corner; give pixels", most_pixels));
    if (!((pixels[left_eye] - pixels[right_eye]).norm() > 1))
        rows.fail("the outer eye corners, points 36 and 45, are at one place; mark the frame as not detected");
    double spread = 0;
    for (const auto k : stable) spread = std::max(spread, (pixels[k] - pixels[right_eye]).norm());
    if (!(spread < 1e3 * (pixels[left_eye] - pixels[right_eye]).norm()))
        rows.fail("the points of eyes and nose lie far apart beside the distance of the eyes; mend the frame");
}

/// FeatureMotion::check(), which knows frames and no lines. @param fail  throws, by the number of a frame
template <class Fail>
void check_motion(const FeatureMotion& motion, const std::string& name, const Fail& fail) {
    try {
        motion.check();
    } catch (const InputError& whole) {
        for (std::size_t k = 0; k < motion.frames.size(); ++k) try {
                FeatureMotion{motion.names, motion.rate_hz, {motion.frames[k]}}.check();
            } catch (const InputError& e) {
                const std::string_view what = e.what(), prefix = "frame 0: ";
                fail(k, std::string(what.starts_with(prefix) ? what.substr(prefix.size()) : what));
            }
        throw InputError(fmt::format("{}: {}", name, whole.what()));
    }
}

template <class Rows>
bool zero_or_one(const Rows& rows, std::size_t column, const char* name) {
    const double value = rows.number(column);
    if (value != 0 && value != 1)
        rows.fail(fmt::format("{} is {}; give 0 or 1", name, base::in_quotes(rows.field(column))));
    return value == 1;
}

}  // namespace

LandmarkTable decode_points68_csv(std::string_view text, const std::string& name, const LandmarkTableOptions& options) {
    options.check();
    base::CsvReader rows(text, name);
    const auto frame_column = rows.column("frame"), detected = rows.column("detected");
    std::array<std::array<std::size_t, 2>, point_count> columns{};
    for (std::size_t k = 0; k < point_count; ++k)
        columns[k] = {rows.column(fmt::format("x{}", k)), rows.column(fmt::format("y{}", k))};
    LandmarkTable table;
    const double rate_hz = options.rate_hz.value_or(30.0);
    if (!options.rate_hz)
        table.remarks.push_back(
            fmt::format("{}: a table of 68 points says no time; 30 frames a second are assumed "
                        "(--rate)",
                        name));
    std::vector<Row> read;
    while (rows.next()) {
        const auto number = base::parse_integer(rows.field(frame_column));
        if (!number || *number != static_cast<std::int64_t>(read.size()))
            rows.fail(fmt::format("frame is {}, and {} comes next; one row for every frame, from 0 on",
                                  base::in_quotes(rows.field(frame_column)), read.size()));
        Row row;
        row.time_s = static_cast<double>(read.size()) / rate_hz;
        row.tracked = zero_or_one(rows, detected, "detected");
        row.confidence = row.tracked ? 1 : 0;
        if (row.tracked) {
            for (std::size_t k = 0; k < point_count; ++k)
                row.pixels[k] = {rows.number(columns[k][0]), rows.number(columns[k][1])};
            check_pixels(rows, row.pixels);
        }
        read.push_back(row);
    }
    table.motion = begun(read, rate_hz);
    place_flat(read, options.outer_eye_mm, table.motion);
    table.remarks.push_back(
        fmt::format("{}: pixels say nothing of depth; turning and nodding of the head stay in the features", name));
    check_motion(table.motion, name, [&](std::size_t frame, const std::string& what) {
        base::CsvReader again(text, name);
        for (std::size_t k = 0; k <= frame; ++k) (void)again.next();
        again.fail(what);
    });
    return table;
}

namespace {

/// Rx Ry Rz, as OpenFace has it.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& angles_rad) {
    return (Eigen::AngleAxisd(angles_rad.x(), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(angles_rad.y(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(angles_rad.z(), Eigen::Vector3d::UnitZ()))
        .toRotationMatrix();
}

class OpenFaceReader {
public:
    OpenFaceReader(std::string_view text, const std::string& name, const LandmarkTableOptions& options)
        : rows_(text, name), name_(name), options_(options), success_(rows_.column("success")) {
        time_ = rows_.find("timestamp");
        confidence_ = rows_.find("confidence");
        face_ = rows_.find("face_id");
        solid_ = rows_.find("pose_Tx") && rows_.find("Z_67");
        for (std::size_t k = 0; k < point_count; ++k) {
            pixels_[k] = {rows_.column(fmt::format("x_{}", k)), rows_.column(fmt::format("y_{}", k))};
            for (std::size_t axis = 0; axis < 3 && solid_; ++axis)
                points_[k][axis] = rows_.column(fmt::format("{}_{}", "XYZ"[axis], k));
        }
        for (std::size_t axis = 0; axis < 3 && solid_; ++axis) {
            translation_[axis] = rows_.column(fmt::format("pose_T{}", "xyz"[axis]));
            rotation_[axis] = rows_.column(fmt::format("pose_R{}", "xyz"[axis]));
        }
    }

    LandmarkTable read() {
        LandmarkTable table;
        while (rows_.next()) read_row();
        const double rate_hz = rate(table);
        if (!time_)
            for (std::size_t k = 0; k < read_.size(); ++k) read_[k].time_s = static_cast<double>(k) / rate_hz;
        table.motion = begun(read_, rate_hz);
        if (solid_)
            place_solid(table.motion);
        else
            place_flat(read_, options_.outer_eye_mm, table.motion);
        if (other_faces_ > 0)
            table.remarks.push_back(fmt::format("{}: {} of other faces left out", name_,
                                                base::counted(other_faces_, "row is", "rows are")));
        if (!solid_)
            table.remarks.push_back(fmt::format(
                "{}: no columns X_0 to Z_67 and pose_Tx to pose_Rz, so depth and the head's turning are not known",
                name_));
        check_motion(table.motion, name_, [&](std::size_t frame, const std::string& what) {
            throw InputError(fmt::format("{}: line {}: {}", name_, lines_[frame], what));
        });
        return table;
    }

private:
    struct Solid {
        HeadPose pose;
        std::array<Eigen::Vector3d, point_count> points_mm;  ///< camera
    };

    void read_row();
    [[nodiscard]] double rate(LandmarkTable& table) const;
    void place_solid(FeatureMotion& motion) const;
    [[nodiscard]] Eigen::Vector3d vector(const std::array<std::size_t, 3>& columns) const {
        return {rows_.number(columns[0]), rows_.number(columns[1]), rows_.number(columns[2])};
    }

    PlainTable rows_;
    std::string name_;
    const LandmarkTableOptions& options_;
    std::size_t success_ = 0, other_faces_ = 0;
    std::optional<std::size_t> time_, confidence_, face_;
    std::string first_face_;
    std::array<std::array<std::size_t, 2>, point_count> pixels_{};
    std::array<std::array<std::size_t, 3>, point_count> points_{};
    std::array<std::size_t, 3> translation_{}, rotation_{};
    bool solid_ = false;
    std::vector<Row> read_;
    std::vector<std::size_t> lines_;  ///< of these
    std::vector<Solid> solids_;       ///< of rows that are tracked
};

void OpenFaceReader::read_row() {
    // Every frame takes memory for its features, so a row of few letters must not be one.
    if (rows_.fields() != rows_.header().size())
        rows_.fail(fmt::format("{} where the header names {}; write the line whole",
                               base::counted(rows_.fields(), "field"), base::counted(rows_.header().size(), "column")));
    if (face_) {
        if (read_.empty()) first_face_ = rows_.field(*face_);
        if (rows_.field(*face_) != first_face_) {
            ++other_faces_;
            return;
        }
    }
    Row row;
    if (time_) {
        row.time_s = rows_.number(*time_);
        if (row.time_s < 0 || (!read_.empty() && row.time_s <= read_.back().time_s))
            rows_.fail(fmt::format("timestamp is {} s after {} s; give seconds that grow", row.time_s,
                                   read_.empty() ? 0 : read_.back().time_s));
    }
    row.tracked = zero_or_one(rows_, success_, "success");
    row.confidence = confidence_ ? rows_.number(*confidence_) : (row.tracked ? 1 : 0);
    if (!(row.confidence >= 0 && row.confidence <= 1))
        rows_.fail(fmt::format("confidence is {}; give 0 to 1", row.confidence));
    if (row.tracked) {
        for (std::size_t k = 0; k < point_count; ++k)
            row.pixels[k] = {rows_.number(pixels_[k][0]), rows_.number(pixels_[k][1])};
        check_pixels(rows_, row.pixels);
        if (solid_) {
            auto& solid = solids_.emplace_back();
            solid.pose.translation_mm = vector(translation_);
            const Eigen::AngleAxisd turn(rotation_of(vector(rotation_)));
            solid.pose.rotation_vector = turn.angle() * turn.axis();
            for (std::size_t k = 0; k < point_count; ++k) solid.points_mm[k] = vector(points_[k]);
        }
    }
    read_.push_back(row);
    lines_.push_back(rows_.line());
}

double OpenFaceReader::rate(LandmarkTable& table) const {
    if (options_.rate_hz) return *options_.rate_hz;
    if (time_ && read_.size() > 1) {
        const double rate_hz = static_cast<double>(read_.size() - 1) / (read_.back().time_s - read_.front().time_s);
        if (rate_hz > 0 && rate_hz <= 1e5) return std::round(rate_hz * 1e3) / 1e3;
    }
    table.remarks.push_back(fmt::format("{}: nothing says how many frames a second; 30 are assumed (--rate)", name_));
    return 30.0;
}

/// OpenFace's camera has y down and z away, as ours; its face looks at the camera, as ours does after half a turn about
/// x. The origin goes between the outer eye corners as they usually are.
void OpenFaceReader::place_solid(FeatureMotion& motion) const {
    const Eigen::Matrix3d half_turn = Eigen::Vector3d(1, -1, -1).asDiagonal();
    std::vector<std::array<Eigen::Vector3d, point_count>> in_head;
    std::array<std::vector<double>, 3> middles;
    for (const auto& [pose, points_mm] : solids_) {
        const double angle = pose.rotation_vector.norm();
        const Eigen::Matrix3d head_from_camera =
            half_turn * Eigen::AngleAxisd(-angle, angle > 0 ? Eigen::Vector3d(pose.rotation_vector / angle)
                                                            : Eigen::Vector3d::UnitX())
                            .toRotationMatrix();
        auto& placed = in_head.emplace_back();
        for (std::size_t k = 0; k < point_count; ++k)
            placed[k] = head_from_camera * (points_mm[k] - pose.translation_mm);
        const Eigen::Vector3d middle = 0.5 * (placed[right_eye] + placed[left_eye]);
        for (std::size_t axis = 0; axis < 3; ++axis) middles[axis].push_back(middle[static_cast<Eigen::Index>(axis)]);
    }
    if (in_head.empty()) return;
    const Eigen::Vector3d origin(base::median(middles[0]), base::median(middles[1]), base::median(middles[2]));
    std::size_t next = 0;
    for (auto& frame : motion.frames) {
        if (frame.state == TrackState::lost) continue;
        const auto& solid = solids_[next];
        const auto& placed = in_head[next++];
        const double angle = solid.pose.rotation_vector.norm();
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(
                angle, angle > 0 ? Eigen::Vector3d(solid.pose.rotation_vector / angle) : Eigen::Vector3d::UnitX())
                .toRotationMatrix() *
            half_turn;
        const Eigen::AngleAxisd as_vector(turn);
        frame.camera_from_head =
            HeadPose{as_vector.angle() * as_vector.axis(), solid.pose.translation_mm + turn * origin};
        for (std::size_t k = 0; k < motion.names.size(); ++k) {
            auto& sample = frame.features[k];
            sample.valid = true;
            sample.head_mm = placed[static_cast<std::size_t>(face_features()[k].point68)] - origin;
        }
    }
}

}  // namespace

LandmarkTable decode_openface_csv(std::string_view text, const std::string& name, const LandmarkTableOptions& options) {
    options.check();
    return OpenFaceReader(text, name, options).read();
}

MotionTableFormat motion_table_format(std::string_view text, const std::string& name) {
    base::LineReader lines(text, name);
    if (!lines.next_not_blank()) throw InputError(fmt::format("{}: the file is empty; give a table of motion", name));
    auto line = base::trimmed(lines.line());
    if (line.starts_with("# mimik motion")) return MotionTableFormat::features;
    while (line.starts_with('#') && lines.next_not_blank()) line = base::trimmed(lines.line());
    std::vector<std::string> header;
    base::split_csv_line(lines, header);
    const auto has = [&](std::string_view title) {
        return std::find(header.begin(), header.end(), title) != header.end();
    };
    if (base::equal_ignoring_case(header[0], "Timecode")) return MotionTableFormat::live_link;
    if (has("success") && has("x_0")) return MotionTableFormat::openface;
    if (has("detected") && has("x0")) return MotionTableFormat::points68;
    throw InputError(
        fmt::format("{}: {} is no header of a motion; tables are those of 'mimik capture' (# mimik motion, schema 1), "
                    "68 points (frame,detected,x0,y0,...), OpenFace (success, x_0, ...) and Live Link Face "
                    "(Timecode,BlendShapeCount,...)",
                    name, base::in_quotes(lines.line())));
}

}  // namespace mimik::capture
