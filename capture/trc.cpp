#include "capture/trc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "capture/length_units.h"
#include "capture/marker_names.h"

namespace mimik::capture {
namespace {

using Fields = std::vector<std::string_view>;

/// By tabs, as the format says; a line without one by runs of blanks.
Fields split(std::string_view line) {
    Fields fields;
    if (line.find('\t') == std::string_view::npos) {
        for (auto word = base::next_word(line); !word.empty(); word = base::next_word(line)) fields.push_back(word);
        return fields;
    }
    while (true) {
        const auto tab = line.find('\t');
        fields.push_back(base::trimmed(line.substr(0, tab)));
        if (tab == std::string_view::npos) break;
        line.remove_prefix(tab + 1);
    }
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    return fields;
}

class Reader {
public:
    Reader(std::string_view text, const std::string& name, const MotionReadOptions& options)
        : lines_(text, name), name_(name), options_(options) {}

    MotionFile read() {
        read_values();
        read_names();
        read_rows();
        MotionFile file;
        file.format = "TRC";
        file.unit = io::to_string(unit_);
        file.markers = MarkerSequence(usable_names(names_, remarks_), rate_hz_, rows_, first_frame_);
        for (std::size_t k = 0; k < samples_mm_.size(); ++k)
            if (samples_mm_[k]) file.markers.set(k / names_.size(), k % names_.size(), *samples_mm_[k]);
        file.remarks = std::move(remarks_);
        return file;
    }

private:
    void read_values();
    void read_names();
    void read_rows();
    void read_row(const Fields& fields);
    [[nodiscard]] std::optional<double> number(const Fields& fields, std::size_t k) const;

