#include "synthesis/builtin_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "synthesis/builtin_curves.h"

namespace mimik::synthesis {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Lofting curves of the bare face: one line per height, from the midline to the ear. Heights are in mm over the
/// nasion, forward positions in mm before it. Rounded by hand to 3D Facial Norms' means (widths, depths to the
/// tragion).
constexpr std::size_t curve_points = 9;
constexpr std::array<double, curve_points> across = {0, 14, 28, 42, 54, 66, 80, 98, 116};
struct Curve {
    double t;
    std::array<double, curve_points> x, y, z;  ///< y NaN: the height of the row itself
};
constexpr std::array<double, curve_points> level = {none, none, none, none, none, none, none, none, none};
constexpr std::array<Curve, 14> curves = {{
    {78, {0, 14, 28, 41, 51, 59, 65, 69, 70}, level, {-26, -27.5, -32, -40.5, -51, -63, -77, -94, -111}},
    {60, {0, 14, 28, 42, 53, 61, 67, 71, 72}, level, {-13.5, -15, -20, -29, -40.5, -53.5, -69, -88, -106}},
    {42, {0, 14, 28, 42, 53.5, 62, 68.5, 72, 73}, level, {-6, -7.5, -12, -20, -30.5, -44, -61, -82, -102}},
    {24, {0, 14, 28, 42, 54, 62.5, 69, 72.5, 74}, level, {-1, -2, -5, -12.5, -23.5, -39, -57, -79.5, -99}},
    {12, {0, 14, 28, 42, 54, 62.5, 69, 72.5, 74}, level, {0, -2, -5, -10, -20, -36.5, -56, -79, -99}},
    {0, {0, 14, 28, 42, 54, 62.5, 69, 72.5, 73.5}, level, {-7, -11, -11.5, -14, -22.5, -37, -55, -78, -98}},
    {-9, {0, 14, 28, 42, 54, 62.5, 68.5, 72, 73}, level, {-8, -12.5, -13, -16.5, -25, -37, -53, -77, -98}},
    {-20, {0, 14, 28, 42, 54, 62.5, 68, 71.5, 72.5}, level, {-6, -9.5, -10.5, -14.2, -22, -34, -51.5, -77, -98}},
    {-34, {0, 14, 28, 42, 54, 62.5, 67.5, 71, 72}, level, {-3, -6, -8.5, -13.5, -21, -33, -51.5, -78, -99}},
    {-46,
     {0, 14, 28, 42, 53.5, 61.5, 67, 70, 71},
     {-46, -46, -46, -46, -45.5, -45, -44, -42, -40},
     {0, -2, -6, -12.5, -21.5, -35, -54.5, -80, -100}},
    {-60,
     {0, 14, 28, 41.5, 52.5, 60, 65, 68, 69.5},
     {-60, -60, -60, -59.5, -58.5, -57, -55, -51, -48},
     {5.5, 3, -4, -13, -25, -40, -59.5, -83, -101}},
    {-77,
     {0, 14, 28, 41, 50.5, 57, 61.5, 64.5, 66.5},
     {-77, -77, -76.5, -75.5, -74, -71.5, -68, -62, -56.5},
     {4.5, 1, -6.5, -18, -32, -47.5, -65.5, -86, -101}},
    {-95,
     {0, 14, 27.5, 39, 47, 52.5, 57, 61, 63.5},
     {-95, -95, -94, -92, -89.5, -86, -80.5, -72, -64},
     {1, -1, -9, -24, -39, -54, -70, -87, -100}},
    {-110,
     {0, 14, 27, 37.5, 44.5, 49.5, 54.5, 59.5, 62},
     {-110, -109.5, -107.5, -103.5, -100, -95.5, -89, -79, -69},
     {0.5, -2, -12.5, -29, -43, -56, -70.5, -86, -99}},
}};
constexpr std::array<Curve, 3> under_curves = {{
    {-121,
     {0, 13, 25.5, 35.5, 41.7, 46, 50, 55, 58},
     {-121, -120, -117, -112, -107.5, -103, -97, -85, -72},
     {-11.5, -14.5, -24.5, -38, -48.5, -59, -71, -85, -98.5}},
    {-132,
     {0, 12, 23, 32, 37.5, 41.5, 45, 50, 54},
     {-127.5, -127, -124, -118.5, -112.5, -106.5, -98.5, -86, -73},
     {-28.5, -31.5, -41, -53, -63, -73, -84, -96, -107}},
    {-150,
     {0, 11, 21, 28.5, 33, 36, 39, 44, 49},
     {-132.5, -131.8, -128, -121, -114, -107.2, -99, -86.5, -73.5},
     {-48, -51, -58, -68, -77, -86, -96, -106, -114}},
}};

struct Stretch {
    double to, step;  ///< next knot and the greatest spacing up to it, mm
};

std::vector<double> subdivide(double from, const std::vector<Stretch>& stretches) {
    std::vector<double> values = {from};
    for (const auto& [to, step] : stretches) {
        const double start = values.back();
        const int pieces = static_cast<int>(std::ceil(std::abs(to - start) / step));
        for (int i = 1; i < pieces; ++i) values.push_back(start + (to - start) * i / pieces);
        values.push_back(to);
    }
    return values;
}

double across_eye(double s) {
    constexpr double middle = (place::inner_canthus + place::outer_canthus) / 2;
    constexpr double half = (place::outer_canthus - place::inner_canthus) / 2;
    return (std::abs(s) - middle) / half;
}

/// A slit of the sheet (lids, lips): rows `upper` and `lower` are its margins, which on the face run at `above` over
/// and `below` under the middle line; the rows around give way over `reach`.
double through_slit(double v, double middle, double upper, double lower, double above, double below, double reach) {
    const double up = upper - middle, down = middle - lower;
    if (v >= upper) return v + (above - up) * (1 - smooth_step(upper, upper + reach, v));
    if (v >= middle) return middle + (v - middle) / up * above;
    if (v >= lower) return middle + (v - middle) / down * below;
    return v - (below - down) * (1 - smooth_step(0, reach, lower - v));
}

double eye_height(double s, double v) {
    using namespace place;
    const double q = across_eye(s), beyond = std::max(0.0, std::abs(q) - 1) * 13.8;
    const auto arc = [](double x, double power) { return x * x >= 1 ? 0 : std::pow(1 - x * x, power); };
    const double rejoin = smooth_step(0, 10, beyond);
    const double above = 0.25 + 5.4 * arc(q + 0.14 * (1 - q * q), 0.8) + (upper_lid - eye - 0.25) * rejoin;
    const double below = 0.25 + 4.2 * arc(q - 0.16 * (1 - q * q), 0.85) + (eye - lower_lid - 0.25) * rejoin;
    const double a = std::abs(s);
    const double tilt = -smooth_step(5, 16, a) + 2.2 * smooth_step(13, 47, a) - 1.2 * smooth_step(47, 75, a);
    return through_slit(v, eye, upper_lid, lower_lid, above, below, 15) + tilt * plateau(v - eye, 4.5, 24);
}

double mouth_height(double s, double v) {
    using namespace place;
    const double a = std::abs(s), q = std::min(1.0, a / mouth_corner);
    const double rejoin = smooth_step(0, 14, a - mouth_corner);
    const double bow = 0.9 * bell(a - philtrum_crest, 3.2) - 0.9 * bell(philtrum_crest, 3.2);
    const double soft = std::min(1.0, std::sqrt(q * q + 0.0064) - 0.08 * (1 - q));  // no kink at the midline
    const double above = 0.2 + 6.5 * std::pow(1 - soft, 0.62) * (1 + 0.32 * soft) + bow * (1 - q) + 6.5 * rejoin;
    const double below = 0.2 + 8.3 * std::pow(1 - q * q * (0.7 + 0.3 * q), 0.8) + 8.3 * rejoin;
    const double line = (0.8 * (bell(a - 8.5, 4.5) - bell(8.5, 4.5)) - 0.7 * smooth_step(13, 25, a)) * hump(a, 45);
    return through_slit(v, stomion, upper_lip, lower_lip, above, below, 13.5) + line * plateau(v - stomion, 9, 21);
}

/// The mean face's bare surface at (s, t).
class Loft {
public:
    Loft() : across_(both_sides()), along_(heights()) {
        for (const auto& c : curves) lines_.push_back(&c);
        for (const auto& c : under_curves) lines_.push_back(&c);
        std::reverse(lines_.begin(), lines_.end());
    }

