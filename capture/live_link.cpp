#include "capture/live_link.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "capture/plain_table.h"
#include "facs/arkit_shapes.h"

namespace mimik::capture {
namespace {

/// "EyeBlinkLeft" is ARKit's "eyeBlinkLeft"; other channels keep their names.
std::string arkit_spelling(std::string title) {
    auto lower = title;
    if (!lower.empty()) lower[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(lower[0])));
    return facs::is_arkit_shape(lower) ? lower : title;
}

struct Timecode {
    double seconds = 0;  ///< whole ones since midnight
    double frame = 0;    ///< with its part
};

Timecode parse_timecode(const PlainTable& rows, const std::string& text) {
    std::array<double, 4> parts{};
    std::string_view rest = text;
    bool good = true;
    for (std::size_t k = 0; k < 4 && good; ++k) {
        const auto end = k < 3 ? rest.find(':') : rest.size();
        good = end != std::string_view::npos;
        const auto value = good ? base::parse_double(rest.substr(0, end)) : std::nullopt;
        good = good && value && *value >= 0 && *value < 1000 && (k == 3 || *value == std::floor(*value));
        if (!good) break;
        parts[k] = *value;
        rest = k < 3 ? rest.substr(end + 1) : std::string_view();
    }
    if (!good || parts[0] > 23 || parts[1] > 59 || parts[2] > 59)
        rows.fail(fmt::format("Timecode is {}; give HH:MM:SS:FF, such as 12:30:05:29.5", base::in_quotes(text)));
    return {3600 * parts[0] + 60 * parts[1] + parts[2], parts[3]};
}

/// Frames count from 0 within a second, so the rate is the next above the largest.
double usual_rate(double largest_frame) {
    for (const double rate : {24.0, 25.0, 30.0, 50.0, 60.0, 120.0, 240.0})
        if (largest_frame < rate) return rate;
    return std::ceil(largest_frame + 1);
}

/// Seconds from the first frame on. @throws by `name` where time does not grow
std::vector<double> seconds_of(const std::vector<Timecode>& codes, double rate_hz, const std::string& name) {
    constexpr double day_s = 86400;
    std::vector<double> times_s;
    double days_s = 0;
    for (std::size_t k = 0; k < codes.size(); ++k) {
        const double since_midnight_s = codes[k].seconds + codes[k].frame / rate_hz;
        if (k > 0 && codes[k].seconds + day_s / 2 < codes[k - 1].seconds) days_s += day_s;
        times_s.push_back(days_s + since_midnight_s);
        if (k > 0 && times_s[k] <= times_s[k - 1])
            throw InputError(
                fmt::format("{}: timecodes do not grow from row {} to {}; order the rows, or give the "
                            "rate they were recorded with (--rate)",
                            name, k, k + 1));
    }
    for (auto it = times_s.rbegin(); it != times_s.rend(); ++it) *it -= times_s.front();
    return times_s;
}

}  // namespace

std::optional<std::size_t> ShapeMotion::find(std::string_view shape) const {
    const auto it = std::find(shapes.begin(), shapes.end(), shape);
    if (it == shapes.end()) return std::nullopt;
    return static_cast<std::size_t>(it - shapes.begin());
}

