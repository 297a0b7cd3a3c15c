#include "capture/feature_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::capture {
namespace {

// The outline of the 68 points as iBUG drew it; point 0 is at the subject's right ear.
constexpr std::array<FaceFeature, 48> features = {{{"brow_outer_right", 17},
                                                   {"brow_outer_middle_right", 18},
                                                   {"brow_middle_right", 19},
                                                   {"brow_inner_middle_right", 20},
                                                   {"brow_inner_right", 21},
                                                   {"brow_inner_left", 22},
                                                   {"brow_inner_middle_left", 23},
                                                   {"brow_middle_left", 24},
                                                   {"brow_outer_middle_left", 25},
                                                   {"brow_outer_left", 26},
                                                   {"nose_tip", 30},
                                                   {"nose_wing_right", 31},
                                                   {"nostril_right", 32},
                                                   {"nose_base", 33},
                                                   {"nostril_left", 34},
                                                   {"nose_wing_left", 35},
                                                   {"eye_outer_right", 36},
                                                   {"lid_upper_outer_right", 37},
                                                   {"lid_upper_inner_right", 38},
                                                   {"eye_inner_right", 39},
                                                   {"lid_lower_inner_right", 40},
                                                   {"lid_lower_outer_right", 41},
                                                   {"eye_inner_left", 42},
                                                   {"lid_upper_inner_left", 43},
                                                   {"lid_upper_outer_left", 44},
                                                   {"eye_outer_left", 45},
                                                   {"lid_lower_outer_left", 46},
                                                   {"lid_lower_inner_left", 47},
                                                   {"mouth_corner_right", 48},
                                                   {"upper_lip_outer_side_right", 49},
                                                   {"upper_lip_outer_peak_right", 50},
                                                   {"upper_lip_outer", 51},
                                                   {"upper_lip_outer_peak_left", 52},
                                                   {"upper_lip_outer_side_left", 53},
                                                   {"mouth_corner_left", 54},
                                                   {"lower_lip_outer_side_left", 55},
                                                   {"lower_lip_outer_peak_left", 56},
                                                   {"lower_lip_outer", 57},
                                                   {"lower_lip_outer_peak_right", 58},
                                                   {"lower_lip_outer_side_right", 59},
                                                   {"mouth_corner_inner_right", 60},
                                                   {"upper_lip_inner_right", 61},
                                                   {"upper_lip_inner", 62},
                                                   {"upper_lip_inner_left", 63},
                                                   {"mouth_corner_inner_left", 64},
                                                   {"lower_lip_inner_left", 65},
                                                   {"lower_lip_inner", 66},
                                                   {"lower_lip_inner_right", 67}}};

constexpr std::string_view schema_words = "# mimik motion, schema 1, rate_hz ";
constexpr std::array<const char*, 10> first_columns = {"frame", "time", "state", "confidence", "rx",
                                                       "ry",    "rz",   "tx",    "ty",         "tz"};
constexpr std::array<const char*, 5> feature_columns = {"u", "v", "x", "y", "z"};
// A head is within 100 m of its camera, and a feature within 1 m of the head's middle: else the unit is another.
constexpr double farthest_head_mm = 1e5, farthest_feature_mm = 1e3, most_pixels = 1e6;

void check_names(std::span<const std::string> names) {
    if (names.empty()) throw InputError("a motion has no feature; give at least one of face_features()");
    std::set<std::string_view> seen;
    for (const auto& name : names) {
        if (!find_face_feature(name))
            throw InputError(fmt::format("no feature is called {}; names are such as {}, {} and {}",
                                         base::in_quotes(name), features[0].name, features[16].name,
                                         features[31].name));
        if (!seen.insert(name).second) throw InputError(fmt::format("feature {} is there twice; leave one out", name));
    }
}

void check_rate(double rate_hz) {
    if (!std::isfinite(rate_hz) || rate_hz <= 0 || rate_hz > 1e5)
        throw InputError(fmt::format("rate_hz is {}; give frames a second, above 0 and up to 100000", rate_hz));
}

/// What is wrong with a frame, for whoever knows its number or line; empty: nothing.
std::string fault_of(const FeatureFrame& frame, std::span<const std::string> names) {
    if (!std::isfinite(frame.time_s) || frame.time_s < 0 || frame.time_s > 1e9)
        return fmt::format("time is {}; give seconds from the start, 0 or more", frame.time_s);
    if (!(frame.confidence >= 0 && frame.confidence <= 1))
        return fmt::format("confidence is {}; give 0 to 1", frame.confidence);
    if (frame.features.size() != names.size())
        return fmt::format("{} for {} names", base::counted(frame.features.size(), "feature"), names.size());
    if (const auto& pose = frame.camera_from_head) {
        // Written so that NaN is a fault.
        if (!(pose->rotation_vector.cwiseAbs().maxCoeff() <= 100 && pose->rotation_vector.allFinite()))
            return "the head's rotation is not a rotation vector in rad; give rx, ry and rz, or leave them empty";
        if (!(pose->translation_mm.cwiseAbs().maxCoeff() <= farthest_head_mm && pose->translation_mm.allFinite()))
            return fmt::format("the head is farther than {:g} mm from the camera; give mm, or leave tx, ty, tz empty",
                               farthest_head_mm);
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto& feature = frame.features[k];
        if (feature.in_image && !feature.valid)
            return fmt::format("{} has a pixel and no position in the head's frame; give both, or neither", names[k]);
        if (feature.valid && frame.state == TrackState::lost)
            return fmt::format("{} has a position in a frame that is lost; leave it empty, or call the frame tracked",
                               names[k]);
        if (feature.valid &&
            !(feature.head_mm.cwiseAbs().maxCoeff() <= farthest_feature_mm && feature.head_mm.allFinite()))
            return fmt::format("{} is farther than {:g} mm from the head's middle; give mm in the head's frame",
                               names[k], farthest_feature_mm);
        if (feature.in_image && !(feature.pixel.cwiseAbs().maxCoeff() <= most_pixels && feature.pixel.allFinite()))
            return fmt::format("{} is farther than {:g} pixels from the image's corner; give pixels", names[k],
                               most_pixels);
    }
    return {};
}

/// The rate, of the first line that is not blank.
double stated_rate_hz(std::string_view text, const std::string& name) {
    base::LineReader lines(text, name);
    if (!lines.next_not_blank())
        throw InputError(fmt::format("{}: the file is empty; a motion begins with '{}30'", name, schema_words));
    auto line = base::trimmed(lines.line());
    if (!line.starts_with(schema_words))
        lines.fail(fmt::format("{} is no schema line; a motion of features begins with '{}30'",
                               base::in_quotes(lines.line()), schema_words));
    line.remove_prefix(schema_words.size());
    const auto rate_hz = base::parse_double(line);
    if (!rate_hz) lines.fail(fmt::format("rate_hz is {}; give frames a second, such as 30", base::in_quotes(line)));
    try {
        check_rate(*rate_hz);
    } catch (const InputError& e) {
        lines.fail(e.what());
    }
    return *rate_hz;
}

class Reader {
public:
    Reader(std::string_view text, const std::string& name) : name_(name), rows_(text, name) {}

