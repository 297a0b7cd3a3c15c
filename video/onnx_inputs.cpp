#include "video/onnx_inputs.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace mimik::video {
namespace {

/// Fields of a protobuf message, one after the other; false at the end, or where it is damaged.
class Fields {
public:
    explicit Fields(std::string_view message) : rest_(message) {}
    bool next() {
        const auto tag = varint();
        if (!tag) return false;
        number = *tag >> 3U;
        value = 0;
        bytes = {};
        std::uint64_t length = 0;
        switch (*tag & 7U) {
            case 0:
                value = varint().value_or(0);
                return true;
            case 1:
                length = 8;
                break;
            case 2:
                length = varint().value_or(rest_.size() + 1);
                break;
            case 5:
                length = 4;
                break;
            default:
                return false;
        }
        if (length > rest_.size()) return false;
        bytes = rest_.substr(0, length);
        rest_.remove_prefix(length);
        return true;
    }
    std::uint64_t number = 0, value = 0;
    std::string_view bytes;

private:
    std::optional<std::uint64_t> varint() {
        std::uint64_t made = 0;
        for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
            const auto byte = static_cast<std::uint8_t>(rest_.front());
            rest_.remove_prefix(1);
            made |= static_cast<std::uint64_t>(byte & 127U) << shift;
            if (byte < 128) return made;
        }
        return std::nullopt;
    }
    std::string_view rest_;
};

/// The field of this number; empty: there is none.
std::string_view part_of(std::string_view message, std::uint64_t number) {
    for (Fields fields(message); fields.next();)
        if (fields.number == number) return fields.bytes;
    return {};
}

/// Sides of an ONNX ValueInfoProto's tensor; 0: not fixed.
std::vector<int> sides_of(std::string_view value_info) {
    std::vector<int> shape;
    for (Fields sides(part_of(part_of(part_of(value_info, 2), 1), 2)); sides.next();) {
        if (sides.number != 1) continue;
        std::uint64_t side = 0;
        for (Fields fields(sides.bytes); fields.next();)
            if (fields.number == 1) side = fields.value;
        shape.push_back(side < 1'000'000 ? static_cast<int>(side) : 0);
    }
    return shape;
}

}  // namespace

std::vector<std::vector<int>> onnx_inputs(std::string_view model) {
    const auto graph = part_of(model, 7);
    std::unordered_set<std::string_view> constants;
    for (Fields fields(graph); fields.next();)
        if (fields.number == 5) constants.insert(part_of(fields.bytes, 8));
    std::vector<std::vector<int>> inputs;
    for (Fields fields(graph); fields.next();)
        if (fields.number == 11 && !constants.contains(part_of(fields.bytes, 1)))
            inputs.push_back(sides_of(fields.bytes));
    return inputs;
}

}  // namespace mimik::video
