#include "video/picture_memory.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace mimik::video {
namespace {

constexpr int columns = 24, rows = 18;  ///< cells; a head that moves changes few of them
constexpr int samples = 4;              ///< of a cell, each way: the noise of single pixels goes
constexpr std::size_t most_kept = 6;    ///< frames: no tracker notices a cut later
/// A quarter of the picture may be hidden, or a head of it; something over half of it passes for a cut.
constexpr double least_alike = 0.5;

}  // namespace

double grey_correlation(const std::vector<float>& a, const std::vector<float>& b) {
    double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        sum_a += a[k], sum_b += b[k];
        aa += double{a[k]} * a[k], bb += double{b[k]} * b[k], ab += double{a[k]} * b[k];
    }
    const auto n = static_cast<double>(std::max<std::size_t>(1, a.size()));
    constexpr double noise = 1;  // grey level: a blank picture is like nothing
    aa = std::max(0.0, aa - sum_a * sum_a / n) + noise * n;
    bb = std::max(0.0, bb - sum_b * sum_b / n) + noise * n;
    return (ab - sum_a * sum_b / n) / std::sqrt(aa * bb);
}

void PictureMemory::look_at(const io::Image& frame) {
    now_.assign(static_cast<std::size_t>(columns) * rows, 0);
    const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
    if (width == 0 || height == 0) return;
    constexpr std::size_t across = std::size_t{columns} * samples, down = std::size_t{rows} * samples;
    for (std::size_t y = 0; y < down; ++y)
        for (std::size_t x = 0; x < across; ++x) {
            const auto pixel = 3 * ((2 * y + 1) * height / (2 * down) * width + (2 * x + 1) * width / (2 * across));
            const int sum = frame.rgb[pixel] + frame.rgb[pixel + 1] + frame.rgb[pixel + 2];
            now_[y / samples * columns + x / samples] += static_cast<float>(sum) / (3 * samples * samples);
        }
}

void PictureMemory::keep() {
    if (now_.empty()) return;
    kept_.push_back(now_);
    if (kept_.size() > most_kept) kept_.pop_front();
}

bool PictureMemory::is_another() const {
    return !kept_.empty() && !now_.empty() && grey_correlation(now_, kept_.front()) < least_alike;
}

void PictureMemory::forget() {
    now_.clear();
    kept_.clear();
}

}  // namespace mimik::video
