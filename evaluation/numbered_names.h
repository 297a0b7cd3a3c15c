#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace mimik::evaluation {

/// Numbers for names, in the order in which they came.
class NumberedNames {
public:
    std::uint32_t number(const std::string& name) {
        const auto [at, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
        if (is_new) names_.push_back(name);
        return at->second;
    }
    [[nodiscard]] const std::string& name(std::size_t number) const { return names_[number]; }
    [[nodiscard]] std::size_t size() const { return names_.size(); }
    /// Place of each name in the alphabet.
    [[nodiscard]] std::vector<std::uint32_t> places() const {
        std::vector<std::uint32_t> places;
        for (const auto& name : names_)
            places.push_back(static_cast<std::uint32_t>(std::distance(numbers_.begin(), numbers_.find(name))));
        return places;
    }

private:
    std::map<std::string, std::uint32_t> numbers_;
    std::vector<std::string> names_;
};

}  // namespace mimik::evaluation
