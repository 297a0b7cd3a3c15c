#include "report/quality_sheet.h"

#include <algorithm>
#include <array>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "geometry/box.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "preprocessing/workspace_layout.h"
#include "report/figure_description.h"

namespace mimik::report {

using preprocessing::Face;
using preprocessing::Workspace;

using database::ScanId;
using geometry::Point;
namespace fs = std::filesystem;

namespace {

/// Part of every mark: raise it when a sheet looks different for the same faces.
constexpr int sheet_version = 1;
// A mark names the neutrals of all subjects with sizes and times.
constexpr std::uintmax_t most_mark_bytes = 1 << 24;
constexpr std::array<std::uint8_t, 3> measured_colour = {222, 196, 178}, bridged_colour = {112, 172, 104};

/// One subject's sheet and the files beside it.
class Sheet {
public:
    Sheet(const Workspace& workspace, std::string subject)
        : workspace_(workspace), subject_(std::move(subject)), folder_(preprocessing::sheets_folder(workspace.root())) {
        for (const auto& id : workspace.scans())
            if (id.subject == subject_) scans_.push_back(id);
    }

    [[nodiscard]] bool up_to_date() const {
        std::error_code error;
        if (!fs::is_regular_file(file(".done"), error)) return false;
        try {
            const auto expected = done_text();
            return base::read_text(file(".done"), expected.size()) == expected;
        } catch (const InputError&) {
            return false;  // unreadable: drawn again
        }
    }

    /// @return what went wrong; empty: nothing
    [[nodiscard]] std::string make(const DrawFigure& draw) const {
        remove();  // a sheet that shows other faces than there are is worse than none
        auto fault = draw(write_parts(), file(".png"));
        fs::remove_all(parts());
        if (fault.empty()) base::write_atomically(file(".done"), done_text());
        return fault;
    }

    void remove() const {
        std::error_code ignored;
        for (const char* suffix : {".done", ".png"}) fs::remove(file(suffix), ignored);
        fs::remove_all(parts(), ignored);  // of a run that was killed
    }

private:
    [[nodiscard]] fs::path file(const char* suffix) const { return folder_ / (subject_ + suffix); }
    [[nodiscard]] fs::path parts() const { return file(".parts"); }

    /// What the sheet was drawn from: the marks of its faces, and how long it is itself.
    [[nodiscard]] std::string done_text() const {
        std::error_code error;
        const auto bytes = fs::file_size(file(".png"), error);
        auto text = fmt::format("sheet {} png {}\n", sheet_version, error ? 0 : bytes);
        for (const auto& id : scans_) {
            auto mark = workspace_.stem(id);
            text += id.name() + " " + base::read_text(mark += ".done", most_mark_bytes);
        }
        return text;
    }

    [[nodiscard]] static std::string caption(const Face& face, bool first_neutral) {
        const auto share = [&](geometry::VertexOrigin origin) {
            return 100.0 * static_cast<double>(std::count(face.grid.origin.begin(), face.grid.origin.end(), origin)) /
                   static_cast<double>(face.grid.size());
        };
        return fmt::format("{}_{}\n{:.0f} % measured, {:.1f} % bridged\n{}", face.id.group_and_code(),
                           face.id.repetition, share(geometry::VertexOrigin::measured),
                           share(geometry::VertexOrigin::bridged),
                           first_neutral ? std::string("the others are aligned to it")
                                         : fmt::format("aligned to {:.2f} mm rms", face.alignment_rms_mm));
    }

    /// Coloured meshes, landmarks and the description. @return the description
    [[nodiscard]] fs::path write_parts() const {
        FigureDescription description;
        const auto first = workspace_.neutral(subject_);
        Point centre_mm = Point::Zero();
        auto order = scans_;
        std::stable_partition(order.begin(), order.end(), [&](const ScanId& id) { return id == first; });
        for (const auto& id : order) {
            const auto face = workspace_.face(id);
            const auto mesh = coloured_mesh(face);
            if (id == first) centre_mm = geometry::box_of(mesh.vertices_mm).center();
            auto& panel = description.panels.emplace_back();
            panel.mesh = parts() / (id.name() + ".ply");
            panel.landmarks = parts() / (id.name() + ".csv");
            panel.caption = caption(face, id == first);
            panel.centre_mm = centre_mm;
            io::write_mesh(panel.mesh, mesh);
            io::write_landmarks(panel.landmarks, geometry::transformed(face.landmarks, face.neutral_from_scan));
        }
        auto& page = description.page;
        page.title = fmt::format("{}: {} {}scans; landmarks blue, bridged surface green", subject_, order.size(),
                                 workspace_.made_with_truth() ? "synthetic " : "");
        page.panel_width_px = 270;
        page.panel_height_px = 320;
        page.font_size_px = 15;
        page.scale_bar_mm = 50;
        auto file = parts() / "figure.json";
        write_figure_description(file, description);
        return file;
    }

    /// Brought to the subject's first neutral; what is measured and what is bridged in colours of their own.
    [[nodiscard]] static geometry::Mesh coloured_mesh(const Face& face) {
        auto mesh = geometry::to_mesh(face.grid);
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
            mesh.vertices_mm[v] = face.neutral_from_scan * mesh.vertices_mm[v];
            const bool measured =
                mesh.attributes.front().values[v] == static_cast<double>(geometry::VertexOrigin::measured);
            mesh.colours.push_back(measured ? measured_colour : bridged_colour);
        }
        return mesh;
    }

    const Workspace& workspace_;
    std::string subject_;
    fs::path folder_;
    std::vector<ScanId> scans_;
};

std::vector<fs::path> files_of_sheets(const Workspace& workspace) {
    std::error_code none;
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(preprocessing::sheets_folder(workspace.root()), none))
        found.push_back(entry.path());
    return found;
}

}  // namespace

QualitySheetReport draw_quality_sheets(const Workspace& workspace, const DrawFigure& draw,
                                       const std::function<void(const std::string&)>& progress) {
    preprocessing::remove_sheets_of_hidden(workspace);
    std::error_code none;
    for (const auto& path : files_of_sheets(workspace))  // of runs that were killed
        if (path.extension() == ".parts") fs::remove_all(path, none);

    const auto subjects = workspace.shown_subjects();
    enum class Outcome { drawn, up_to_date, failed };
    std::vector<Outcome> outcomes(subjects.size(), Outcome::failed);
    std::vector<std::string> faults(subjects.size());
    base::parallel_for(subjects.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            try {
                const Sheet sheet(workspace, subjects[s]);
                if (sheet.up_to_date()) {
                    outcomes[s] = Outcome::up_to_date;
                } else {
                    faults[s] = sheet.make(draw);
                    if (faults[s].empty()) outcomes[s] = Outcome::drawn;
                }
            } catch (const std::exception& e) {
                faults[s] = e.what();
            }
            if (progress) progress(subjects[s]);
        }
    });
    QualitySheetReport report;
    for (std::size_t s = 0; s < subjects.size(); ++s) {
        if (outcomes[s] == Outcome::drawn) ++report.drawn;
        if (outcomes[s] == Outcome::up_to_date) ++report.up_to_date;
        if (outcomes[s] == Outcome::failed) report.failures.push_back(subjects[s] + ": no quality sheet: " + faults[s]);
    }
    return report;
}

}  // namespace mimik::report
