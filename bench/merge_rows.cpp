// merge_rows ROWS FOLDER: what `mimik merge` takes for so many rows, in time and memory. Writes shards of made-up rows
// into FOLDER (made anew, removed at the end), then does with them what the merge does: check them, score, write
// rows.csv and rows.sqlite, compare methods. Prints one line for each step: seconds, and the most memory so far.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>

#include "evaluation/case_store.h"
#include "evaluation/comparison.h"
#include "evaluation/score.h"
#include "report/rows_files.h"

namespace {

using namespace mimik;

void timed(const char* what, const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::cout << fmt::format("{:<24} {:8.1f} s, at most {} MB so far\n", what, seconds, usage.ru_maxrss / 1024)
              << std::flush;
}

/// The rows that every experiment has of one case.
void add_case(std::vector<evaluation::CaseRow>& rows, const evaluation::CaseKey& key, double error_mm) {
    for (const auto* region : {"zone", "face"})
        rows.push_back({key, "surface_distance", region, "mean", error_mm / 3, "mm", ""});
    rows.push_back({key, "field", "face", "left_out", 0.0, "vertices", ""});
    rows.push_back({key, "field", "face", "largest_step", error_mm * 1.7, "mm", ""});
    rows.push_back({key, "lip_aperture", "mouth", "error", error_mm / 7, "mm", ""});
    rows.push_back({key, "still_skin", "face", "mean", error_mm / 9, "mm", ""});
    rows.push_back({key, "peak", "zone", "animated", error_mm * 4.1, "mm", ""});
    for (const auto* region : {"mouth", "face"})
        rows.push_back({key, "over_hole", region, "vertices", 3.0, "vertices", ""});
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "merge_rows ROWS FOLDER\n";
        return 2;
    }
    const auto wanted = static_cast<std::size_t>(std::atoll(argv[1]));
    const std::filesystem::path folder(argv[2]);
    constexpr std::size_t sources = 104, expressions = 9, rows_a_case = 9, shards = 20;
    const std::size_t targets = 1 + wanted / (rows_a_case * (2 * sources + 1) * expressions);
    std::filesystem::create_directories(folder);
    std::vector<std::filesystem::path> files;
    std::size_t count = 0;
    timed("write shards", [&] {
        for (std::size_t s = 0; s < shards; ++s) {
            files.push_back(folder / fmt::format("{}-of-{}.rows", s + 1, shards));
            std::filesystem::remove(files.back());
            auto store = evaluation::CaseStore::gone_on_with(files.back());
            const std::size_t units = expressions * targets;
            for (std::size_t u = units * s / shards; u < units * (s + 1) / shards; ++u) {
                const auto expression = fmt::format("{}", u / targets + 1),
                           target = fmt::format("bs{:05}", u % targets);
                std::vector<evaluation::CaseRow> rows;
                add_case(rows, {"", target, expression, "nothing", 1.0}, 2.5);
                for (const auto* method : {"thesis", "default"})
                    for (std::size_t k = 0; k < sources; ++k)
                        add_case(rows,
                                 {fmt::format("bs{:05}", (u % targets + 1 + k) % (targets + sources)), target,
                                  expression, method, 1.0},
                                 1.0 + static_cast<double>((u * 37 + k * 11) % 1000) / 997);
                count += rows.size();
                store.append(expression + " " + target, rows);
            }
        }
    });
    std::uintmax_t bytes = 0;
    for (const auto& file : files) bytes += std::filesystem::file_size(file);
    std::cout << fmt::format("{} rows in {} shards, {:.0f} MB\n", count, shards, static_cast<double>(bytes) / 1e6);
    std::optional<evaluation::CaseStore> store;
    timed("check", [&] { store.emplace(evaluation::CaseStore::of_files(files)); });
    const auto read = [&](const auto& visit) { store->read(visit); };
    timed("scores", [&] { (void)evaluation::scores_of(read); });
    timed("rows.csv", [&] { report::write_rows_csv(folder / "rows.csv", read); });
    timed("rows.sqlite", [&] { report::write_rows_sqlite(folder / "rows.sqlite", read); });
    timed("compare methods", [&] { (void)evaluation::compare_methods(read); });
    std::cout << fmt::format("rows.csv {:.0f} MB, rows.sqlite {:.0f} MB\n",
                             static_cast<double>(std::filesystem::file_size(folder / "rows.csv")) / 1e6,
                             static_cast<double>(std::filesystem::file_size(folder / "rows.sqlite")) / 1e6);
    for (const auto& file : files) std::filesystem::remove(file);
    std::filesystem::remove(folder / "rows.csv");
    std::filesystem::remove(folder / "rows.sqlite");
}
