#include "synthesis/builtin_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "synthesis/builtin_curves.h"

namespace mimik::synthesis {
namespace {

using Eigen::Vector2d;

/// The point of a profile at `from_a` from a and `from_b` from b, on the side of `forward`; lengths that close no
/// triangle give the nearest flat one.
Vector2d triangle(const Vector2d& a, const Vector2d& b, double from_a, double from_b, bool forward) {
    const Vector2d along = b - a;
    const double base = along.norm();
    const double foot = (from_a * from_a - from_b * from_b + base * base) / (2 * base);
    const double rise = std::sqrt(std::max(0.25, from_a * from_a - foot * foot));
    Vector2d out(-along.y(), along.x());
    out /= base;
    if ((out.y() > 0) != forward) out = -out;
    return a + along / base * foot + out * rise;
}

/// One number per height, tabulated.
class Table {
public:
    Table(const SplineBasis& basis, const std::vector<double>& values) {
        std::vector<double> w(basis.size());
        for (int i = 0; i < count; ++i) {
            basis.weights(from + i * step, w);
            values_.push_back(std::inner_product(w.begin(), w.end(), values.begin(), 0.0));
        }
    }
    Table(const std::vector<double>& t, const std::vector<double>& values) : Table(SplineBasis(t), values) {}
    [[nodiscard]] double operator()(double t) const {
        const double x = std::clamp((t - from) / step, 0.0, count - 1.001);
        const auto i = static_cast<std::size_t>(x);
        return values_[i] + (x - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
    }

private:
    static constexpr double from = -160, step = 0.25;
    static constexpr int count = 1000;
    std::vector<double> values_;
};

/// Half-width of the nose and how boxy its cross-section is, by height.
struct NoseSection {
    double half_width, shoulder;
};
NoseSection nose_section(double t) {
    // Nearly a bell of deviation w / sqrt(2 shoulder), about 0.6 of its height: walls of 45 degrees from a narrow root
    // (7 mm) to a broad tip (9 mm).
    static const MonotoneCurve width({-60, -55.3, -53, -50.5, -48.5, -46, -43, -34, -20, -9, 0, 8, 16},
                                     {24, 15, 9, 9.5, 12.5, 15, 17, 19.5, 21.5, 21, 20.5, 21, 22});
    static const MonotoneCurve shoulder({-50, -46, -43, -37, -30, -22, -9, 0, 10, 26, 90},
                                        {1.6, 1.9, 2.3, 2.6, 3.0, 4.2, 7.5, 7.8, 4.6, 2.2, 2});
    return {width(t), shoulder(t)};
}

double compact(double q, double shoulder) { return q * q >= 1 ? 0 : std::pow(1 - q * q, shoulder); }

/// As compact, but flatter in the middle: the back of a nose is a strip, not an edge.
double ridge_section(double q, double shoulder) { return q >= 1 ? 0 : std::pow(1 - std::pow(q, 2.5), shoulder); }

/// How far the relief of the midline over the muzzle reaches sideways on the lower face: lips, sulcus, chin.
double relief_section(double a, double v, double chin_reach) {
    using namespace place;
    const double lip_skin = compact(a / 27, 1.7);
    const double lips = compact(a / (mouth_corner + 0.2), 1.1);
    const double below = compact(a / 27, 1.7);
    const double chin = compact(a / chin_reach, 1.6);
    if (v > upper_lip) return lip_skin + (lips - lip_skin) * smooth_step(upper_lip + 6, upper_lip, v);
    if (v > lower_lip) return lips;
    if (v > sulcus) return lips + (below - lips) * smooth_step(lower_lip, sulcus + 2, v);
    return below + (chin - below) * smooth_step(sulcus, pogonion + 4, v);
}

/// What the profile, the measurements and the forms make of the mean face.
class PersonMap {
public:
    PersonMap(const Sheet& sheet, const FaceNumbers& face)
        : sheet_(sheet),
          face_(face),
          profile_(solve_profile(face)),
          y_(heights()),
          y_side_(side_heights()),
          midline_(midline()),
          base_shift_(shift()) {
        using M = Measurement;
        const double ft = face[M::forehead_width] / 2, en = face[M::inner_canthal_width] / 2,
                     ex = face[M::outer_canthal_width] / 2, zy = face[M::face_width] / 2, al = face[M::nose_width] / 2,
                     ch = face[M::mouth_width] / 2, cph = face[M::philtrum_width] / 2, go = face[M::jaw_width] / 2,
                     ear = face[M::ear_width] / 2;
        const double chin = 20 * (1 + 0.09 * face[Form::chin_width]) * go / 50;
        levels_ = {MonotoneCurve({0, 54, 72}, {0, ft, 0.5 * (ear * 72 / 73 + ft + 18)}),
                   MonotoneCurve({0, place::inner_canthus, place::outer_canthus, 67.5, 73}, {0, en, ex, zy, ear}),
                   MonotoneCurve({0, place::wing, 45, 67, 72}, {0, al, 45 * zy / 67.5, zy - 0.5, ear}),
                   MonotoneCurve({0, place::philtrum_crest, place::mouth_corner, 57, 70},
                                 {0, cph, ch, 0.4 * zy * 57 / 67.5 + 0.6 * go * 57 / 51, ear * 70 / 73}),
                   MonotoneCurve({0, 20, 51, 64}, {0, chin, go, ear * 64 / 73})};
        for (std::size_t r = 0; r < sheet.row_t.size(); ++r)
            row_height_.push_back(midline_at(sheet.row_v[r], sheet.row_t[r]) -
                                  bare_z(0, sheet.row_t[r], sheet.row_midline_base_z_mm[r]));
        const auto height_at = [&](double v) {
            std::size_t best = 0;
            for (std::size_t r = 1; r < sheet.row_v.size(); ++r)
                if (std::abs(sheet.row_v[r] - v) < std::abs(sheet.row_v[best] - v)) best = r;
            return row_height_[best];
        };
        muzzle_top_ = height_at(-58);
        muzzle_bottom_ = height_at(place::sulcus);
        std::vector<double> t, h;
        for (std::size_t r = 0; r < sheet.row_t.size() && sheet.row_v[r] > -60; ++r) {
            t.push_back(-sheet.row_t[r]);
            h.push_back(row_height_[r]);
        }
        nose_height_ = MonotoneCurve(t, h);
    }

