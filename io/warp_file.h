#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "geometry/thin_plate_spline.h"
#include "io/body_frame.h"
#include "io/mesh_io.h"

namespace mimik::io {

struct WarpReport {
    std::size_t landmarks = 0;
    std::size_t points = 0;                ///< moved, in the input file
    double largest_landmark_residual = 0;  ///< |spline(from) - to|: rounding only, unless smoothing > 0
    double bending_energy = 0;
    double largest_displacement = 0;        ///< of the points of the input
    std::vector<std::string> remarks = {};  ///< what was left out or taken otherwise than written, with the file
};

/// How landmarks of two files find each other.
enum class PairBy { name, order };
[[nodiscard]] constexpr const char* to_string(PairBy pair_by) { return pair_by == PairBy::name ? "name" : "order"; }

struct WarpFileOptions {
    PairBy pair_by = PairBy::name;
    std::optional<BodyFrame> input_frame = {};  ///< of an input that states none
    MadeBy made_by = {};                        ///< kept in the output mesh (MeshWriteOptions::made_by)

    static constexpr std::size_t unlisted = 1;  // made_by
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("pair_by", self.pair_by);
        visit("input_frame", self.input_frame);
    }
};

/// Warps a file: points as CSV (name,x,y,z) or a mesh (PLY, OBJ, STL, PCD, VTP), by extension, to a file of the same or
/// another of these formats (not PCD). CSV keeps the names; points of a mesh get their number, from 0, as name. The
/// texture images of an output face.ply or face.obj are copied beside it as face_texture.<ext>, face_texture_2.<ext>,
/// ..., the image's extension. What is no image, or lies outside the input's folder where links lead, is not copied.
/// Points of the input that were not measured (NaN) are left out, with a remark.
///
/// Frames: the input's coordinates stand, and the output states the frame that the input states (LPS or RAS, as Slicer
/// does). Landmarks whose file states a frame are brought into that of the input: the one that it states, else
/// `more.input_frame`, else the one in which `from` lies on it (frame_judged_by) or, if that file states no frame, `to`
/// lies less than half as far from it, else LPS, as Slicer takes a mesh. Landmarks without a stated frame are taken as
/// written.
/// @param from, to  landmark files in any form that read_landmark_file knows.
/// @param check_texture  asked before the image that a mesh names is copied; throws to refuse it.
/// @throws InputError listing every landmark that has no partner, and where a file and the options state different
/// frames; NumericalError from the spline, and where the place of a point is not finite. Each names the files.
WarpReport warp_file(const std::filesystem::path& from, const std::filesystem::path& to,
                     const std::filesystem::path& input, const std::filesystem::path& output,
                     const geometry::ThinPlateSplineOptions& options = {},
                     const std::function<void(const std::filesystem::path&)>& check_texture = {},
                     const WarpFileOptions& more = {});

/// Whether a mesh of this format can name an image.
[[nodiscard]] bool takes_texture(const std::filesystem::path& output);

/// The bytes of an image that may be handed on: it lies with the mesh, also where links lead, and is one by its
/// content.
/// @param mesh  its name, for messages. @throws InputError saying why it is left out.
[[nodiscard]] std::string checked_image(const std::filesystem::path& image, const std::filesystem::path& folder,
                                        const std::string& mesh);

/// Copies the images that a mesh names beside an output face.ply or face.obj, as face_texture.<ext>,
/// face_texture_2.<ext>, ..., so that no other of their names is taken for them, and lets `options` name the copies.
/// What cannot be handed on is told in `remarks`. @param check_texture  as of warp_file
void copy_textures(MeshFile& file, const std::filesystem::path& input, const std::filesystem::path& output,
                   const std::function<void(const std::filesystem::path&)>& check_texture, MeshWriteOptions& options,
                   std::vector<std::string>& remarks);

}  // namespace mimik::io
