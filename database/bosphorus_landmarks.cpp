#include "database/bosphorus_landmarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "database/scan_id.h"
#include "io/landmark_io.h"

namespace mimik::database {
namespace {

constexpr std::uintmax_t max_file_bytes = 4 << 20;

struct Label {
    std::string_view label;
    std::string_view stem;  ///< our name, without the side if it has one
    facs::Side side;        ///< of the label
};

// Bosphorus list in its usual order. "Nose peak" is the nose wing, "nose saddle" the side of the nose root.
constexpr std::array<Label, 26> labels = {{
    {"Outer left eyebrow", "brow_outer", facs::Side::left},
    {"Middle left eyebrow", "brow_middle", facs::Side::left},
    {"Inner left eyebrow", "brow_inner", facs::Side::left},
    {"Inner right eyebrow", "brow_inner", facs::Side::right},
    {"Middle right eyebrow", "brow_middle", facs::Side::right},
    {"Outer right eyebrow", "brow_outer", facs::Side::right},
    {"Outer left eye corner", "eye_outer", facs::Side::left},
    {"Inner left eye corner", "eye_inner", facs::Side::left},
    {"Inner right eye corner", "eye_inner", facs::Side::right},
    {"Outer right eye corner", "eye_outer", facs::Side::right},
    {"Nose saddle left", "nose_saddle", facs::Side::left},
    {"Nose saddle right", "nose_saddle", facs::Side::right},
    {"Left nose peak", "nose_wing", facs::Side::left},
    {"Nose tip", "nose_tip", facs::Side::both},
    {"Right nose peak", "nose_wing", facs::Side::right},
    {"Left mouth corner", "mouth_corner", facs::Side::left},
    {"Upper lip outer middle", "upper_lip_outer", facs::Side::both},
    {"Right mouth corner", "mouth_corner", facs::Side::right},
    {"Upper lip inner middle", "upper_lip_inner", facs::Side::both},
    {"Lower lip inner middle", "lower_lip_inner", facs::Side::both},
    {"Lower lip outer middle", "lower_lip_outer", facs::Side::both},
    {"Chin middle", "chin", facs::Side::both},
    {"Left ear lobe", "ear_lobe", facs::Side::left},
    {"Right ear lobe", "ear_lobe", facs::Side::right},
    {"Left temple", "temple", facs::Side::left},
    {"Right temple", "temple", facs::Side::right},
}};

// Anthropometric points that have a counterpart among the Bosphorus landmarks (Farkas; see docs/formats.md).
struct AnatomicalName {
    std::string_view name, abbreviation, stem;
    bool paired;
};
constexpr std::array<AnatomicalName, 8> anatomical_names = {{
    {"exocanthion", "ex", "eye_outer", true},
    {"endocanthion", "en", "eye_inner", true},
    {"alare", "al", "nose_wing", true},
    {"cheilion", "ch", "mouth_corner", true},
    {"pronasale", "prn", "nose_tip", false},
    {"labiale_superius", "ls", "upper_lip_outer", false},
    {"labiale_inferius", "li", "lower_lip_outer", false},
    {"pogonion", "pg", "chin", false},
}};

struct NumberedPoint {
    int number;  ///< 0-based
    std::string_view stem;
    facs::Side side;  ///< image side, as the Bosphorus labels have it
};
constexpr std::array<NumberedPoint, 18> numbered_points = {{
    {17, "brow_outer", facs::Side::left},
    {19, "brow_middle", facs::Side::left},
    {21, "brow_inner", facs::Side::left},
    {22, "brow_inner", facs::Side::right},
    {24, "brow_middle", facs::Side::right},
    {26, "brow_outer", facs::Side::right},
    {36, "eye_outer", facs::Side::left},
    {39, "eye_inner", facs::Side::left},
    {42, "eye_inner", facs::Side::right},
    {45, "eye_outer", facs::Side::right},
    {30, "nose_tip", facs::Side::both},
    {48, "mouth_corner", facs::Side::left},
    {54, "mouth_corner", facs::Side::right},
    {51, "upper_lip_outer", facs::Side::both},
    {57, "lower_lip_outer", facs::Side::both},
    {62, "upper_lip_inner", facs::Side::both},
    {66, "lower_lip_inner", facs::Side::both},
    {8, "chin", facs::Side::both},
}};

/// Lower case, everything but letters and digits as one '_': "Outer left eyebrow" -> "outer_left_eyebrow".
std::string as_name(std::string_view label) {
    std::string name;
    for (const char c : label) {
        const bool upper = c >= 'A' && c <= 'Z';
        const bool kept =
            upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
        if (kept)
            name += upper ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!name.empty() && name.back() != '_')
            name += '_';
    }
    if (!name.empty() && name.back() == '_') name.pop_back();
    return name.empty() ? "unnamed" : name;
}

std::string with_side(std::string_view stem, facs::Side side) {
    return side == facs::Side::both ? std::string(stem) : fmt::format("{}_{}", stem, to_string(side));
}

/// A mark whose name may depend on which side its label means.
struct Recognised {
    std::string_view stem;
    facs::Side side = facs::Side::both;
    bool side_is_the_labels = false;  ///< else it is the subject's own already
};

std::optional<Recognised> recognise_bosphorus(const std::string& name) {
    static const auto names = [] {
        std::array<std::string, labels.size()> result;
        std::transform(labels.begin(), labels.end(), result.begin(), [](const Label& l) { return as_name(l.label); });
        return result;
    }();
    const auto it = std::find(names.begin(), names.end(), name);
    if (it == names.end()) return std::nullopt;
    const auto& label = labels[static_cast<std::size_t>(it - names.begin())];
    return Recognised{label.stem, label.side, label.side != facs::Side::both};
}

std::optional<Recognised> recognise_anatomical(std::string_view name) {
    facs::Side side = facs::Side::both;
    for (const auto& [suffix, meaning] : {std::pair<std::string_view, facs::Side>{"_left", facs::Side::left},
                                          {"_right", facs::Side::right},
                                          {"_l", facs::Side::left},
                                          {"_r", facs::Side::right}})
        if (side == facs::Side::both && name.ends_with(suffix)) {
            side = meaning;
            name.remove_suffix(suffix.size());
        }
    for (const auto& known : anatomical_names)
        if ((name == known.name || name == known.abbreviation) && known.paired == (side != facs::Side::both))
            return Recognised{known.stem, side, false};
    return std::nullopt;
}

/// Pairs whose left and right lie the other way round than most pairs of the face, whatever they were called in the
/// file and however the head is turned. In a tie the outer eye corners decide, else +x is the subject's left.
std::vector<std::string> pairs_against_the_rest(const geometry::Landmarks& landmarks) {
    constexpr std::string_view left = "_left";
    struct Pair {
        std::string stem;
        geometry::Vector direction;
    };
    std::vector<Pair> pairs;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const auto& mark : landmarks.all()) {
        const auto* other = mark.name.ends_with(left) ? landmarks.find(geometry::mirrored_name(mark.name)) : nullptr;
        if (!other || mark.position_mm == other->position_mm) continue;
        const geometry::Vector direction = (mark.position_mm - other->position_mm).normalized();
        spread += direction * direction.transpose();
        pairs.push_back({mark.name.substr(0, mark.name.size() - left.size()), direction});
    }
    if (pairs.empty()) return {};
    // The line along which most of them lie, whichever way each is named.
    geometry::Vector lateral = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
    const auto along = [&](const Pair& pair) { return lateral.dot(pair.direction) > 0; };
    const auto agreeing = 2 * std::count_if(pairs.begin(), pairs.end(), along);
    const auto all = static_cast<std::ptrdiff_t>(pairs.size());
    const auto eyes = std::find_if(pairs.begin(), pairs.end(), [](const Pair& p) { return p.stem == "eye_outer"; });
    if (agreeing != all ? agreeing < all : eyes != pairs.end() ? !along(*eyes) : lateral.x() < 0) lateral = -lateral;
    std::vector<std::string> against;
    for (auto& pair : pairs)
        if (!along(pair)) against.push_back(std::move(pair.stem));
    return against;
}

