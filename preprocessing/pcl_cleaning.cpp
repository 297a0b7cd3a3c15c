#include "preprocessing/pcl_cleaning.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/companion.h"
#include "base/errors.h"
#include "base/pcl_module.h"
#include "base/text.h"
#include "geometry/leave_out_points.h"
#include "preprocessing/scan_parts.h"

namespace mimik::preprocessing {

using geometry::RangeScan;

namespace {

struct PclModule {
    mimik_pcl_outliers_function* outliers = nullptr;
    mimik_pcl_clusters_function* clusters = nullptr;
};

/// Stays loaded: PCL's libraries do not let go of what they hold.
PclModule load_module() {
    const auto wanted = base::companion_folder() / base::pcl_module_name;
    constexpr const char* mend =
        "install libpcl-dev and build Mimik again ('scripts/setup.sh --adapters'), or clean with own";
    if (base::find_companion(base::pcl_module_name).empty())
        throw InputError(fmt::format("cleaning is pcl, but its module {} is not there; {}", wanted.string(), mend));
    void* handle = dlopen(wanted.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr)
        throw InputError(fmt::format("cleaning is pcl, but its module does not load ({}); {}", dlerror(), mend));
    PclModule module;
    module.outliers = reinterpret_cast<mimik_pcl_outliers_function*>(dlsym(handle, base::pcl_outliers_name));
    module.clusters = reinterpret_cast<mimik_pcl_clusters_function*>(dlsym(handle, base::pcl_clusters_name));
    if (module.outliers == nullptr || module.clusters == nullptr)
        throw InputError(fmt::format("cleaning is pcl, but {} is of another version; {}", wanted.string(), mend));
    return module;
}

/// A call that throws leaves it to the next one.
const PclModule& pcl_module() {
    static const PclModule module = load_module();
    return module;
}

/// The measured points without those at one place in single precision, which PCL's trees would search one by one.
struct Places {
    std::vector<std::uint32_t> place_of;  // of each point; no_part: not measured
    std::vector<double> xyz;              // of the places
    std::vector<std::uint32_t> first;     // point of each place
};

Places places_of(const RangeScan& scan) {
    std::vector<std::uint32_t> measured;
    for (std::uint32_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) measured.push_back(i);
    // Single precision holds the scan wherever its frame has its origin.
    const geometry::Point origin = measured.empty() ? geometry::Point::Zero() : scan.points_mm[measured.front()];
    const auto single = [&](std::uint32_t i) {
        const geometry::Point p = scan.points_mm[i] - origin;
        // Adding zero makes the negative one positive.
        return std::array{static_cast<float>(p.x()) + 0.0F, static_cast<float>(p.y()) + 0.0F,
                          static_cast<float>(p.z()) + 0.0F};
    };
    std::vector<std::uint32_t> stands_for(scan.points_mm.size(), no_part), order = measured;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(single(a), a) < std::pair(single(b), b); });
    for (std::size_t k = 0; k < order.size(); ++k)
        stands_for[order[k]] = k > 0 && single(order[k]) == single(order[k - 1]) ? stands_for[order[k - 1]] : order[k];
    Places places;
    places.place_of.assign(scan.points_mm.size(), no_part);
    for (const auto i : measured) {  // in the scan's order, which the numbers of clusters follow
        if (stands_for[i] == i) {
            places.place_of[i] = static_cast<std::uint32_t>(places.first.size());
            places.first.push_back(i);
            const geometry::Point p = scan.points_mm[i] - origin;
            places.xyz.insert(places.xyz.end(), {p.x(), p.y(), p.z()});
        } else {
            places.place_of[i] = places.place_of[stands_for[i]];
        }
    }
    return places;
}

/// What the module says is wrong is nothing that the user typed; the scan is named by who calls.
void check_done(int code, const std::array<char, 256>& message) {
    if (code != 0) throw InputError(fmt::format("PCL cannot clean the scan: {}", message.data()));
}

