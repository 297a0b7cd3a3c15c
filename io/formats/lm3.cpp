#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "io/formats/landmark_formats.h"
#include "io/landmark_io.h"

namespace mimik::io {

using geometry::Landmarks;
using geometry::Point;

std::size_t read_landmark_count(base::LineReader& lines) {
    std::optional<base::LineReader> other;  // at the first line that is nothing known
    bool free_text = false;
    while (lines.next()) {
        std::string_view rest = base::trimmed(lines.line());
        if (rest.starts_with('#')) continue;
        free_text = !rest.empty() && (free_text || rest.starts_with('*'));
        const auto number = base::next_word(rest);
        const bool announced = base::equal_ignoring_case(base::trimmed(rest), "landmarks:");
        if (const auto count = base::parse_integer(number); announced && count) {
            if (*count < 0 || *count > static_cast<std::int64_t>(most_landmarks))
                lines.fail(fmt::format("the number of landmarks is {}; a face has 0 to {}", *count, most_landmarks));
            return static_cast<std::size_t>(*count);
        }
        if (free_text || number.empty()) continue;
        if (announced)
            lines.fail(fmt::format("the number of landmarks is {}, not a whole number", base::in_quotes(number)));
        if (!other) other = lines;
    }
    if (other)
        other->fail(
            fmt::format("{} stands where the number of landmarks is expected, such as '22 landmarks:'; the file is "
                        "damaged or of another format",
                        base::in_quotes(other->line())));
    throw InputError(fmt::format(
        "{}: has no line '<N> landmarks:', such as '22 landmarks:'; it is empty, truncated or of another format",
        lines.file_name()));
}

namespace formats {

RawLandmarks decode_lm3(std::string_view text, const std::string& name) {
    base::LineReader lines(text, name);
    const auto count = read_landmark_count(lines);
    RawLandmarks raw;
    for (std::size_t i = 0; i < count; ++i) {
        if (!lines.next_not_blank())
            throw InputError(fmt::format("{}: has {} of the {} that it announces; it is truncated", name, i,
                                         base::counted(count, "landmark")));
        const auto label = base::trimmed(lines.line());
        if (!lines.next_not_blank())
            throw InputError(
                fmt::format("{}: landmark {} has no position; the file is truncated", name, base::in_quotes(label)));
        std::string_view rest = lines.line();
        Point position;
        for (auto& coordinate : position) {
            const auto word = base::next_word(rest);
            const auto value = base::parse_double(word);
            if (!value || !std::isfinite(*value))
                lines.fail(
                    fmt::format("coordinate of landmark {} is {}, not a finite number; leave a landmark that is not "
                                "visible out, with its label",
                                base::in_quotes(label), word.empty() ? "missing" : base::in_quotes(word)));
            coordinate = *value;
        }
        if (const auto extra = base::next_word(rest); !extra.empty())
            lines.fail(fmt::format("{} stands after the position of landmark {}", base::in_quotes(extra),
                                   base::in_quotes(label)));
        add_mark(raw, label, position, name);
    }
    if (lines.next_not_blank())
        lines.fail(fmt::format("{} stands after the {} that the file announces; correct the number",
                               base::in_quotes(lines.line()), base::counted(count, "landmark")));
    return raw;
}

std::string encode_lm3(const Landmarks& landmarks) {
    std::string text = fmt::format("# 3D landmarks, millimetres\n\n{} landmarks:\n", landmarks.size());
    for (const auto& mark : landmarks.all())
        fmt::format_to(std::back_inserter(text), "{}\n{:.17g} {:.17g} {:.17g}\n", mark.name, mark.position_mm.x(),
                       mark.position_mm.y(), mark.position_mm.z());
    return text;
}

}  // namespace formats
}  // namespace mimik::io
