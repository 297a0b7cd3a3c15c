// mimik-video is a program of its own: OpenCV's video modules take longer to load than all of `mimik`.

#include <algorithm>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "capture/feature_motion.h"
#include "cli/capture_options.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/live_loop.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "cli/tracker_choice.h"
#include "io/json_values.h"
#include "video/colour_network.h"
#include "video/curve_picture.h"
#include "video/rendered_performance.h"
#include "video/track_video.h"
#include "video/video_file.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;

void track(const CaptureArguments& arguments) {
    check_capture_options(arguments);
    const auto options = track_options(arguments.tracking, arguments.frames);
    const auto tracker = make_tracker(arguments.tracking);
    video::TrackVideoReport report;
    check_by_option(option_of_pixel, [&] {
        report =
            video::track_video(arguments.source, *tracker,
                               {arguments.output, arguments.landmarks68, arguments.sheet, arguments.video}, options);
    });
    if (!arguments.common.quiet && !arguments.common.json) say_notes(report.remarks);
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::ordered_json{{"schema", 1},
                                                          {"output", arguments.output},
                                                          {"frames", report.frames},
                                                          {"tracked", report.tracked},
                                                          {"found", report.found_anew},
                                                          {"rate_hz", report.rate_hz},
                                                          {"tracking_s", report.seconds},
                                                          {"tracker", tracker->name()},
                                                          {"remarks", report.remarks}});
    else if (!arguments.common.quiet)
        std::cout << fmt::format("{}: {}, the face in {} of them, found {}; {:.0f} frames a second\n", arguments.output,
                                 base::counted(static_cast<std::size_t>(report.frames), "frame"), report.tracked,
                                 base::counted(static_cast<std::size_t>(report.found_anew), "time"),
                                 report.frames_a_second());
}

struct WriteArguments {
    std::string folder, output, performer, motion;
    std::vector<std::string> beside;
    double rate_hz = 30;
    bool quiet = false;
};

std::vector<fs::path> pictures_in(const std::string& folder) {
    if (!fs::is_directory(folder)) throw InputError(fmt::format("{}: is no folder of PNG files", folder));
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (base::equal_ignoring_case(entry.path().extension().string(), ".png")) files.push_back(entry.path());
    if (files.empty()) throw InputError(fmt::format("{}: holds no PNG file", folder));
    std::sort(files.begin(), files.end());
    return files;
}

/// A performer's video, frame after frame, with the curves that its table of motion has.
class PerformerFrames {
public:
    PerformerFrames(const std::string& clip, const std::string& motion) : clip_(clip), reader_(clip) {
        if (!motion.empty()) motion_ = capture::read_feature_motion(motion);
    }
    /// @throws InputError if the video has ended
    const io::Image& next() {
        if (!reader_.next(frame_))
            throw InputError(
                fmt::format("{}: ends at frame {}, before the performance; is it the video that the motion "
                            "was captured from?",
                            clip_, given_));
        if (motion_ && given_ < motion_->frames.size()) video::draw_motion(frame_, *motion_, given_);
        ++given_;
        return frame_;
    }

private:
    std::string clip_;
    video::VideoReader reader_;
    std::optional<capture::FeatureMotion> motion_;
    io::Image frame_;
    std::size_t given_ = 0;
};

/// What a video is like, for 'mimik perform': a JSON file.
void look(const std::string& source, const std::string& output) {
    video::VideoReader reader(source);
    io::Image first;
    if (!reader.next(first)) throw InputError(fmt::format("{}: no frame can be decoded", source));
    base::write_atomically(output, io::json_text(nlohmann::ordered_json{{"schema", 1},
                                                                        {"width", first.width},
                                                                        {"height", first.height},
                                                                        {"height_beside", video::beside_height(first)},
                                                                        {"frames", reader.frames()},
                                                                        {"rate_hz", reader.rate_hz()}}));
}