std::vector<std::uint8_t> outlier_places(const Places& places, const PclCleaningOptions& options) {
    std::vector<std::uint8_t> outlier(places.first.size(), 0);
    // A mean of fewer neighbours than asked for is none.
    if (places.first.size() <= static_cast<std::size_t>(options.neighbours)) return outlier;
    std::array<char, 256> message{};
    check_done(pcl_module().outliers(places.xyz.data(), outlier.size(), options.neighbours, options.deviations,
                                     outlier.data(), message.data(), message.size()),
               message);
    return outlier;
}

/// The cluster of each place, no_part for outliers.
std::vector<std::uint32_t> clusters_of(const Places& places, const std::vector<std::uint8_t>& outlier,
                                       double tolerance_mm) {
    std::vector<double> xyz;
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < outlier.size(); ++k)
        if (!outlier[k]) {
            kept.push_back(k);
            xyz.insert(xyz.end(), places.xyz.begin() + static_cast<std::ptrdiff_t>(3 * k),
                       places.xyz.begin() + static_cast<std::ptrdiff_t>(3 * k + 3));
        }
    std::vector<std::uint32_t> found(kept.size(), no_part), cluster(outlier.size(), no_part);
    std::array<char, 256> message{};
    check_done(
        pcl_module().clusters(xyz.data(), kept.size(), tolerance_mm, found.data(), message.data(), message.size()),
        message);
    for (std::size_t k = 0; k < kept.size(); ++k) cluster[kept[k]] = found[k];
    return cluster;
}

}  // namespace

const char* to_string(CleaningMethod method) { return method == CleaningMethod::own ? "own" : "pcl"; }

CleaningMethod parse_cleaning_method(const std::string& text) {
    if (text == "own") return CleaningMethod::own;
    if (text == "pcl") return CleaningMethod::pcl;
    throw InputError(fmt::format("cleaning is {}; give own or pcl", base::in_quotes(text)));
}

void PclCleaningOptions::check() const {
    constexpr int most_neighbours = 1000;
    if (neighbours < 1 || neighbours > most_neighbours)
        throw InputError(fmt::format("neighbours is {}; give 1 to {}", neighbours, most_neighbours));
    if (!(deviations > 0)) throw InputError(fmt::format("deviations is {}; give more than 0", deviations));
    constexpr double most_mm = 50;  // PCL asks every point for all that lie within: seconds a scan
    if (!(tolerance_mm > 0 && tolerance_mm <= most_mm))
        throw InputError(fmt::format("tolerance_mm is {}; give more than 0, up to {}", tolerance_mm, most_mm));
    if (!(min_part >= 0 && min_part <= 1))
        throw InputError(fmt::format("min_part is {}; give a share between 0 and 1", min_part));
}

void require_pcl_cleaning() { (void)pcl_module(); }

RangeScan clean_with_pcl(const RangeScan& scan, const PclCleaningOptions& options, CleaningReport* report) {
    options.check();
    require_pcl_cleaning();
    const std::size_t n = scan.points_mm.size();
    CleaningReport counts;
    for (std::size_t i = 0; i < n; ++i) counts.points += scan.valid(i) ? 1 : 0;
    if (counts.points == 0) throw InputError("the scan holds no measured point");
    const auto places = places_of(scan);
    const auto outlier = outlier_places(places, options);
    const auto cluster = clusters_of(places, outlier, options.tolerance_mm);
    geometry::VertexMask dropped(n, 0), counted(n, 0);
    std::vector<std::uint32_t> part_of(n, no_part);
    for (std::size_t i = 0; i < n; ++i) {
        if (places.place_of[i] == no_part) continue;
        part_of[i] = cluster[places.place_of[i]];
        counted[i] = places.first[places.place_of[i]] == i;
        dropped[i] = outlier[places.place_of[i]];
        counts.spikes += dropped[i];
    }
    const ScanParts parts(scan, std::move(part_of), counted, options.min_part);
    const auto stray = parts.stray_points();
    counts.stray_parts = parts.stray_parts();
    for (std::size_t i = 0; i < n; ++i)
        if (stray[i]) {
            dropped[i] = 1;
            ++counts.stray_points;
        }
    counts.kept = counts.points - counts.spikes - counts.stray_points;
    if (counts.kept == 0) throw InputError("cleaning left no point; raise deviations or lower min_part");
    if (report) *report = counts;
    return geometry::leave_out_points(scan, dropped);
}

}  // namespace mimik::preprocessing
