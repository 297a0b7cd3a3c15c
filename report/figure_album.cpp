#include "report/figure_album.h"

#include <algorithm>
#include <exception>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/markup.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "base/temporary.h"
#include "io/image.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "report/figure_description.h"
#include "report/latex_tables.h"

namespace mimik::report {

namespace fs = std::filesystem;

namespace {

/// Points as a file that every reader of landmarks takes: their names must differ.
void write_points(const fs::path& file, const std::vector<geometry::Point>& points_mm) {
    std::vector<geometry::Landmark> marks;
    for (const auto& p : points_mm) marks.push_back({fmt::format("p{}", marks.size() + 1), p, {}});
    io::write_landmarks(file, geometry::Landmarks(std::move(marks)));
}

void write_arrows(const fs::path& file, const std::vector<figures::Arrow>& arrows) {
    std::string text = "x,y,z,to_x,to_y,to_z\n";
    for (const auto& a : arrows)
        text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", a.from_mm.x(), a.from_mm.y(),
                            a.from_mm.z(), a.to_mm.x(), a.to_mm.y(), a.to_mm.z());
    base::write_atomically(file, text);
}

PanelDescription write_panel(const fs::path& folder, const std::string& stem, const figures::Panel& panel) {
    PanelDescription description;
    description.caption = panel.caption;
    description.view = panel.view;
    description.centre_mm = panel.centre_mm;
    description.scalar = panel.scalar;
    description.wire_frame = panel.wire_frame;
    description.lit_as_skin = panel.lit_as_skin;
    if (panel.mesh.vertices_mm.empty()) return description;
    description.mesh = folder / (stem + ".ply");
    io::write_mesh(description.mesh, panel.mesh);
    if (panel.texture) {
        description.texture = folder / (stem + "_texture.png");
        io::write_png(description.texture, *panel.texture);
    }
    int number = 0;
    for (const auto& set : panel.markers) {
        if (set.positions_mm.empty()) continue;
        const auto file = folder / fmt::format("{}_points{}.csv", stem, ++number);
        write_points(file, set.positions_mm);
        description.markers.push_back({file, set.name, set.colour, set.radius_mm, set.numbered});
    }
    if (!panel.arrows.empty()) {
        description.arrows = folder / (stem + "_arrows.csv");
        write_arrows(description.arrows, panel.arrows.front().arrows);
    }
    return description;
}

/// One figure's files.
class Maker {
public:
    Maker(fs::path folder, const fs::path& parts, const AlbumTools& tools)
        : folder_(std::move(folder)), parts_(parts), tools_(tools) {}

    void make(const NamedFigure& figure, const FigureCast& cast, AlbumEntry& entry) const {
        const auto plan = figure.build(cast);
        entry.caption = plan.caption;
        entry.remarks = plan.remarks;
        const auto stem = file_stem(figure);
        if (!plan.picture.panels.empty()) picture(plan, stem, entry);
        if (!plan.svg.empty()) plot(plan, stem, entry);
        if (!plan.table.header.empty()) table(plan, stem, entry);
    }

private:
    void picture(const FigurePlan& plan, const std::string& stem, AlbumEntry& entry) const {
        const auto description = write_picture_parts(parts_ / stem, plan.picture);
        const auto file = stem + ".png";
        if (const auto fault = tools_.draw(description, folder_ / file); !fault.empty()) throw InputError(fault);
        entry.files.emplace_back(file);
    }
    void plot(const FigurePlan& plan, const std::string& stem, AlbumEntry& entry) const {
        base::write_atomically(folder_ / (stem + ".svg"), plan.svg);
        entry.files.emplace_back(stem + ".svg");
        if (!tools_.convert) {
            entry.remarks.emplace_back("no PDF and no PNG: rsvg-convert (package librsvg2-bin) is not installed");
            return;
        }
        for (const auto* ending : {".pdf", ".png"}) {
            if (const auto fault = tools_.convert(folder_ / (stem + ".svg"), folder_ / (stem + ending)); !fault.empty())
                entry.remarks.push_back(fault);
            else
                entry.files.emplace_back(stem + ending);
        }
    }
    void table(const FigurePlan& plan, const std::string& stem, AlbumEntry& entry) const {
        base::write_atomically(folder_ / (stem + ".csv"), table_csv(plan.table));
        base::write_atomically(folder_ / (stem + ".tex"), table_latex(plan.table));
        entry.files.emplace_back(stem + ".csv");
        entry.files.emplace_back(stem + ".tex");
        entry.table = plan.table;
    }