ShapeMotion decode_live_link_csv(std::string_view text, const std::string& name, std::optional<double> rate_hz) {
    if (rate_hz && !(*rate_hz > 0 && *rate_hz <= 1e5))
        throw InputError(fmt::format("rate_hz is {}; give frames a second, above 0 and up to 100000", *rate_hz));
    PlainTable rows(text, name);
    if (rows.header().size() < 3 || !base::equal_ignoring_case(rows.header()[0], "Timecode") ||
        !base::equal_ignoring_case(rows.header()[1], "BlendShapeCount"))
        throw InputError(
            fmt::format("{}: the header does not begin with Timecode,BlendShapeCount; this is no table of "
                        "Live Link Face",
                        name));
    constexpr std::size_t most_columns = 4096;
    if (rows.header().size() > most_columns)
        throw InputError(fmt::format("{}: {} columns, and {} are the most; leave out those that are no blendshapes",
                                     name, rows.header().size(), most_columns));
    ShapeMotion motion;
    std::set<std::string> seen;
    for (std::size_t k = 2; k < rows.header().size(); ++k) {
        motion.shapes.push_back(arkit_spelling(rows.header()[k]));
        if (motion.shapes.back().empty() || !seen.insert(motion.shapes.back()).second)
            throw InputError(fmt::format("{}: column {} has no name or another's name; rename it", name, k + 1));
    }
    std::vector<Timecode> codes;
    std::vector<double> values;
    double largest_frame = 0;
    while (rows.next()) {
        // A short row may stand for many values, so the text does not bound them.
        constexpr std::size_t most_values = 20'000'000;
        if (values.size() + motion.shapes.size() > most_values)
            rows.fail(fmt::format("more than {} values; cut the recording", most_values));
        codes.push_back(parse_timecode(rows, rows.field(0)));
        largest_frame = std::max(largest_frame, std::floor(codes.back().frame));
        const double count = rows.number(1);
        if (count != 0 && count != static_cast<double>(motion.shapes.size()))
            rows.fail(fmt::format("BlendShapeCount is {}; give {}, or 0 where the face was lost",
                                  base::in_quotes(rows.field(1)), motion.shapes.size()));
        motion.tracked.push_back(count != 0 ? 1 : 0);
        for (std::size_t k = 0; k < motion.shapes.size(); ++k) {
            const double value = count != 0 ? rows.number(2 + k) : 0.0;
            if (!(std::abs(value) <= 100))
                rows.fail(fmt::format("{} is {}; weights are about 0 to 1", rows.header()[2 + k], value));
            values.push_back(value);
        }
    }
    motion.rate_hz = rate_hz.value_or(usual_rate(largest_frame));
    if (!rate_hz)
        motion.remarks.push_back(
            fmt::format("{}: {:g} frames a second, as its timecodes count (--rate)", name, motion.rate_hz));
    motion.times_s = seconds_of(codes, motion.rate_hz, name);
    motion.values = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        values.data(), static_cast<Eigen::Index>(codes.size()), static_cast<Eigen::Index>(motion.shapes.size()));
    return motion;
}

std::span<const std::string_view> live_link_channels() {
    static constexpr std::array<std::string_view, 61> channels = {"EyeBlinkLeft",
                                                                  "EyeLookDownLeft",
                                                                  "EyeLookInLeft",
                                                                  "EyeLookOutLeft",
                                                                  "EyeLookUpLeft",
                                                                  "EyeSquintLeft",
                                                                  "EyeWideLeft",
                                                                  "EyeBlinkRight",
                                                                  "EyeLookDownRight",
                                                                  "EyeLookInRight",
                                                                  "EyeLookOutRight",
                                                                  "EyeLookUpRight",
                                                                  "EyeSquintRight",
                                                                  "EyeWideRight",
                                                                  "JawForward",
                                                                  "JawRight",
                                                                  "JawLeft",
                                                                  "JawOpen",
                                                                  "MouthClose",
                                                                  "MouthFunnel",
                                                                  "MouthPucker",
                                                                  "MouthRight",
                                                                  "MouthLeft",
                                                                  "MouthSmileLeft",
                                                                  "MouthSmileRight",
                                                                  "MouthFrownLeft",
                                                                  "MouthFrownRight",
                                                                  "MouthDimpleLeft",
                                                                  "MouthDimpleRight",
                                                                  "MouthStretchLeft",
                                                                  "MouthStretchRight",
                                                                  "MouthRollLower",
                                                                  "MouthRollUpper",
                                                                  "MouthShrugLower",
                                                                  "MouthShrugUpper",
                                                                  "MouthPressLeft",
                                                                  "MouthPressRight",
                                                                  "MouthLowerDownLeft",
                                                                  "MouthLowerDownRight",
                                                                  "MouthUpperUpLeft",
                                                                  "MouthUpperUpRight",
                                                                  "BrowDownLeft",
                                                                  "BrowDownRight",
                                                                  "BrowInnerUp",
                                                                  "BrowOuterUpLeft",
                                                                  "BrowOuterUpRight",
                                                                  "CheekPuff",
                                                                  "CheekSquintLeft",
                                                                  "CheekSquintRight",
                                                                  "NoseSneerLeft",
                                                                  "NoseSneerRight",
                                                                  "TongueOut",
                                                                  "HeadYaw",
                                                                  "HeadPitch",
                                                                  "HeadRoll",
                                                                  "LeftEyeYaw",
                                                                  "LeftEyePitch",
                                                                  "LeftEyeRoll",
                                                                  "RightEyeYaw",
                                                                  "RightEyePitch",
                                                                  "RightEyeRoll"};
    return channels;
}