void write_video(const WriteArguments& arguments) {
    const auto files = pictures_in(arguments.folder);
    std::vector<std::vector<fs::path>> beside;
    for (const auto& folder : arguments.beside) {
        beside.push_back(pictures_in(folder));
        if (beside.back().size() != files.size())
            throw InputError(fmt::format("{}: holds {} PNG files, {} {}; give as many", folder, beside.back().size(),
                                         arguments.folder, files.size()));
    }
    if (arguments.performer.empty() && !arguments.motion.empty())
        throw InputError(fmt::format("--motion is '{}'; it goes with --performer", arguments.motion));
    std::optional<PerformerFrames> performer;
    if (!arguments.performer.empty()) performer.emplace(arguments.performer, arguments.motion);
    video::VideoWriter writer(arguments.output, arguments.rate_hz);
    for (std::size_t k = 0; k < files.size(); ++k) {
        std::vector<io::Image> pictures = {io::read_png(files[k])};
        for (const auto& folder : beside) pictures.push_back(io::read_png(folder[k]));
        if (performer) {
            writer.add(video::beside(performer->next(), pictures, pictures.front().height));
        } else {
            const io::Image first = pictures.front();
            pictures.erase(pictures.begin());
            writer.add(pictures.empty() ? first : video::beside(first, pictures, first.height));
        }
    }
    writer.finish();
    if (!arguments.quiet) std::cout << fmt::format("{}: {}\n", arguments.output, base::counted(files.size(), "frame"));
}

/// PREFIX.mp4, PREFIX_points.csv (68 points), PREFIX_curves.csv, PREFIX_truth.csv (pose and weights).
void render(const std::string& prefix, const video::PerformanceOptions& options) {
    const video::RenderedPerformance performance(options);
    video::VideoWriter writer(prefix + ".mp4", options.rate_hz);
    std::string points = video::landmarks68_header(), curves = "frame,curve,point,x,y\n";
    std::string truth = "frame,time,rx,ry,rz,tx,ty,tz,weights\n";
    for (int f = 0; f < options.frames; ++f) {
        writer.add(performance.image(f));
        const auto now = performance.truth(f);
        points += video::landmarks68_row(f, now.points);
        for (std::size_t c = 0; c < video::curve_count; ++c)
            for (std::size_t k = 0; k < now.curves[c].size(); ++k)
                curves += fmt::format("{},{},{},{:.3f},{:.3f}\n", f, video::name_of(static_cast<video::FaceCurve>(c)),
                                      k, now.curves[c][k].x(), now.curves[c][k].y());
        const auto& turn = now.camera_from_head.rotation_vector;
        const auto& shift = now.camera_from_head.translation_mm;
        std::string weights;
        for (const auto& [shape, weight] : now.weights)
            weights += fmt::format("{}{}={:.4f}", weights.empty() ? "" : " ", shape, weight);
        truth += fmt::format("{},{:.4f},{:.6f},{:.6f},{:.6f},{:.3f},{:.3f},{:.3f},{}\n", f, now.time_s, turn.x(),
                             turn.y(), turn.z(), shift.x(), shift.y(), shift.z(), weights);
    }
    writer.finish();
    base::write_atomically(prefix + "_points.csv", points);
    base::write_atomically(prefix + "_curves.csv", curves);
    base::write_atomically(prefix + "_truth.csv", truth);
    std::cout << fmt::format("{}.mp4: {}\n", prefix, base::counted(static_cast<std::size_t>(options.frames), "frame"));
}

struct TrainArguments {
    std::vector<std::string> files;  ///< VIDEO LABELS, again and again
    std::string output, made_of;
    int every = 1;
    video::ColourTrainingOptions options;
};

void train(const TrainArguments& arguments) {
    constexpr std::size_t most_patches = 400;
    if (arguments.files.size() % 2 != 0)
        throw InputError("give each video with its labels: VIDEO LABELS.csv [VIDEO LABELS.csv ...]");
    if (arguments.every < 1) throw InputError(fmt::format("--every is {}; give 1 or more", arguments.every));
    std::vector<video::LabelledPatch> labelled;
    for (std::size_t k = 0; k < arguments.files.size(); k += 2) {
        const auto rows = video::read_landmarks68(arguments.files[k + 1], 1'000'000);
        video::VideoReader reader(arguments.files[k]);
        io::Image frame;
        std::size_t row = 0;
        for (long f = 0; row < rows.size() && reader.next(frame); ++f) {
            while (row < rows.size() && rows[row].frame < f) ++row;
            if (row == rows.size() || rows[row].frame != f || f % arguments.every != 0) continue;
            if (labelled.size() == most_patches) break;
            const auto& p = rows[row].points;
            const auto place = video::place_between(p[36], p[45]);
            auto in_patch = p;
            for (auto& at : in_patch) at = place.patch_from_frame(at);
            labelled.push_back({video::cut_patch(frame, place), video::curves_through(in_patch)});
        }
    }
    const auto made_of =
        arguments.made_of.empty() ? fmt::format("{} labelled frames", labelled.size()) : arguments.made_of;
    video::ColourNetwork::train(labelled, made_of, arguments.options).save(arguments.output);
    std::cout << fmt::format("{}: learnt from {}\n", arguments.output,
                             base::counted(labelled.size(), "labelled frame"));
}