/// Names all marks; where a label's side has to be judged by position, all pairs vote.
geometry::Landmarks renamed(const geometry::Landmarks& raw, const std::vector<std::optional<Recognised>>& recognised,
                            SideReport* report) {
    SideReport sides;
    struct Pair {
        std::string_view stem;
        bool left_is_image_left;
    };
    std::vector<Pair> pairs;
    const auto marks = raw.all();
    const auto has_side = [&](std::size_t i, facs::Side side) {
        return recognised[i] && recognised[i]->side_is_the_labels && recognised[i]->side == side;
    };
    // One partner each: a label in many spellings is refused below, but not each paired with each before.
    std::map<std::string_view, std::size_t> right;
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (has_side(i, facs::Side::right)) right.emplace(recognised[i]->stem, i);
    for (std::size_t i = 0; i < marks.size(); ++i) {
        if (!has_side(i, facs::Side::left)) continue;
        if (const auto partner = right.find(recognised[i]->stem); partner != right.end())
            pairs.push_back({recognised[i]->stem, marks[i].position_mm.x() < marks[partner->second].position_mm.x()});
    }
    const auto image_left =
        std::count_if(pairs.begin(), pairs.end(), [](const Pair& p) { return p.left_is_image_left; });
    const auto other = static_cast<std::ptrdiff_t>(pairs.size()) - image_left;
    if (image_left != other) {
        sides.left_label_is_subject_right = image_left > other;
    } else if (const auto eyes =
                   std::find_if(pairs.begin(), pairs.end(), [](const Pair& p) { return p.stem == "eye_outer"; });
               eyes != pairs.end()) {
        sides.left_label_is_subject_right = eyes->left_is_image_left;
    }
    for (const auto& pair : pairs) {
        if (pair.left_is_image_left == sides.left_label_is_subject_right) {
            ++sides.pairs_agreeing;
        } else {
            ++sides.pairs_disagreeing;
        }
    }

    std::vector<geometry::Landmark> result;
    result.reserve(marks.size());
    for (std::size_t i = 0; i < marks.size(); ++i) {
        geometry::Landmark mark = marks[i];
        if (mark.original_label.empty()) mark.original_label = mark.name;
        if (recognised[i]) {
            const auto& known = *recognised[i];
            const bool mirror = known.side_is_the_labels && sides.left_label_is_subject_right;
            mark.name = with_side(known.stem, mirror ? facs::opposite(known.side) : known.side);
        } else {
            mark.name = as_name(mark.original_label);
        }
        result.push_back(std::move(mark));
    }
    geometry::Landmarks named(std::move(result));
    sides.swapped_pairs = pairs_against_the_rest(named);
    if (report) *report = std::move(sides);
    return named;
}

