#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace mimik::fuzzing {

/// Reads the bytes. An InputError is the right answer to a damaged file; anything else that is thrown, a broken promise
/// (require) or a sanitizer's complaint is a find. Defined by each fuzzer.
void fuzz_one(std::span<const std::uint8_t> bytes);

/// Well-formed files to start from. Defined by each fuzzer.
std::vector<std::string> seeds();

inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline void require(bool promise, const char* what) {
    if (promise) return;
    std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

}  // namespace mimik::fuzzing

extern "C" inline __attribute__((used)) int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        mimik::fuzzing::fuzz_one({data, size});
    } catch (const mimik::InputError&) {
    }
    return 0;
}

/// With MIMIK_FUZZ_SEEDS=FOLDER in the environment the program writes its seeds there and ends.
extern "C" inline __attribute__((used)) int LLVMFuzzerInitialize(int*, char***) {
    const char* folder = std::getenv("MIMIK_FUZZ_SEEDS");
    if (!folder) return 0;
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const auto& seed : mimik::fuzzing::seeds()) {
        std::ofstream file(std::filesystem::path(folder) / ("seed" + std::to_string(number++)), std::ios::binary);
        file << seed;
    }
    std::exit(0);
}
