#include "cli/input_digests.h"

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/file_digest.h"
#include "base/parallel.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;

std::string name_of(const fs::path& file) { return (file.parent_path().filename() / file.filename()).generic_string(); }

}  // namespace

InputDigests InputDigests::read(const fs::path& file) {
    InputDigests digests;
    if (!base::is_there(file)) return digests;
    try {
        const auto document = io::parse_json(base::read_text(file, io::most_json_bytes), file.string());
        for (const auto& [name, pair] :
             io::read_field<std::map<std::string, std::vector<std::string>>>(document, "files"))
            if (pair.size() == 2) digests.known_[name] = {pair[0], pair[1]};
    } catch (const InputError&) {
        return {};
    }
    return digests;
}

InputDigests InputDigests::of(const std::vector<fs::path>& files) {
    std::vector<Known> known(files.size());
    base::parallel_for_each(files.size(), [&](std::size_t k) {
        // The stamp first: a file that changes in between is read again by whoever asks.
        known[k].stamp = base::file_stamp(files[k]);
        known[k].digest = base::digest_of_file(files[k]).text();
    });
    InputDigests digests;
    for (std::size_t k = 0; k < files.size(); ++k) digests.known_[name_of(files[k])] = known[k];
    return digests;
}

void InputDigests::write(const fs::path& file) const {
    nlohmann::ordered_json files = nlohmann::ordered_json::object();
    for (const auto& [name, known] : known_) files[name] = {known.stamp, known.digest};
    base::write_atomically(file, nlohmann::ordered_json{{"schema", 1}, {"files", files}}.dump(1) + "\n");
}

std::string InputDigests::digest(const fs::path& file) const {
    const auto found = known_.find(name_of(file));
    if (found != known_.end() && found->second.stamp == base::file_stamp(file)) return found->second.digest;
    return base::digest_of_file(file).text();
}

}  // namespace mimik::cli