    [[nodiscard]] geometry::Point operator()(const SheetVertex& p) const {
        const double a = std::abs(p.s);
        const double x = person_x(std::abs(p.base.x()), p.base.y());
        double y = y_(p.base.y());
        // The lengths of lips and nose stay near the midline; the sides share the height of the whole face.
        y += smooth_step(25, 52, a) * (y_side_(p.base.y()) - y);
        y += face_[Form::jaw_angle_height] * 2.0 * bell(a - 80, 22) * bell(p.t + 112, 22);
        double z = bare_z(a, p.t, p.base.z());
        z = with_cheeks(a, p.t, z);
        z = with_nose(a, p.t, p.v, p.row, z);
        z = with_mouth(a, p.v, p.t, z);
        with_eye(p, a, y, z);
        return {p.s < 0 ? -x : x, y, z};
    }

private:
    [[nodiscard]] MonotoneCurve heights() const {
        using namespace place;
        const auto& f = profile_;
        const double top_y = top + 4.5 * face_[Form::forehead_height], brow = 1.6 * face_[Form::brow_height];
        return {{bottom, gnathion, pogonion, sulcus, lower_lip, stomion, upper_lip, subnasale, pronasale, -20, eye,
                 nasion, 12, 45, top},
                {f.gnathion.x() - 26, f.gnathion.x(), f.pogonion.x(), f.sulcus.x(), f.lower_lip.x(), f.stomion.x(),
                 f.upper_lip.x(), f.subnasale.x(), f.pronasale.x(),
                 eye + (f.pronasale.x() - eye) * (20 + eye) / (eye - pronasale), eye, nasion, 12 + brow,
                 45 + brow + 0.4 * (top_y - top), top_y}};
    }