namespace {

/// HH:MM:SS:FF.part of a time since midnight. Thousandths are counted, so that 59.9996 is the next second's 0.
std::string timecode(double since_midnight_s, double rate_hz) {
    const double whole = std::floor(since_midnight_s);
    auto seconds = static_cast<long>(whole);
    double thousandths = std::round((since_midnight_s - whole) * rate_hz * 1000);
    if (thousandths >= rate_hz * 1000) {
        thousandths = 0;
        ++seconds;
    }
    constexpr long day_s = 86400;
    seconds %= day_s;
    const auto frames = static_cast<long>(thousandths);
    return fmt::format("{:02}:{:02}:{:02}:{:02}.{:03}", seconds / 3600, seconds / 60 % 60, seconds % 60, frames / 1000,
                       frames % 1000);
}

/// Where each channel is among the shapes of a motion. @throws InputError if a shape is no channel
std::vector<std::optional<std::size_t>> columns_of_channels(const ShapeMotion& motion) {
    std::vector<std::optional<std::size_t>> columns;
    std::size_t found = 0;
    for (const auto channel : live_link_channels()) {
        columns.push_back(motion.find(arkit_spelling(std::string(channel))));
        found += columns.back() ? 1 : 0;
    }
    if (found == motion.shapes.size()) return columns;
    for (std::size_t k = 0; k < motion.shapes.size(); ++k)
        if (std::find(columns.begin(), columns.end(), k) == columns.end()) {
            if (motion.find(motion.shapes[k]) != k)
                throw InputError(
                    fmt::format("{} is there twice; keep one of the two", base::in_quotes(motion.shapes[k])));
            throw InputError(fmt::format("{} is none of the 61 channels of Live Link Face; leave it out",
                                         base::in_quotes(motion.shapes[k])));
        }
    return columns;
}

}  // namespace

std::string encode_live_link_csv(const ShapeMotion& motion, double start_s) {
    const auto frames = motion.times_s.size();
    if (motion.tracked.size() != frames || motion.values.rows() != static_cast<Eigen::Index>(frames) ||
        motion.values.cols() != static_cast<Eigen::Index>(motion.shapes.size()))
        throw InputError(fmt::format("a motion of {} times, {} frames and {} x {} values of {} shapes; give one each",
                                     frames, motion.tracked.size(), motion.values.rows(), motion.values.cols(),
                                     motion.shapes.size()));
    if (!(motion.rate_hz > 0 && motion.rate_hz <= 1e5))
        throw InputError(fmt::format("rate_hz is {}; give frames a second, above 0 and up to 100000", motion.rate_hz));
    const auto columns = columns_of_channels(motion);
    std::string text = "Timecode,BlendShapeCount";
    for (const auto channel : live_link_channels()) text += fmt::format(",{}", channel);
    text += '\n';
    for (std::size_t f = 0; f < frames; ++f) {
        const double time_s = start_s + motion.times_s[f];
        if (!(time_s >= 0 && time_s < 1e9))
            throw InputError(fmt::format("frame {} is at {} s; give a time since midnight", f + 1, time_s));
        text += fmt::format("{},{}", timecode(time_s, motion.rate_hz), motion.tracked[f] ? columns.size() : 0);
        for (const auto& column : columns) {
            // Adding zero makes the negative one positive.
            const double value =
                column ? motion.values(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(*column)) + 0.0 : 0.0;
            if (motion.tracked[f]) text += fmt::format(",{}", value);
        }
        text += '\n';
    }
    return text;
}

}  // namespace mimik::capture
