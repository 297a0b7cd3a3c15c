// Reading C3D; c3d_write.cpp writes it.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "capture/c3d.h"
#include "capture/c3d_bytes.h"
#include "capture/length_units.h"
#include "capture/marker_names.h"

namespace mimik::capture {

const char* to_string(C3dProcessor processor) {
    return processor == C3dProcessor::intel ? "Intel" : processor == C3dProcessor::dec ? "DEC" : "SGI";
}

namespace {

constexpr float cortex_missing = 9999999;  // what Motion Analysis' Cortex writes in all three coordinates

struct Parameter {
    int type = 0;  ///< -1 text, 1 byte, 2 word, 4 real: its absolute value is the size
    std::vector<std::size_t> sizes;
    std::span<const std::uint8_t> values;
};

struct Section {
    C3dProcessor processor = C3dProcessor::intel;
    std::map<std::string, Parameter> parameters;  ///< "POINT:LABELS", in upper case

    [[nodiscard]] const Parameter* find(const std::string& name) const {
        const auto it = parameters.find(name);
        return it == parameters.end() || it->second.values.empty() ? nullptr : &it->second;
    }
    /// Words count without sign: 16-bit counts of frames need all bits.
    [[nodiscard]] std::optional<double> number(const std::string& name, std::size_t k = 0) const {
        const auto* found = find(name);
        if (!found || found->type < 0) return std::nullopt;
        const auto size = static_cast<std::size_t>(found->type);
        if (found->values.size() < (k + 1) * size) return std::nullopt;
        const auto* at = found->values.data() + k * size;
        if (found->type == 1) return *at;
        if (found->type == 2) return c3d_word(at, processor);
        return c3d_real(at, processor);
    }
    /// A count; none where the number is no count.
    [[nodiscard]] std::optional<std::uint64_t> count(const std::string& name, std::size_t k = 0) const {
        const auto value = number(name, k);
        if (!value || !(*value >= 0 && *value < 4294967296.0)) return std::nullopt;
        return static_cast<std::uint64_t>(*value);
    }
    /// 32 bits in two words, the low one first.
    [[nodiscard]] std::optional<std::uint64_t> long_count(const std::string& name) const {
        const auto low = count(name, 0), high = count(name, 1);
        if (!low || !high || *low > 65535 || *high > 65535) return std::nullopt;
        return *low + (*high << 16U);
    }
    [[nodiscard]] std::vector<std::string> texts(const std::string& name) const {
        const auto* found = find(name);
        std::vector<std::string> list;
        if (!found || found->type != -1) return list;
        const auto length = found->sizes.empty() ? 1 : found->sizes[0];
        if (length == 0) return list;
        for (std::size_t at = 0; at + length <= found->values.size(); at += length) {
            std::string_view text(reinterpret_cast<const char*>(found->values.data()) + at, length);
            while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.remove_suffix(1);
            list.emplace_back(base::trimmed(text));
        }
        return list;
    }
};

/// What the header and the parameters say about the data.
struct Layout {
    std::size_t points = 0, analogue_values = 0;  ///< a frame
    std::size_t data_begin = 0;
    bool reals = true;
    double scale = 0;  ///< file units a step of integers; of residuals, too
    double rate_hz = 0;
    std::uint64_t frames = 0;
    std::int64_t first_frame = 1;

    [[nodiscard]] std::uint64_t frame_bytes() const {
        return (std::uint64_t{4} * points + analogue_values) * (reals ? 4U : 2U);
    }
};

class Reader {
public:
    Reader(std::span<const std::uint8_t> bytes, std::string name, const MotionReadOptions& options)
        : bytes_(bytes), name_(std::move(name)), options_(options) {}