    FeatureMotion read(double rate_hz) {
        FeatureMotion motion;
        motion.rate_hz = rate_hz;
        motion.names = read_names();
        while (rows_.next()) {
            auto frame = read_row(motion.frames.size(), motion.names.size());
            if (const auto fault = fault_of(frame, motion.names); !fault.empty()) rows_.fail(fault);
            if (!motion.frames.empty() && frame.time_s <= motion.frames.back().time_s)
                rows_.fail(fmt::format("time goes from {} to {} s; give seconds that grow", motion.frames.back().time_s,
                                       frame.time_s));
            motion.frames.push_back(std::move(frame));
        }
        return motion;
    }

private:
    /// The columns are ours alone, in one order, so that a table of another kind is not taken for one.
    std::vector<std::string> read_names() const {
        const auto& header = rows_.header();
        const auto expect = [&](std::size_t column, const std::string& title) {
            const auto found = column < header.size() ? header[column] : std::string("nothing");
            if (found != title)
                throw InputError(
                    fmt::format("{}: column {} is {}, and '{}' belongs there; keep the columns as "
                                "'mimik capture' writes them",
                                name_, column + 1, base::in_quotes(found), title));
        };
        for (std::size_t k = 0; k < first_columns.size(); ++k) expect(k, first_columns[k]);
        std::vector<std::string> names;
        for (std::size_t at = first_columns.size(); at < header.size(); at += feature_columns.size()) {
            const auto& first = header[at];
            auto stem = first.size() > 2 ? first.substr(0, first.size() - 2) : first;
            for (std::size_t k = 0; k < feature_columns.size(); ++k)
                expect(at + k, fmt::format("{}_{}", stem, feature_columns[k]));
            names.push_back(std::move(stem));
        }
        try {
            check_names(names);
        } catch (const InputError& e) {
            throw InputError(fmt::format("{}: {}", name_, e.what()));
        }
        return names;
    }

    /// All of these columns as numbers, or none of them.
    template <std::size_t count>
    std::optional<std::array<double, count>> numbers(std::size_t first) const {
        std::size_t given = 0;
        for (std::size_t k = 0; k < count; ++k) given += rows_.field(first + k).empty() ? 0 : 1;
        if (given == 0) return std::nullopt;
        if (given != count)
            rows_.fail(fmt::format("{} to {} have {} of their {} numbers; give all, or leave all empty",
                                   rows_.header()[first], rows_.header()[first + count - 1], given, count));
        std::array<double, count> values{};
        for (std::size_t k = 0; k < count; ++k) values[k] = rows_.number(first + k);
        return values;
    }

