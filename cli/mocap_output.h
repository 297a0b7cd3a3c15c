#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/marker_sequence.h"
#include "cli/command.h"
#include "cli/mocap_target.h"

// Where an animation goes: a folder of meshes, one GLB, a video, a contact sheet.

namespace mimik::cli {

/// A recording on a rig: every frame moves every vertex.
class MocapMotion {
public:
    /// @param markers  on the target, with those of the rig; a sample that is missing holds still where it was last
    MocapMotion(const MocapRig& rig, const capture::MarkerSequence& markers);

    [[nodiscard]] const MocapRig& rig() const { return rig_; }
    [[nodiscard]] std::size_t frames() const { return markers_.frames(); }
    [[nodiscard]] double rate_hz() const { return markers_.rate_hz(); }
    [[nodiscard]] std::int64_t number(std::size_t frame) const {
        return markers_.first_frame() + static_cast<std::int64_t>(frame);
    }
    [[nodiscard]] std::size_t held() const { return held_; }  ///< samples
    [[nodiscard]] std::span<const geometry::Point> markers_mm(std::size_t frame) const {
        return markers_.frame_mm(frame);
    }
    void displace(std::size_t frame, std::span<geometry::Vector> displacement_mm) const;

private:
    const MocapRig& rig_;
    capture::MarkerSequence markers_;
    std::size_t held_ = 0;
};

/// What was written, in words.
struct MocapWritten {
    std::string what;
    std::optional<double> bound_mm, rms_mm;  ///< of a GLB: what its components lose
    std::size_t components = 0;
    std::vector<std::string> remarks;
};

/// frame_000123.vtp (or .ply) for every frame that is asked for, with `displacement_mm` per vertex.
[[nodiscard]] MocapWritten write_meshes(const std::filesystem::path& folder, const std::string& extension,
                                        const MocapMotion& motion, std::size_t every, const Common& common);
/// One file whose morph weights move. @throws InputError if it cannot be written.
[[nodiscard]] MocapWritten write_moving_glb(const std::filesystem::path& file, const MocapMotion& motion,
                                            std::size_t every, std::size_t components);
/// Pictures by mimik-figure, and mimik-video makes them a video. @throws InputError if either is not there.
[[nodiscard]] MocapWritten write_mocap_video(const std::filesystem::path& file, const MocapMotion& motion,
                                             std::size_t every, const Common& common);
/// The strengths of AUs as a table of Live Link Face. @throws InputError if the method knows none.
[[nodiscard]] MocapWritten write_live_link(const std::filesystem::path& file, const MocapMotion& motion,
                                           std::size_t every);
/// Evenly spaced frames: above the markers of the recording as their control surface, below the face.
/// @param source  as recorded, the head's motion taken off
[[nodiscard]] MocapWritten write_sheet(const std::filesystem::path& picture, const MocapMotion& motion,
                                       const capture::MarkerSequence& source, const capture::MarkerSet& set,
                                       std::size_t panels);

}  // namespace mimik::cli
