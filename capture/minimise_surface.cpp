#include "capture/minimise_surface.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/companion.h"
#include "base/errors.h"
#include "base/optimiser_modules.h"
#include "base/text.h"
#include "capture/smooth_terms.h"

namespace mimik::capture {

using geometry::Point;
using geometry::Vector;

namespace {

/// A module of companions/ and what gets it.
struct Library {
    const char *module, *function, *package;
};
constexpr Library ceres_library = {base::ceres_module_name, base::ceres_function_name, "libceres-dev"};
constexpr Library simplex_library = {base::simplex_module_name, base::simplex_function_name, "libopencv-dev"};

/// Stays loaded: such libraries do not let go of what they hold.
void* load(const Library& library, SurfaceMinimiser by) {
    const auto file = base::companion_folder() / library.module;
    const auto mend = fmt::format("install {} and build Mimik again ('scripts/setup.sh --adapters'), or take {}",
                                  library.package, to_string(SurfaceMinimiser::levenberg));
    if (base::find_companion(library.module).empty())
        throw InputError(fmt::format("minimiser {}: {} is not there; {}", to_string(by), file.string(), mend));
    void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr)
        throw InputError(
            fmt::format("minimiser {}: its module does not load ({}); {}", to_string(by), dlerror(), mend));
    void* function = dlsym(handle, library.function);
    if (function == nullptr)
        throw InputError(fmt::format("minimiser {}: {} is of another version; {}", to_string(by), file.string(), mend));
    return function;
}

/// A call that throws leaves it to the next one.
mimik_ceres_function* ceres_function() {
    static auto* const function = reinterpret_cast<mimik_ceres_function*>(load(ceres_library, SurfaceMinimiser::ceres));
    return function;
}
mimik_simplex_function* simplex_function() {
    static auto* const function =
        reinterpret_cast<mimik_simplex_function*>(load(simplex_library, SurfaceMinimiser::simplex));
    return function;
}

void check_done(int code, const char* library, const std::array<char, 256>& message) {
    if (code != 0) throw NumericalError(fmt::format("{} found no pose of least energy: {}", library, message.data()));
}

double residual_for_ceres(void* problem, std::size_t term, const double* const* blocks, double* const* gradients) {
    const auto& terms = *static_cast<const SmoothTerms*>(problem);
    const std::size_t count = terms.energy().terms()[term].count;
    std::array<Point, SurfaceEnergy::most_corners> corners;
    std::array<Vector, SurfaceEnergy::most_corners> by_corner;
    corners.fill(Point::Zero());  // the compiler cannot know that a term reads its own corners alone
    for (std::size_t c = 0; c < count; ++c) corners[c] = Eigen::Map<const Vector>(blocks[c]);
    const double value = terms.residual(term, corners.data(), gradients ? by_corner.data() : nullptr);
    for (std::size_t c = 0; gradients && c < count; ++c)
        if (gradients[c]) std::copy_n(by_corner[c].data(), 3, gradients[c]);
    return value;
}

std::size_t solve_by_ceres(SmoothTerms terms, std::vector<Point>& pose_mm, std::span<const std::uint8_t> holding,
                           const MinimiseSurfaceOptions& options) {
    std::vector<std::uint32_t> first = {0}, block;
    for (const auto& term : terms.energy().terms()) {
        block.insert(block.end(), term.corners.begin(), term.corners.begin() + term.count);
        first.push_back(static_cast<std::uint32_t>(block.size()));
    }
    const mimik_residuals residuals{pose_mm.size(), terms.size(), first.data(), block.data(), holding.data()};
    int evaluations = 0;
    std::array<char, 256> message{};
    check_done(ceres_function()(residual_for_ceres, &terms, &residuals, pose_mm.front().data(), options.most_iterations,
                                options.least_change, &evaluations, message.data(), message.size()),
               "Ceres", message);
    return static_cast<std::size_t>(evaluations);
}

/// The energy of those vertices that move, for the simplex.
struct MovingPose {
    const SurfaceEnergy* energy;
    std::vector<Point> pose_mm;
    std::vector<std::size_t> moving;

    void take(const double* x) {
        for (std::size_t k = 0; k < moving.size(); ++k) pose_mm[moving[k]] = Eigen::Map<const Vector>(x + 3 * k);
    }
};

double energy_for_simplex(void* data, const double* x) {
    auto& pose = *static_cast<MovingPose*>(data);
    pose.take(x);
    return pose.energy->of(pose.pose_mm).total;
}

std::size_t solve_by_simplex(const SurfaceEnergy& energy, std::vector<Point>& pose_mm,
                             std::span<const std::uint8_t> holding, const MinimiseSurfaceOptions& options) {
    MovingPose moving{&energy, pose_mm, {}};
    std::vector<double> x;
    for (std::size_t v = 0; v < pose_mm.size(); ++v) {
        if (holding[v] != 0) continue;
        moving.moving.push_back(v);
        x.insert(x.end(), pose_mm[v].data(), pose_mm[v].data() + 3);
    }
    int evaluations = options.most_evaluations;
    double value = 0;
    std::array<char, 256> message{};
    check_done(simplex_function()(energy_for_simplex, &moving, x.data(), x.size(), options.first_step_mm,
                                  options.least_difference, &evaluations, &value, message.data(), message.size()),
               "OpenCV", message);
    moving.take(x.data());
    pose_mm = std::move(moving.pose_mm);
    return static_cast<std::size_t>(evaluations);
}

}  // namespace

