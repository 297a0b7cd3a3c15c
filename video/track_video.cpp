#include "video/track_video.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "video/curve_picture.h"
#include "video/feature_rows.h"
#include "video/video_file.h"

namespace mimik::video {
namespace {

/// What this thread has taken of the processor: decoders have threads of their own.
double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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

void follow(VideoReader& reader, FeatureTracker& tracker, std::ostream& motion, std::ostream* landmarks,
            const TrackVideoFiles& files, const TrackVideoOptions& options, TrackVideoReport& report) {
    std::vector<std::string> names;
    for (const auto& feature : capture::face_features()) names.emplace_back(feature.name);
    motion << capture::feature_motion_header(names, report.rate_hz);
    if (landmarks) *landmarks << landmarks68_header();
    const auto write_row = [&](const FeatureRows::Row& row) {
        motion << capture::feature_motion_row(static_cast<std::size_t>(row.frame), row.features);
        if (landmarks) *landmarks << landmarks68_row(row.frame, row.points);
    };
    io::Image frame;
    std::optional<FeatureRows> rows;
    std::optional<VideoWriter> video;
    FrameTimes times(report.rate_hz);
    if (!files.video.empty()) video.emplace(files.video, report.rate_hz);
    ContactSheet sheet;
    const long said = options.most_frames > 0 && reader.frames() > 0 ? std::min(options.most_frames, reader.frames())
                                                                     : std::max(options.most_frames, reader.frames());
    const long every = std::max(1L, said > 0 ? said / 20 : 30);
    while ((options.most_frames == 0 || report.frames < options.most_frames) && reader.next(frame)) {
        if (!rows) rows.emplace(report.rate_hz, frame.width, frame.height, options, write_row);
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
    if (rows) {
        report.remarks = finish_rows(*rows);
        report.tracked = rows->tracked();
    }
    if (auto remark = camera_rate_remark(reader)) report.remarks.push_back(std::move(*remark));
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
    camera.check();
    one_euro.check();
    if (neutral_from < 0 || neutral_to < neutral_from || neutral_to >= most_waiting_frames)
        throw InputError(fmt::format("neutral frames are {} to {}; give two frames A:B with 0 <= A <= B < {}",
                                     neutral_from, neutral_to, most_waiting_frames));
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