    MotionFile read() {
        read_parameters();
        read_layout();
        find_frames();
        MotionFile file;
        file.format = fmt::format("C3D, {}, {}", to_string(section_.processor), layout_.reals ? "float" : "integer");
        const double mm = millimetres_a_unit(file);
        file.markers = MarkerSequence(labels(), layout_.rate_hz, layout_.frames, layout_.first_frame);
        read_samples(file.markers, mm);
        remark_what_is_left_out();
        file.remarks = std::move(remarks_);
        return file;
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", name_, what)); }
    [[nodiscard]] std::uint16_t header(std::size_t byte) const { return c3d_word(&bytes_[byte], section_.processor); }

    void read_parameters();
    std::size_t read_record(std::size_t at, std::map<int, std::string>& groups,
                            std::vector<std::pair<int, std::pair<std::string, Parameter>>>& found);
    void read_layout();
    void find_frames();
    [[nodiscard]] std::vector<std::pair<const char*, std::uint64_t>> stated_frames() const;
    [[nodiscard]] std::uint64_t empty_frames_at_end(std::uint64_t whole) const;
    [[nodiscard]] double millimetres_a_unit(MotionFile& file);
    std::vector<std::string> labels();
    void read_samples(MarkerSequence& markers, double mm);
    void remark_what_is_left_out();

    std::span<const std::uint8_t> bytes_;
    std::string name_;
    const MotionReadOptions& options_;
    Section section_;
    std::uint64_t value_bytes_ = 0;  // of all parameters
    Layout layout_;
    std::vector<std::string> remarks_;
};

void Reader::read_parameters() {
    if (bytes_.size() < 2 * c3d_block_bytes)
        fail(fmt::format("has {} bytes, a C3D file has at least {}; the file is truncated or no C3D", bytes_.size(),
                         2 * c3d_block_bytes));
    if (bytes_[1] != 0x50) {
        const auto zeros = std::find_if(bytes_.begin(), bytes_.end(), [](std::uint8_t b) { return b != 0; });
        const auto count = zeros - bytes_.begin();
        if (count > 0 && bytes_.end() - zeros > 2 && zeros[1] == 0x50)
            fail(fmt::format("{} zero before the header; take them off",
                             base::counted(static_cast<std::uint64_t>(count), "byte is", "bytes are")));
        fail(fmt::format("byte 1 is {}, not 80 as in every C3D file; it is no C3D", bytes_[1]));
    }
    const std::size_t block = bytes_[0];
    const std::size_t begin = (block - 1) * c3d_block_bytes;
    if (block < 2 || begin + 4 > bytes_.size())
        fail(fmt::format("the parameters are said to begin in block {}, and the file has {}; it is damaged", block,
                         base::counted(bytes_.size() / c3d_block_bytes, "block")));
    const auto processor = bytes_[begin + 3];
    if (processor < 84 || processor > 86)
        fail(fmt::format("the processor is {}; there are 84 (Intel), 85 (DEC) and 86 (SGI); the file is damaged",
                         processor));
    section_.processor = static_cast<C3dProcessor>(processor);

    std::map<int, std::string> groups;
    std::vector<std::pair<int, std::pair<std::string, Parameter>>> found;  // groups may come after their parameters
    for (std::size_t at = begin + 4; at != 0;) at = read_record(at, groups, found);
    for (auto& [group, named] : found) {
        const auto it = groups.find(group);
        if (it != groups.end())  // the first of two holds
            section_.parameters.emplace(it->second + ":" + named.first, std::move(named.second));
    }
}

/// Returns where the next record begins; 0 behind the last.
std::size_t Reader::read_record(std::size_t at, std::map<int, std::string>& groups,
                                std::vector<std::pair<int, std::pair<std::string, Parameter>>>& found) {
    const auto left = [&](std::size_t from) { return bytes_.size() - std::min(bytes_.size(), from); };
    const auto need = [&](std::size_t from, std::size_t count) {
        if (left(from) < count)
            fail(fmt::format("byte {}: the parameters go on behind the end of the file; it is truncated", from));
    };
    need(at, 2);
    const int length = std::abs(static_cast<int>(static_cast<std::int8_t>(bytes_[at])));
    const int id = static_cast<std::int8_t>(bytes_[at + 1]);
    if (length == 0 || id == 0) return 0;
    const auto name_bytes = static_cast<std::size_t>(length);
    need(at + 2, name_bytes + 2);
    std::string name(reinterpret_cast<const char*>(&bytes_[at + 2]), name_bytes);
    for (auto& c : name)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    const std::size_t offset_at = at + 2 + name_bytes;
    const std::size_t next = c3d_word(&bytes_[offset_at], section_.processor);
    if (id < 0) {
        groups.emplace(-id, name);
    } else {
        std::size_t p = offset_at + 2;
        need(p, 2);
        Parameter parameter;
        parameter.type = static_cast<std::int8_t>(bytes_[p]);
        const std::size_t dimensions = bytes_[p + 1];
        const auto size = static_cast<std::size_t>(std::abs(parameter.type));
        if (parameter.type < -1 || size == 0 || size == 3 || size > 4 || dimensions > 7)
            fail(
                fmt::format("byte {}: parameter {} has type {} and {}; there are types -1, 1, 2 and 4 of at most 7 "
                            "dimensions; the file is damaged",
                            p, base::in_quotes(name), parameter.type, base::counted(dimensions, "dimension")));
        p += 2;
        need(p, dimensions);
        std::uint64_t count = size;
        for (std::size_t k = 0; k < dimensions; ++k) {
            parameter.sizes.push_back(bytes_[p + k]);
            count *= bytes_[p + k];  // at most 4 * 255^7: no overflow
        }
        p += dimensions;
        if (left(p) < count)
            fail(fmt::format(
                "byte {}: parameter {} has {} bytes, which go on behind the end of the file; it is truncated", p,
                base::in_quotes(name), count));
        // A section has 255 blocks at most; more is the same bytes again and again.
        value_bytes_ += count;
        if (value_bytes_ > 255 * c3d_block_bytes)
            fail(fmt::format("byte {}: the parameters hold more than their section can; the file is damaged", p));
        parameter.values = bytes_.subspan(p, count);
        found.emplace_back(id, std::pair(std::move(name), std::move(parameter)));
    }
    return next == 0 ? 0 : offset_at + next;
}

void Reader::read_layout() {
    const auto& section = section_;
    const double used = section.number("POINT:USED").value_or(header(2));
    if (!(used >= 1 && used <= 65535))
        fail(fmt::format("POINT:USED is {}; a recording of markers has 1 to 65535 points", used));
    layout_.points = static_cast<std::size_t>(used);
    if (layout_.points != header(2))
        remarks_.push_back(fmt::format("the header says {}, POINT:USED says {}; the latter holds",
                                       base::counted(header(2), "point"), layout_.points));

    const double scale = section.number("POINT:SCALE").value_or(c3d_real(&bytes_[12], section.processor));
    if (!std::isfinite(scale) || scale == 0)
        fail(fmt::format("POINT:SCALE is {}; it must be a number other than 0; the file is damaged", scale));
    layout_.reals = scale < 0;
    layout_.scale = std::abs(scale);

    layout_.rate_hz =
        options_.rate_hz.value_or(section.number("POINT:RATE").value_or(c3d_real(&bytes_[20], section.processor)));
    if (!std::isfinite(layout_.rate_hz) || layout_.rate_hz <= 0)
        fail(fmt::format("POINT:RATE is {} Hz; give the rate of the frames (--rate)", layout_.rate_hz));

    layout_.analogue_values = header(4);
    if (const auto channels = section.count("ANALOG:USED"); channels && *channels <= 65535) {
        const auto by_parameters = static_cast<std::size_t>(*channels) * header(18);
        if (by_parameters != layout_.analogue_values)
            remarks_.push_back(fmt::format("the header says {} a frame, ANALOG:USED says {}; the latter holds",
                                           base::counted(layout_.analogue_values, "analogue value"), by_parameters));
        layout_.analogue_values = by_parameters;
    }

    const std::size_t block = section.count("POINT:DATA_START").value_or(header(16));
    layout_.data_begin = (std::max<std::size_t>(block, 1) - 1) * c3d_block_bytes;
    if (block < 3 || layout_.data_begin >= bytes_.size())
        fail(fmt::format("the data are said to begin in block {}, and the file has {}; it is damaged or truncated",
                         block, base::counted(bytes_.size() / c3d_block_bytes, "block")));
}

/// Every place that says how many frames there are, the most trusted first.
std::vector<std::pair<const char*, std::uint64_t>> Reader::stated_frames() const {
    std::vector<std::pair<const char*, std::uint64_t>> list;
    const auto begin = section_.long_count("TRIAL:ACTUAL_START_FIELD");
    const auto end = section_.long_count("TRIAL:ACTUAL_END_FIELD");
    if (begin && end && *end >= *begin) list.emplace_back("TRIAL:ACTUAL_END_FIELD", *end - *begin + 1);
    list.emplace_back("POINT:LONG_FRAMES", section_.count("POINT:LONG_FRAMES").value_or(0));
    list.emplace_back("POINT:FRAMES", section_.count("POINT:FRAMES").value_or(0));
    const std::uint64_t first = header(6), last = header(8);
    list.emplace_back("the header", last >= first ? last - first + (last == 0 ? 0 : 1) : 0);
    list.erase(std::remove_if(list.begin(), list.end(), [](const auto& one) { return one.second == 0; }), list.end());
    return list;
}

/// Of `whole` frames those that are nothing but the zeros that fill up the last block.
std::uint64_t Reader::empty_frames_at_end(std::uint64_t whole) const {
    const auto each = layout_.frame_bytes();
    std::uint64_t count = 0;
    while (count + 1 < whole && (count + 1) * each < c3d_block_bytes) {
        const auto frame = bytes_.subspan(layout_.data_begin + (whole - count - 1) * each, each);
        if (std::any_of(frame.begin(), frame.end(), [](std::uint8_t byte) { return byte != 0; })) break;
        ++count;
    }
    return count;
}

void Reader::find_frames() {
    const std::uint64_t left = bytes_.size() - layout_.data_begin, each = layout_.frame_bytes();
    const std::uint64_t whole = left / each;
    const auto stated = stated_frames();
    if (stated.empty()) fail("no field says that there is a frame; the file holds no motion, or is damaged");
    // The length of the file decides: its last block is filled up, so fewer than 512 bytes may be left.
    const auto fills_file = [&](std::uint64_t frames) {
        return frames > 0 && frames <= whole && left - frames * each < c3d_block_bytes;
    };
    const auto fitting =
        std::find_if(stated.begin(), stated.end(), [&](const auto& one) { return fills_file(one.second); });
    layout_.frames = stated.front().second;
    if (fitting != stated.end()) {
        layout_.frames = fitting->second;
    } else if (layout_.frames <= 65535 && whole > layout_.frames) {
        // 16 bits were too few, and nothing else says how many: they hold the rest, or the largest number.
        const auto with_rest = whole - (whole - layout_.frames) % 65536;
        if (with_rest > layout_.frames && fills_file(with_rest))
            layout_.frames = with_rest;
        else if (layout_.frames == 65535)
            layout_.frames = whole - empty_frames_at_end(whole);
    }
    for (const auto& [place, count] : stated)
        if (count != layout_.frames && count != 65535)
            remarks_.push_back(fmt::format("{} says {}, the length of the file {}; the latter holds", place,
                                           base::counted(count, "frame"), layout_.frames));
    if (layout_.frames > whole)
        fail(fmt::format(
            "{} of {} points and {} analogue values a frame need {} bytes behind byte {}, and there are {}; "
            "the file is truncated: copy it again",
            base::counted(layout_.frames, "frame"), layout_.points, layout_.analogue_values, layout_.frames * each,
            layout_.data_begin, left));
    if (const auto behind = left - layout_.frames * each; behind >= c3d_block_bytes)
        remarks_.push_back(
            fmt::format("{} behind the last frame; not read", base::counted(behind, "byte is", "bytes are")));
    if (layout_.frames * layout_.points > most_samples)
        fail(fmt::format("{} frames of {} points are more than the {} samples that Mimik reads; cut the recording",
                         layout_.frames, layout_.points, most_samples));
    layout_.first_frame = header(6);
    if (const auto start = section_.long_count("TRIAL:ACTUAL_START_FIELD"))
        layout_.first_frame = static_cast<std::int64_t>(*start);
}

double Reader::millimetres_a_unit(MotionFile& file) {
    const auto units = section_.texts("POINT:UNITS");
    const auto stated = units.empty() ? std::string() : units.front();
    if (options_.unit) {
        file.unit = io::to_string(*options_.unit);
    } else if (stated.empty()) {
        remarks_.emplace_back("POINT:UNITS says nothing; millimetres are assumed");
        file.unit = "mm";
    } else {
        file.unit = io::to_string(unit_of_motion_file(stated, name_, "POINT:UNITS"));
    }
    return io::millimetres_per(io::parse_length_unit(file.unit));
}

std::vector<std::string> Reader::labels() {
    auto list = section_.texts("POINT:LABELS");
    for (std::size_t k = 2; list.size() < layout_.points; ++k) {
        const auto more = section_.texts(fmt::format("POINT:LABELS{}", k));
        if (more.empty()) break;
        list.insert(list.end(), more.begin(), more.end());
    }
    if (list.size() > layout_.points)
        remarks_.push_back(fmt::format("{} for {} points; the last ones are left out",
                                       base::counted(list.size(), "label"), layout_.points));
    list.resize(layout_.points);
    return usable_names(std::move(list), remarks_);
}

void Reader::read_samples(MarkerSequence& markers, double mm) {
    const auto processor = section_.processor;
    const std::size_t word = layout_.reals ? 4 : 2;
    std::size_t no_numbers = 0, cortex = 0, at_origin = 0;
    for (std::size_t frame = 0; frame < markers.frames(); ++frame) {
        const auto* at = bytes_.data() + layout_.data_begin + frame * layout_.frame_bytes();
        for (std::size_t point = 0; point < markers.markers(); ++point, at += 4 * word) {
            std::array<double, 3> x{};
            bool valid = false;
            unsigned residual = 0;
            if (layout_.reals) {
                for (std::size_t k = 0; k < 3; ++k) x[k] = double{c3d_real(at + 4 * k, processor)};
                const float w = c3d_real(at + 12, processor);
                valid = w >= 0;
                residual = valid ? static_cast<unsigned>(std::min(w, 65535.0F)) & 0xFFU : 0;
            } else {
                for (std::size_t k = 0; k < 3; ++k)
                    x[k] = layout_.scale * static_cast<std::int16_t>(c3d_word(at + 2 * k, processor));
                const auto w = static_cast<std::int16_t>(c3d_word(at + 6, processor));
                valid = w >= 0;
                residual = static_cast<std::uint16_t>(w) & 0xFFU;
            }
            if (!valid) continue;
            const Point position = mm * Point(x[0], x[1], x[2]);
            if (!position.allFinite()) {
                ++no_numbers;
                continue;
            }
            if (x[0] == cortex_missing && x[1] == cortex_missing && x[2] == cortex_missing) {
                ++cortex;
                continue;
            }
            if (position.cwiseAbs().maxCoeff() > farthest_marker_mm)
                fail(
                    fmt::format("marker {} is {:.3g} mm from the origin in frame {}, and {:g} mm is the most; the unit "
                                "may be another (--unit), or the file is damaged",
                                base::in_quotes(markers.names()[point]), position.norm(),
                                markers.first_frame() + static_cast<std::int64_t>(frame), farthest_marker_mm));
            at_origin += position.isZero(0) ? 1 : 0;
            markers.set(frame, point, position);
            if (residual != 0) markers.set_residual_mm(frame, point, static_cast<float>(mm * layout_.scale * residual));
        }
    }
    if (no_numbers > 0)
        remarks_.push_back(
            fmt::format("{} no numbers; taken as missing", base::counted(no_numbers, "sample holds", "samples hold")));
    if (cortex > 0)
        remarks_.push_back(fmt::format("{} 9999999 in all coordinates; taken as missing",
                                       base::counted(cortex, "sample has", "samples have")));
    if (at_origin > 0)
        remarks_.push_back(fmt::format("{} exactly at the origin and not marked as missing; kept",
                                       base::counted(at_origin, "sample is", "samples are")));
}

void Reader::remark_what_is_left_out() {
    if (layout_.analogue_values > 0)
        remarks_.push_back(
            fmt::format("{} a frame; not read", base::counted(layout_.analogue_values, "analogue value")));
    if (const auto events = section_.count("EVENT:USED").value_or(header(300)); events > 0)
        remarks_.push_back(fmt::format("{}; not read", base::counted(events, "event")));
}

}  // namespace

MotionFile decode_c3d(std::span<const std::uint8_t> bytes, const std::string& name, const MotionReadOptions& options) {
    options.check();
    return Reader(bytes, name, options).read();
}

}  // namespace mimik::capture