    FeatureFrame read_row(std::size_t frame_number, std::size_t feature_count) const {
        const auto number = base::parse_integer(rows_.field(0));
        if (!number || *number != static_cast<std::int64_t>(frame_number))
            rows_.fail(fmt::format("frame is {}, and {} comes next; one row for every frame, from 0 on",
                                   base::in_quotes(rows_.field(0)), frame_number));
        FeatureFrame frame;
        frame.time_s = rows_.number(1);
        const auto& state = rows_.field(2);
        if (state != "tracked" && state != "lost")
            rows_.fail(fmt::format("state is {}; give tracked or lost", base::in_quotes(state)));
        frame.state = state == "tracked" ? TrackState::tracked : TrackState::lost;
        frame.confidence = rows_.number(3);
        if (const auto pose = numbers<6>(4))
            frame.camera_from_head =
                HeadPose{{(*pose)[0], (*pose)[1], (*pose)[2]}, {(*pose)[3], (*pose)[4], (*pose)[5]}};
        frame.features.resize(feature_count);
        for (std::size_t k = 0; k < feature_count; ++k) {
            auto& feature = frame.features[k];
            const auto at = first_columns.size() + k * feature_columns.size();
            if (const auto pixel = numbers<2>(at)) {
                feature.in_image = true;
                feature.pixel = {(*pixel)[0], (*pixel)[1]};
            }
            if (const auto position = numbers<3>(at + 2)) {
                feature.valid = true;
                feature.head_mm = {(*position)[0], (*position)[1], (*position)[2]};
            }
        }
        return frame;
    }

    std::string name_;
    base::CsvReader rows_;
};

}  // namespace

std::span<const FaceFeature> face_features() { return features; }

std::optional<std::size_t> find_face_feature(std::string_view name) {
    const auto it =
        std::find_if(features.begin(), features.end(), [&](const FaceFeature& f) { return f.name == name; });
    if (it == features.end()) return std::nullopt;
    return static_cast<std::size_t>(it - features.begin());
}

std::optional<std::size_t> feature_of_point68(int point) {
    const auto it =
        std::find_if(features.begin(), features.end(), [&](const FaceFeature& f) { return f.point68 == point; });
    if (it == features.end()) return std::nullopt;
    return static_cast<std::size_t>(it - features.begin());
}

std::optional<std::size_t> FeatureMotion::find(std::string_view name) const {
    const auto it = std::find(names.begin(), names.end(), name);
    if (it == names.end()) return std::nullopt;
    return static_cast<std::size_t>(it - names.begin());
}

void FeatureMotion::check() const {
    check_names(names);
    check_rate(rate_hz);
    for (std::size_t k = 0; k < frames.size(); ++k) {
        if (const auto fault = fault_of(frames[k], names); !fault.empty())
            throw InputError(fmt::format("frame {}: {}", k, fault));
        if (k > 0 && frames[k].time_s <= frames[k - 1].time_s)
            throw InputError(fmt::format("frame {}: time goes from {} to {} s; give seconds that grow", k,
                                         frames[k - 1].time_s, frames[k].time_s));
    }
}

std::string feature_motion_header(std::span<const std::string> names, double rate_hz) {
    check_names(names);
    check_rate(rate_hz);
    auto text = fmt::format("{}{}\n", schema_words, rate_hz);
    for (const auto* column : first_columns) fmt::format_to(std::back_inserter(text), "{},", column);
    for (const auto& name : names)
        for (const auto* column : feature_columns) fmt::format_to(std::back_inserter(text), "{}_{},", name, column);
    text.back() = '\n';
    return text;
}

std::string feature_motion_row(std::size_t frame_number, const FeatureFrame& frame) {
    auto text = fmt::format("{},{},{},{}", frame_number, frame.time_s, to_string(frame.state), frame.confidence);
    const auto add = [&](const auto& vector) {
        for (const double value : vector) fmt::format_to(std::back_inserter(text), ",{}", value);
    };
    if (frame.camera_from_head) {
        add(frame.camera_from_head->rotation_vector);
        add(frame.camera_from_head->translation_mm);
    } else {
        text += ",,,,,,";
    }
    for (const auto& feature : frame.features) {
        if (feature.in_image)
            add(feature.pixel);
        else
            text += ",,";
        if (feature.valid)
            add(feature.head_mm);
        else
            text += ",,,";
    }
    text += '\n';
    return text;
}

std::string encode_feature_motion(const FeatureMotion& motion) {
    motion.check();
    auto text = feature_motion_header(motion.names, motion.rate_hz);
    for (std::size_t k = 0; k < motion.frames.size(); ++k) text += feature_motion_row(k, motion.frames[k]);
    return text;
}

FeatureMotion decode_feature_motion(std::string_view text, const std::string& name) {
    const auto rate_hz = stated_rate_hz(text, name);
    return Reader(text, name).read(rate_hz);
}

void write_feature_motion(const std::filesystem::path& file, const FeatureMotion& motion) {
    base::write_atomically(file, encode_feature_motion(motion));
}

FeatureMotion read_feature_motion(const std::filesystem::path& file) {
    return decode_feature_motion(base::read_text(file), file.string());
}

}  // namespace mimik::capture
