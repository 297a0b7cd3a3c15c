#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/fields.h"
#include "capture/motion_file.h"

namespace mimik::capture {

/// Whose numbers a C3D file holds: byte order and kind of reals.
enum class C3dProcessor : std::uint8_t {
    intel = 84,  ///< little-endian, IEEE
    dec = 85,    ///< little-endian integers, VAX F reals
    sgi = 86     ///< big-endian, IEEE (SGI, MIPS)
};
[[nodiscard]] const char* to_string(C3dProcessor processor);  ///< "Intel", "DEC", "SGI"

/// C3D as the public readers agree about it (docs/formats.md): blocks of 512 bytes; parameters go before the header;
/// the length of the file decides where counts of frames disagree. A sample is missing where its fourth word is below
/// 0, where a coordinate is no number, or where all three are 9999999 (Cortex); a point at the origin is a point.
/// Camera masks, analogue channels and events are not kept; `remarks` says so where there are any.
/// @throws InputError naming file, field, value and mend; sizes are checked before memory is taken.
[[nodiscard]] MotionFile decode_c3d(std::span<const std::uint8_t> bytes, const std::string& name,
                                    const MotionReadOptions& options = {});

struct C3dWriteOptions {
    C3dProcessor processor = C3dProcessor::intel;
    /// Millimetres a step of 16-bit integers, as old programs want them (positions are rounded to it); none: 32-bit
    /// reals.
    std::optional<double> integer_step_mm = {};
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("processor", self.processor);
        visit("integer_step_mm", self.integer_step_mm);
    }
    /// @throws InputError if the step is not positive and finite.
    void check() const;
};
static_assert(base::lists_every_field<C3dWriteOptions>());

/// In mm; frames beyond 65,535 by TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD and by POINT:LONG_FRAMES, names beyond
/// 255 in LABELS2 and so on. Positions that are 32-bit reals read back as they were (on DEC those below 3e-39
/// become 0), residuals to 0.01 mm, or to 1/255 of the largest where that is more. @param name  of the file, for
/// messages
/// @throws InputError if a name is longer than 127 bytes, if there are more markers or names than a C3D can hold, or
/// if a coordinate is beyond the range of the integers.
[[nodiscard]] std::string encode_c3d(const MarkerSequence& markers, const std::string& name,
                                     const C3dWriteOptions& options = {});

}  // namespace mimik::capture
