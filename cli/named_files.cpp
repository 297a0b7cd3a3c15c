#include "cli/named_files.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::cli {
namespace {

bool are_one_file(const std::string& a, const std::string& b) {
    std::error_code none;
    if (std::filesystem::equivalent(a, b, none)) return true;
    const auto from = std::filesystem::weakly_canonical(a, none), to = std::filesystem::weakly_canonical(b, none);
    return a == b || (!from.empty() && from == to);
}

}  // namespace

CLI::Validator named_file() {
    return {[](const std::string& text) { return text.empty() ? "is empty; name a file, or leave it out" : ""; }, "",
            "file"};
}

void check_ending(const char* option, const std::string& file, const char* extension) {
    if (file.empty() || base::equal_ignoring_case(std::filesystem::path(file).extension().string(), extension)) return;
    throw InputError(fmt::format("{} is '{}'; it is written as {}", option, file, extension));
}

void check_files_differ(const std::vector<NamedFile>& files, std::size_t read) {
    for (std::size_t k = read; k < files.size(); ++k)
        for (std::size_t other = 0; other < k; ++other)
            if (!files[k].file.empty() && !files[other].file.empty() && are_one_file(files[k].file, files[other].file))
                throw InputError(fmt::format("{} is '{}', the same file as {}; give it another name", files[k].option,
                                             files[k].file, files[other].option));
}

}  // namespace mimik::cli
