#include "cli/performer_examples.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"

namespace mimik::cli {

modeling::SourceExamples examples_of_character(const modeling::SourceExamples& source,
                                               const animation::FacialExamples& character,
                                               const std::filesystem::path& folder, std::vector<std::string>& remarks) {
    std::vector<std::string> shared, missing;
    for (const auto& name : source.examples) {
        const bool there = std::any_of(character.examples.begin(), character.examples.end(),
                                       [&](const animation::FacialExample& example) { return example.name == name; });
        (there ? shared : missing).push_back(name);
    }
    if (shared.empty())
        throw InputError(fmt::format("{}: has none of the examples {}; name its own with --key or --source-examples",
                                     folder.string(), fmt::join(missing, ", ")));
    if (!missing.empty())
        remarks.push_back(fmt::format("{}: has no example {}, so the performer's is left out", folder.string(),
                                      fmt::join(missing, ", ")));
    return modeling::with_examples(source, shared);
}

Eigen::MatrixXd columns_of(const animation::FacialExamples& character, const std::vector<std::string>& examples,
                           const Eigen::MatrixXd& mapped, std::vector<std::string>& remarks) {
    Eigen::MatrixXd weights =
        Eigen::MatrixXd::Zero(mapped.rows(), static_cast<Eigen::Index>(character.examples.size()));
    std::vector<std::string> still;
    for (std::size_t k = 0; k < character.examples.size(); ++k) {
        const auto& name = character.examples[k].name;
        const auto it = std::find(examples.begin(), examples.end(), name);
        if (it == examples.end())
            still.push_back(name);
        else
            weights.col(static_cast<Eigen::Index>(k)) = mapped.col(it - examples.begin());
    }
    if (!still.empty()) remarks.push_back(fmt::format("nothing drives {}", fmt::join(still, ", ")));
    return weights;
}

}  // namespace mimik::cli
