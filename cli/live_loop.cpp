#include "cli/live_loop.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "animation/expression_mapping.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/quantile.h"
#include "base/text.h"
#include "cli/live_face.h"
#include "cli/notes.h"
#include "cli/tracker_choice.h"
#include "cli/video_window.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "video/curve_picture.h"
#include "video/feature_rows.h"
#include "video/video_file.h"

namespace mimik::cli {
namespace {

using Clock = std::chrono::steady_clock;

enum Stage : std::size_t { reading, tracking, mapping, blending, drawing, showing, all_but_reading, stage_count };
constexpr std::array<const char*, stage_count> stage_names = {"read", "track", "map", "blend", "draw", "show", "total"};

/// Times of the stages, of the last frames alone: memory does not grow.
class StageTimes {
public:
    void begin() { then_ = Clock::now(); }
    /// From the last call on.
    void end(Stage stage) {
        const auto now = Clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - then_).count();
        then_ = now;
        if (stage == reading)
            total_ms_ = 0;
        else
            total_ms_ += ms;
        put(stage, ms);
        if (stage == showing) {
            put(all_but_reading, total_ms_);
            ++frames_;
        }
    }
    [[nodiscard]] double quantile_ms(std::size_t stage, double share) const {
        return ms_[stage].empty() ? 0 : base::quantile(ms_[stage], share);
    }

private:
    void put(std::size_t stage, double ms) {
        constexpr std::size_t most = 10'000;
        if (ms_[stage].size() < most)
            ms_[stage].push_back(ms);
        else
            ms_[stage][frames_ % most] = ms;
    }
    Clock::time_point then_ = Clock::now();
    double total_ms_ = 0;
    std::size_t frames_ = 0;
    std::array<std::vector<double>, stage_count> ms_;
};

struct LiveReport {
    long frames = 0, tracked = 0;
    double seconds = 0;
    bool from_camera = false;
    StageTimes times;
    std::vector<std::string> remarks;
    [[nodiscard]] double frames_a_second() const { return seconds > 0 ? static_cast<double>(frames) / seconds : 0; }
};

/// A file is shown as fast as it was taken; a camera waits by itself.
void wait_until(Clock::time_point due) {
    constexpr auto longest = std::chrono::seconds(1);  // a window that is looked after less often seems dead
    std::this_thread::sleep_until(std::min(due, Clock::now() + longest));
}

void follow(const LiveArguments& arguments, video::FeatureTracker& tracker, LiveFace& face, video::VideoReader& reader,
            const video::TrackVideoOptions& options, std::ostream* weights, LiveReport& report) {
    std::optional<video::VideoWriter> file;
    std::optional<VideoWindow> window;
    if (arguments.output.empty())
        window.emplace();
    else
        file.emplace(arguments.output, reader.rate_hz());
    if (weights) *weights << animation::weights_header(face.examples());
    std::optional<video::FeatureRows> rows;
    io::Image frame;
    const auto begun = Clock::now();
    for (bool goes_on = true; goes_on && (arguments.frames == 0 || report.frames < arguments.frames);) {
        report.times.begin();
        if (!reader.next(frame)) break;
        report.times.end(reading);
        if (!rows)
            rows.emplace(reader.rate_hz(), frame.width, frame.height, options,
                         [&](const video::FeatureRows::Row& row) { face.take(row); });
        const auto seen = tracker.next(frame);
        report.times.end(tracking);
        rows->add(seen);
        if (rows->has_neutral()) face.begin();
        report.times.end(mapping);
        face.blend();
        report.times.end(blending);
        video::draw_face(frame, seen);
        const int height_px = video::beside_height(frame);
        const auto picture = video::beside(frame, {face.picture(height_px)}, height_px);
        report.times.end(drawing);
        if (file) file->add(picture);
        if (window) goes_on = window->show(picture, 1);
        report.times.end(showing);
        if (weights)
            *weights << animation::weights_row(static_cast<std::size_t>(report.frames),
                                               static_cast<double>(report.frames) / reader.rate_hz(), seen.has_value(),
                                               face.weights());
        ++report.frames;
        report.tracked += seen ? 1 : 0;
        // Nothing is late by this: it is none of the latencies.
        if (window && !reader.is_camera())
            wait_until(begun + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                   static_cast<double>(report.frames) / reader.rate_hz())));
    }
    report.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    if (file) file->finish();
    const bool began = face.has_begun();  // finish_rows() gives out what waits
    std::vector<std::string> said;
    if (rows) said = video::finish_rows(*rows);
    if (!began && report.tracked > 0)
        said.push_back(fmt::format("ended before the neutral frames did (--neutral {}:{}), so the face did not move",
                                   options.neutral_from, options.neutral_to));
    if (auto remark = video::camera_rate_remark(reader)) said.push_back(std::move(*remark));
    report.remarks = face.remarks();
    for (const auto& remark : said) report.remarks.push_back(fmt::format("{}: {}", arguments.source, remark));
}