    [[nodiscard]] geometry::Point operator()(double s, double t) const {
        std::array<double, 2 * curve_points - 1> both{};
        std::array<double, curve_points> column{};
        std::array<double, curves.size() + under_curves.size()> row{};
        across_.weights(std::abs(s), both);
        for (std::size_t c = 0; c < curve_points; ++c) {
            column[c] = both[curve_points - 1 + c];
            if (c > 0) column[c] += both[curve_points - 1 - c];
        }
        // x is odd across the midline, y and z are even.
        std::array<double, curve_points> odd = column;
        for (std::size_t c = 1; c < curve_points; ++c) odd[c] -= 2 * both[curve_points - 1 - c];
        along_.weights(t, row);
        geometry::Point p = geometry::Point::Zero();
        for (std::size_t r = 0; r < row.size(); ++r)
            for (std::size_t c = 0; c < curve_points; ++c) {
                const auto& line = *lines_[r];
                const double y = std::isnan(line.y[c]) ? line.t : line.y[c];
                p += row[r] * geometry::Point(odd[c] * line.x[c], column[c] * y, column[c] * line.z[c]);
            }
        if (s < 0) p.x() = -p.x();
        return p;
    }

private:
    static std::vector<double> both_sides() {
        std::vector<double> s;
        for (std::size_t c = curve_points - 1; c > 0; --c) s.push_back(-across[c]);
        s.insert(s.end(), across.begin(), across.end());
        return s;
    }
    static std::vector<double> heights() {
        std::vector<double> t;
        t.reserve(std::size(curves) + std::size(under_curves));
        for (const auto& c : curves) t.push_back(c.t);
        for (const auto& c : under_curves) t.push_back(c.t);
        std::reverse(t.begin(), t.end());
        return t;
    }
    SplineBasis across_, along_;
    std::vector<const Curve*> lines_;
};

std::string region_of(const SheetVertex& p) {
    using namespace place;
    const double a = std::abs(p.s);
    if (p.v < upper_lid && p.v > lower_lid && std::abs(p.across_eye) < 1)
        return cornea_radius(p.across_eye, p.t) < 0.9 ? "eye" : "sclera";
    if (p.v < upper_lid + 0.8 && p.v >= upper_lid && std::abs(p.across_eye) < 1) return "lid";
    if (p.v <= upper_lip && p.v >= lower_lip && a <= mouth_corner) return "lip";
    if (std::hypot((a - 7.0) / 3.0, (p.t + 52.2) / 1.7) < 1) return "nostril";
    const double thickness = 4.2 - 2.4 * smooth_step(34, 52, a);
    if (a > 9 && a < 53 && std::abs(p.t - brow_line(a)) < thickness) return "brow";
    return "skin";
}

/// Distances of the columns from the midline, on one side.
std::vector<double> half_columns() {
    using namespace place;
    return subdivide(0, {{philtrum_crest, 0.8},
                         {inner_canthus, 0.83},
                         {wing, 0.6},
                         {mouth_corner, 0.85},
                         {outer_canthus, 0.92},
                         {54, 1.25},
                         {zygion, 1.6},
                         {gonion, 2.2},
                         {98, 2.7},
                         {rim, 3.1}});
}

/// Heights of the rows, and the upper one of the two of the mouth, which touch and are not joined.
struct Rows {
    std::vector<double> v;
    std::uint32_t mouth = 0;
};
Rows sheet_rows() {
    using namespace place;
    auto rows = subdivide(top, {{60, 2},
                                {42, 1.3},
                                {24, 1.2},
                                {8, 0.95},
                                {upper_lid, 0.65},
                                {eye, 0.5},
                                {lower_lid, 0.5},
                                {-20, 0.7},
                                {-34, 0.9},
                                {pronasale, 0.8},
                                {-47, 0.65},
                                {subnasale, 0.45},
                                {upper_lip, 0.8},
                                {stomion, 0.42}});
    const auto lower = subdivide(
        stomion, {{lower_lip, 0.5}, {sulcus, 0.7}, {pogonion, 0.9}, {gnathion, 0.95}, {-132, 1.2}, {bottom, 2.5}});
    const auto mouth = static_cast<std::uint32_t>(rows.size() - 1);
    rows.insert(rows.end(), lower.begin(), lower.end());

    return {std::move(rows), mouth};
}

class SheetMaker {
public:
    SheetMaker() : half_(half_columns()), half_count_(static_cast<std::uint32_t>(half_.size())), rows_(sheet_rows()) {
        sheet_.columns = 2 * half_count_ - 1;
        sheet_.row_v = rows_.v;
        index_.resize(rows_.v.size() * sheet_.columns);
    }

