#include "video/track_video.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <fstream>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "video/curve_picture.h"
#include "video/video_file.h"

namespace mimik::video {
namespace {

const Eigen::Vector2d half_pixel(0.5, 0.5);  // motion.csv has the first pixel's middle at (0.5, 0.5)

// What decode_feature_motion() accepts; NaN is outside.
bool fits_motion(const capture::HeadPose& pose) {
    constexpr double farthest_head_mm = 1e5, most_turn_rad = 100;
    return pose.rotation_vector.allFinite() && pose.rotation_vector.cwiseAbs().maxCoeff() <= most_turn_rad &&
           pose.translation_mm.allFinite() && pose.translation_mm.cwiseAbs().maxCoeff() <= farthest_head_mm;
}
bool fits_motion(const Pixel& pixel, const geometry::Point& head_mm) {
    constexpr double farthest_feature_mm = 1e3, most_pixels = 1e6;
    return head_mm.allFinite() && head_mm.cwiseAbs().maxCoeff() <= farthest_feature_mm && pixel.allFinite() &&
           pixel.cwiseAbs().maxCoeff() <= most_pixels;
}

/// What this thread has taken of the processor: decoders have threads of their own.
double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Rows of one video.
class Rows {
public:
    Rows(std::ostream& motion, std::ostream* landmarks, double rate_hz, int width, int height,
         const TrackVideoOptions& options)
        : motion_(motion), landmarks_(landmarks), rate_hz_(rate_hz), width_(width), height_(height), options_(options) {
        std::vector<std::string> names;
        for (const auto& feature : capture::face_features()) names.emplace_back(feature.name);
        motion_ << capture::feature_motion_header(names, rate_hz);
        if (landmarks_) *landmarks_ << landmarks68_header();
        filters_.assign(3 * names.size() + 6, OneEuroFilter(rate_hz, options.one_euro));
    }

    void add(const std::optional<TrackedFace>& face) {
        waiting_.push_back(face);
        const long frame = written_ + static_cast<long>(waiting_.size()) - 1;
        if (head_ || frame < options_.neutral_to) {
            if (head_) flush();
            return;
        }
        fit_head();
        if (head_) flush();
        // Nobody was there yet: the first face that comes is taken for neutral.
        while (!head_ && waiting_.size() > 1) write_lost_front();
    }

    /// @returns whether there ever was a face
    bool finish() {
        if (!head_) fit_head();
        if (head_) flush();
        while (!waiting_.empty()) write_lost_front();
        return head_.has_value();
    }
    [[nodiscard]] bool late_neutral() const { return late_neutral_; }
    [[nodiscard]] long tracked() const { return tracked_; }            ///< rows
    [[nodiscard]] long without_pose() const { return without_pose_; }  ///< rows lost though a face was seen

private:
    static Points68 points_of(const TrackedFace& face) {
        Points68 points;
        points.fill(Pixel::Zero());
        if (face.points) return *face.points;
        points_on_curves(face.curves, points);
        return points;
    }
    static Known68 known_of(const TrackedFace& face) {
        if (!face.points) return known_on_curves();
        Known68 all{};
        all.fill(true);
        return all;
    }

    void fit_head() {
        Points68 sum;
        sum.fill(Pixel::Zero());
        Known68 known{};
        double count = 0;
        const auto add_face = [&](const TrackedFace& face) {
            const auto points = points_of(face);
            for (std::size_t k = 0; k < 68; ++k) sum[k] += points[k];
            known = known_of(face);
            ++count;
        };
        for (std::size_t k = 0; k < waiting_.size(); ++k) {
            const long frame = written_ + static_cast<long>(k);
            if (waiting_[k] && frame >= options_.neutral_from && frame <= options_.neutral_to) add_face(*waiting_[k]);
        }
        if (count == 0)
            for (const auto& face : waiting_)
                if (face && count == 0) {
                    add_face(*face);
                    late_neutral_ = true;
                }
        if (count == 0) return;
        for (auto& p : sum) p /= count;
        head_.emplace(sum, known, width_, height_, options_.camera);
    }

    void flush() {
        for (; !waiting_.empty(); waiting_.pop_front()) write(waiting_.front());
    }
    void write_lost_front() {
        write(std::nullopt);
        waiting_.pop_front();
    }

    double smooth(std::size_t k, double value) { return options_.smooth ? filters_[k](value) : value; }

