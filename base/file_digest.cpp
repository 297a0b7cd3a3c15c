#include "base/file_digest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/file.h"

namespace mimik::base {

namespace {

constexpr std::uint64_t prime = 0x9e3779b97f4a7c15ULL;
constexpr std::size_t lanes = 4;

/// Little endian, whatever the machine.
std::uint64_t word_at(const char* bytes, std::size_t count) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(&word, bytes, count);
    else
        for (std::size_t k = 0; k < count; ++k) word |= std::uint64_t{static_cast<unsigned char>(bytes[k])} << (8 * k);
    return word;
}

/// One to one in each argument: a single word that differs always shows. The turn brings high bits down, so that two
/// flipped signs do not cancel.
std::uint64_t mixed(std::uint64_t state, std::uint64_t word) { return std::rotl((state ^ word) * prime, 29); }

}  // namespace

std::string FileDigest::text() const { return fmt::format("{} {:016x}", bytes, hash); }

FileDigest digest_of(std::string_view bytes) {
    constexpr std::size_t step = 8;
    std::array<std::uint64_t, lanes> state = {1, 2, 3, 4};  // lanes do not wait for one another
    std::size_t at = 0, lane = 0;
    for (; at + lanes * step <= bytes.size(); at += lanes * step)
        for (std::size_t k = 0; k < lanes; ++k) state[k] = mixed(state[k], word_at(bytes.data() + at + k * step, step));
    for (; at < bytes.size(); at += step, lane = (lane + 1) % lanes)
        state[lane] = mixed(state[lane], word_at(bytes.data() + at, std::min(step, bytes.size() - at)));
    std::uint64_t hash = bytes.size();
    for (const auto value : state) hash = mixed(hash, value);
    return {bytes.size(), hash};
}

FileDigest digest_of_file(const std::filesystem::path& file) { return digest_of(read_text(file)); }

}  // namespace mimik::base
