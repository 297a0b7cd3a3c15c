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
#include "video/curve_picture.h"
#include "video/video_file.h"

namespace mimik::video {
namespace {

const Eigen::Vector2d half_pixel(0.5, 0.5);  // motion.csv has the first pixel's middle at (0.5, 0.5)

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
        if (head_ || frame + 1 < options_.neutral_to) {
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
            if (waiting_[k] && frame >= options_.neutral_from && frame < options_.neutral_to) add_face(*waiting_[k]);
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
        }
        if (pose) {
            const auto known = known_of(*face);
            head_->fill(*points, known, *pose);
            if (options_.smooth)
                for (int a = 0; a < 3; ++a) {
                    pose->translation_mm[a] = smooth(static_cast<std::size_t>(a), pose->translation_mm[a]);
                    pose->rotation_vector[a] = smooth(static_cast<std::size_t>(3 + a), pose->rotation_vector[a]);
                }
            row.state = capture::TrackState::tracked;
            row.confidence = face->confidence;
            row.camera_from_head = pose;
            for (std::size_t f = 0; f < features.size(); ++f) {
                const auto k = static_cast<std::size_t>(features[f].point68);
                if (!known[k]) continue;
                auto& sample = row.features[f];
                sample.valid = sample.in_image = true;
                sample.pixel = (*points)[k] + half_pixel;
                sample.head_mm = head_->head_point_mm(k, (*points)[k], *pose);
                for (int a = 0; a < 3; ++a)
                    sample.head_mm[a] = smooth(6 + 3 * f + static_cast<std::size_t>(a), sample.head_mm[a]);
            }
        } else {
            points.reset();
            for (auto& filter : filters_) filter.restart();
        }
        last_pose_ = pose;
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
    long written_ = 0;
    bool late_neutral_ = false;
};

/// Calls use(stream) for a file that is written at the end, or use(nullptr) for none.
void with_file(const std::filesystem::path& file, const std::function<void(std::ostream*)>& use) {
    if (file.empty()) return use(nullptr);
    base::write_atomically(file, [&](std::ostream& out) { use(&out); });
}

void follow(VideoReader& reader, FeatureTracker& tracker, std::ostream& motion, std::ostream* landmarks,
            const TrackVideoFiles& files, const TrackVideoOptions& options, TrackVideoReport& report) {
    io::Image frame;
    std::optional<Rows> rows;
    std::optional<VideoWriter> video;
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
        if (face) ++report.tracked;
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
    if (rows && !rows->finish()) report.remarks.emplace_back("no face was found in any frame: every row is lost");
    if (rows && rows->late_neutral())
        report.remarks.emplace_back(
            "no face was found in the neutral frames: the first face that was found is taken for neutral");
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
    if (neutral_from < 0 || neutral_to <= neutral_from || neutral_to > most_waiting)
        throw InputError(fmt::format("neutral frames are {} to {}; give two frames A:B with 0 <= A < B <= {}",
                                     neutral_from, neutral_to, most_waiting));
    if (most_frames < 0) throw InputError(fmt::format("most_frames is {}; give 0 or more", most_frames));
}

TrackVideoReport track_video(const std::string& source, FeatureTracker& tracker, const TrackVideoFiles& files,
                             const TrackVideoOptions& options) {
    options.check();
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
