#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/types.h"

namespace mimik::capture {

using geometry::Point;

/// Where some markers were, frame after frame, at a constant rate: what a motion capture system records. Millimetres,
/// in the frame of the laboratory, which need not be that of a face (often z points up).
class MarkerSequence {
public:
    MarkerSequence() = default;
    /// Every sample is missing. @param first_frame  number of the first frame, as files count: mostly 1
    /// @throws InputError if a name is empty or there twice, or if the rate is not positive and finite.
    MarkerSequence(std::vector<std::string> names, double rate_hz, std::size_t frames, std::int64_t first_frame = 1);

    [[nodiscard]] std::span<const std::string> names() const { return names_; }  ///< as the file has them
    [[nodiscard]] std::size_t markers() const { return names_.size(); }
    [[nodiscard]] std::size_t frames() const { return frames_; }
    [[nodiscard]] double rate_hz() const { return rate_hz_; }
    [[nodiscard]] std::int64_t first_frame() const { return first_frame_; }

    [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
    /// @throws InputError with the nearest names, if there is no marker of that name.
    [[nodiscard]] std::size_t index(const std::string& name) const;

    /// Whether the marker was seen (or filled in) in that frame, counted from 0.
    [[nodiscard]] bool valid(std::size_t frame, std::size_t marker) const {
        return valid_[frame * markers() + marker] != 0;
    }
    /// (0, 0, 0) where it is not valid; ask valid(), since a marker may be at the origin.
    [[nodiscard]] const Point& at_mm(std::size_t frame, std::size_t marker) const {
        return positions_mm_[frame * markers() + marker];
    }
    /// All markers of a frame.
    [[nodiscard]] std::span<const Point> frame_mm(std::size_t frame) const {
        return std::span(positions_mm_).subspan(frame * markers(), markers());
    }
    void set(std::size_t frame, std::size_t marker, const Point& position_mm) {
        positions_mm_[frame * markers() + marker] = position_mm;
        valid_[frame * markers() + marker] = 1;
    }
    void set_missing(std::size_t frame, std::size_t marker) {
        positions_mm_[frame * markers() + marker] = Point::Zero();
        valid_[frame * markers() + marker] = 0;
    }

    /// How well the cameras agreed about a sample, where the file says so (C3D); 0: it was interpolated or computed.
    [[nodiscard]] bool has_residuals() const { return !residuals_mm_.empty(); }
    [[nodiscard]] float residual_mm(std::size_t frame, std::size_t marker) const {
        return residuals_mm_.empty() ? 0.0F : residuals_mm_[frame * markers() + marker];
    }
    void set_residual_mm(std::size_t frame, std::size_t marker, float residual_mm);

    [[nodiscard]] std::size_t valid_count(std::size_t marker) const;

    friend bool operator==(const MarkerSequence&, const MarkerSequence&) = default;

private:
    std::vector<std::string> names_;
    double rate_hz_ = 1;
    std::size_t frames_ = 0;
    std::int64_t first_frame_ = 1;
    std::vector<Point> positions_mm_;  ///< [frame * markers + marker]
    std::vector<std::uint8_t> valid_;
    std::vector<float> residuals_mm_;  ///< empty: the file has none
};

/// Frames in a row, counted from 0, in which a marker is missing.
struct MarkerGap {
    std::size_t marker = 0, first = 0, last = 0;
};
/// In the order of the markers, then of the frames.
[[nodiscard]] std::vector<MarkerGap> gaps(const MarkerSequence& sequence);

/// The frames first to last, numbered as the file numbers them, both among them. @throws InputError if there are no
/// such frames.
[[nodiscard]] MarkerSequence frames_between(const MarkerSequence& sequence, std::int64_t first, std::int64_t last);

/// These markers in this order. @throws InputError naming one that there is not, or that is asked for twice.
[[nodiscard]] MarkerSequence with_markers(const MarkerSequence& sequence, std::span<const std::string> names);

}  // namespace mimik::capture