    [[nodiscard]] MonotoneCurve side_heights() const {
        using namespace place;
        const double chin = profile_.gnathion.x(), brow = 1.6 * face_[Form::brow_height],
                     top_y = top + 4.5 * face_[Form::forehead_height];
        return {{bottom, gnathion, eye, nasion, 12, 45, top},
                {chin - 26, chin, eye, nasion, 12 + brow, 45 + brow + 0.4 * (top_y - top), top_y}};
    }

    [[nodiscard]] std::pair<Table, Table> midline() const {
        using namespace place;
        const auto& f = profile_;
        const double prn = f.pronasale.y(), sn = f.subnasale.y(), hump = face_[Form::dorsum_hump],
                     root = face_[Form::nose_root_depth], slope = face_[Form::forehead_slope],
                     ridge = face_[Form::brow_ridge];
        const double ls = f.upper_lip.y(), sto = f.stomion.y(), li = f.lower_lip.y(), sl = f.sulcus.y(),
                     pog = f.pogonion.y(), gn = f.gnathion.y();
        return {Table({stomion,   -76.3, -75.2, -73, upper_lip, -64,    -59, subnasale, -52.3, -48.6, -45.7,
                       pronasale, -38,   -29,   -20, -10,       nasion, 11,  24,        42,    60,    top},
                      {sto,
                       sto + 2.6,
                       ls - 0.1,
                       ls + 1.2,
                       ls,
                       sn - 0.35 + 0.3 * (ls - sn),
                       sn - 0.5,
                       sn,
                       sn + 0.43 * (prn - sn),
                       sn + 0.86 * (prn - sn),
                       prn - 0.5,
                       prn,
                       0.89 * prn + 0.2,
                       0.64 * prn + 0.9 + 0.8 * hump,
                       0.42 * prn + 1.2 + 1.3 * hump,
                       0.17 * prn + 0.8 + 0.7 * hump,
                       0,
                       1.8 + 0.9 * ridge + 0.8 * root,
                       0.8 + 0.5 * ridge + 0.7 * root - 0.5 * slope,
                       -5 - 1.8 * slope + 0.7 * root,
                       -13.5 - 3.4 * slope + 0.7 * root,
                       -26.5 - 5.5 * slope}),
                Table({bottom, -140, -132, -126, gnathion, -115, pogonion, -101, sulcus, -90, lower_lip, -81.5, -79,
                       -77.8, stomion},
                      {gn - 36.5, gn - 26.5, gn - 17, gn - 7.5, gn, pog - 4.0, pog, 0.35 * sl + 0.65 * pog + 0.3, sl,
                       0.55 * sl + 0.45 * li - 0.5, li, li + 1.5, li + 0.4, sto + 2.4, sto})};
    }
    [[nodiscard]] double midline_at(double v, double t) const {
        return v >= place::stomion && t >= place::stomion - 1e-9 ? midline_.first(t) : midline_.second(t);
    }

    /// The bare face moves forward or back with the jaws that carry it.
    [[nodiscard]] Table shift() const {
        const auto& f = profile_;
        const double upper = f.subnasale.y() - 6, mouth = f.stomion.y() - 1.5, chin = f.pogonion.y() - 0.5;
        const double slope = face_[Form::forehead_slope], root = face_[Form::nose_root_depth];
        return {std::vector<double>{place::bottom, place::gnathion, place::pogonion, place::stomion, place::subnasale,
                                    -20, place::nasion, 20, 45, place::top},
                {f.gnathion.y() + 11.5, f.gnathion.y() + 11.5, chin, mouth, upper, 0.3 * upper, 0.3 * root, 0.7 * root,
                 -1.8 * slope + 0.7 * root, -5.5 * slope}};
    }

