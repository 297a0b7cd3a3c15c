#include "capture/marker_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/text.h"
#include "capture/marker_names.h"

namespace mimik::capture {
namespace {

constexpr std::int64_t most_frame_number = std::int64_t{1} << 40;

/// Columns of one marker in a wide table.
struct MarkerColumns {
    std::string name;
    std::array<std::size_t, 3> x{};
};

class Reader {
public:
    Reader(std::string_view text, const std::string& name, const MotionReadOptions& options)
        : rows_(text, name), name_(name), options_(options), mm_(io::millimetres_per(unit())) {
        frame_column_ = rows_.find_column("frame");
        if (!frame_column_) frame_column_ = rows_.find_column("frame#");
        time_column_ = rows_.find_column("time");
    }

    MotionFile read() {
        auto marker = rows_.find_column("marker");
        if (!marker) marker = rows_.find_column("name");
        const bool is_long = marker && rows_.find_column("x") && rows_.find_column("y") && rows_.find_column("z");
        MotionFile file;
        file.format = is_long ? "CSV, long" : "CSV, wide";
        file.unit = io::to_string(unit());
        file.markers = is_long ? read_long(*marker) : read_wide();
        file.remarks = std::move(remarks_);
        return file;
    }

private:
    [[nodiscard]] io::LengthUnit unit() const { return options_.unit.value_or(io::LengthUnit::millimetre); }
    [[nodiscard]] std::vector<MarkerColumns> marker_columns() const;
    [[nodiscard]] std::optional<Point> position(const std::array<std::size_t, 3>& columns,
                                                const std::string& marker) const;
    [[nodiscard]] std::int64_t frame_number(std::int64_t otherwise) const;
    [[nodiscard]] std::optional<double> time_s() const;
    [[nodiscard]] double rate_hz(const std::map<std::int64_t, double>& times_s);
    MarkerSequence read_wide();
    MarkerSequence read_long(std::size_t marker_column);
    void check_size(std::uint64_t markers, std::uint64_t frames) const {
        if (markers * frames > most_samples)
            rows_.fail(fmt::format("more than the {} samples that Mimik reads; cut the recording", most_samples));
    }

