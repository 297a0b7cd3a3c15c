#include "video/face_choice.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::video {

void FaceChoiceOptions::check() const {
    if (rank < 1 || rank > most_faces)
        throw InputError(fmt::format("rank is {}; give 1 for the largest face, to {}", rank, most_faces));
    if (x_px.has_value() != y_px.has_value()) throw InputError("x_px and y_px go together; give both or neither");
    if (x_px && !may_be_pixel(*x_px, *y_px))
        throw InputError(fmt::format("x_px, y_px are {}, {}; give a pixel of the frame", *x_px, *y_px));
    if (wait_frames < 0) throw InputError(fmt::format("wait_frames is {}; give 0 or more", wait_frames));
}

FaceChooser::FaceChooser(const FaceChoiceOptions& options) : options_(options) { options_.check(); }

std::vector<FaceBox> FaceChooser::near(std::span<const FaceBox> faces, const Pixel& at, double within_sizes) const {
    std::vector<FaceBox> there;
    for (const auto& face : faces)
        if ((face.middle() - at).norm() < within_sizes * face.size_px) there.push_back(face);
    std::stable_sort(there.begin(), there.end(), [&](const FaceBox& a, const FaceBox& b) {
        return (a.middle() - at).norm() < (b.middle() - at).norm();
    });
    return there;
}

void FaceChooser::look_at(const io::Image& frame) {
    if (options_.x_px && !(*options_.x_px < frame.width && *options_.y_px < frame.height))
        throw InputError(fmt::format("x_px, y_px are {}, {}, and frames have {} x {} pixels; give a pixel of the frame",
                                     *options_.x_px, *options_.y_px, frame.width, frame.height));
    picture_.look_at(frame);
    width_px_ = frame.width;
    height_px_ = frame.height;
}

bool FaceChooser::may_have_left() const {
    if (width_px_ == 0 || !last_) return false;
    const double near_px = 0.5 * last_->size_px;  // what a face goes within a frame or two
    const Pixel end = last_->corner + Pixel(last_->size_px, last_->size_px);
    return last_->corner.minCoeff() < near_px || end.x() > width_px_ - near_px || end.y() > height_px_ - near_px;
}

std::vector<FaceBox> FaceChooser::candidates(std::span<const FaceBox> faces) const {
    constexpr double same_size = 1.5, same_place = 0.5;
    const bool waits = last_ && since_ <= options_.wait_frames;
    if (waits) {
        std::vector<FaceBox> alike;
        for (const auto& face : faces)
            if (face.size_px < same_size * last_->size_px && last_->size_px < same_size * face.size_px)
                alike.push_back(face);
        if (auto there = near(alike, last_->middle(), same_place); !there.empty()) return there;
    }
    if (options_.x_px) {
        // One who was pointed at is looked for where they were last: a face elsewhere may be anybody's.
        if (last_) return near(faces, last_->middle(), same_place);
        return near(faces, {*options_.x_px, *options_.y_px}, 0.75);
    }
    // Who else is in the picture is a neighbour. After a cut it may be the performer, and who went over the picture's
    // edge comes back anywhere.
    if (waits && !may_have_left() && !picture_.is_another()) return {};
    if (options_.rank == 1) return {faces.begin(), faces.end()};
    const auto at = static_cast<std::size_t>(options_.rank - 1);
    if (at >= faces.size()) return {};
    return {faces[at]};
}

void FaceChooser::followed(const FaceBox& face) {
    last_ = face;
    since_ = 0;
    picture_.keep();
}

void FaceChooser::lost() { ++since_; }

void FaceChooser::restart() {
    last_.reset();
    since_ = 0;
    picture_.forget();
}

}  // namespace mimik::video