    [[nodiscard]] double bare_z(double a, double t, double z) const {
        const double depth = (face_[Measurement::upper_face_depth] - 126) / 126;
        return z * (1 + 1.15 * depth * smooth_step(-10, -70, z)) + base_shift_(t) * hump(a, 60);
    }

    [[nodiscard]] double person_x(double x, double y) const {
        constexpr std::array<double, 5> at = {26, -8, -46, -77, -110};
        std::size_t i = 0;
        while (i + 2 < at.size() && y < at[i + 1]) ++i;
        const double w = smooth_step(at[i], at[i + 1], y);
        return (1 - w) * levels_[i](x) + w * levels_[i + 1](x);
    }

    [[nodiscard]] double with_cheeks(double a, double t, double z) const {
        const auto blob = [&](double s0, double t0, double ws, double wt) {
            return bell(a - s0, ws) * bell(t - t0, wt);
        };
        z += (0.7 + 1.3 * face_[Form::cheekbone]) * blob(47, -24, 12, 9);
        z += 1.7 * face_[Form::cheek_fullness] * blob(42, -64, 15, 19);
        z -= (0.3 + 1.2 * face_[Form::temple_hollow]) * blob(66, 18, 10, 15);
        z += (0.5 + 0.9 * face_[Form::brow_ridge]) * blob(26, 13, 15, 6);
        // Brow hair and the fat under it stand out a little.
        z += 0.7 * bell(t - brow_line(a), 2.6) * smooth_step(8, 14, a) * (1 - smooth_step(46, 56, a));
        // Tear trough, from the inner canthus down and out.
        z -= (0.35 + 0.3 * face_[Form::under_eye]) * bell(t + 14.5 + 0.55 * (a - 15), 4.6) * smooth_step(9, 16, a) *
             (1 - smooth_step(24, 42, a));
        // Nasolabial fold: a soft furrow with the cheek standing over it.
        const double fold = 19 + 0.36 * (-47 - t);
        const double d = (a - fold) * 0.94;
        const double here = smooth_step(-44, -52, t) * (1 - smooth_step(-70, -86, t));
        const double depth = std::max(0.05, 0.55 + 0.3 * face_[Form::nasolabial_fold]);
        z += here * depth * (0.9 * bell(d - 7, 5) - 0.9 * bell(d, 2.3));
        return z;
    }

    /// The jaws carry the whole muzzle forward; lips, sulcus and chin stand out from it near the midline only.
    [[nodiscard]] double lower_height(std::uint32_t row, double a, double v, double t) const {
        const auto muzzle = [&](double height) {
            return muzzle_top_ + smooth_step(-58, place::sulcus, height) * (muzzle_bottom_ - muzzle_top_);
        };
        return muzzle(t) * compact(a / 44, 2.4) + (row_height_[row] - muzzle(sheet_.row_t[row])) *
                                                      relief_section(a, v, 25 + 2.5 * face_[Form::chin_width]);
    }

