#include "database/bnt.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::database {
namespace {

static_assert(std::endian::native == std::endian::little, "a .bnt is read and written as it lies in memory");

constexpr std::size_t fixed_header_bytes = 14;   // rows, cols, background, length of the texture name
constexpr std::uintmax_t max_cells = 5'000'000;  // 200 MB; a Bosphorus scan has about 50,000
constexpr double farthest_mm = 1e6;              // scanners of faces look a few metres far
constexpr std::size_t longest_header_bytes = fixed_header_bytes + 65535 + 4;

template <typename T>
T value_at(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// Checks the header against the length of the file before anything is allocated. `bytes` holds at least the header, or
/// the whole file where that is shorter. Returns where the first block begins.
std::size_t read_header(std::span<const std::uint8_t> bytes, std::uintmax_t file_bytes, const std::string& name,
                        Bnt& bnt) {
    if (bytes.size() < fixed_header_bytes)
        throw InputError(fmt::format(
            "{}: {} too few for a .bnt header of at least 18; the file is truncated or not a Bosphorus scan", name,
            base::counted(file_bytes, "byte is", "bytes are")));
    bnt.rows = value_at<std::uint16_t>(bytes.data());
    bnt.cols = value_at<std::uint16_t>(bytes.data() + 2);
    bnt.background = value_at<double>(bytes.data() + 4);
    const std::size_t name_bytes = value_at<std::uint16_t>(bytes.data() + 12);
    if (bnt.rows == 0 || bnt.cols == 0)
        throw InputError(fmt::format("{}: {} is 0; the file is damaged or not a Bosphorus scan", name,
                                     bnt.rows == 0 ? "nrows" : "ncols"));
    const std::size_t data_begin = fixed_header_bytes + name_bytes + 4;
    if (data_begin > file_bytes || data_begin > bytes.size())
        throw InputError(
            fmt::format("{}: the texture name is said to be {} bytes long, but the file has only {}; it is "
                        "truncated or not a Bosphorus scan",
                        name, name_bytes, file_bytes));
    bnt.texture_file.assign(reinterpret_cast<const char*>(bytes.data()) + fixed_header_bytes, name_bytes);
    const std::uintmax_t values = value_at<std::uint32_t>(bytes.data() + fixed_header_bytes + name_bytes);
    const std::uintmax_t cells = std::uintmax_t{bnt.rows} * bnt.cols;
    if (values != 5 * cells)
        throw InputError(
            fmt::format("{}: value count is {}, but nrows {} x ncols {} x 5 is {}; the file is damaged or not a "
                        "Bosphorus scan",
                        name, values, bnt.rows, bnt.cols, 5 * cells));
    if (cells > max_cells)
        throw InputError(
            fmt::format("{}: nrows {} x ncols {} is more than the {} cells that Mimik reads; thin the scan out", name,
                        bnt.rows, bnt.cols, max_cells));
    const std::uintmax_t expected = data_begin + 8 * values;
    if (file_bytes != expected)
        throw InputError(fmt::format("{}: has {} bytes, its header promises {}; {}", name, file_bytes, expected,
                                     file_bytes < expected
                                         ? "the file is truncated: copy it again"
                                         : "there is something behind the last value: copy it again"));
    if (std::isnan(bnt.background))
        throw InputError(fmt::format("{}: zmin is not a number; the file is damaged or not a Bosphorus scan", name));
    return data_begin;
}

std::array<std::vector<double>*, 5> columns(Bnt& bnt) { return {&bnt.x, &bnt.y, &bnt.z, &bnt.u, &bnt.v}; }
std::array<const std::vector<double>*, 5> columns(const Bnt& bnt) { return {&bnt.x, &bnt.y, &bnt.z, &bnt.u, &bnt.v}; }

// O_NONBLOCK: a pipe by that name is refused, not waited for.
class OpenFile {
public:
    explicit OpenFile(const std::filesystem::path& file)
        : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
        if (descriptor_ < 0)
            throw InputError(fmt::format("{}: cannot be opened ({}); check the name and the permissions", file.string(),
                                         std::strerror(errno)));
    }
    ~OpenFile() { ::close(descriptor_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    [[nodiscard]] int get() const { return descriptor_; }

private:
    int descriptor_;
};

std::size_t read_up_to(int descriptor, std::uint8_t* to, std::size_t count, const std::string& name) {
    std::size_t done = 0;
    while (done < count) {
        const ssize_t got = ::read(descriptor, to + done, count - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0)
            throw InputError(fmt::format("{}: cannot be read ({}); check the disk", name, std::strerror(errno)));
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

[[noreturn]] void refuse_far_cell(const Bnt& bnt, std::size_t cell, const geometry::Point& point_mm,
                                  const std::string& name) {
    Eigen::Index axis = 0;
    const double far_mm = point_mm.cwiseAbs().maxCoeff(&axis);
    throw InputError(
        fmt::format("{}: {} of row {}, column {} is {:g} mm from the origin, {:g} mm is the most; the file is damaged, "
                    "or its unit or background marker is another",
                    name, "xyz"[axis], cell / bnt.cols, cell % bnt.cols, far_mm, farthest_mm));
}

}  // namespace

Bnt decode_bnt(std::span<const std::uint8_t> bytes, const std::string& name) {
    Bnt bnt;
    std::size_t at = read_header(bytes, bytes.size(), name, bnt);
    const std::size_t cells = std::size_t{bnt.rows} * bnt.cols;
    for (auto* column : columns(bnt)) {
        column->resize(cells);
        std::memcpy(column->data(), bytes.data() + at, 8 * cells);
        at += 8 * cells;
    }
    return bnt;
}

bool is_bnt(const std::filesystem::path& file) { return base::equal_ignoring_case(file.extension().string(), ".bnt"); }

// Reads straight into the five columns: no second copy of the file in memory.
Bnt read_bnt(const std::filesystem::path& file) {
    const std::string name = file.string();
    const OpenFile open(file);
    struct stat status {};
    if (::fstat(open.get(), &status) != 0 || !S_ISREG(status.st_mode))
        throw InputError(fmt::format("{}: is not a regular file; give a .bnt file", name));
    const auto file_bytes = static_cast<std::uintmax_t>(status.st_size);

    std::array<std::uint8_t, 256> start{};  // a texture name has about 20 characters
    std::size_t have = read_up_to(open.get(), start.data(), std::min<std::uintmax_t>(start.size(), file_bytes), name);
    std::vector<std::uint8_t> longer;
    std::span<const std::uint8_t> head(start.data(), have);
    if (have == start.size() && fixed_header_bytes + value_at<std::uint16_t>(start.data() + 12) + 4U > start.size()) {
        longer.resize(std::min<std::uintmax_t>(longest_header_bytes, file_bytes));
        std::memcpy(longer.data(), start.data(), have);
        have += read_up_to(open.get(), longer.data() + have, longer.size() - have, name);
        head = std::span<const std::uint8_t>(longer.data(), have);
    }
    Bnt bnt;
    std::size_t at = read_header(head, file_bytes, name, bnt);

    const std::size_t column_bytes = 8 * std::size_t{bnt.rows} * bnt.cols;
    for (auto* column : columns(bnt)) column->resize(column_bytes / 8);
    // What the first read brought along beyond the header is read again: simpler than stitching, and at most 64 KB.
    std::size_t done = 0;
    const std::size_t total = 5 * column_bytes;
    while (done < total) {
        std::array<iovec, 5> pieces{};
        int count = 0;
        for (std::size_t c = done / column_bytes; c < 5; ++c) {
            const std::size_t skip = c == done / column_bytes ? done % column_bytes : 0;
            pieces[static_cast<std::size_t>(count++)] = {reinterpret_cast<char*>(columns(bnt)[c]->data()) + skip,
                                                         column_bytes - skip};
        }
        const ssize_t got = ::preadv(open.get(), pieces.data(), count, static_cast<off_t>(at + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            throw InputError(fmt::format("{}: ends after {} of {} bytes; copy it again", name, at + done, file_bytes));
        done += static_cast<std::size_t>(got);
    }
    return bnt;
}

void write_bnt(const std::filesystem::path& file, const Bnt& bnt) {
    const std::size_t cells = std::size_t{bnt.rows} * bnt.cols;
    for (const auto* column : columns(bnt))
        if (column->size() != cells || cells == 0)
            throw InputError(
                fmt::format("{}: a column has {} values, nrows {} x ncols {} is {}; give every column one value "
                            "per cell",
                            file.string(), column->size(), bnt.rows, bnt.cols, cells));
    if (cells > max_cells)
        throw InputError(
            fmt::format("{}: nrows {} x ncols {} is more than the {} cells that a .bnt may have; thin the scan out",
                        file.string(), bnt.rows, bnt.cols, max_cells));
    if (bnt.texture_file.size() > 65535)
        throw InputError(fmt::format("{}: the texture name has {} bytes, 65535 is the most; shorten it", file.string(),
                                     bnt.texture_file.size()));
    base::write_atomically(file, [&](std::ostream& out) {
        const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
        put(bnt.rows);
        put(bnt.cols);
        put(bnt.background);
        put(static_cast<std::uint16_t>(bnt.texture_file.size()));
        out.write(bnt.texture_file.data(), static_cast<std::streamsize>(bnt.texture_file.size()));
        put(static_cast<std::uint32_t>(5 * cells));
        for (const auto* column : columns(bnt))
            out.write(reinterpret_cast<const char*>(column->data()), static_cast<std::streamsize>(8 * cells));
    });
}

geometry::RangeScan to_range_scan(const Bnt& bnt, const std::string& name, io::LengthUnit unit) {
    geometry::RangeScan scan;
    try {
        if (!bnt.texture_file.empty()) scan.texture_file = io::checked_texture_name(bnt.texture_file, name);
    } catch (const InputError& e) {  // the surface can be used without its picture
        scan.texture_error = e.what();
    }
    scan.rows = bnt.rows;
    scan.cols = bnt.cols;
    const std::size_t cells = std::size_t{bnt.rows} * bnt.cols;
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    scan.points_mm.resize(cells);
    scan.texture_coordinates.resize(cells);
    // A measurement is finite and in no coordinate the background marker (files with partly marked points exist).
    const auto measured = [&](double value) { return std::isfinite(value) && value != bnt.background; };
    bool any_texture = false;
    const double scale = io::millimetres_per(unit);
    for (std::size_t i = 0; i < cells; ++i) {
        if (measured(bnt.x[i]) && measured(bnt.y[i]) && measured(bnt.z[i])) {
            scan.points_mm[i] = scale * geometry::Point(bnt.x[i], bnt.y[i], bnt.z[i]);
            if (scan.points_mm[i].cwiseAbs().maxCoeff() > farthest_mm) refuse_far_cell(bnt, i, scan.points_mm[i], name);
            const bool textured = measured(bnt.u[i]) && measured(bnt.v[i]);
            scan.texture_coordinates[i] = textured ? geometry::TextureCoordinate(bnt.u[i], 1.0 - bnt.v[i])
                                                   : geometry::TextureCoordinate(nothing, nothing);
            any_texture = any_texture || textured;
        } else {
            scan.points_mm[i].setConstant(nothing);
            scan.texture_coordinates[i].setConstant(nothing);
        }
    }
    if (!any_texture) scan.texture_coordinates.clear();
    return scan;
}

geometry::RangeScan read_bnt_scan(const std::filesystem::path& file, io::LengthUnit unit, io::BadTexture bad_texture) {
    auto scan = to_range_scan(read_bnt(file), file.string(), unit);
    if (bad_texture == io::BadTexture::refuse && !scan.texture_error.empty()) throw InputError(scan.texture_error);
    return scan;
}

Bnt to_bnt(const geometry::RangeScan& scan, double background) {
    const auto cells =
        static_cast<std::size_t>(std::max(scan.rows, 0)) * static_cast<std::size_t>(std::max(scan.cols, 0));
    if (!scan.organised() || cells != scan.points_mm.size())
        throw InputError(fmt::format(
            "a .bnt needs a scan in rows and columns: this one has {} for {} rows x {} columns; write it as .ply",
            base::counted(scan.points_mm.size(), "point"), scan.rows, scan.cols));
    if (scan.rows > 65535 || scan.cols > 65535)
        throw InputError(fmt::format("a .bnt holds at most 65535 rows and columns, this scan has {} x {}; thin it out",
                                     scan.rows, scan.cols));
    if (!scan.texture_coordinates.empty() && scan.texture_coordinates.size() != cells)
        throw InputError(fmt::format("the scan has {} for {} points; give one for each, or none",
                                     base::counted(scan.texture_coordinates.size(), "texture coordinate"), cells));
    Bnt bnt;
    bnt.rows = static_cast<std::uint16_t>(scan.rows);
    bnt.cols = static_cast<std::uint16_t>(scan.cols);
    bnt.background = background;
    if (!scan.texture_file.empty()) bnt.texture_file = io::checked_texture_name(scan.texture_file, "scan");
    for (auto* column : columns(bnt)) column->assign(cells, background);
    for (std::size_t i = 0; i < cells; ++i) {
        if (!scan.valid(i)) continue;
        const auto& p = scan.points_mm[i];
        if (!p.allFinite() || (p.array() == background).any())
            throw InputError(
                fmt::format("point {} of the scan, ({}, {}, {}), has a coordinate that is not finite or equals the "
                            "background marker {}; choose another marker",
                            i, p.x(), p.y(), p.z(), background));
        bnt.x[i] = p.x();
        bnt.y[i] = p.y();
        bnt.z[i] = p.z();
        if (scan.texture_coordinates.empty() || !scan.texture_coordinates[i].allFinite()) continue;
        bnt.u[i] = scan.texture_coordinates[i].x();
        bnt.v[i] = 1.0 - scan.texture_coordinates[i].y();
    }
    return bnt;
}

}  // namespace mimik::database
