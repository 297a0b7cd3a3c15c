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

std::vector<FaceBox> FaceChooser::candidates(std::span<const FaceBox> faces) const {
    if (last_ && since_ <= options_.wait_frames) {
        constexpr double same_size = 1.5;
        std::vector<FaceBox> alike;
        for (const auto& face : faces)
            if (face.size_px < same_size * last_->size_px && last_->size_px < same_size * face.size_px)
                alike.push_back(face);
        if (auto there = near(alike, last_->middle(), 0.5); !there.empty()) return there;
    }
    if (options_.x_px) {
        // One who was pointed at is looked for where they were last: a face elsewhere may be anybody's.
        if (last_) return near(faces, last_->middle(), 1.5);
        return near(faces, {*options_.x_px, *options_.y_px}, 0.75);
    }
    if (options_.rank == 1) return {faces.begin(), faces.end()};
    const auto at = static_cast<std::size_t>(options_.rank - 1);
    if (at >= faces.size()) return {};
    return {faces[at]};
}

void FaceChooser::followed(const FaceBox& face) {
    last_ = face;
    since_ = 0;
}

void FaceChooser::lost() { ++since_; }

void FaceChooser::restart() {
    last_.reset();
    since_ = 0;
}

}  // namespace mimik::video