    void write(const std::optional<TrackedFace>& face) {
        const auto features = capture::face_features();
        capture::FeatureFrame row;
        row.time_s = static_cast<double>(written_) / rate_hz_;
        row.features.resize(features.size());
        std::optional<Points68> points;
        std::optional<capture::HeadPose> pose;
        if (face && head_) {
            points = points_of(*face);
            pose = head_->pose(*points, last_pose_);
            if (pose && !fits_motion(*pose)) pose.reset();
            if (!pose) ++without_pose_;
        }
        last_pose_ = pose;  // as it was measured: a smoothed pose lags, and rays through it miss
        if (pose) {
            const auto known = known_of(*face);
            head_->fill(*points, known, *pose);
            auto written_pose = *pose;
            for (int a = 0; a < 3; ++a) {
                auto& shift = written_pose.translation_mm[a];
                auto& turn = written_pose.rotation_vector[a];
                shift = smooth(static_cast<std::size_t>(a), shift);
                turn = smooth(static_cast<std::size_t>(3 + a), turn);
            }
            ++tracked_;
            row.state = capture::TrackState::tracked;
            row.confidence = face->confidence >= 0 ? std::min(face->confidence, 1.0) : 0;
            row.camera_from_head = written_pose;
            for (std::size_t f = 0; f < features.size(); ++f) {
                const auto k = static_cast<std::size_t>(features[f].point68);
                if (!known[k]) continue;
                const Pixel pixel = (*points)[k] + half_pixel;
                const auto head_mm = head_->head_point_mm(k, (*points)[k], *pose);
                if (!fits_motion(pixel, head_mm)) continue;  // a ray along its plane
                auto& sample = row.features[f];
                sample.valid = sample.in_image = true;
                sample.pixel = pixel;
                sample.head_mm = head_mm;
                for (int a = 0; a < 3; ++a)
                    sample.head_mm[a] = smooth(6 + 3 * f + static_cast<std::size_t>(a), sample.head_mm[a]);
            }
        } else {
            points.reset();
            for (auto& filter : filters_) filter.restart();
        }
        motion_ << capture::feature_motion_row(static_cast<std::size_t>(written_), row);
        if (landmarks_) *landmarks_ << landmarks68_row(written_, points);
        ++written_;
    }