    Sheet make() {
        add_vertices();
        add_mirror();
        add_faces();
        add_landmarks();
        return std::move(sheet_);
    }

private:
    [[nodiscard]] std::uint32_t& at(std::size_t r, std::size_t c) { return index_[r * sheet_.columns + c]; }
    [[nodiscard]] double column_s(std::uint32_t c) const {
        return c + 1 < half_count_ ? -half_[half_count_ - 1 - c] : half_[c + 1 - half_count_];
    }

    void add_vertices() {
        for (std::uint32_t r = 0; r < rows_.v.size(); ++r) {
            for (std::uint32_t c = 0; c < sheet_.columns; ++c) {
                if (r == rows_.mouth + 1 && std::abs(column_s(c)) >= place::mouth_corner)
                    at(r, c) = at(rows_.mouth, c);  // beyond the corners the lips are one
                else
                    add_vertex(r, c);
            }
            const auto& middle = sheet_.vertices[at(r, half_count_ - 1)];
            sheet_.row_t.push_back(middle.t);
            sheet_.row_midline_base_z_mm.push_back(middle.base.z());
        }
    }
    void add_vertex(std::uint32_t r, std::uint32_t c) {
        SheetVertex p;
        p.s = column_s(c);
        p.v = rows_.v[r];
        p.t = p.v > -35 ? eye_height(p.s, p.v) : mouth_height(p.s, p.v);
        p.across_eye = across_eye(p.s);
        p.base = loft_(p.s, p.t);
        p.row = r;
        p.column = c;
        at(r, c) = static_cast<std::uint32_t>(sheet_.vertices.size());
        sheet_.lower_lip_side.push_back(r > rows_.mouth);
        sheet_.regions.push_back(region_of(p));
        sheet_.vertices.push_back(p);
    }
    void add_mirror() {
        sheet_.mirror.resize(sheet_.vertices.size());
        for (std::uint32_t r = 0; r < rows_.v.size(); ++r)
            for (std::uint32_t c = 0; c < sheet_.columns; ++c) sheet_.mirror[at(r, c)] = at(r, sheet_.columns - 1 - c);
    }
    void add_faces() {
        for (std::uint32_t r = 0; r + 1 < rows_.v.size(); ++r) {
            if (r == rows_.mouth) continue;
            for (std::uint32_t c = 0; c + 1 < sheet_.columns; ++c) {
                const std::array<std::uint32_t, 4> quad = {at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c + 1)};
                sheet_.faces.add(quad);
            }
        }
    }

