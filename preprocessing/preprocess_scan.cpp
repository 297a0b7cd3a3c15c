#include "preprocessing/preprocess_scan.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/point_index.h"
#include "io/image.h"
#include "preprocessing/bake_texture.h"

namespace mimik::preprocessing {

using geometry::Point;

namespace {

/// A cloud of a whole head says nothing about what is in front.
void judge_cloud(const GriddingReport& gridded, const database::LoadedScan& loaded, std::vector<std::string>& remarks) {
    // Of what a scanner sees no more than 0.0002; of whole heads from 0.04 on, however dense their front.
    if (gridded.seen_through > 0.02)
        throw InputError(fmt::format(
            "{}: {:.1f} % of the triangles between neighbouring points join front and back, and a cloud does not say "
            "which is which; give the mesh with its faces, or cut off what lies behind the face",
            loaded.entry.scan_file.string(), 100 * gridded.seen_through));
    if (gridded.seen_through > 0.002)
        remarks.push_back(
            fmt::format("{:.1f} % of the triangles between neighbouring points join front and back; the surface there "
                        "counts as bridged",
                        100 * gridded.seen_through));
}

/// The box of the face; none if all is kept, or a landmark is missing (a remark).
std::optional<FaceBox> box_of(const geometry::Landmarks& landmarks, const FaceCropOptions& options,
                              std::vector<std::string>& remarks) {
    if (!options.crop) return std::nullopt;
    std::string lacking;
    auto box = face_box(landmarks, options, &lacking);
    if (!box) remarks.push_back(fmt::format("not cropped to the face: {}", lacking));
    return box;
}

/// Every landmark at the nearest vertex of the grid. Where an ear was cut off, the nearest vertex is no ear.
geometry::Landmarks snapped_landmarks(const Face& face, const std::optional<FaceBox>& box) {
    std::vector<Point> inside;
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        if (face.grid.inside(v)) inside.push_back(face.grid.vertices_mm[v]);
    const geometry::PointIndex index(inside);
    std::vector<geometry::Landmark> snapped;
    for (auto mark : face.landmarks.all()) {
        if (box && !box->holds(mark.position_mm)) continue;
        mark.position_mm = inside[index.nearest(mark.position_mm).index];
        snapped.push_back(mark);
    }
    return geometry::Landmarks(std::move(snapped));
}

/// The images of a scan; what cannot be read is said. Of one image it is the database's choice which.
std::vector<std::optional<io::Image>> read_images(const database::LoadedScan& loaded,
                                                  std::vector<std::string>& remarks) {
    const auto& named = loaded.scan.charts->images;
    std::vector<std::filesystem::path> files;
    files.reserve(named.size());
    for (const auto& name : named) files.push_back(loaded.entry.scan_file.parent_path() / name);
    if (files.size() < 2) files = {loaded.entry.texture_file};
    std::vector<std::optional<io::Image>> images;
    for (const auto& file : files) {
        images.emplace_back();
        try {
            images.back() = io::read_image(file);
        } catch (const InputError& e) {
            remarks.push_back(fmt::format("a texture is left out: {}", e.what()));
        }
    }
    return images;
}

/// Where the scan's texture has charts, a new picture takes its place.
void give_picture(Face& face, const database::LoadedScan& loaded) {
    const auto& charts = loaded.scan.charts;
    if (!charts || face.texture_file.empty()) return;
    const auto images = read_images(loaded, face.remarks);
    face.texture_file.clear();
    if (std::any_of(images.begin(), images.end(), [](const auto& image) { return image.has_value(); }))
        face.picture = std::make_shared<const io::Image>(bake_texture(*charts, images, face.grid));
    else
        face.grid.texture_coordinates.clear();
}

geometry::RangeScan cleaned_scan(const geometry::RangeScan& scan, const ScanSteps& steps, CleaningReport& report) {
    return steps.cleaning_method == CleaningMethod::pcl ? clean_with_pcl(scan, steps.pcl_cleaning, &report)
                                                        : clean(scan, steps.cleaning, &report);
}

void remark_on_losses(const ScanStepsReport& done, CleaningMethod method, std::vector<std::string>& remarks) {
    if (const auto& crop = done.crop; 2 * crop.left_out > crop.points)
        remarks.push_back(fmt::format("cropped to the face: {:.0f} % of the points lie outside",
                                      100.0 * static_cast<double>(crop.left_out) / static_cast<double>(crop.points)));
    const auto& cleaned = done.cleaning;
    if (const auto lost = cleaned.spikes + cleaned.stray_points; 20 * lost > cleaned.points)
        remarks.push_back(fmt::format(
            "cleaning left out {} of {} points: {}, and {} in {}", lost, cleaned.points,
            base::counted(cleaned.spikes, method == CleaningMethod::pcl ? "outlier" : "spike"),
            base::counted(cleaned.stray_points, "stray point"), base::counted(cleaned.stray_parts, "part")));
}

}  // namespace

void ScanSteps::check() const {
    landmark_error.check();
    crop.check();
    cleaning.check();
    pcl_cleaning.check();
    gridding.check();
    if (cleaning_method == CleaningMethod::pcl) require_pcl_cleaning();
}

Face preprocess_scan(const database::LoadedScan& loaded, const ScanSteps& steps, ScanStepsReport* report) {
    Face face;
    face.id = loaded.entry.id;
    face.sex = loaded.entry.sex;
    face.landmarks = loaded.landmarks;
    face.remarks = loaded.remarks;
    if (steps.landmark_error.mean_mm > 0) {
        face.landmarks = with_landmark_error(loaded.landmarks, loaded.entry.id.name(), steps.landmark_error);
        face.remarks.push_back(fmt::format("its landmarks were moved by drawn errors of {:g} mm in the mean (seed {})",
                                           steps.landmark_error.mean_mm, steps.landmark_error.seed));
    }
    // A manifest may list meshes that know of no image, and any image of the same name lies beside them.
    if (!loaded.scan.texture_coordinates.empty())
        face.texture_file = loaded.entry.texture_file;
    else if (!loaded.entry.texture_file.empty())
        face.remarks.emplace_back("the image beside it is not used: the scan has no texture coordinates");
    ScanStepsReport done;
    const auto box = box_of(face.landmarks, steps.crop, face.remarks);
    // Before cleaning: shoulders may be the largest part of a scan, and the face a stray one.
    const auto cropped = box ? crop_to_face(loaded.scan, *box, &done.crop) : loaded.scan;
    face.grid = grid_scan(cleaned_scan(cropped, steps, done.cleaning), steps.gridding, &done.gridding);
    judge_cloud(done.gridding, loaded, face.remarks);
    give_picture(face, loaded);
    remark_on_losses(done, steps.cleaning_method, face.remarks);
    if (report) *report = done;

    face.snapped_landmarks = snapped_landmarks(face, box);
    return face;
}

}  // namespace mimik::preprocessing