    base::CsvReader rows_;
    std::string name_;
    const MotionReadOptions& options_;
    double mm_ = 1;
    std::optional<std::size_t> frame_column_, time_column_;
    std::vector<std::string> remarks_;
};

/// A few samples must not stand for a sea of missing ones.
bool too_sparse(std::uint64_t samples, std::uint64_t stated) {
    constexpr std::uint64_t always = 1'000'000, samples_a_stated_one = 32;
    return samples > std::max(always, samples_a_stated_one * stated);
}

/// The axis of a column NAME_x; none where it is none.
std::optional<std::size_t> axis_of(std::string_view column) {
    if (column.size() < 3) return std::nullopt;
    const auto sign = column[column.size() - 2];
    if (std::string_view("_-.: ").find(sign) == std::string_view::npos) return std::nullopt;
    switch (column.back()) {
        case 'x':
        case 'X':
            return 0;
        case 'y':
        case 'Y':
            return 1;
        case 'z':
        case 'Z':
            return 2;
        default:
            return std::nullopt;
    }
}

std::vector<MarkerColumns> Reader::marker_columns() const {
    constexpr auto none = static_cast<std::size_t>(-1);
    std::vector<MarkerColumns> markers;
    std::map<std::string, std::size_t> place;
    for (std::size_t column = 0; column < rows_.header().size(); ++column) {
        const auto& title = rows_.header()[column];
        const auto axis = axis_of(title);
        if (!axis) continue;
        auto stem = std::string(base::trimmed(std::string_view(title).substr(0, title.size() - 2)));
        const auto [it, is_new] = place.try_emplace(stem, markers.size());
        if (is_new) markers.push_back({std::move(stem), {none, none, none}});
        auto& there = markers[it->second].x[*axis];
        if (there != none)
            throw InputError(fmt::format("{}: there are two columns of {} for {}; rename one", name_, "xyz"[*axis],
                                         base::in_quotes(markers[it->second].name)));
        there = column;
    }
    for (const auto& marker : markers)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (marker.x[axis] == none)
                throw InputError(fmt::format("{}: marker {} has no column {}_{}; add it, or rename its others", name_,
                                             base::in_quotes(marker.name), marker.name, "xyz"[axis]));
    if (markers.empty())
        throw InputError(
            fmt::format("{}: no column of a marker; a wide table has NAME_x, NAME_y, NAME_z, a long one "
                        "marker, x, y, z",
                        name_));
    return markers;
}

std::optional<Point> Reader::position(const std::array<std::size_t, 3>& columns, const std::string& marker) const {
    Point point;
    int known = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& field = rows_.field(columns[axis]);
        if (field.empty()) continue;
        const auto plain = base::parse_double_or_nan(field);
        if (plain && !std::isfinite(*plain)) continue;
        const double value = rows_.number(columns[axis]);  // a decimal comma, too
        point[static_cast<Eigen::Index>(axis)] = mm_ * value;
        ++known;
    }
    if (known == 0) return std::nullopt;
    if (known != 3) rows_.fail(fmt::format("marker {} has {} of its 3 coordinates", base::in_quotes(marker), known));
    if (!(point.cwiseAbs().maxCoeff() <= farthest_marker_mm))
        rows_.fail(
            fmt::format("marker {} is {:.3g} mm from the origin, and {:g} mm is the most; the unit may be another "
                        "(--unit)",
                        base::in_quotes(marker), point.norm(), farthest_marker_mm));
    return point;
}

std::int64_t Reader::frame_number(std::int64_t otherwise) const {
    if (!frame_column_) return otherwise;
    const auto number = base::parse_integer(rows_.field(*frame_column_));
    if (!number || *number > most_frame_number || *number < -most_frame_number)
        rows_.fail(fmt::format("frame is {}; give a whole number up to {}",
                               base::in_quotes(rows_.field(*frame_column_)), most_frame_number));
    return *number;
}

std::optional<double> Reader::time_s() const {
    if (!time_column_ || rows_.field(*time_column_).empty()) return std::nullopt;
    const double value = rows_.number(*time_column_);
    if (!std::isfinite(value)) rows_.fail("time is not finite; give seconds");
    return value;
}

double Reader::rate_hz(const std::map<std::int64_t, double>& times_s) {
    if (options_.rate_hz) return *options_.rate_hz;
    if (times_s.size() < 2)
        throw InputError(
            fmt::format("{}: nothing says how many frames a second; give it (--rate), or a column time in "
                        "seconds",
                        name_));
    const auto first = *times_s.begin(), last = *times_s.rbegin();
    const double rate = static_cast<double>(last.first - first.first) / (last.second - first.second);
    if (!std::isfinite(rate) || rate <= 0)
        throw InputError(fmt::format("{}: time goes from {} to {} s over {} frames; give seconds that grow", name_,
                                     first.second, last.second, times_s.size()));
    double largest_off_s = 0;
    for (const auto& [frame, time] : times_s)
        largest_off_s =
            std::max(largest_off_s, std::abs(time - first.second - static_cast<double>(frame - first.first) / rate));
    if (largest_off_s * rate > 0.5)
        remarks_.push_back(fmt::format("time is up to {:.3g} s off a constant rate of {:.6g} Hz", largest_off_s, rate));
    // Time is written with some digits; rates have few.
    const double rounded = std::round(rate * 1e4) / 1e4;
    return std::abs(rounded - rate) < 1e-6 * rate ? rounded : rate;
}

MarkerSequence Reader::read_wide() {
    const auto columns = marker_columns();
    std::vector<std::optional<Point>> samples;
    std::vector<std::int64_t> numbers;
    std::map<std::int64_t, double> by_row_s, by_number_s;
    std::int64_t frames = 0;
    std::size_t jumps = 0;
    while (rows_.next()) {
        check_size(columns.size(), static_cast<std::uint64_t>(frames) + 1);
        const auto number = frame_number(frames + 1);
        jumps += frames > 0 && number != numbers.back() + 1 ? 1 : 0;
        numbers.push_back(number);
        if (const auto time = time_s()) {
            by_row_s.emplace(frames, *time);
            by_number_s.emplace(number, *time);
        }
        for (const auto& marker : columns) samples.push_back(position(marker.x, marker.name));
        ++frames;
    }
    if (frames == 0) throw InputError(fmt::format("{}: there is no row; the table holds no motion", name_));
    // Numbers that grow say when each row was; frames between them are absent, not shorter.
    const bool grow = std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
    const auto span = static_cast<std::uint64_t>(numbers.back() - numbers.front()) + 1;
    const bool placed = grow && span <= most_samples && !too_sparse(span * columns.size(), samples.size());
    if (jumps > 0 && placed)
        remarks_.push_back(fmt::format("{} absent; the markers are missing there",
                                       base::counted(span - numbers.size(), "frame is", "frames are")));
    else if (jumps > 0)
        remarks_.push_back(fmt::format("{} not one more than the frame before; taken in the order of the rows",
                                       base::counted(jumps, "frame is", "frames are")));
    if (placed) check_size(columns.size(), span);
    std::vector<std::string> names;
    for (const auto& marker : columns) names.push_back(marker.name);
    MarkerSequence sequence(usable_names(std::move(names), remarks_), rate_hz(placed ? by_number_s : by_row_s),
                            placed ? static_cast<std::size_t>(span) : numbers.size(), numbers.front());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const auto row = k / columns.size();
        const auto frame = placed ? static_cast<std::size_t>(numbers[row] - numbers.front()) : row;
        if (samples[k]) sequence.set(frame, k % columns.size(), *samples[k]);
    }
    return sequence;
}