    [[nodiscard]] std::uint32_t row_of(double v, bool last = false) const {
        const auto& rows = rows_.v;
        std::uint32_t best = 0;
        for (std::uint32_t r = 0; r < rows.size(); ++r)
            if (std::abs(rows[r] - v) < std::abs(rows[best] - v) || (last && rows[r] == rows[best])) best = r;
        return best;
    }
    [[nodiscard]] std::uint32_t column_of(double s) const {
        std::uint32_t best = 0;
        for (std::uint32_t c = 0; c < half_count_; ++c)
            if (std::abs(half_[c] - s) < std::abs(half_[best] - s)) best = c;
        return best;
    }
    /// The sheet row that runs through the brow line there.
    [[nodiscard]] double brow_row(double a) const {
        double best = 0;
        for (const double v : rows_.v)
            if (v > -2 && std::abs(eye_height(a, v) - brow_line(a)) < std::abs(eye_height(a, best) - brow_line(a)))
                best = v;
        return best;
    }
    void mark(const std::string& name, double v, double s) {
        sheet_.landmarks[name] = at(row_of(v), half_count_ - 1 + column_of(s));
    }
    void mark_pair(const std::string& name, double v, double s) {
        const auto r = row_of(v), c = column_of(s);
        sheet_.landmarks[name + "_left"] = at(r, half_count_ - 1 + c);
        sheet_.landmarks[name + "_right"] = at(r, half_count_ - 1 - c);
    }
    void add_landmarks() {
        using namespace place;
        mark_pair("brow_inner", brow_row(11), 11);
        mark_pair("brow_middle", brow_row(32), 32);
        mark_pair("brow_outer", brow_row(51), 51);
        mark_pair("eye_inner", eye, inner_canthus);
        mark_pair("eye_outer", eye, outer_canthus);
        mark_pair("nose_saddle", eye, 9.5);
        mark_pair("nose_wing", -45.5, wing);
        mark("nose_tip", pronasale, 0);
        mark_pair("mouth_corner", stomion, mouth_corner);
        mark("upper_lip_outer", upper_lip, 0);
        mark("upper_lip_inner", stomion, 0);
        sheet_.landmarks["lower_lip_inner"] = at(row_of(stomion, true), half_count_ - 1);
        mark("lower_lip_outer", lower_lip, 0);
        mark("chin", pogonion, 0);
    }

