#include "video/feature_rows.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace mimik::video {
namespace {

const Eigen::Vector2d half_pixel(0.5, 0.5);  // motion.csv has the first pixel's middle at (0.5, 0.5)

// What decode_feature_motion() accepts; NaN is outside.
bool fits_motion(const capture::HeadPose& pose) {
    constexpr double farthest_head_mm = 1e5, most_turn_rad = 100;
    return pose.rotation_vector.allFinite() && pose.rotation_vector.cwiseAbs().maxCoeff() <= most_turn_rad &&
           pose.translation_mm.allFinite() && pose.translation_mm.cwiseAbs().maxCoeff() <= farthest_head_mm;
}
bool fits_motion(const Pixel& pixel, const geometry::Point& head_mm) {
    constexpr double farthest_feature_mm = 1e3, most_pixels = 1e6;
    return head_mm.allFinite() && head_mm.cwiseAbs().maxCoeff() <= farthest_feature_mm && pixel.allFinite() &&
           pixel.cwiseAbs().maxCoeff() <= most_pixels;
}

Points68 points_of(const TrackedFace& face) {
    if (face.points) return *face.points;
    Points68 points;
    points.fill(Pixel::Zero());
    points_on_curves(face.curves, points);
    return points;
}

Known68 known_of(const TrackedFace& face) {
    if (!face.points) return known_on_curves();
    Known68 all{};
    all.fill(true);
    return all;
}

}  // namespace

FeatureRows::FeatureRows(double rate_hz, int width, int height, const TrackVideoOptions& options,
                         std::function<void(const Row&)> take)
    : take_(std::move(take)), rate_hz_(rate_hz), width_(width), height_(height), options_(options) {
    filters_.assign(3 * capture::face_features().size() + 6, OneEuroFilter(rate_hz, options.one_euro));
}

void FeatureRows::add(const std::optional<TrackedFace>& face) {
    waiting_.push_back(face);
    const long frame = given_ + static_cast<long>(waiting_.size()) - 1;
    if (head_ || frame < options_.neutral_to) {
        if (head_) flush();
        return;
    }
    fit_head();
    if (head_) flush();
    // Nobody was there yet: the first face that comes is taken for neutral.
    while (!head_ && waiting_.size() > 1) give_lost_front();
}

bool FeatureRows::finish() {
    if (!head_) fit_head();
    if (head_) flush();
    while (!waiting_.empty()) give_lost_front();
    return head_.has_value();
}

void FeatureRows::fit_head() {
    Points68 sum;
    sum.fill(Pixel::Zero());
    Known68 known{};
    double count = 0;
    const auto add_face = [&](const TrackedFace& face) {
        const auto points = points_of(face);
        for (std::size_t k = 0; k < 68; ++k) sum[k] += points[k];
        known = known_of(face);
        ++count;
    };
    for (std::size_t k = 0; k < waiting_.size(); ++k) {
        const long frame = given_ + static_cast<long>(k);
        if (waiting_[k] && frame >= options_.neutral_from && frame <= options_.neutral_to) add_face(*waiting_[k]);
    }
    if (count == 0)
        for (const auto& face : waiting_)
            if (face && count == 0) {
                add_face(*face);
                late_neutral_ = true;
            }
    if (count == 0) return;
    for (auto& p : sum) p /= count;
    head_.emplace(sum, known, width_, height_, options_.camera);
}

void FeatureRows::flush() {
    for (; !waiting_.empty(); waiting_.pop_front()) give(waiting_.front());
}

void FeatureRows::give_lost_front() {
    give(std::nullopt);
    waiting_.pop_front();
}

void FeatureRows::fill(Row& row, const TrackedFace& face, const capture::HeadPose& pose) {
    const auto features = capture::face_features();
    const auto known = known_of(face);
    head_->fill(*row.points, known, pose);
    auto written_pose = pose;
    for (int a = 0; a < 3; ++a) {
        auto& shift = written_pose.translation_mm[a];
        auto& turn = written_pose.rotation_vector[a];
        shift = smooth(static_cast<std::size_t>(a), shift);
        turn = smooth(static_cast<std::size_t>(3 + a), turn);
    }
    row.features.state = capture::TrackState::tracked;
    row.features.confidence = face.confidence >= 0 ? std::min(face.confidence, 1.0) : 0;
    row.features.camera_from_head = written_pose;
    for (std::size_t f = 0; f < features.size(); ++f) {
        const auto k = static_cast<std::size_t>(features[f].point68);
        if (!known[k]) continue;
        const Pixel pixel = (*row.points)[k] + half_pixel;
        const auto head_mm = head_->head_point_mm(k, (*row.points)[k], pose);
        if (!fits_motion(pixel, head_mm)) continue;  // a ray along its plane
        auto& sample = row.features.features[f];
        sample.valid = sample.in_image = true;
        sample.pixel = pixel;
        sample.head_mm = head_mm;
        for (int a = 0; a < 3; ++a)
            sample.head_mm[a] = smooth(6 + 3 * f + static_cast<std::size_t>(a), sample.head_mm[a]);
    }
}

void FeatureRows::give(const std::optional<TrackedFace>& face) {
    Row row;
    row.frame = given_++;
    row.features.time_s = static_cast<double>(row.frame) / rate_hz_;
    row.features.features.resize(capture::face_features().size());
    std::optional<capture::HeadPose> pose;
    if (face && head_) {
        row.points = points_of(*face);
        pose = head_->pose(*row.points, last_pose_);
        if (pose && !fits_motion(*pose)) pose.reset();
        if (!pose) ++without_pose_;
    }
    last_pose_ = pose;  // as it was measured: a smoothed pose lags, and rays through it miss
    if (pose) {
        fill(row, *face, *pose);
        ++tracked_;
    } else {
        row.points.reset();
        for (auto& filter : filters_) filter.restart();
    }
    take_(row);
}

std::vector<std::string> finish_rows(FeatureRows& rows) {
    std::vector<std::string> remarks;
    if (!rows.finish()) remarks.emplace_back("no face was found in any frame: every row is lost");
    if (rows.late_neutral())
        remarks.emplace_back(
            "no face was found in the neutral frames: the first face that was found is taken for neutral");
    if (rows.without_pose() > 0)
        remarks.push_back(fmt::format("the head had no pose in {} in which a face was seen: these rows are lost",
                                      base::counted(static_cast<std::size_t>(rows.without_pose()), "frame")));
    return remarks;
}

}  // namespace mimik::video