/// 0 or 1 where the labels are exactly the numbers of the 68-point scheme counted from there; else empty.
std::optional<int> first_number_of_68(const geometry::Landmarks& raw) {
    if (raw.size() != 68) return std::nullopt;
    std::array<bool, 69> seen{};
    for (const auto& mark : raw.all()) {
        const auto number = base::parse_integer(mark.name);
        if (!number || *number < 0 || *number > 68) return std::nullopt;
        seen[static_cast<std::size_t>(*number)] = true;
    }
    // 68 unique numbers out of 0..68: exactly one is missing.
    if (!seen[68]) return 0;
    return seen[0] ? std::nullopt : std::optional(1);
}

}  // namespace

geometry::Landmarks parse_lm3(std::string_view text, const std::string& name) {
    return io::decode_landmarks(io::LandmarkFormat::lm3, text, name);
}

geometry::Landmarks read_lm3(const std::filesystem::path& file) {
    return parse_lm3(base::read_text(file, max_file_bytes), file.string());
}

void write_lm3(const std::filesystem::path& file, const geometry::Landmarks& bosphorus_labelled) {
    base::write_atomically(file, io::encode_landmarks(io::LandmarkFormat::lm3, bosphorus_labelled));
}

std::vector<ImageLandmark> parse_lm2(std::string_view text, const std::string& name) {
    base::LineReader lines(text, name);
    const std::size_t count = io::read_landmark_count(lines);
    const auto next = [&](const std::string& what) {
        if (!lines.next_not_blank())
            throw InputError(fmt::format("{}: ends before {}; the file is truncated: copy it again", name, what));
    };
    const auto expect_heading = [&](std::string_view begin, const std::string& example) {
        next(example);
        if (!as_name(lines.line()).starts_with(begin))
            lines.fail(fmt::format("{} stands where '{}' is expected; the count may be wrong",
                                   base::in_quotes(lines.line()), example));
    };
    std::vector<ImageLandmark> marks;
    expect_heading("labels", "Labels:");
    while (marks.size() < count) {
        next(fmt::format("label {} of {}", marks.size() + 1, count));
        marks.push_back({std::string(base::trimmed(lines.line())), 0, 0});
    }
    expect_heading("2d", "2D Image coordinates:");
    for (auto& mark : marks) {
        next(fmt::format("the position of {}", base::in_quotes(mark.label)));
        std::string_view rest = lines.line();
        const auto x = base::parse_double(base::next_word(rest)), y = base::parse_double(base::next_word(rest));
        if (!x || !y || !std::isfinite(*x) || !std::isfinite(*y) || !base::trimmed(rest).empty())
            lines.fail(fmt::format("{} stands where x y of landmark {} are expected; mark it again",
                                   base::in_quotes(lines.line()), base::in_quotes(mark.label)));
        mark.column = *x;
        mark.row = *y;
    }
    if (lines.next_not_blank())
        lines.fail(
            fmt::format("{} follows after all {} landmarks; correct the count", base::in_quotes(lines.line()), count));
    return marks;
}

