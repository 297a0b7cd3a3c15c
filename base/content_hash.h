#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace mimik::base {

/// Tells one content from another, the same on every machine: FNV-1a, 64 bits. No defence against people who want two
/// contents to look alike.
class ContentHash {
public:
    void add(std::string_view bytes) {
        for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    }
    void add(double number) {
        const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
        add(std::string_view(bytes.data(), bytes.size()));
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }
    [[nodiscard]] std::string text() const;  ///< 16 hexadecimal digits

private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace mimik::base