    [[nodiscard]] double with_nose(double a, double t, double v, std::uint32_t row, double z) const {
        using namespace place;
        if (v <= -58) return z + lower_height(row, a, v, t);
        const double height = nose_height_(-t);
        const auto [half_width, shoulder] = nose_section(t);
        const double tip = 1 + 0.09 * face_[Form::nose_tip_width] * bell(t + 43, 8);
        double reach = half_width * tip;
        if (t > 4) reach += (60 - reach) * smooth_step(4, 26, t);  // from the root out over the whole forehead
        double ridge = z + height * ridge_section(a / reach, shoulder);
        if (v < -55.3) {
            const double w = smooth_step(-55.3, -58, v);
            ridge += w * (z + lower_height(row, a, v, t) - ridge);
        }
        // The wing: an ellipsoid beside the tip, cut off steeply where it meets the cheek.
        const double wing_t = -45.8 + 0.7 * face_[Form::wing_height];
        const double q = std::hypot((a - 11.2) / 6.3, (t - wing_t) / (t > wing_t ? 8.4 : 5.6));
        if (q < 1) {
            const double wing_z = z - 2.5 + 12.0 * std::pow(1 - q * q, 0.7);
            ridge = smooth_max(ridge, wing_z, 7.0);
        }
        // Alar crease, and the nostril.
        const double crease = std::hypot((a - 11.4) / 7.3, (t - wing_t) / (t > wing_t ? 9.8 : 6.6));
        ridge -= 0.4 * bell(crease - 0.98, 0.17) * smooth_step(11, 16, a) * smooth_step(-54, -50, t) *
                 smooth_step(-37, -43, t);
        const double hole = std::hypot((a - 6.9) / 3.2, (t + 51.7) / 1.9);
        ridge -= 5.0 * (1 - smooth_step(0.35, 1.25, hole));
        return ridge;
    }

    [[nodiscard]] double with_mouth(double a, double v, double t, double z) const {
        using namespace place;
        if (t > -50 || t < -104) return z;
        // Philtral crests from the columella to the bow's peaks.
        const double up = (v - upper_lip) / (subnasale - upper_lip);
        const double crest = philtrum_crest - 2.0 * std::clamp(up, 0.0, 1.0);
        z += (0.5 + 0.2 * face_[Form::philtrum_depth]) * (1 - 0.45 * std::clamp(up, 0.0, 1.0)) * bell(a - crest, 1.9) *
             (1 - bell(a, 1.6)) * smooth_step(subnasale + 1, -60, v) *
             (1 - smooth_step(upper_lip + 0.5, upper_lip - 3, v));
        // White roll along the border of the red, and the pit and the muscle knot at the corner.
        const double mouth = 1 - smooth_step(12, mouth_corner + 1, a);
        z += 0.3 * mouth * (1 - bell(a, 2)) * (bell(v - upper_lip - 0.6, 0.8) + 0.6 * bell(v - lower_lip + 0.6, 0.9));
        z -= 1.3 * bell(a - mouth_corner, 2.2) * bell(t - stomion + 0.7, 2.6);
        z += 0.9 * bell(a - 31, 4.5) * bell(t + 78, 7);
        return z;
    }

    void with_eye(const SheetVertex& p, double a, double& y, double& z) const {
        using namespace place;
        const double q = p.across_eye, v = p.v, above_middle = v - eye;
        // Lids open wider, and the outer corner stands higher, person by person.
        const double inside = hump(above_middle, 17) * hump(q, 1.7);
        const double margin = above_middle > 0 ? smooth_step(0, upper_lid - eye, above_middle)
                                               : -0.35 * smooth_step(0, eye - lower_lid, -above_middle);
        y += 0.55 * face_[Form::lid_opening] * inside * margin * std::max(0.0, 1 - q * q);
        y +=
            0.9 * face_[Form::eye_tilt] * smooth_step(-1, 1.2, q) * hump(q - 0.8, 1.5) * plateau(above_middle, 4.5, 22);
        // Mouth corners.
        y += 0.8 * face_[Form::mouth_corner_tilt] * bell(a - mouth_corner, 6) * plateau(v - stomion, 9, 20);
        if (std::abs(q) > 1.6 || v > 16 || v < -27) return;
        const double deep = 0.9 * face_[Form::eye_depth];
        const double dy = p.t - eye - 0.8 * q;
        const double tall = 13.2;
        const double r2 = q * q * 0.84 + (dy / tall) * (dy / tall);
        // Under the eye the ball runs on straight: where it fell away, its rim stood out as a second lid.
        const double r = std::sqrt(r2), below = smooth_step(-3, -8, above_middle);
        const double round = std::sqrt(std::max(0.03, 1 - r2)) - 2.4 * smooth_step(0.93, 1.5, r);
        const double straight = (r < 0.6 ? round : 0.8 - 0.75 * (r - 0.6)) - 0.6 * smooth_step(0.9, 1.6, std::abs(q));
        const double ball = -22.8 - deep + 12.4 * (round + below * (straight - round)) - 2.9 * q;
        const auto lid = lid_thickness_mm(q, v);
        const bool open = v < upper_lid && v > lower_lid && std::abs(q) < 1;
        double eye_z = ball + lid.upper + lid.lower;
        if (open) {  // cornea
            const double c = cornea_radius(q, p.t);
            if (c < 1) eye_z += 1.1 * (1 - c * c) * (1 - c * c);
        }
        const double socket = z - deep * bell(q, 0.8) * hump(above_middle, 16);
        // The lower lid runs out into the cheek, the upper one dives under the brow.
        z = smooth_max(socket, eye_z, 3.2 + 9 * smooth_step(-3, -9, above_middle));
        // Fold of the upper lid: a crease, and the skin over it that hangs forward.
        const double fold = v - (upper_lid + 4.3 - 1.2 * q * q);
        const double along = hump(q - 0.05, 1.2);
        const double hood = 1 + 0.3 * face_[Form::lid_hooding];
        z += along * (-0.8 * bell(fold, 0.95) + 0.8 * hood * bell(fold - 3.6, 2.2));
        // Pouch of the lower lid.
        z += 0.15 * along * bell(v - (lower_lid - 2.4), 1.5);
    }

