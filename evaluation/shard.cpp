#include "evaluation/shard.h"

#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::evaluation {
namespace {

/// 1 ... most_shards
std::optional<std::size_t> number(std::string_view text) {
    std::size_t value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size() || value < 1 || value > most_shards)
        return std::nullopt;
    return value;
}

}  // namespace

std::string Shard::text() const { return fmt::format("{}/{}", index, count); }

Shard parse_shard(std::string_view text) {
    const auto slash = text.find('/');
    const auto index = number(text.substr(0, slash));
    const auto count = slash == std::string_view::npos ? std::nullopt : number(text.substr(slash + 1));
    if (!index || !count || *index > *count)
        throw InputError(fmt::format("shard {} is none; give i/n, such as 3/20 for the third of 20 (n up to {})",
                                     base::in_quotes(std::string(text)), most_shards));
    return {*index, *count};
}

}  // namespace mimik::evaluation
