#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

// A tiny ONNX file, written byte by byte: one picture is flattened, and each value of the answer is a weighted sum of
// its pixels and a constant.

namespace mimik::video {

class ProtobufText {
public:
    ProtobufText& number(int field, std::uint64_t value) {
        varint(static_cast<std::uint64_t>(field) << 3U);
        varint(value);
        return *this;
    }
    ProtobufText& text(int field, const std::string& value) {
        varint((static_cast<std::uint64_t>(field) << 3U) | 2U);
        varint(value.size());
        bytes_ += value;
        return *this;
    }
    ProtobufText& part(int field, const ProtobufText& value) { return text(field, value.bytes_); }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    void varint(std::uint64_t value) {
        for (; value >= 128; value >>= 7U) bytes_ += static_cast<char>((value & 127U) | 128U);
        bytes_ += static_cast<char>(value);
    }
    std::string bytes_;
};

struct TinyNet {
    int depth = 3, height = 4, width = 4, values = 136;
    std::vector<float> weights = {};    ///< values x (depth height width), a row per value; empty: all 0
    std::vector<float> constants = {};  ///< per value; empty: all 0
    bool fixed_count = true;            ///< false: it takes any number of pictures
    bool fixed_size = true;             ///< false: height and width have names in the place of numbers
};

inline std::string onnx_file(const TinyNet& net) {
    const auto floats = [](std::vector<float> values, std::size_t count) {
        values.resize(count);
        std::string raw;
        for (const float value : values)
            for (unsigned byte = 0; byte < 4; ++byte)
                raw += static_cast<char>((std::bit_cast<std::uint32_t>(value) >> (8 * byte)) & 255U);
        return raw;
    };
    const auto tensor = [](const std::string& name, const std::vector<int>& sides, const std::string& raw) {
        ProtobufText made;
        for (const int side : sides) made.number(1, static_cast<std::uint64_t>(side));
        return made.number(2, 1).text(8, name).text(9, raw);
    };
    const auto value = [](const std::string& name, const std::vector<int>& sides) {
        ProtobufText shape;
        for (const int side : sides)
            shape.part(1, side > 0 ? ProtobufText().number(1, static_cast<std::uint64_t>(side))
                                   : ProtobufText().text(2, "side"));
        return ProtobufText().text(1, name).part(2, ProtobufText().part(1, ProtobufText().number(1, 1).part(2, shape)));
    };
    const auto node = [](const std::string& type, const std::vector<std::string>& in, const std::string& out) {
        ProtobufText made;
        for (const auto& name : in) made.text(1, name);
        return made.text(2, out).text(3, out + "_node").text(4, type);
    };
    const int pixels = net.depth * net.height * net.width;
    const ProtobufText transposed = ProtobufText().text(1, "transB").number(3, 1).number(20, 2);
    const ProtobufText graph =
        ProtobufText()
            .part(1, node("Flatten", {"picture"}, "flat"))
            .part(1, node("Gemm", {"flat", "weights", "constants"}, "points").part(5, transposed))
            .text(2, "tiny")
            .part(5,
                  tensor("weights", {net.values, pixels},
                         floats(net.weights, static_cast<std::size_t>(net.values) * static_cast<std::size_t>(pixels))))
            .part(5, tensor("constants", {net.values}, floats(net.constants, static_cast<std::size_t>(net.values))))
            .part(11, value("picture", {net.fixed_count ? 1 : 0, net.depth, net.fixed_size ? net.height : 0,
                                        net.fixed_size ? net.width : 0}))
            .part(12, value("points", {1, net.values}));
    return ProtobufText().number(1, 7).part(8, ProtobufText().text(1, "").number(2, 11)).part(7, graph).bytes();
}

}  // namespace mimik::video
