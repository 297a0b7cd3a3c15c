#pragma once

#include <span>
#include <string>

namespace mimik::facs {

/// A point of a catalogue and the offset that it is to have.
struct PointOffset {
    int unit = 0;
    std::string point;
    double lateral = 0, up = 0;
};

/// The text of a catalogue with the offsets of some points replaced, and nothing else: comments and layout stay.
/// @throws InputError if the text is no catalogue, or has no such point.
[[nodiscard]] std::string with_offsets(const std::string& text, std::span<const PointOffset> offsets);

}  // namespace mimik::facs
