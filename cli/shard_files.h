#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/case_store.h"
#include "evaluation/shard.h"

namespace mimik::cli {

/// The files of an experiment that is run in shards, in `OUT/shards`:
///   3-of-20.<16 hexadecimal digits>.part  while it runs: rows as they come, of one attempt (evaluation/case_store.h)
///   3-of-20.rows                          the same, whole
///   3-of-20.json                          command, host and time
/// No two attempts write one file, so none needs a lock, and shards know nothing of each other. An attempt begins with
/// what the longest of the earlier ones has whole. The first unit of each file has no rows and names the experiment.
class ShardFiles {
public:
    /// @param identity  content of experiment.json
    ShardFiles(std::filesystem::path root, evaluation::Shard shard, const std::string& identity);

    [[nodiscard]] const evaluation::Shard& shard() const { return shard_; }
    [[nodiscard]] std::filesystem::path rows() const { return stem_.string() + ".rows"; }
    [[nodiscard]] std::filesystem::path provenance() const { return stem_.string() + ".json"; }
    [[nodiscard]] bool whole() const;
    /// A file of its own, which begins with what earlier attempts did. @param found  targets of those
    /// @throws InputError if the folder takes no files.
    [[nodiscard]] evaluation::CaseStore begin(std::size_t& found);
    /// The rows take their name, and what attempts left goes. After the store is gone.
    /// @throws InputError if it cannot be done.
    void finish();
    /// What the first unit of a whole file says. @throws InputError if it is of another experiment or no such file.
    void check() const;

private:
    [[nodiscard]] std::vector<std::filesystem::path> parts() const;
    [[nodiscard]] std::string identity_unit() const { return "experiment " + identity_; }

    std::filesystem::path folder_, stem_, own_;
    evaluation::Shard shard_;
    std::string identity_;  // digest
};

/// Into how many shards the whole files of `root` cut their experiment. @param asked  0: whatever is there
/// @throws InputError if there is none, or they cut it differently and nothing was asked.
[[nodiscard]] std::size_t shard_count(const std::filesystem::path& root, std::size_t asked);

/// Every file of shards that lies in `root`, whole or not.
[[nodiscard]] std::vector<std::filesystem::path> files_of_shards(const std::filesystem::path& root);

/// "3, 7-9, 20", of numbers in ascending order.
[[nodiscard]] std::string number_list(const std::vector<std::size_t>& numbers, const std::string& between = ", ");

}  // namespace mimik::cli
