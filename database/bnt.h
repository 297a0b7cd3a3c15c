#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/range_scan.h"
#include "io/mesh_io.h"

namespace mimik::database {

/// A Bosphorus .bnt file, number for number (docs/formats.md gives the byte layout): writing what was read gives the
/// same bytes.
struct Bnt {
    std::uint16_t rows = 0;
    std::uint16_t cols = 0;
    double background = -1e9;           ///< the file's zmin: marks cells where nothing was measured
    std::string texture_file;           ///< as stored; checked to be a plain file name when converted to a scan
    std::vector<double> x, y, z, u, v;  ///< rows * cols each, row-major, row 0 lowest; v counts from the image's top
};

/// By extension, case ignored.
[[nodiscard]] bool is_bnt(const std::filesystem::path& file);
/// @throws InputError naming file, field, value: truncated, absurd sizes, 5 * rows * cols != value count, ...
[[nodiscard]] Bnt read_bnt(const std::filesystem::path& file);
[[nodiscard]] Bnt decode_bnt(std::span<const std::uint8_t> bytes, const std::string& name);
void write_bnt(const std::filesystem::path& file, const Bnt& bnt);

/// Invalid cells (any of x, y, z is the background or not finite) become NaN; texture v is turned to count from the
/// bottom. A texture's name that is no bare file name is not followed: texture_error says so, beginning with `name`.
/// @throws InputError, beginning so too, for a coordinate beyond 1e6 mm, which no scanner measures.
[[nodiscard]] geometry::RangeScan to_range_scan(const Bnt& bnt, const std::string& name,
                                                io::LengthUnit unit = io::LengthUnit::millimetre);
/// Both in one. @throws InputError also for that name, unless it is asked to be reported.
[[nodiscard]] geometry::RangeScan read_bnt_scan(const std::filesystem::path& file,
                                                io::LengthUnit unit = io::LengthUnit::millimetre,
                                                io::BadTexture bad_texture = io::BadTexture::refuse);
/// The scan must be organised. NaN points become background cells.
[[nodiscard]] Bnt to_bnt(const geometry::RangeScan& scan, double background = -1e9);

}  // namespace mimik::database
