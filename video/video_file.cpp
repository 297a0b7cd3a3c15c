#include "video/video_file.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/temporary.h"
#include "base/text.h"

namespace mimik::video {

void use_one_thread() { cv::setNumThreads(1); }

void silence_decoders() {
    // NOLINTBEGIN(concurrency-mt-unsafe): before any thread
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    if (std::getenv("OPENCV_LOG_LEVEL") == nullptr)  // which OpenCV read when it was loaded
        cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    // NOLINTEND(concurrency-mt-unsafe)
}

namespace {

bool is_camera_number(const std::string& source) {
    return !source.empty() && source.size() < 4 &&
           std::all_of(source.begin(), source.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// Frames that a file holds; 0: it cannot be read.
long frames_in(const std::filesystem::path& file) {
    try {
        cv::VideoCapture capture(file.string());
        if (!capture.isOpened()) return 0;
        const double said = capture.get(cv::CAP_PROP_FRAME_COUNT);
        if (said > 0 && said < 1e9) return std::lround(said);
        long count = 0;
        while (capture.grab()) ++count;
        return count;
    } catch (const cv::Exception&) {
        return 0;
    }
}

}  // namespace

bool names_a_camera(const std::string& source) { return is_camera_number(source) || source.starts_with("/dev/video"); }

struct VideoReader::Parts {
    std::string name;
    cv::VideoCapture capture;
    cv::Mat frame, first;
    bool camera = false;
    double time_ms = 0;
    std::chrono::steady_clock::time_point began, last;  ///< the first frame and the last were given
    long given = 0;
};

VideoReader::VideoReader(const std::string& source) : parts_(std::make_unique<Parts>()) {
    parts_->name = source;
    const bool number = is_camera_number(source);
    parts_->camera = names_a_camera(source);
    if (!parts_->camera && !base::is_there(source))
        throw InputError(fmt::format("{}: there is no such file, and no camera has that name", source));
    if (std::filesystem::is_directory(source))
        throw InputError(fmt::format("{}: is a folder; give a video file", source));
    try {
        if (number)
            parts_->capture.open(std::stoi(source));
        else if (parts_->camera)
            parts_->capture.open(source, cv::CAP_V4L2);
        else
            parts_->capture.open(source);
        if (parts_->capture.isOpened()) parts_->capture.read(parts_->first);
    } catch (const cv::Exception&) {
        parts_->first.release();
    }
    if (parts_->first.empty() && parts_->camera)
        throw InputError(fmt::format("camera {}: gives no picture; is it connected, and may you read it?", source));
    if (parts_->first.empty())
        throw InputError(
            fmt::format("{}: no frame can be decoded; it is damaged, no video, or of a codec that OpenCV does not know "
                        "(convert it: ffmpeg -i IN -c:v libx264 OUT.mp4)",
                        source));
}
VideoReader::~VideoReader() = default;

bool VideoReader::is_camera() const { return parts_->camera; }
double VideoReader::rate_hz() const {
    const double rate = parts_->capture.get(cv::CAP_PROP_FPS);
    return std::isfinite(rate) && rate >= 1 && rate <= 1000 ? rate : 30;
}
long VideoReader::frames() const {
    const double count = parts_->capture.get(cv::CAP_PROP_FRAME_COUNT);
    return !parts_->camera && count > 0 && count < 1e9 ? std::lround(count) : 0;
}

std::optional<double> VideoReader::time_s() const {
    if (!(parts_->time_ms > 0 && parts_->time_ms < 1e12)) return std::nullopt;
    return 1e-3 * parts_->time_ms;
}

bool VideoReader::next(io::Image& frame) {
    if (!parts_->first.empty()) {
        parts_->frame = parts_->first;
        parts_->first.release();
    } else {
        try {
            if (!parts_->capture.read(parts_->frame)) return false;
        } catch (const cv::Exception&) {
            return false;
        }
    }
    const auto& from = parts_->frame;
    if (from.empty() || from.depth() != CV_8U) return false;
    parts_->time_ms = parts_->capture.get(cv::CAP_PROP_POS_MSEC);
    frame.width = from.cols;
    frame.height = from.rows;
    frame.rgb.resize(3 * from.total());
    cv::Mat to(from.rows, from.cols, CV_8UC3, frame.rgb.data());
    cv::cvtColor(from, to, from.channels() == 1 ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
    parts_->last = std::chrono::steady_clock::now();
    if (parts_->given++ == 0) parts_->began = parts_->last;
    return true;
}

std::pair<long, double> VideoReader::frames_and_seconds() const {
    if (parts_->given == 0) return {0, 0};
    return {parts_->given - 1, std::chrono::duration<double>(parts_->last - parts_->began).count()};
}

std::optional<std::string> rate_remark(long frames, double seconds, double said_hz) {
    constexpr double alike = 0.05;  // a camera's clock and ours; and a frame more or less in the first second
    if (!(seconds >= 1 && said_hz > 0)) return std::nullopt;
    const double rate_hz = static_cast<double>(frames) / seconds;
    if (std::abs(rate_hz - said_hz) <= alike * said_hz) return std::nullopt;
    return fmt::format(
        "gave {:.1f} frames a second and says {:g}, which times and videos go by: motion is shown {:.2f} times as fast",
        rate_hz, said_hz, said_hz / rate_hz);
}

std::optional<std::string> camera_rate_remark(const VideoReader& reader) {
    if (!reader.is_camera()) return std::nullopt;
    const auto [frames, seconds] = reader.frames_and_seconds();
    return rate_remark(frames, seconds, reader.rate_hz());
}

struct VideoWriter::Parts {
    std::filesystem::path file, part;
    std::optional<base::TemporaryFolder> folder;  ///< of `part`: OpenCV goes by a name and its ending
    double rate_hz = 30;
    cv::VideoWriter writer;  // after the folder: closed before that is removed
    cv::Size size;
    long frames = 0;
};

VideoWriter::VideoWriter(const std::filesystem::path& file, double rate_hz) : parts_(std::make_unique<Parts>()) {
    if (!base::equal_ignoring_case(file.extension().string(), ".mp4"))
        throw InputError(fmt::format("{}: videos are written as .mp4", file.string()));
    if (!(rate_hz >= 1 && rate_hz <= 1000))
        throw InputError(fmt::format("{} frames a second; give 1 to 1000", rate_hz));
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder; name the file to write", file.string()));
    if (const auto folder = file.parent_path(); !folder.empty()) {
        std::filesystem::create_directories(folder, error);
        if (error)
            throw InputError(
                fmt::format("{}: its folder cannot be made ({}); write elsewhere", file.string(), error.message()));
    }
    try {
        parts_->folder.emplace(file.parent_path());
    } catch (const std::system_error& e) {
        throw InputError(fmt::format("{}: cannot be written ({}); check the folder's permissions", file.string(),
                                     e.code().message()));
    }
    parts_->file = file;
    parts_->part = parts_->folder->path() / "video.mp4";
    parts_->rate_hz = rate_hz;
}
VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const io::Image& frame) {
    auto& p = *parts_;
    const cv::Size size(frame.width / 2 * 2, frame.height / 2 * 2);
    if (!p.writer.isOpened()) {
        p.size = size;
        if (size.empty() ||
            !p.writer.open(p.part.string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), p.rate_hz, size))
            throw InputError(fmt::format("{}: cannot be written", p.file.string()));
    }
    if (size != p.size)
        throw InputError(fmt::format("{}: a frame of {} x {} pixels after frames of {} x {}; all must have one size",
                                     p.file.string(), size.width, size.height, p.size.width, p.size.height));
    const cv::Mat from(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.rgb.data()));  // NOLINT
    cv::Mat to;
    cv::cvtColor(from(cv::Rect(0, 0, size.width, size.height)), to, cv::COLOR_RGB2BGR);
    p.writer.write(to);
    ++p.frames;
}

void VideoWriter::finish() {
    auto& p = *parts_;
    if (!p.writer.isOpened()) throw InputError(fmt::format("{}: there is no frame to write", p.file.string()));
    p.writer.release();
    // OpenCV's writer tells of no error, not even of a full disk.
    if (const long held = frames_in(p.part); held != p.frames)
        throw InputError(fmt::format("{}: would hold {} of {} frames and was not written; is the disk full?",
                                     p.file.string(), held, p.frames));
    std::error_code error;
    std::filesystem::rename(p.part, p.file, error);
    if (error) throw InputError(fmt::format("{}: cannot be written: {}", p.file.string(), error.message()));
}

}  // namespace mimik::video
