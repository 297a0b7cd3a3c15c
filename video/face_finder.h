#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "io/image.h"
#include "video/face_patch.h"

namespace mimik::video {

/// A face that stands upright, found by a cascade of Haar features (Viola and Jones 2001; OpenCV's frontalface_alt2
/// of Debian's opencv-data).
struct FoundFace {
    Pixel corner = Pixel::Zero();  ///< upper left, pixels of the frame
    double size_px = 0;            ///< of the square box

    /// Where the eyes of such a box usually are.
    [[nodiscard]] FacePlace place() const;
};

class FaceFinder {
public:
    /// @param cascade  empty: where Debian's opencv-data has it, or the file that MIMIK_FACE_CASCADE names
    /// @throws InputError saying which package to install
    explicit FaceFinder(const std::filesystem::path& cascade = {});
    ~FaceFinder();
    FaceFinder(FaceFinder&&) noexcept;

    /// All faces of at least a tenth of the frame's height, the largest first.
    [[nodiscard]] std::vector<FoundFace> find(const io::Image& frame);
    /// Whether there is a face where one was, give or take a sixth of its size.
    [[nodiscard]] bool sees(const io::Image& frame, const FacePlace& place);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mimik::video
