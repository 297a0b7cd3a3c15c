#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "animation/expression_mapping.h"
#include "animation/facial_examples.h"
#include "animation/wires.h"
#include "capture/feature_motion.h"
#include "cli/command.h"
#include "io/mesh_io.h"

// What 'mimik perform' writes.

namespace mimik::cli {

/// A character and its weights over time; a column of the weights per example of the character.
struct Performance {
    animation::FacialExamples character;
    Eigen::MatrixXd weights;
    std::vector<double> times_s;
    double rate_hz = 30.0;
    const animation::WireExamples* wires = nullptr;  ///< blended in the place of vertices; null: vertices are
    int picture_size = 480;                          ///< pixels
    io::MadeBy made_by;
};

/// Finds out before the work what cannot be written. @throws InputError for a format that is not known, or a video
/// where nobody can write one.
void check_performance_output(const std::filesystem::path& output);

/// Finds out before the work whether a video can stand beside a performance of so many frames.
/// @returns how high the pictures beside it are, pixels. @throws InputError naming --video
[[nodiscard]] int check_clip(const std::filesystem::path& clip, const std::filesystem::path& output,
                             std::size_t frames);

/// The performer in the video: the clip (empty: not in it) and the motion that was captured from it.
struct PerformerVideo {
    std::filesystem::path clip;
    const capture::FeatureMotion* motion = nullptr;
};

/// .glb (morph targets whose weights move), .mp4 (by mimik-video) or a folder of pictures frame_000000.png, ...
/// @param performances  at least one; what is no video shows the first alone
/// @return remarks
[[nodiscard]] std::vector<std::string> write_performance(const std::filesystem::path& output,
                                                         const std::vector<Performance>& performances,
                                                         const PerformerVideo& performer, const Common& common);

}  // namespace mimik::cli