const char* to_string(SurfaceMinimiser minimiser) {
    switch (minimiser) {
        case SurfaceMinimiser::levenberg:
            return "levenberg";
        case SurfaceMinimiser::ceres:
            return "ceres";
        case SurfaceMinimiser::simplex:
            return "simplex";
    }
    return "";
}

std::span<const SurfaceMinimiser> surface_minimisers() {
    static constexpr std::array all = {SurfaceMinimiser::levenberg, SurfaceMinimiser::ceres, SurfaceMinimiser::simplex};
    return all;
}

bool is_there(SurfaceMinimiser minimiser) {
    switch (minimiser) {
        case SurfaceMinimiser::levenberg:
            return true;
        case SurfaceMinimiser::ceres:
            return !base::find_companion(base::ceres_module_name).empty();
        case SurfaceMinimiser::simplex:
            return !base::find_companion(base::simplex_module_name).empty();
    }
    return false;
}

void MinimiseSurfaceOptions::check() const {
    if (!(first_width_mm >= last_width_mm && last_width_mm > 0 && first_width_mm <= 1e3))
        throw InputError(
            fmt::format("first_width_mm is {} and last_width_mm {}; give a width up to 1000 and one above "
                        "0 that is no wider",
                        first_width_mm, last_width_mm));
    for (const auto& [name, value, most] :
         {std::tuple{"stages", stages, 100}, std::tuple{"most_iterations", most_iterations, 100000},
          std::tuple{"most_evaluations", most_evaluations, 100000000}})
        if (value < 1 || value > most) throw InputError(fmt::format("{} is {}; give 1 to {}", name, value, most));
    for (const auto& [name, value] :
         {std::pair{"least_change", least_change}, std::pair{"least_difference", least_difference}})
        if (!(value >= 0 && value < 1)) throw InputError(fmt::format("{} is {}; give 0 or more, below 1", name, value));
    if (!(first_step_mm > 0 && first_step_mm <= 1e3))
        throw InputError(fmt::format("first_step_mm is {}; give more than 0, up to 1000", first_step_mm));
}

double SmoothTerms::residual(std::size_t term, const Point* corners_mm, Vector* gradients) const {
    const auto& one = energy_->terms()[term];
    // A bend has no unit: as if it were the height of a corner that turns over this length.
    constexpr double bend_mm = 10;
    const double unit_mm = one.kind == SurfaceEnergy::Term::Kind::bending ? bend_mm : 1;
    const double r = unit_mm * energy_->residual(one, corners_mm, gradients);
    const double root = std::hypot(r, width_mm_);
    // 2 (sqrt(r^2 + a^2) - a) without the loss of digits of a difference.
    const double square = 2 * r * r / (root + width_mm_);
    const double weight = std::sqrt(one.weight / unit_mm);
    const double value = weight * std::copysign(std::sqrt(square), r);
    if (gradients) {
        // ds/dr = r / (s sqrt(r^2 + a^2)), which is sqrt((sqrt(r^2 + a^2) + a) / 2) / sqrt(r^2 + a^2).
        const double slope = weight * unit_mm * std::sqrt((root + width_mm_) / 2) / root;
        for (std::size_t c = 0; c < one.count; ++c) gradients[c] *= slope;
    }
    return value;
}

MinimisedSurface minimise_surface(const SurfaceEnergy& energy, std::span<const Point> start_mm,
                                  std::span<const std::uint8_t> holding, SurfaceMinimiser minimiser,
                                  const MinimiseSurfaceOptions& options) {
    options.check();
    if (start_mm.size() != energy.vertices() || (!holding.empty() && holding.size() != start_mm.size()))
        throw InputError(fmt::format("{} points begin and {} are said to hold; the surface has {} vertices",
                                     start_mm.size(), holding.size(), energy.vertices()));
    if (minimiser == SurfaceMinimiser::ceres) (void)ceres_function();
    if (minimiser == SurfaceMinimiser::simplex) (void)simplex_function();
    std::vector<std::uint8_t> held(holding.begin(), holding.end());
    held.resize(start_mm.size(), 0);
    MinimisedSurface result;
    result.pose_mm.assign(start_mm.begin(), start_mm.end());
    result.start = result.end = energy.of(start_mm);
    bool any_moves = false;
    for (const auto one : held) any_moves = any_moves || one == 0;
    if (!any_moves) return result;
    const auto begun = std::chrono::steady_clock::now();
    auto pose = result.pose_mm;
    const auto keep_if_lower = [&] {
        const auto found = energy.of(pose);
        if (!(found.total < result.end.total)) return;
        result.end = found;
        result.pose_mm = pose;
    };
    if (minimiser == SurfaceMinimiser::simplex) {
        result.evaluations = solve_by_simplex(energy, pose, held, options);
        keep_if_lower();
    } else {
        for (int stage = 0; stage < options.stages; ++stage) {
            const double share = options.stages == 1 ? 1 : static_cast<double>(stage) / (options.stages - 1);
            const SmoothTerms terms(
                energy, options.first_width_mm * std::pow(options.last_width_mm / options.first_width_mm, share));
            result.evaluations +=
                minimiser == SurfaceMinimiser::ceres
                    ? solve_by_ceres(terms, pose, held, options)
                    : solve_by_levenberg(terms, pose, held, options.most_iterations, options.least_change);
            keep_if_lower();
        }
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return result;
}

}  // namespace mimik::capture