    fs::path folder_;
    const fs::path& parts_;
    const AlbumTools& tools_;
};

std::string captions_text(const std::vector<AlbumEntry>& entries) {
    std::string text = "# Captions\n";
    for (const auto& entry : entries) {
        text += fmt::format("\n## {}: {}\n\n", entry.name, entry.title);
        if (!entry.failure.empty()) {
            text += fmt::format("Not made: {}\n", entry.failure);
            continue;
        }
        text += entry.caption + "\n";
        for (const auto& remark : entry.remarks) text += fmt::format("\n- {}\n", remark);
        std::vector<std::string> files;
        for (const auto& file : entry.files) files.push_back(fmt::format("[{0}]({0})", file.string()));
        text += fmt::format("\n{}\n", fmt::join(files, ", "));
    }
    return text;
}

std::string html_table(const FigureTable& table) {
    if (table.header.empty()) return {};
    std::string text = "<table>\n";
    const auto add = [&](const std::vector<std::string>& cells, const char* tag) {
        text += "<tr>";
        for (const auto& cell : cells) text += fmt::format("<{0}>{1}</{0}>", tag, base::markup_text(cell));
        text += "</tr>\n";
    };
    add(table.header, "th");
    for (const auto& row : table.rows) add(row, "td");
    return text + "</table>\n";
}

std::string index_page(const std::vector<AlbumEntry>& entries) {
    std::string body;
    for (const auto& entry : entries) {
        body += fmt::format("<section id=\"{0}\"><h2>{0}: {1}</h2>\n", base::markup_text(entry.name),
                            base::markup_text(entry.title));
        if (!entry.failure.empty()) {
            body += fmt::format("<p class=\"missing\">Not made: {}</p></section>\n", base::markup_text(entry.failure));
            continue;
        }
        // The picture of a figure; of a plot its SVG, which is there first.
        const auto shown = std::find_if(entry.files.begin(), entry.files.end(), [](const auto& file) {
            return file.extension() == ".png" || file.extension() == ".svg";
        });
        if (shown != entry.files.end())
            body += fmt::format("<a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\" loading=\"lazy\"></a>\n",
                                base::markup_text(shown->string()), base::markup_text(entry.title));
        body += html_table(entry.table) + fmt::format("<p>{}</p>\n", base::markup_text(entry.caption));
        for (const auto& remark : entry.remarks)
            body += fmt::format("<p class=\"remark\">{}</p>\n", base::markup_text(remark));
        body += "<p class=\"files\">";
        for (const auto& file : entry.files)
            body += fmt::format("<a href=\"{0}\">{0}</a> ", base::markup_text(file.string()));
        body += "</p></section>\n";
    }
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Figures</title>\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<style>body{font:16px/1.5 sans-serif;max-width:60em;margin:1em auto;padding:0 1em;color:#202020}"
           "img{max-width:100%;max-height:90vh;border:1px solid #ddd}h2{font-size:1.1em;margin:2em 0 .4em}"
           "table{border-collapse:collapse}th,td{text-align:left;vertical-align:top;padding:.2em .6em;"
           "border-bottom:1px solid "
           "#ddd}.missing{color:#a02020}.remark,.files{color:#606060;font-size:.9em;margin:.2em "
           "0}</style></head><body>\n"
           "<h1>Figures</h1>\n<p><a href=\"captions.md\">All captions as text</a></p>\n" +
           body + "</body></html>\n";
}

}  // namespace

fs::path write_picture_parts(const fs::path& folder, const figures::Figure& picture) {
    fs::create_directories(folder);
    FigureDescription description;
    description.page = picture;
    description.page.panels.clear();
    int number = 0;
    for (const auto& panel : picture.panels)
        description.panels.push_back(write_panel(folder, fmt::format("panel{:02}", ++number), panel));
    auto file = folder / "figure.json";
    write_figure_description(file, description);
    return file;
}

std::string table_csv(const FigureTable& table) {
    std::string text;
    const auto add = [&](const std::vector<std::string>& cells) {
        for (std::size_t k = 0; k < cells.size(); ++k) text += (k == 0 ? "" : ",") + base::csv_field(cells[k]);
        text += '\n';
    };
    add(table.header);
    for (const auto& row : table.rows) add(row);
    return text;
}

std::string table_latex(const FigureTable& table) {
    constexpr std::size_t long_text = 24;  // letters: a column that is longer is set as a paragraph
    std::vector<std::size_t> widest(table.header.size(), 0);
    for (const auto& row : table.rows)
        for (std::size_t k = 0; k < row.size(); ++k) widest[k] = std::max(widest[k], row[k].size());
    const auto paragraphs = std::count_if(widest.begin(), widest.end(), [](auto n) { return n > long_text; });
    std::string text = "% needs \\usepackage{booktabs}\n\\begin{tabular}{";
    for (const auto n : widest)
        text += n > long_text ? fmt::format("p{{{:.2f}\\textwidth}}", 0.75 / static_cast<double>(paragraphs)) : "l";
    text += "}\n\\toprule\n";
    const auto add = [&](const std::vector<std::string>& cells) {
        for (std::size_t k = 0; k < cells.size(); ++k) text += (k == 0 ? "" : " & ") + latex_text(cells[k]);
        text += " \\\\\n";
    };
    add(table.header);
    text += "\\midrule\n";
    for (const auto& row : table.rows) add(row);
    return text + "\\bottomrule\n\\end{tabular}\n";
}

std::vector<AlbumEntry> make_album(const FigureCast& cast, const std::vector<const NamedFigure*>& figures,
                                   const fs::path& folder, const AlbumTools& tools, bool keep_parts) {
    base::check_takes_files(folder);
    std::optional<base::TemporaryFolder> temporary;
    if (!keep_parts) temporary.emplace(folder);
    const auto parts = keep_parts ? folder / "parts" : temporary->path();
    const Maker maker(folder, parts, tools);
    std::vector<AlbumEntry> entries(figures.size());
    base::parallel_for(figures.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            auto& entry = entries[k];
            entry.name = figures[k]->name;
            entry.title = figures[k]->title;
            try {
                maker.make(*figures[k], cast, entry);
            } catch (const std::exception& e) {
                entry.failure = e.what();
            }
            if (!keep_parts) {  // a mesh per panel: all of them together would take hundreds of megabytes
                std::error_code ignored;
                fs::remove_all(parts / file_stem(*figures[k]), ignored);
            }
            if (tools.progress) tools.progress(entry.name);
        }
    });
    base::write_atomically(folder / "captions.md", captions_text(entries));
    base::write_atomically(folder / "index.html", index_page(entries));
    return entries;
}

}  // namespace mimik::report
