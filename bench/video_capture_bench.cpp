#include <map>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "video/colour_network.h"
#include "video/face_finder.h"
#include "video/paper_tracker.h"
#include "video/rendered_performance.h"
#include "video/video_file.h"

// A frame of a performer's video: found anew, and followed, at several resolutions. One thread; decoding is not in it.

namespace {

using namespace mimik;

/// Frames there and back again, so that nobody jumps.
const std::vector<io::Image>& frames(int height_px) {
    static std::map<int, std::vector<io::Image>> made;
    auto& list = made[height_px];
    if (list.empty()) {
        video::PerformanceOptions options;
        options.height_px = height_px;
        options.width_px = height_px * 4 / 3;
        const video::RenderedPerformance performance(options);
        for (int k = 0; k < 40; ++k) list.push_back(performance.image(k));
        for (std::size_t k = list.size() - 1; k-- > 1;) list.push_back(io::Image(list[k]));
    }
    return list;
}

std::unique_ptr<video::FeatureTracker> tracker() {
    video::use_one_thread();
    return video::make_paper_tracker(std::make_shared<const video::ColourNetwork>(video::ColourNetwork::shipped()));
}

void following(benchmark::State& state) {
    const auto& list = frames(static_cast<int>(state.range(0)));
    const auto follows = tracker();
    std::size_t at = 0, lost = 0;
    (void)follows->next(list[at++]);
    for (auto _ : state) {
        lost += follows->next(list[at]) ? 0 : 1;
        at = (at + 1) % list.size();
    }
    state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
    state.counters["lost"] = static_cast<double>(lost);
}

void finding_anew(benchmark::State& state) {
    const auto& list = frames(static_cast<int>(state.range(0)));
    const auto follows = tracker();
    for (auto _ : state) {
        follows->restart();
        benchmark::DoNotOptimize(follows->next(list[0]));
    }
    state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
}

BENCHMARK(following)->Arg(240)->Arg(480)->Arg(720)->Arg(1080)->Unit(benchmark::kMillisecond);
BENCHMARK(finding_anew)->Arg(240)->Arg(480)->Arg(1080)->Unit(benchmark::kMillisecond);

}  // namespace
