#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "io/body_frame.h"

namespace mimik::io {

/// Units of a file that does not state them; Mimik works in millimetres and converts here, at the reader.
enum class LengthUnit { millimetre, centimetre, metre, inch };
[[nodiscard]] LengthUnit parse_length_unit(const std::string& text);  ///< "mm", "cm", "m", "inch"; throws InputError
[[nodiscard]] const char* to_string(LengthUnit unit);                 ///< "mm", "cm", "m", "inch"
[[nodiscard]] double millimetres_per(LengthUnit unit);

enum class MeshFormat { ply, obj, stl, pcd, vtp };
/// By extension, case ignored. @throws InputError listing the extensions there are.
[[nodiscard]] MeshFormat mesh_format(const std::filesystem::path& file);

/// PLY (ASCII, both binaries), OBJ (polygons, vt, vertex colours, negative indices), STL (both, welded), PCD v0.7
/// (ascii, binary, binary_compressed), VTP (inline or appended arrays, with or without zlib). By extension, case
/// ignored; header and sizes are checked against the length of the file before anything is allocated. Normals are not
/// read: they follow from the faces. Further scalar values per vertex become attributes. Points that are
/// marked as not measured (NaN) and that no face uses are left out; a corner of a face must be finite. A mesh that says
/// that it is in RAS comes in LPS, the frame of those that say nothing.
/// @throws InputError naming file, line or byte, field, value and mend.
[[nodiscard]] geometry::Mesh read_mesh(const std::filesystem::path& file, LengthUnit unit = LengthUnit::millimetre);

/// Attributes can take much more memory than the surface: who has no use for them need not have them decoded.
enum class MeshParts { all, without_attributes };

/// Whether a texture's name that cannot be used is an error, or said in MeshFile::texture_error and the surface read.
enum class BadTexture { refuse, report };

/// Of a face: it has no picture.
inline constexpr std::uint32_t no_picture = std::numeric_limits<std::uint32_t>::max();

/// What a file holds beside the surface.
struct MeshFile {
    geometry::Mesh mesh;
    std::string texture_file;  ///< the image in the mesh's folder or below it ("tex/skin.png"); empty: none, or several
    std::vector<std::string> texture_files = {};    ///< all images in use, likewise
    std::vector<std::uint32_t> face_textures = {};  ///< which of them each face has, or no_picture; empty: the first
    std::vector<std::string> material_files = {};   ///< of an OBJ: where its images stand, likewise; there or not
    std::string texture_error = {};                 ///< of names that cannot be used, as the error would say it
    std::vector<std::string> remarks = {};  ///< what was left out or taken otherwise than written, with the file
    int rows = 0;  ///< of a PCD with HEIGHT > 1, in the file's order; its NaN points are then still in `mesh`
    int cols = 0;
    std::optional<BodyFrame> frame = {};  ///< where the file states it ("SPACE=RAS"); the coordinates are as written
};
/// read_mesh with the names of the texture images (PLY: comments TextureFile, faces' `texnumber`; OBJ: map_Kd of the
/// materials in use) and a PCD's lattice. A name from another machine is looked for beside the mesh (find_beside); an
/// OBJ's -s and -o are applied to the texture positions.
/// @throws InputError also where a texture's name leads out of the mesh's folder and no such file is beside it
/// (BadTexture::refuse).
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& file, LengthUnit unit = LengthUnit::millimetre,
                                      MeshParts parts = MeshParts::all, BadTexture bad_texture = BadTexture::refuse);

/// The same from memory; `name` stands for the file in messages. Names of textures are as written: `texture_files` are
/// those of a PLY, of an OBJ the names of its materials.
[[nodiscard]] MeshFile decode_mesh(MeshFormat format, std::span<const std::uint8_t> bytes, const std::string& name,
                                   LengthUnit unit = LengthUnit::millimetre, MeshParts parts = MeshParts::all);

/// Leaves out the points that are marked as not measured (NaN), a lattice with them, and says so with their number. No
/// face may use one. @throws InputError if none is left.
void drop_unmeasured(MeshFile& file, const std::string& name);

/// Brings a mesh that says that it is in RAS into LPS, with a remark that begins with `name`.
void bring_to_lps(MeshFile& file, const std::string& name);

/// What made a mesh: names and values, such as "source" and "bs003".
using MadeBy = std::vector<std::pair<std::string, std::string>>;

struct MeshWriteOptions {
    std::string texture_file;  ///< image beside the mesh, named in OBJ's MTL and PLY's comment; empty: none
    bool binary = true;        ///< PLY and STL; false: readable text
    std::vector<std::string> texture_files = {};    ///< several images in place of texture_file
    std::vector<std::uint32_t> face_textures = {};  ///< as in MeshFile
    MadeBy made_by = {};                            ///< kept as comments (PLY, OBJ) or field data (VTP)
    std::optional<BodyFrame> frame = {};            ///< stated as Slicer does, "SPACE=RAS"; nothing: not stated

    static constexpr std::size_t unlisted = 1;  // made_by
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("texture_file", self.texture_file);
        visit("binary", self.binary);
        visit("texture_files", self.texture_files);
        visit("face_textures", self.face_textures);
        visit("frame", self.frame);
    }
};

/// PLY (double precision, attributes as extra properties), OBJ (17 digits), STL (single precision, triangles), VTP
/// (attributes as point data), by extension. Faces, texture coordinates and colours are kept where the format can hold
/// them; docs/formats.md says what each leaves out. OBJ with a texture also writes the .mtl beside it.
/// An attribute whose name the format cannot hold (blanks in PLY, names of coordinates) is renamed.
/// @return what was left out or renamed, with the file's name.
/// @throws InputError if the parts of the mesh do not fit together, or the file cannot be written.
std::vector<std::string> write_mesh(const std::filesystem::path& file, const geometry::Mesh& mesh,
                                    const MeshWriteOptions& options = {});

/// The bytes of the PLY that write_mesh writes. @throws InputError as write_mesh; `name` stands for the file.
[[nodiscard]] std::string encode_ply(const geometry::Mesh& mesh, const std::string& name,
                                     const MeshWriteOptions& options = {});

/// The texture's name if it is a bare file name (a leading "./" is dropped). @throws InputError naming `file` and the
/// value where it has a folder in it.
[[nodiscard]] std::string checked_texture_name(const std::string& texture, const std::string& file);

}  // namespace mimik::io
