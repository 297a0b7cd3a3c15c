#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mimik::statistics {

/// Numbers from 0 on in the place of any, in ascending order of these.
struct DenseIds {
    std::vector<std::uint32_t> of_case;
    std::size_t count = 0;
};
[[nodiscard]] DenseIds dense_ids(std::span<const std::uint32_t> ids);

/// Which cases belong together, because they share a subject: they are drawn together, or not at all. Any numbers stand
/// for subjects.
class Clusters {
public:
    /// One subject per case.
    [[nodiscard]] static Clusters one_way(std::span<const std::uint32_t> subject);
    /// Two factors that are drawn apart: a case weighs as often as its first was drawn times as often as its second was
    /// (the pigeonhole bootstrap: Owen 2007). @throws InputError if the lists differ in length.
    [[nodiscard]] static Clusters two_way(std::span<const std::uint32_t> first, std::span<const std::uint32_t> second);
    /// Sources and targets that are the same people: one draw of people, in which a case weighs as often as its source
    /// was drawn times as often as its target was (Snijders and Borgatti 1999). What a person is as a source and as a
    /// target may go together. @throws InputError if the lists differ in length.
    [[nodiscard]] static Clusters pairs_of_people(std::span<const std::uint32_t> source,
                                                  std::span<const std::uint32_t> target);

    [[nodiscard]] std::size_t cases() const { return first_.size(); }
    /// How many are drawn, in each independent draw.
    [[nodiscard]] std::span<const std::size_t> draws() const { return draws_; }
    /// The weight of each case, given how often each member of each draw was drawn.
    void weigh(std::span<const std::vector<double>> counts, std::span<double> weights) const;

private:
    std::vector<std::size_t> draws_;
    std::vector<std::uint32_t> first_, second_;  // member of a draw, per case; no second: empty
    std::size_t second_draw_ = 0;
};

}  // namespace mimik::statistics