    const Sheet& sheet_;
    const FaceNumbers& face_;
    Profile profile_;
    MonotoneCurve y_, y_side_;
    std::pair<Table, Table> midline_;
    Table base_shift_;
    std::array<MonotoneCurve, 5> levels_;
    std::vector<double> row_height_;
    double muzzle_top_ = 0, muzzle_bottom_ = 0;
    MonotoneCurve nose_height_;
};

}  // namespace

Profile solve_profile(const FaceNumbers& face) {
    using M = Measurement;
    Profile p;
    const Vector2d nasion(0, 0);
    const auto below = [](double length, double z) { return Vector2d(-std::sqrt(length * length - z * z), z); };
    p.subnasale = below(face[M::nose_height], 6 + 1.4 * face[Form::maxilla_projection]);
    p.pronasale = triangle(nasion, p.subnasale, face[M::nose_bridge_length], face[M::nasal_protrusion], true);
    const double lips = 0.7 * face[Form::lip_projection];
    p.stomion = below(face[M::upper_face_height], p.subnasale.y() - 4.8 + lips);
    const auto beside = [](const Vector2d& from, double length, double forward, double down) {
        const double z = std::clamp(forward, -0.8 * length, 0.8 * length);
        return Vector2d(from.x() - down * std::sqrt(length * length - z * z), from.y() + z);
    };
    p.upper_lip = beside(p.stomion, face[M::upper_vermilion], 0.58 * face[M::upper_vermilion], -1);
    p.lower_lip = beside(p.stomion, face[M::lower_vermilion], 0.46 * face[M::lower_vermilion], 1);
    p.gnathion = below(face[M::face_height], -11.5 + 2.6 * face[Form::chin_projection]);
    const double pogonion_z = p.gnathion.y() + 12.3;
    p.sulcus = beside(p.stomion, std::max(face[M::lower_lip_height], face[M::lower_vermilion] + 4),
                      0.5 * (pogonion_z - p.stomion.y()) - 1.2, 1);
    p.pogonion = {p.gnathion.x() + 0.46 * (p.sulcus.x() - p.gnathion.x()), pogonion_z};
    return p;
}

std::vector<geometry::Point> build_neutral_mm(const Sheet& sheet, const FaceNumbers& face) {
    const PersonMap person(sheet, face);
    std::vector<geometry::Point> points(sheet.vertices.size());
    base::parallel_for(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) points[i] = person(sheet.vertices[i]);
    });
    return points;
}

}  // namespace mimik::synthesis
