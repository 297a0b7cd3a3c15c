#include "io/points_csv.h"

#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"

namespace mimik::io {

PointTable decode_points_csv(std::string_view text, const std::string& name) {
    base::CsvReader rows(text, name);
    const auto x = rows.column("x"), y = rows.column("y"), z = rows.column("z");
    const auto label = rows.find_column("name");
    PointTable table;
    while (rows.next()) {
        table.points.emplace_back(rows.number(x), rows.number(y), rows.number(z));
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
        throw InputError(fmt::format("{} names for {} points; every point needs one, or none has", table.names.size(),
                                     table.points.size()));
    std::string text = named ? "name,x,y,z\n" : "x,y,z\n";
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