    base::LineReader lines_;
    std::string name_;
    const MotionReadOptions& options_;
    std::vector<std::string> names_, remarks_;
    io::LengthUnit unit_ = io::LengthUnit::millimetre;
    double rate_hz_ = 0;
    std::optional<std::int64_t> stated_frames_, stated_markers_, last_frame_;
    std::int64_t first_frame_ = 1;
    std::size_t rows_ = 0, jumps_ = 0;
    std::uint64_t row_bytes_ = 0;
    std::vector<std::optional<Point>> samples_mm_;
};

void Reader::read_values() {
    if (!lines_.next() || !lines_.line().starts_with("PathFileType"))
        lines_.fail("does not begin with PathFileType; it is no TRC file");
    if (!lines_.next())
        lines_.fail("the file ends before the names of its values (DataRate, Units, ...); it is truncated");
    const auto keys = split(lines_.line());
    std::vector<std::string> key_names(keys.begin(), keys.end());
    if (!lines_.next()) lines_.fail("the file ends before its values (DataRate, Units, ...); it is truncated");
    const auto values = split(lines_.line());
    const auto value = [&](std::string_view key) -> std::string_view {
        for (std::size_t k = 0; k < key_names.size() && k < values.size(); ++k)
            if (base::equal_ignoring_case(key_names[k], key)) return values[k];
        return {};
    };
    const auto rate = base::parse_double(value("DataRate"));
    rate_hz_ = options_.rate_hz.value_or(rate.value_or(0));
    if (!std::isfinite(rate_hz_) || rate_hz_ <= 0)
        lines_.fail(
            fmt::format("DataRate is {}; give the rate of the frames (--rate)", base::in_quotes(value("DataRate"))));
    if (options_.unit) {
        unit_ = *options_.unit;
    } else if (const auto unit = value("Units"); !unit.empty()) {
        unit_ = unit_of_motion_file(std::string(unit), name_, "Units");
    } else {
        remarks_.emplace_back("Units says nothing; millimetres are assumed");
    }
    stated_frames_ = base::parse_integer(value("NumFrames"));
    stated_markers_ = base::parse_integer(value("NumMarkers"));
}

void Reader::read_names() {
    if (!lines_.next()) lines_.fail("the file ends before the names of its markers; it is truncated");
    const bool tabs = lines_.line().find('\t') != std::string_view::npos;
    const auto fields = split(lines_.line());
    if (fields.size() < 3 || !base::equal_ignoring_case(fields[0].substr(0, 5), "Frame"))
        lines_.fail(fmt::format("is {}; the line Frame#, Time and the names of the markers belongs here",
                                base::in_quotes(lines_.line())));
    // A name stands over the first of three columns. A file that lost its tabs has them one after another.
    const std::size_t step = tabs ? 3 : 1;
    for (std::size_t k = 2; k < fields.size(); k += step) names_.emplace_back(fields[k]);
    if (tabs)
        for (std::size_t k = 2; k < fields.size(); ++k)
            if ((k - 2) % 3 != 0 && !fields[k].empty())
                lines_.fail(fmt::format("{} stands over no x coordinate; every name needs two empty columns behind it",
                                        base::in_quotes(fields[k])));
    if (stated_markers_ && *stated_markers_ != static_cast<std::int64_t>(names_.size())) {
        if (!tabs)
            lines_.fail(fmt::format("{} where NumMarkers says {}, and blanks separate them; separate them by tabs",
                                    base::counted(names_.size(), "name"), *stated_markers_));
        remarks_.push_back(fmt::format("NumMarkers says {}, there are {}; the latter holds", *stated_markers_,
                                       base::counted(names_.size(), "name")));
    }
}

std::optional<double> Reader::number(const Fields& fields, std::size_t k) const {
    if (k >= fields.size() || fields[k].empty()) return std::nullopt;
    const auto value = base::parse_double_or_nan(fields[k]);
    if (!value) lines_.fail(fmt::format("column {} is {}, not a number", k + 1, base::in_quotes(fields[k])));
    return std::isfinite(*value) ? value : std::nullopt;
}

void Reader::read_row(const Fields& fields) {
    if (fields.size() > 2 + 3 * names_.size())
        lines_.fail(fmt::format("has {} columns; {} have {}", fields.size(), base::counted(names_.size(), "marker"),
                                2 + 3 * names_.size()));
    if (lines_.line().find('\t') == std::string_view::npos && fields.size() < 2 + 3 * names_.size())
        lines_.fail(
            fmt::format("has {} of {} columns, and blanks separate them: nothing says which are missing; separate "
                        "them by tabs",
                        fields.size(), 2 + 3 * names_.size()));
    const auto frame = base::parse_integer(fields[0]);
    constexpr std::int64_t most_frame_number = std::int64_t{1} << 40;
    if (!frame || *frame > most_frame_number || *frame < -most_frame_number)
        lines_.fail(
            fmt::format("Frame# is {}; give a whole number up to {}", base::in_quotes(fields[0]), most_frame_number));
    // A few short rows must not stand for a sea of missing samples.
    constexpr std::uint64_t always = 1'000'000, samples_a_byte = 8;
    row_bytes_ += lines_.line().size() + 1;
    if ((rows_ + 1) * names_.size() > std::max(always, samples_a_byte * row_bytes_))
        lines_.fail(
            fmt::format("{} and {} by now, nearly all of them missing; it is damaged, or take out the markers "
                        "that were never seen",
                        base::counted(names_.size(), "marker"), base::counted(rows_ + 1, "frame")));
    if (rows_ == 0) first_frame_ = *frame;
    if (last_frame_ && *frame != *last_frame_ + 1) ++jumps_;
    last_frame_ = frame;
    const double mm = io::millimetres_per(unit_);
    for (std::size_t marker = 0; marker < names_.size(); ++marker) {
        std::array<std::optional<double>, 3> x;
        for (std::size_t k = 0; k < 3; ++k) x[k] = number(fields, 2 + 3 * marker + k);
        const auto known = std::count_if(x.begin(), x.end(), [](const auto& one) { return one.has_value(); });
        if (known != 0 && known != 3)
            lines_.fail(fmt::format("marker {} has {} of its 3 coordinates", base::in_quotes(names_[marker]), known));
        if (known == 0) {
            samples_mm_.emplace_back();
            continue;
        }
        const Point position = mm * Point(*x[0], *x[1], *x[2]);
        if (!(position.cwiseAbs().maxCoeff() <= farthest_marker_mm))
            lines_.fail(
                fmt::format("marker {} is {:.3g} mm from the origin, and {:g} mm is the most; the unit may be "
                            "another (--unit)",
                            base::in_quotes(names_[marker]), position.norm(), farthest_marker_mm));
        samples_mm_.emplace_back(position);
    }
    ++rows_;
}

void Reader::read_rows() {
    bool first = true;
    while (lines_.next_not_blank()) {
        const auto fields = split(lines_.line());
        if (fields.empty()) continue;
        // The line X1 Y1 Z1 ... begins with two tabs, or has lost them.
        if (first && (fields[0].empty() || fields[0].starts_with('X') || fields[0].starts_with('x'))) {
            first = false;
            continue;
        }
        first = false;
        if ((rows_ + 1) * names_.size() > most_samples)
            lines_.fail(fmt::format("more than the {} samples that Mimik reads; cut the recording", most_samples));
        read_row(fields);
    }
    if (rows_ == 0)
        throw InputError(fmt::format("{}: there is no row; the file holds no motion, or is truncated", name_));
    if (stated_frames_ && *stated_frames_ != static_cast<std::int64_t>(rows_))
        remarks_.push_back(fmt::format("NumFrames says {}, there are {}; the latter holds", *stated_frames_,
                                       base::counted(rows_, "row")));
    if (jumps_ > 0)
        remarks_.push_back(fmt::format("{} not one more than the frame before; taken in the order of the rows",
                                       base::counted(jumps_, "Frame# is", "Frame# are")));
}

}  // namespace

MotionFile decode_trc(std::string_view text, const std::string& name, const MotionReadOptions& options) {
    options.check();
    return Reader(text, name, options).read();
}

std::string encode_trc(const MarkerSequence& markers, const std::string& name) {
    if (markers.markers() == 0 || markers.frames() == 0)
        throw InputError(fmt::format("{}: there is no {} to write", name, markers.markers() == 0 ? "marker" : "frame"));
    std::string text = fmt::format("PathFileType\t4\t(X/Y/Z)\t{}\n", std::filesystem::path(name).filename().string());
    text += "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n";
    text += fmt::format("{0}\t{0}\t{1}\t{2}\tmm\t{0}\t{3}\t{1}\n", markers.rate_hz(), markers.frames(),
                        markers.markers(), markers.first_frame());
    text += "Frame#\tTime";
    for (const auto& one : markers.names()) {
        if (one.find_first_of("\t\r\n") != std::string::npos)
            throw InputError(fmt::format("{}: the name {} holds a tab or a line break; rename the marker", name,
                                         base::in_quotes(one)));
        text += '\t' + one + "\t\t";
    }
    text += "\n\t";
    for (std::size_t k = 1; k <= markers.markers(); ++k) text += fmt::format("\tX{0}\tY{0}\tZ{0}", k);
    text += "\n\n";
    for (std::size_t frame = 0; frame < markers.frames(); ++frame) {
        const auto number = markers.first_frame() + static_cast<std::int64_t>(frame);
        fmt::format_to(std::back_inserter(text), "{}\t{}", number, static_cast<double>(frame) / markers.rate_hz());
        for (std::size_t marker = 0; marker < markers.markers(); ++marker) {
            const auto& p = markers.at_mm(frame, marker);
            if (markers.valid(frame, marker))
                fmt::format_to(std::back_inserter(text), "\t{}\t{}\t{}", p.x(), p.y(), p.z());
            else
                text += "\t\t\t";
        }
        text += '\n';
    }
    return text;
}

}  // namespace mimik::capture
