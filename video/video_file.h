#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "io/image.h"

namespace mimik::video {

/// OpenCV's functions stay on the thread that calls them.
void use_one_thread();

/// OpenCV and FFmpeg keep to themselves what they find odd in a file; OPENCV_LOG_LEVEL and OPENCV_FFMPEG_LOGLEVEL in
/// the environment say otherwise. Before any thread.
void silence_decoders();

/// The number of a camera ("0"), or its device ("/dev/video0").
[[nodiscard]] bool names_a_camera(const std::string& source);

/// A video file or a camera, frame after frame, by what OpenCV decodes.
class VideoReader {
public:
    /// @param source  a file, or the number of a camera ("0"), or its device ("/dev/video0")
    /// @throws InputError if it is missing, no video, or has a codec that OpenCV does not decode
    explicit VideoReader(const std::string& source);
    ~VideoReader();

    /// False at the end, or where the rest cannot be decoded.
    [[nodiscard]] bool next(io::Image& frame);
    [[nodiscard]] double rate_hz() const;  ///< 30 where the file does not say
    [[nodiscard]] long frames() const;     ///< as the file says; 0: it does not, or it is a camera
    [[nodiscard]] bool is_camera() const;
    /// When the last frame is shown, as the file says; none: it does not say.
    [[nodiscard]] std::optional<double> time_s() const;
    /// Since the first call of next(): frames but that one, and the time that they took to come.
    [[nodiscard]] std::pair<long, double> frames_and_seconds() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// What is to be said where frames came at another rate than their source says, which rows and videos go by; none where
/// both agree within a twentieth, or a second has not passed.
[[nodiscard]] std::optional<std::string> rate_remark(long frames, double seconds, double said_hz);
/// The same of a camera; none of a file, whose frames come as fast as they are asked for.
[[nodiscard]] std::optional<std::string> camera_rate_remark(const VideoReader& reader);

/// An MP4 (MPEG-4 part 2, which every OpenCV writes). The file is there under its name when finish() has run; until
/// then frames go into a temporary beside it (base/temporary.h), which touches nobody's file.
class VideoWriter {
public:
    /// @throws InputError if the name does not end in .mp4 or is a folder's, or nothing can be written there
    VideoWriter(const std::filesystem::path& file, double rate_hz);
    ~VideoWriter();
    /// All frames have the size of the first; an odd last row or column is left out.
    void add(const io::Image& frame);
    /// @throws InputError if the file would not hold every frame, such as on a full disk; what has its name is kept
    void finish();

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mimik::video
