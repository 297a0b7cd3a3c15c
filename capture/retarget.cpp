#include "capture/retarget.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"

namespace mimik::capture {
namespace {

std::size_t find_rest(const MarkerSequence& sequence, const std::vector<std::size_t>& labelled,
                      std::optional<std::int64_t> asked) {
    if (asked) {
        const auto frame = *asked - sequence.first_frame();
        if (frame < 0 || frame >= static_cast<std::int64_t>(sequence.frames()))
            throw InputError(fmt::format("rest_frame is {}; there are {} to {}", *asked, sequence.first_frame(),
                                         sequence.first_frame() + static_cast<std::int64_t>(sequence.frames()) - 1));
        return static_cast<std::size_t>(frame);
    }
    std::size_t best = 0, most = 0;
    for (std::size_t frame = 0; frame < sequence.frames() && most < labelled.size(); ++frame) {
        std::size_t count = 0;
        for (const auto marker : labelled) count += sequence.valid(frame, marker) ? 1 : 0;
        if (count > most) {
            best = frame;
            most = count;
        }
    }
    return best;
}

}  // namespace

Retargeted retarget(const MarkerSequence& sequence, const geometry::Landmarks& labels, const RetargetOptions& options) {
    Retargeted result;
    std::vector<std::size_t> labelled;
    std::vector<std::string> names, unlabelled, absent;
    for (std::size_t marker = 0; marker < sequence.markers(); ++marker) {
        const auto& name = sequence.names()[marker];
        if (labels.find(name)) {
            labelled.push_back(marker);
            names.push_back(name);
        } else {
            unlabelled.push_back(name);
        }
    }
    for (const auto& label : labels.all())
        if (!sequence.find(label.name)) absent.push_back(label.name);
    if (!unlabelled.empty())
        result.remarks.push_back(fmt::format("{} no label on the target; left out: {}",
                                             base::counted(unlabelled.size(), "marker has", "markers have"),
                                             fmt::join(unlabelled, ", ")));
    if (!absent.empty())
        result.remarks.push_back(fmt::format("{} not in the recording: {}",
                                             base::counted(absent.size(), "label is", "labels are"),
                                             fmt::join(absent, ", ")));

    const auto rest = find_rest(sequence, labelled, options.rest_frame);
    result.rest_frame = sequence.first_frame() + static_cast<std::int64_t>(rest);
    std::vector<Point> source, target;
    std::vector<std::string> paired, not_at_rest;
    for (std::size_t k = 0; k < labelled.size(); ++k) {
        if (sequence.frames() == 0 || !sequence.valid(rest, labelled[k])) {
            not_at_rest.push_back(names[k]);
            continue;
        }
        source.push_back(sequence.at_mm(rest, labelled[k]));
        target.push_back(labels.position_mm(names[k]));
        paired.push_back(names[k]);
    }
    if (source.size() < 4)
        throw InputError(
            fmt::format("{} labelled and there in frame {}; 4 are the least that say a map: label more of "
                        "the recording's markers by their names",
                        base::counted(source.size(), "marker is", "markers are"), result.rest_frame));
    if (!not_at_rest.empty())
        result.remarks.push_back(fmt::format("{} missing in the rest frame {}; the others carry: {}",
                                             base::counted(not_at_rest.size(), "marker is", "markers are"),
                                             result.rest_frame, fmt::join(not_at_rest, ", ")));
    const auto map = geometry::RadialBasisMap::fit(source, target, options.basis, paired);
    result.scale = std::cbrt(std::abs(map.affine().linear().determinant()));
    result.markers = MarkerSequence(names, sequence.rate_hz(), sequence.frames(), sequence.first_frame());
    base::parallel_for(sequence.frames(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t frame = begin; frame < end; ++frame)
            for (std::size_t k = 0; k < labelled.size(); ++k)
                if (sequence.valid(frame, labelled[k]))
                    result.markers.set(frame, k, map(sequence.at_mm(frame, labelled[k])));
    });
    return result;
}

}  // namespace mimik::capture
