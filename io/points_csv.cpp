#include "io/points_csv.h"

#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::io {

PointColumns point_columns(const base::CsvReader& rows) {
    if (!rows.find_column("x") && rows.find_column("s")) {
        if (rows.find_column("r") && rows.find_column("a"))
            return {rows.column("r"), rows.column("a"), rows.column("s"), BodyFrame::ras};
        if (rows.find_column("l") && rows.find_column("p"))
            return {rows.column("l"), rows.column("p"), rows.column("s"), BodyFrame::lps};
    }
    return {rows.column("x"), rows.column("y"), rows.column("z"), std::nullopt};
}

PointTable decode_points_csv(std::string_view text, const std::string& name) {
    base::CsvReader rows(text, name);
    const auto columns = point_columns(rows);
    auto label = rows.find_column("name");
    if (!label) label = rows.find_column("label");
    PointTable table;
    table.frame = columns.frame;
    while (rows.next()) {
        table.points.emplace_back(rows.number(columns.x), rows.number(columns.y), rows.number(columns.z));
        if (label) table.names.push_back(rows.field(*label));
    }
    return table;
}

PointTable read_points_csv(const std::filesystem::path& file) {
    return decode_points_csv(base::read_text(file), file.string());
}

std::string encode_points_csv(const PointTable& table) {
    const bool named = !table.names.empty();
    if (named && table.names.size() != table.points.size())
        throw InputError(fmt::format("{} for {} points; every point needs one, or none has",
                                     base::counted(table.names.size(), "name"), table.points.size()));
    const char* coordinates = !table.frame ? "x,y,z\n" : *table.frame == BodyFrame::ras ? "r,a,s\n" : "l,p,s\n";
    std::string text = fmt::format("{}{}", !named ? "" : table.frame ? "label," : "name,", coordinates);
    for (std::size_t i = 0; i < table.points.size(); ++i) {
        const auto& p = table.points[i];
        if (named) text += base::csv_field(table.names[i]) + ',';
        fmt::format_to(std::back_inserter(text), "{:.17g},{:.17g},{:.17g}\n", p.x(), p.y(), p.z());
    }
    return text;
}

void write_points_csv(const std::filesystem::path& file, const PointTable& table) {
    base::write_atomically(file, encode_points_csv(table));
}

}  // namespace mimik::io