    std::vector<double> half_;
    std::uint32_t half_count_;
    Rows rows_;
    Loft loft_;
    Sheet sheet_;
    std::vector<std::uint32_t> index_;  // of the vertex at a row and a column
};

}  // namespace

std::uint32_t Sheet::nearest(double s, double t) const {
    std::uint32_t best = 0;
    double best_distance = std::numeric_limits<double>::max();
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const double d = std::hypot(vertices[i].s - s, vertices[i].t - t);
        if (d < best_distance) best_distance = d, best = i;
    }
    return best;
}

LidThickness lid_thickness_mm(double across_eye, double v) {
    using namespace place;
    const double taper = std::sqrt(std::max(0.0, 1 - across_eye * across_eye));
    const double edge_mm = 0.35 * std::min(1.0, 2.5 * taper);
    return {(edge_mm + 1.25 * taper) * smooth_step(upper_lid - 0.2, upper_lid + 0.9, v),
            (edge_mm + 0.75 * taper) * smooth_step(lower_lid + 0.2, lower_lid - 0.9, v)};
}

double cornea_radius(double across_eye, double t) {
    return std::hypot(13.8 * across_eye + 0.5, t - place::eye - 0.8 * across_eye) / 6.0;
}

double brow_line(double a) { return 11 + 4.5 * smooth_step(8, 34, a) - 6 * smooth_step(34, 58, a); }

Sheet make_sheet() { return SheetMaker().make(); }

}  // namespace mimik::synthesis
