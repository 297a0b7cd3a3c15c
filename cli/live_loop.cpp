#include "cli/live_loop.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "animation/blend_examples.h"
#include "animation/expression_mapping.h"
#include "animation/facial_examples.h"
#include "base/errors.h"
#include "base/quantile.h"
#include "base/text.h"
#include "cli/notes.h"
#include "cli/performer_examples.h"
#include "cli/tracker_choice.h"
#include "cli/video_window.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "report/shaded_face.h"
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

/// The character, and what it does as the performer's rows come.
class LiveFace {
public:
    LiveFace(const LiveArguments& arguments, double rate_hz) : arguments_(arguments) {
        options_.gain = arguments.gain;
        options_.clamp = arguments.clamp;
        check_by_option({{"gain", "--gain"}}, [&] { options_.check(); });
        const auto neutral_file = std::filesystem::path(arguments.examples) / "neutral.ply";
        if (std::filesystem::exists(neutral_file)) database::refuse_hidden_file(neutral_file);
        character_ = animation::read_facial_examples(arguments.examples);
        std::vector<std::vector<geometry::Vector>> displacements;
        for (const auto& example : character_.examples) displacements.push_back(example.displacement_mm);
        blender_.emplace(character_.neutral.vertices_mm, displacements);
        vertices_mm_ = character_.neutral.vertices_mm;
        weights_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(character_.examples.size()));
        for (const auto& feature : capture::face_features()) motion_.names.emplace_back(feature.name);
        motion_.rate_hz = rate_hz;
        table_ = arguments.source_examples.empty() ? modeling::standard_source_examples()
                                                   : modeling::read_source_examples(arguments.source_examples);
        (void)examples_of_character(table_, character_, arguments.examples, remarks_);  // before the work
        remarks_.clear();
    }

    /// Rows before the performer's rest is known wait for it.
    void take(const video::FeatureRows::Row& row) {
        if (mapper_)
            weights_ = columns_.transpose() * mapper_->next(row.features).weights;
        else if (row.features.state == capture::TrackState::tracked)
            motion_.frames.push_back(row.features);
    }
    /// Once the neutral frames have been seen.
    void begin() {
        if (mapper_ || motion_.frames.empty()) return;
        auto rest = animation::performer_rest(motion_, 0, motion_.frames.size() - 1);
        mapping_.emplace(examples_of_character(animation::fitted_examples(table_, motion_, rest), character_,
                                               arguments_.examples, remarks_),
                         options_);
        const auto& names = mapping_->source().examples;
        const auto count = static_cast<Eigen::Index>(names.size());
        columns_ = columns_of(character_, names, Eigen::MatrixXd::Identity(count, count), remarks_);
        mapper_.emplace(motion_, std::move(rest), *mapping_);
        motion_.frames.clear();
    }
    void blend() { blender_->blend({weights_.data(), static_cast<std::size_t>(weights_.size())}, vertices_mm_); }
    [[nodiscard]] io::Image picture(int size_px) {
        if (!painter_) {
            io::Image texture;
            if (!character_.texture_file.empty()) texture = io::read_image(character_.texture_file);
            report::ShadedFaceOptions options;
            options.width = options.height = size_px;
            painter_.emplace(character_.neutral, std::move(texture), options);
        }
        return painter_->picture(vertices_mm_);
    }
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

private:
    const LiveArguments& arguments_;
    animation::ExpressionMappingOptions options_;
    animation::FacialExamples character_;
    std::optional<animation::ExampleBlender> blender_;
    std::optional<report::FacePainter> painter_;
    modeling::SourceExamples table_;
    capture::FeatureMotion motion_;  ///< of the neutral frames
    std::optional<animation::ExpressionMapping> mapping_;
    std::optional<animation::PerformanceMapper> mapper_;
    Eigen::MatrixXd columns_;  ///< from the mapping's examples to the character's
    Eigen::VectorXd weights_;
    std::vector<geometry::Point> vertices_mm_;
    std::vector<std::string> remarks_;
};

struct LiveReport {
    long frames = 0, tracked = 0;
    double seconds = 0;
    StageTimes times;
    std::vector<std::string> remarks;
    [[nodiscard]] double frames_a_second() const { return seconds > 0 ? static_cast<double>(frames) / seconds : 0; }
};

LiveReport follow(const LiveArguments& arguments, video::FeatureTracker& tracker, LiveFace& face,
                  video::VideoReader& reader, const video::TrackVideoOptions& options) {
    LiveReport report;
    std::optional<video::VideoWriter> file;
    std::optional<VideoWindow> window;
    if (arguments.output.empty())
        window.emplace();
    else
        file.emplace(arguments.output, reader.rate_hz());
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
        const auto picture = video::beside(frame, {face.picture(video::beside_height(frame))});
        report.times.end(drawing);
        if (file) file->add(picture);
        if (window) {
            // A file is shown as fast as it was taken.
            const double due_s = static_cast<double>(report.frames + 1) / reader.rate_hz();
            const double now_s = std::chrono::duration<double>(Clock::now() - begun).count();
            const double wait_ms = reader.is_camera() ? 1 : std::clamp(1e3 * (due_s - now_s), 1.0, 1e3);
            goes_on = window->show(picture, static_cast<int>(wait_ms));
        }
        report.times.end(showing);
        ++report.frames;
        report.tracked += seen ? 1 : 0;
    }
    report.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    if (file) file->finish();
    report.remarks = face.remarks();
    if (report.tracked == 0) report.remarks.push_back(fmt::format("{}: no face was found", arguments.source));
    return report;
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
                                 stage == reading           ? "  (waits for the camera)"
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
    LiveFace face(arguments, reader.rate_hz());
    const auto report = follow(arguments, *tracker, face, reader, options);
    say(arguments, report, tracker->name());
}

}  // namespace mimik::cli