MarkerSequence Reader::read_long(std::size_t marker_column) {
    const std::array columns = {rows_.column("x"), rows_.column("y"), rows_.column("z")};
    if (!frame_column_) throw InputError(fmt::format("{}: a long table needs a column frame; add it", name_));
    std::map<std::int64_t, std::map<std::size_t, std::optional<Point>>> frames;
    std::map<std::int64_t, double> times_s;
    std::map<std::string, std::size_t> place;
    std::vector<std::string> names;
    std::uint64_t rows = 0;
    while (rows_.next()) {
        check_size(1, rows + 1);
        const auto& name = rows_.field(marker_column);
        if (name.empty()) rows_.fail("the marker has no name; give it one");
        const auto [it, is_new] = place.try_emplace(name, names.size());
        if (is_new) names.push_back(name);
        const auto number = frame_number(0);
        if (const auto time = time_s()) times_s.emplace(number, *time);
        if (!frames[number].emplace(it->second, position(columns, name)).second)
            rows_.fail(fmt::format("marker {} is there twice in frame {}", base::in_quotes(name), number));
        ++rows;
    }
    if (frames.empty()) throw InputError(fmt::format("{}: there is no row; the table holds no motion", name_));
    const auto first = frames.begin()->first;
    const auto span = static_cast<std::uint64_t>(frames.rbegin()->first - first) + 1;
    if (span > most_samples || too_sparse(span * names.size(), rows))
        throw InputError(
            fmt::format("{}: {} and {} frames from {} on, but only {}; number the frames one after another", name_,
                        base::counted(names.size(), "marker"), span, first, base::counted(rows, "row")));
    check_size(names.size(), span);
    const double rate = rate_hz(times_s);
    MarkerSequence sequence(usable_names(std::move(names), remarks_), rate, span, first);
    for (const auto& [number, samples] : frames)
        for (const auto& [marker, position_mm] : samples)
            if (position_mm) sequence.set(static_cast<std::size_t>(number - first), marker, *position_mm);
    return sequence;
}

}  // namespace

MotionFile decode_marker_csv(std::string_view text, const std::string& name, const MotionReadOptions& options) {
    options.check();
    return Reader(text, name, options).read();
}

std::string encode_marker_csv(const MarkerSequence& markers) {
    std::string text = "frame,time";
    for (const auto& name : markers.names())
        for (const char axis : {'x', 'y', 'z'}) text += ',' + base::csv_field(fmt::format("{}_{}", name, axis));
    text += '\n';
    for (std::size_t frame = 0; frame < markers.frames(); ++frame) {
        const auto number = markers.first_frame() + static_cast<std::int64_t>(frame);
        fmt::format_to(std::back_inserter(text), "{},{}", number, static_cast<double>(frame) / markers.rate_hz());
        for (std::size_t marker = 0; marker < markers.markers(); ++marker) {
            const auto& p = markers.at_mm(frame, marker);
            if (markers.valid(frame, marker))
                fmt::format_to(std::back_inserter(text), ",{},{},{}", p.x(), p.y(), p.z());
            else
                text += ",,,";
        }
        text += '\n';
    }
    return text;
}

}  // namespace mimik::capture