std::vector<ImageLandmark> read_lm2(const std::filesystem::path& file) {
    return parse_lm2(base::read_text(file, max_file_bytes), file.string());
}

void write_lm2(const std::filesystem::path& file, const std::vector<ImageLandmark>& marks) {
    std::string text =
        fmt::format("# 2D landmarks in pixels of the texture image\n\n{} landmarks:\n\nLabels:\n", marks.size());
    for (const auto& mark : marks) text += fmt::format("{}\n", base::trimmed(mark.label));
    text += "\n2D Image coordinates:\n";
    for (const auto& mark : marks) text += fmt::format("{} {}\n", mark.column, mark.row);
    base::write_atomically(file, text);
}

geometry::Landmarks from_bosphorus_labels(const geometry::Landmarks& raw, SideReport* report) {
    std::vector<std::optional<Recognised>> recognised;
    for (const auto& mark : raw.all()) recognised.push_back(recognise_bosphorus(as_name(mark.name)));
    return renamed(raw, recognised, report);
}

geometry::Landmarks from_any_labels(const geometry::Landmarks& raw, SideReport* report) {
    std::vector<std::optional<Recognised>> recognised;
    if (const auto first = first_number_of_68(raw)) {
        for (const auto& mark : raw.all()) {
            const int number = std::stoi(mark.name) - *first;
            const auto it = std::find_if(numbered_points.begin(), numbered_points.end(),
                                         [&](const NumberedPoint& p) { return p.number == number; });
            recognised.push_back(it == numbered_points.end()
                                     ? std::nullopt
                                     : std::optional(Recognised{it->stem, it->side, it->side != facs::Side::both}));
        }
    } else {
        // "nose_saddle_left" is our name and, but for its spelling, the Bosphorus label of the other side: it is ours
        // where it is spelt as ours and no other label of the file is Bosphorus'.
        bool bosphorus = false;
        for (const auto& mark : raw.all()) {
            const std::string name = as_name(mark.name);
            auto known = recognise_bosphorus(name);
            bosphorus = bosphorus || (known && known->side_is_the_labels && known->stem != "nose_saddle");
            recognised.push_back(known ? known : recognise_anatomical(name));
        }
        const auto ours = geometry::standard_landmark_names();
        for (std::size_t i = 0; i < recognised.size(); ++i)
            if (!bosphorus && std::find(ours.begin(), ours.end(), raw.all()[i].name) != ours.end()) {
                if (auto& known = recognised[i]) known->side_is_the_labels = false;
            }
    }
    return renamed(raw, recognised, report);
}

geometry::Landmarks to_bosphorus_labels(const geometry::Landmarks& landmarks) {
    std::vector<geometry::Landmark> marks;
    std::vector<std::string> taken;
    for (const auto& label : labels) {
        // A label's left is image-left: the subject's right.
        const std::string name = with_side(label.stem, facs::opposite(label.side));
        if (const auto* mark = landmarks.find(name)) {
            marks.push_back({std::string(label.label), mark->position_mm, std::string(label.label)});
            taken.push_back(name);
        }
    }
    for (const auto& mark : landmarks.all()) {
        if (std::find(taken.begin(), taken.end(), mark.name) != taken.end()) continue;
        const std::string label = mark.original_label.empty() ? mark.name : mark.original_label;
        marks.push_back({label, mark.position_mm, label});
    }
    return geometry::Landmarks(std::move(marks));
}

}  // namespace mimik::database
