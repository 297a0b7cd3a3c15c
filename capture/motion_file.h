#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "capture/marker_sequence.h"
#include "io/mesh_io.h"

namespace mimik::capture {

/// What a file may leave unsaid, or say wrongly: goes before what it says.
struct MotionReadOptions {
    std::optional<io::LengthUnit> unit = {};  ///< of the coordinates; mm where neither says one
    std::optional<double> rate_hz = {};       ///< frames per second
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("unit", self.unit);
        visit("rate_hz", self.rate_hz);
    }
    /// @throws InputError if the rate is not positive and finite.
    void check() const;
};
static_assert(base::lists_every_field<MotionReadOptions>());

/// A recording with what is odd about its file.
struct MotionFile {
    MarkerSequence markers;
    std::string format;  ///< "C3D, Intel, float", "TRC", "CSV, wide", "CSV, long"
    std::string unit;    ///< in which the coordinates stand in the file: "mm", "m"
    std::vector<std::string> remarks;
};

enum class MotionFormat { c3d, trc, csv };
/// By extension, case ignored. @throws InputError listing those there are.
[[nodiscard]] MotionFormat motion_format(const std::filesystem::path& file);

/// C3D, TRC or CSV by extension. A file without markers or frames is an error. Samples that are missing are so; what is
/// odd is in `remarks`, one line each.
/// @throws InputError naming file, place, field, value and mend.
[[nodiscard]] MotionFile read_motion(const std::filesystem::path& file, const MotionReadOptions& options = {});
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] MotionFile decode_motion(MotionFormat format, std::span<const std::uint8_t> bytes,
                                       const std::string& name, const MotionReadOptions& options = {});

/// In mm. C3D: Intel, 32-bit floats; TRC and CSV (wide): the shortest digits that read back as the same doubles.
/// @throws InputError if the format cannot hold a name.
void write_motion(const std::filesystem::path& file, const MarkerSequence& markers);
[[nodiscard]] std::string encode_motion(MotionFormat format, const MarkerSequence& markers, const std::string& name);

/// No marker of a face is further from the origin; where one is, the unit is another, or the file is damaged.
inline constexpr double farthest_marker_mm = 1e6;
/// Samples of a sequence (markers x frames): a day of 75 markers at 120 Hz has 800 million, which nobody animates.
inline constexpr std::uint64_t most_samples = 100'000'000;

}  // namespace mimik::capture
