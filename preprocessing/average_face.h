#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "geometry/landmarks.h"
#include "geometry/quad_grid.h"
#include "preprocessing/face.h"

namespace mimik::preprocessing {

struct AverageFaceOptions {
    int rows = 150, cols = 150;  ///< as the scans (thesis 5.4)
    double half_width = 0.82;    ///< crop, in outer-eye distances: cheeks to the ears, without them
    double above_eyes = 0.85;    ///< to the hairline
    double below_chin = 0.18;    ///< the chin's underside turns away from the scanner
    double min_share = 0.5;      ///< a cell counts where at least this share of the faces was measured
    int max_iterations = 50;     ///< of the Procrustes consensus
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("rows", self.rows);
        visit("cols", self.cols);
        visit("half_width", self.half_width);
        visit("above_eyes", self.above_eyes);
        visit("below_chin", self.below_chin);
        visit("min_share", self.min_share);
        visit("max_iterations", self.max_iterations);
    }
    void check() const;
};
static_assert(base::lists_every_field<AverageFaceOptions>());

/// The average face model: nose tip at the origin, frontal, mm.
struct AverageFace {
    geometry::QuadGrid grid;
    geometry::Landmarks landmarks;   ///< the consensus
    std::vector<std::string> scans;  ///< the neutrals that went in
    double consensus_rms_mm = 0.0;   ///< of the subjects' landmarks about the consensus, after similarity alignment
};

/// Consensus of landmark sets: generalised Procrustes (Gower 1975), rigid with mean size kept, then made frontal: the
/// mean orientation of the input, mirror-symmetric about x = 0, nose tip at the origin. Landmarks that fewer than half
/// of the sets have are left out. @throws InputError if fewer than 2 sets, or fewer than 4 landmarks, remain.
[[nodiscard]] geometry::Landmarks consensus_landmarks(std::span<const geometry::Landmarks> sets,
                                                      int max_iterations = 50, double* rms_mm = nullptr);

/// After Salah et al. (2007), as the thesis describes it in 5.3: every face is carried to the consensus landmarks by a
/// thin-plate spline, cropped, its depth sampled on a regular x-y grid, and the depths averaged; where not all faces
/// were measured their slopes are averaged and integrated, so that none leaves a step where it ends. Holes inside the
/// face (brows and eyes that few scans show) are bridged and marked so; the outline is the same on both sides.
/// @param load  gives face k of `count` (one neutral per subject); called from several threads, once per face.
[[nodiscard]] AverageFace build_average_face(std::size_t count, const std::function<Face(std::size_t)>& load,
                                             const geometry::Landmarks& consensus,
                                             const AverageFaceOptions& options = {});

void write_average_face(const std::filesystem::path& stem, const AverageFace& average, const std::string& fingerprint);
/// Whether both files are as they were written, to the last bit.
[[nodiscard]] bool average_face_is_whole(const std::filesystem::path& stem);
[[nodiscard]] AverageFace read_average_face(const std::filesystem::path& stem, std::string* fingerprint = nullptr);
/// What stands in the .json; of the grid, its rows and cols alone. `name` stands for the file. @throws InputError.
[[nodiscard]] AverageFace decode_average_face(std::string_view text, const std::string& name,
                                              std::string* fingerprint = nullptr);

}  // namespace mimik::preprocessing