int run_video(int argc, char** argv) {
    video::silence_decoders();  // what matters is said by us
    // Images of a patch come and go with every frame: their pages stay, so that the system need not clear them anew.
    constexpr int kept_bytes = 64 << 20;
    mallopt(M_MMAP_THRESHOLD, kept_bytes);
    mallopt(M_TRIM_THRESHOLD, kept_bytes);
    // A patch is too small to share out among threads, and sums are then always added in one order.
    video::use_one_thread();
    prepare_standard_streams();
    CLI::App app{"Follows a performer's face in video, without markers.", "mimik-video"};
    app.set_help_flag("-h,--help", "Print this help and stop");
    app.require_subcommand(1);
    CaptureArguments capture;
    auto* tracking = app.add_subcommand("track", "Curves of brows, lids, nostrils and lips in every frame");
    add_capture_options(*tracking, capture);
    tracking->callback([&] { track(capture); });

    LiveArguments live;
    auto* living = app.add_subcommand("live", "Lets a face move as the performer before a camera does");
    add_live_options(*living, live);
    living->callback([&] { run_live(live); });

    WriteArguments write;
    auto* writing = app.add_subcommand("write", "A folder of PNG files as an MP4");
    writing->add_option("FRAMES", write.folder, "Folder of PNG files of one size, in the order of their names")
        ->required();
    writing->add_option("OUTPUT", write.output, "MP4 file")->required();
    writing->add_option("--fps", write.rate_hz, "Frames a second")->capture_default_str();
    writing->add_option("--beside", write.beside, "Further folders, whose pictures stand beside; repeat")
        ->allow_extra_args(false);
    writing->add_option("--performer", write.performer, "Video whose frames stand before the pictures");
    writing->add_option("--motion", write.motion, "Feature motion of that video (.csv): its curves are drawn on");
    writing->add_flag("--quiet", write.quiet, "Say nothing but errors");
    writing->callback([&] { write_video(write); });

    std::string looked_at, facts;
    auto* looking = app.add_subcommand("look", "Size, rate and number of frames of a video, as JSON");
    looking->add_option("VIDEO", looked_at, "Video file")->required();
    looking->add_option("-o,--output", facts, "JSON file")->required();
    looking->callback([&] { look(looked_at, facts); });

    std::string prefix;
    video::PerformanceOptions performance;
    auto* rendering = app.add_subcommand("render", "A made performance with its true curves, pose and weights");
    rendering->add_option("-o,--output", prefix, "PREFIX of PREFIX.mp4 and PREFIX_points|curves|truth.csv")->required();
    rendering->add_option("--frames", performance.frames, "How many")->capture_default_str();
    rendering->add_option("--width", performance.width_px, "Pixels")->capture_default_str();
    rendering->add_option("--height", performance.height_px, "Pixels")->capture_default_str();
    rendering->add_option("--fps", performance.rate_hz, "Frames a second")->capture_default_str();
    rendering->add_option("--noise", performance.noise, "Of the camera, grey levels")->capture_default_str();
    rendering->add_option("--head-motion", performance.head_motion, "0: the head is still")->capture_default_str();
    rendering->add_option("--expression", performance.expression, "0: the face is at rest")->capture_default_str();
    rendering->add_option("--light-change", performance.light_change, "0: the light is steady")->capture_default_str();
    add_seed_option(*rendering, performance.seed);
    rendering->callback([&] { render(prefix, performance); });

    TrainArguments training;
    auto* learning = app.add_subcommand("train", "Weights of the colour transform from labelled frames");
    learning->add_option("FILES", training.files, "VIDEO LABELS.csv, once or more; labels as --landmarks68 writes them")
        ->required();
    learning->add_option("-o,--output", training.output, "YAML file for --colours")->required();
    learning->add_option("--every", training.every, "Takes every so many labelled frames")->capture_default_str();
    learning->add_option("--made-of", training.made_of, "What the file says that it was trained on");
    learning->callback([&] { train(training); });
    return run(app, argc, argv, exit_done);
}

}  // namespace
}  // namespace mimik::cli

int main(int argc, char** argv) { return mimik::cli::run_video(argc, argv); }
