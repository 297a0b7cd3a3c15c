#include "capture/marker_sequence.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::capture {
namespace {

std::string some_names(std::span<const std::string> names) {
    constexpr std::size_t shown = 12;
    const auto count = static_cast<std::ptrdiff_t>(std::min(names.size(), shown));
    return fmt::format("{}{}", fmt::join(names.begin(), names.begin() + count, ", "),
                       names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : std::string());
}

}  // namespace

MarkerSequence::MarkerSequence(std::vector<std::string> names, double rate_hz, std::size_t frames,
                               std::int64_t first_frame)
    : names_(std::move(names)), rate_hz_(rate_hz), frames_(frames), first_frame_(first_frame) {
    if (!std::isfinite(rate_hz) || rate_hz <= 0)
        throw InputError(fmt::format("the frame rate is {} Hz; give one above 0", rate_hz));
    std::set<std::string_view> seen;
    for (std::size_t k = 0; k < names_.size(); ++k) {
        if (names_[k].empty()) throw InputError(fmt::format("marker {} has no name; give it one", k + 1));
        if (!seen.insert(names_[k]).second)
            throw InputError(
                fmt::format("marker {} is there twice; rename one of the two", base::in_quotes(names_[k])));
    }
    positions_mm_.assign(frames * names_.size(), Point::Zero());
    valid_.assign(frames * names_.size(), 0);
}

std::optional<std::size_t> MarkerSequence::find(const std::string& name) const {
    const auto it = std::find(names_.begin(), names_.end(), name);
    return it == names_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(it - names_.begin()));
}

std::size_t MarkerSequence::index(const std::string& name) const {
    if (const auto found = find(name)) return *found;
    for (const auto& other : names_)
        if (base::equal_ignoring_case(other, name))
            throw InputError(
                fmt::format("there is no marker {}; did you mean {}?", base::in_quotes(name), base::in_quotes(other)));
    throw InputError(fmt::format("there is no marker {}; there are {}", base::in_quotes(name), some_names(names_)));
}

void MarkerSequence::set_residual_mm(std::size_t frame, std::size_t marker, float residual_mm) {
    if (residuals_mm_.empty()) residuals_mm_.assign(valid_.size(), 0.0F);
    residuals_mm_[frame * markers() + marker] = residual_mm;
}

std::size_t MarkerSequence::valid_count(std::size_t marker) const {
    std::size_t count = 0;
    for (std::size_t frame = 0; frame < frames_; ++frame) count += valid(frame, marker) ? 1 : 0;
    return count;
}

std::vector<MarkerGap> gaps(const MarkerSequence& sequence) {
    std::vector<MarkerGap> list;
    for (std::size_t marker = 0; marker < sequence.markers(); ++marker)
        for (std::size_t frame = 0; frame < sequence.frames(); ++frame) {
            if (sequence.valid(frame, marker)) continue;
            const auto first = frame;
            while (frame + 1 < sequence.frames() && !sequence.valid(frame + 1, marker)) ++frame;
            list.push_back({marker, first, frame});
        }
    return list;
}

namespace {

void copy_sample(const MarkerSequence& from, std::size_t frame, std::size_t marker, MarkerSequence& to,
                 std::size_t to_frame, std::size_t to_marker) {
    if (from.valid(frame, marker)) to.set(to_frame, to_marker, from.at_mm(frame, marker));
    if (from.has_residuals()) to.set_residual_mm(to_frame, to_marker, from.residual_mm(frame, marker));
}

}  // namespace

MarkerSequence frames_between(const MarkerSequence& sequence, std::int64_t first, std::int64_t last) {
    const auto before = sequence.first_frame();
    const auto end = before + static_cast<std::int64_t>(sequence.frames());
    if (first < before || last < first || last >= end)
        throw InputError(
            fmt::format("frames {} to {} are asked for; there are {} to {}", first, last, before, end - 1));
    const auto skipped = static_cast<std::size_t>(first - before);
    const auto names = sequence.names();
    MarkerSequence part({names.begin(), names.end()}, sequence.rate_hz(), static_cast<std::size_t>(last - first) + 1,
                        first);
    for (std::size_t frame = 0; frame < part.frames(); ++frame)
        for (std::size_t marker = 0; marker < part.markers(); ++marker)
            copy_sample(sequence, frame + skipped, marker, part, frame, marker);
    return part;
}

MarkerSequence with_markers(const MarkerSequence& sequence, std::span<const std::string> names) {
    std::vector<std::size_t> chosen;
    chosen.reserve(names.size());
    for (const auto& name : names) chosen.push_back(sequence.index(name));
    MarkerSequence part({names.begin(), names.end()}, sequence.rate_hz(), sequence.frames(), sequence.first_frame());
    for (std::size_t frame = 0; frame < part.frames(); ++frame)
        for (std::size_t marker = 0; marker < part.markers(); ++marker)
            copy_sample(sequence, frame, chosen[marker], part, frame, marker);
    return part;
}

}  // namespace mimik::capture
