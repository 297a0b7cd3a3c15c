#include "capture/motion_file.h"

#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "capture/c3d.h"
#include "capture/marker_csv.h"
#include "capture/trc.h"

namespace mimik::capture {

void MotionReadOptions::check() const {
    if (rate_hz && (!std::isfinite(*rate_hz) || *rate_hz <= 0))
        throw InputError(fmt::format("rate_hz is {}; give one above 0", *rate_hz));
}

MotionFormat motion_format(const std::filesystem::path& file) {
    const auto extension = base::lower_case(file.extension().string());
    if (extension == ".c3d") return MotionFormat::c3d;
    if (extension == ".trc") return MotionFormat::trc;
    if (extension == ".csv" || extension == ".tsv") return MotionFormat::csv;
    throw InputError(fmt::format("{}: '{}' is no format of marker recordings; there are .c3d, .trc, .csv and .tsv",
                                 file.string(), extension));
}

MotionFile decode_motion(MotionFormat format, std::span<const std::uint8_t> bytes, const std::string& name,
                         const MotionReadOptions& options) {
    options.check();
    if (format == MotionFormat::c3d) return decode_c3d(bytes, name, options);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return format == MotionFormat::trc ? decode_trc(text, name, options) : decode_marker_csv(text, name, options);
}

MotionFile read_motion(const std::filesystem::path& file, const MotionReadOptions& options) {
    const auto format = motion_format(file);
    return decode_motion(format, base::read_bytes(file), file.string(), options);
}

std::string encode_motion(MotionFormat format, const MarkerSequence& markers, const std::string& name) {
    if (format == MotionFormat::c3d) return encode_c3d(markers, name);
    return format == MotionFormat::trc ? encode_trc(markers, name) : encode_marker_csv(markers);
}

void write_motion(const std::filesystem::path& file, const MarkerSequence& markers) {
    base::write_atomically(file, encode_motion(motion_format(file), markers, file.string()));
}

}  // namespace mimik::capture