    std::ostream& motion_;
    std::ostream* landmarks_;
    double rate_hz_;
    int width_, height_;
    const TrackVideoOptions& options_;
    std::deque<std::optional<TrackedFace>> waiting_;
    std::optional<FittedHead> head_;
    std::optional<capture::HeadPose> last_pose_;
    std::vector<OneEuroFilter> filters_;
    long written_ = 0, tracked_ = 0, without_pose_ = 0;
    bool late_neutral_ = false;
};

/// Calls use(stream) for a file that is written at the end, or use(nullptr) for none.
void with_file(const std::filesystem::path& file, const std::function<void(std::ostream*)>& use) {
    if (file.empty()) return use(nullptr);
    base::write_atomically(file, [&](std::ostream& out) { use(&out); });
}

/// How far the times of a file are from those of a steady rate. The second frame is the start: of the first, some
/// files say when it was decoded, not when it is shown.
class FrameTimes {
public:
    explicit FrameTimes(double rate_hz) : rate_hz_(rate_hz) {}
    void add(std::optional<double> time_s) {
        const long frame = frame_++;
        if (frame == 0 || !time_s) return;
        const double shift_s = *time_s - static_cast<double>(frame) / rate_hz_;
        if (!std::exchange(started_, true)) start_s_ = shift_s;
        worst_s_ = std::max(worst_s_, std::abs(shift_s - start_s_));
    }
    [[nodiscard]] double worst_s() const { return worst_s_; }

private:
    double rate_hz_, worst_s_ = 0, start_s_ = 0;
    bool started_ = false;
    long frame_ = 0;
};

/// Writes what waits, and tells the report.
void say_of_rows(Rows& rows, TrackVideoReport& report) {
    if (!rows.finish()) report.remarks.emplace_back("no face was found in any frame: every row is lost");
    if (rows.late_neutral())
        report.remarks.emplace_back(
            "no face was found in the neutral frames: the first face that was found is taken for neutral");
    report.tracked = rows.tracked();
    if (rows.without_pose() > 0)
        report.remarks.push_back(fmt::format("the head had no pose in {} in which a face was seen: these rows are lost",
                                             base::counted(static_cast<std::size_t>(rows.without_pose()), "frame")));
}

void follow(VideoReader& reader, FeatureTracker& tracker, std::ostream& motion, std::ostream* landmarks,
            const TrackVideoFiles& files, const TrackVideoOptions& options, TrackVideoReport& report) {
    io::Image frame;
    std::optional<Rows> rows;
    std::optional<VideoWriter> video;
    FrameTimes times(report.rate_hz);
    if (!files.video.empty()) video.emplace(files.video, report.rate_hz);
    ContactSheet sheet;
    const long said = options.most_frames > 0 && reader.frames() > 0 ? std::min(options.most_frames, reader.frames())
                                                                     : std::max(options.most_frames, reader.frames());
    const long every = std::max(1L, said > 0 ? said / 20 : 30);
    while ((options.most_frames == 0 || report.frames < options.most_frames) && reader.next(frame)) {
        if (!rows) rows.emplace(motion, landmarks, report.rate_hz, frame.width, frame.height, options);
        const double begun_s = thread_seconds();
        const auto face = tracker.next(frame);
        report.seconds += thread_seconds() - begun_s;
        rows->add(face);
        times.add(reader.time_s());
        if (face && face->found_anew) ++report.found_anew;
        if (!files.sheet.empty() && report.frames % every == 0)
            sheet.add(
                frame, face,
                face ? fmt::format("{}  {:.2f}", report.frames, face->confidence) : std::to_string(report.frames));
        ++report.frames;
        if (!video) continue;
        draw_face(frame, face);
        video->add(frame);
    }
    if (rows) say_of_rows(*rows, report);
    if (!reader.is_camera() && times.worst_s() > 0.5 / report.rate_hz)
        report.remarks.push_back(fmt::format(
            "the file's own times differ by up to {:.3f} s from {:g} frames a second, which the rows go by: "
            "make its rate constant (ffmpeg -i IN -vsync cfr OUT.mp4)",
            times.worst_s(), report.rate_hz));
    if (video) video->finish();
    if (!files.sheet.empty()) io::write_png(files.sheet, sheet.image());
    if (reader.frames() > report.frames + 2 && options.most_frames == 0)
        report.remarks.push_back(fmt::format("the file promises {} frames, {} can be decoded: it may be damaged",
                                             reader.frames(), report.frames));
}

}  // namespace

void TrackVideoOptions::check() const {
    constexpr int most_waiting = 1000;  // rows that wait for the neutral frames are kept in memory
    camera.check();
    one_euro.check();
    if (neutral_from < 0 || neutral_to < neutral_from || neutral_to >= most_waiting)
        throw InputError(fmt::format("neutral frames are {} to {}; give two frames A:B with 0 <= A <= B < {}",
                                     neutral_from, neutral_to, most_waiting));
    if (most_frames < 0) throw InputError(fmt::format("most_frames is {}; give 0 or more", most_frames));
}

TrackVideoReport track_video(const std::string& source, FeatureTracker& tracker, const TrackVideoFiles& files,
                             const TrackVideoOptions& options) {
    options.check();
    if (options.most_frames == 0 && names_a_camera(source))
        throw InputError(fmt::format(
            "camera {}: never ends, and no number of frames is given; say how many, such as --frames 300", source));
    VideoReader reader(source);
    TrackVideoReport report;
    report.rate_hz = reader.rate_hz();
    base::write_atomically(files.motion, [&](std::ostream& motion) {
        with_file(files.landmarks68,
                  [&](std::ostream* landmarks) { follow(reader, tracker, motion, landmarks, files, options, report); });
    });
    for (auto& remark : report.remarks) remark = fmt::format("{}: {}", source, remark);
    return report;
}

std::string landmarks68_header() {
    std::string line = "frame,detected";
    for (int k = 0; k < 68; ++k) line += fmt::format(",x{0},y{0}", k);
    return line + "\n";
}

std::string landmarks68_row(long frame, const std::optional<Points68>& points) {
    std::string line = fmt::format("{},{}", frame, points ? 1 : 0);
    for (std::size_t k = 0; k < 68; ++k)
        line += points ? fmt::format(",{:.2f},{:.2f}", (*points)[k].x(), (*points)[k].y()) : std::string(",,");
    return line + "\n";
}

std::vector<LabelledRow> read_landmarks68(const std::filesystem::path& file, std::size_t most_rows) {
    const auto text = base::read_text(file);
    base::CsvReader csv(text, file.string());
    const auto frame = csv.column("frame"), detected = csv.column("detected");
    std::array<std::size_t, 136> columns{};
    for (std::size_t k = 0; k < 136; ++k) columns[k] = csv.column(fmt::format("{}{}", k % 2 ? 'y' : 'x', k / 2));
    std::vector<LabelledRow> rows;
    while (rows.size() < most_rows && csv.next()) {
        if (csv.number(detected) == 0) continue;
        const double number = csv.number(frame);
        if (!(number >= 0 && number < 1e9 && number == std::floor(number)))
            csv.fail(fmt::format("frame is {}; give a whole number from 0 on", number));
        LabelledRow row{static_cast<long>(number), {}};
        for (std::size_t k = 0; k < 68; ++k)
            row.points[k] = {csv.number(columns[2 * k]), csv.number(columns[2 * k + 1])};
        rows.push_back(row);
    }
    return rows;
}

}  // namespace mimik::video
