#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "bench/bench_scan.h"
#include "database/bnt.h"
#include "io/json_values.h"

namespace {

using namespace mimik;

/// 200 x 175 cells, 35,000 points of five numbers: 1.4 MB.
class ScanFile {
public:
    ScanFile()
        : path_(std::filesystem::temp_directory_path() / ("mimik_bench_" + std::to_string(::getpid()) + ".bnt")) {
        auto scan = bench::make_scan(0.0);
        scan.rows = 200;
        scan.cols = 175;
        scan.points_mm.resize(35000);
        scan.texture_coordinates.assign(35000, {0.5, 0.5});
        scan.texture_file = "skin.png";
        database::write_bnt(path_, database::to_bnt(scan));
    }
    ~ScanFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    ScanFile(const ScanFile&) = delete;
    ScanFile& operator=(const ScanFile&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

const std::filesystem::path& scan_file() {
    static const ScanFile file;
    return file.path();
}

void mimik_read_bnt(benchmark::State& state) {
    const auto& path = scan_file();
    for (auto _ : state) benchmark::DoNotOptimize(database::read_bnt(path));
}

void mimik_read_bnt_as_scan(benchmark::State& state) {
    const auto& path = scan_file();
    for (auto _ : state) benchmark::DoNotOptimize(database::read_bnt_scan(path));
}

/// What the machine allows: the five columns with one fread each, nothing checked.
void fread_read_bnt(benchmark::State& state) {
    const auto path = scan_file().string();
    const long data_at = static_cast<long>(std::filesystem::file_size(path)) - 35000L * 5 * 8;
    for (auto _ : state) {
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
        std::fseek(file.get(), data_at, SEEK_SET);
        std::vector<std::vector<double>> columns(5, std::vector<double>(35000));
        for (auto& column : columns)
            if (std::fread(column.data(), sizeof(double), column.size(), file.get()) != column.size())
                state.SkipWithError("file too short");
        benchmark::DoNotOptimize(columns.data());
    }
}

/// 200,000 objects in one list: a reader that pays for every entry anew takes quadratic time here.
const std::string& list_of_objects() {
    static const std::string text = [] {
        std::string list = "[";
        for (int k = 0; k < 200'000; ++k) list += "{},";
        return list + "0]";
    }();
    return text;
}

void mimik_parse_json(benchmark::State& state) {
    const auto& text = list_of_objects();
    for (auto _ : state) benchmark::DoNotOptimize(io::parse_json(text, "list"));
}

/// What the library takes where nothing is bounded.
void nlohmann_parse_json(benchmark::State& state) {
    const auto& text = list_of_objects();
    for (auto _ : state) benchmark::DoNotOptimize(nlohmann::json::parse(text));
}

BENCHMARK(mimik_parse_json)->Unit(benchmark::kMillisecond);
BENCHMARK(nlohmann_parse_json)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_read_bnt)->Unit(benchmark::kMillisecond);
BENCHMARK(fread_read_bnt)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_read_bnt_as_scan)->Unit(benchmark::kMillisecond);

}  // namespace