void say(const LiveArguments& arguments, const LiveReport& report, const std::string& tracker) {
    if (arguments.common.json) {
        nlohmann::ordered_json latency;
        for (std::size_t stage = 0; stage < stage_count; ++stage)
            latency[stage_names[stage]] = {{"median_ms", report.times.quantile_ms(stage, 0.5)},
                                           {"p95_ms", report.times.quantile_ms(stage, 0.95)}};
        std::cout << io::json_text(nlohmann::ordered_json{{"schema", 1},
                                                          {"output", arguments.output},
                                                          {"frames", report.frames},
                                                          {"tracked", report.tracked},
                                                          {"frames_a_second", report.frames_a_second()},
                                                          {"latency", latency},
                                                          {"tracker", tracker},
                                                          {"remarks", report.remarks}});
        return;
    }
    if (arguments.common.quiet) return;
    say_notes(report.remarks);
    std::cout << fmt::format("{}: {}, the face in {} of them; {:.1f} frames a second\n",
                             arguments.output.empty() ? arguments.source : arguments.output,
                             base::counted(static_cast<std::size_t>(report.frames), "frame"), report.tracked,
                             report.frames_a_second());
    std::cout << "latency in ms: median, 95 %\n";
    for (std::size_t stage = 0; stage < stage_count; ++stage)
        std::cout << fmt::format("  {:6} {:8.2f} {:8.2f}{}\n", stage_names[stage], report.times.quantile_ms(stage, 0.5),
                                 report.times.quantile_ms(stage, 0.95),
                                 stage == reading           ? (report.from_camera ? "  (waits for the camera)" : "")
                                 : stage == all_but_reading ? "  (of all but read)"
                                                            : "");
}

}  // namespace

void run_live(const LiveArguments& arguments) {
    check_live_options(arguments);
    const auto options = track_options(arguments.tracking, arguments.frames);
    if (arguments.frames == 0 && !arguments.output.empty() && video::names_a_camera(arguments.source))
        throw InputError(
            fmt::format("camera {}: never ends, and a file has an end; say how many frames, such as "
                        "--frames 300",
                        arguments.source));
    if (!arguments.source_examples.empty()) database::refuse_hidden_file(arguments.source_examples);
    const auto tracker = make_tracker(arguments.tracking);
    video::VideoReader reader(arguments.source);
    LiveFace face(arguments, reader.rate_hz(), options.neutral_from);
    LiveReport report;
    report.from_camera = reader.is_camera();
    check_by_option(option_of_pixel, [&] {
        if (arguments.weights.empty()) return follow(arguments, *tracker, face, reader, options, nullptr, report);
        base::write_atomically(arguments.weights, [&](std::ostream& weights) {
            follow(arguments, *tracker, face, reader, options, &weights, report);
        });
    });
    say(arguments, report, tracker->name());
}

}  // namespace mimik::cli
