#include "modeling/source_examples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::modeling {
namespace {

using geometry::Point;
using geometry::Vector;

constexpr std::string_view standard_table =
#include "modeling/standard_examples_csv.inc"
    ;

constexpr const char* resting = "neutral";
// A feature is within 1 m of the head's middle: else the unit is another.
constexpr double farthest_mm = 1e3;

template <class Names>
std::optional<std::size_t> place_of(const Names& names, std::string_view name) {
    const auto it = std::find(names.begin(), names.end(), name);
    if (it == names.end()) return std::nullopt;
    return static_cast<std::size_t>(it - names.begin());
}

void check_once(const std::vector<std::string>& names, const char* what) {
    if (names.empty()) throw InputError(fmt::format("there is no {}; give at least one", what));
    std::set<std::string> seen;
    for (const auto& name : names) {
        if (name.empty()) throw InputError(fmt::format("one {} has no name; give it one", what));
        if (!seen.insert(name).second)
            throw InputError(fmt::format("{} {} is there twice; leave one out", what, base::in_quotes(name)));
    }
}

/// The names of the features, of a header example,NAME_x,NAME_y,NAME_z,...
std::vector<std::string> feature_names(const std::vector<std::string>& header, const std::string& file) {
    std::vector<std::string> names;
    for (std::size_t at = 1; at < header.size(); at += 3) {
        const auto& first = header[at];
        auto stem = first.size() > 2 ? first.substr(0, first.size() - 2) : first;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto expected = fmt::format("{}_{}", stem, "xyz"[axis]);
            const auto found = at + axis < header.size() ? header[at + axis] : std::string("nothing");
            if (found != expected)
                throw InputError(
                    fmt::format("{}: column {} is {}, and '{}' belongs there; columns are "
                                "example,NAME_x,NAME_y,NAME_z,...",
                                file, at + axis + 1, base::in_quotes(found), expected));
        }
        names.push_back(std::move(stem));
    }
    return names;
}

}  // namespace

std::optional<std::size_t> SourceExamples::find_feature(std::string_view name) const {
    return place_of(features, name);
}

std::optional<std::size_t> SourceExamples::find_example(std::string_view name) const {
    return place_of(examples, name);
}

void SourceExamples::check() const {
    check_once(features, "feature");
    check_once(examples, "example");
    if (find_example(resting)) throw InputError("an example is called 'neutral', as the face at rest is; rename it");
    if (neutral_mm.size() != features.size() || displacement_mm.size() != examples.size())
        throw InputError(fmt::format("{} for {} and {} for {}", base::counted(neutral_mm.size(), "position"),
                                     base::counted(features.size(), "feature"),
                                     base::counted(displacement_mm.size(), "row"),
                                     base::counted(examples.size(), "example")));
    const auto near = [](const Vector& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= farthest_mm; };
    for (std::size_t k = 0; k < features.size(); ++k)
        if (!near(neutral_mm[k]))
            throw InputError(
                fmt::format("{} at rest is farther than {:g} mm from the head's middle; give mm in the head's frame",
                            features[k], farthest_mm));
    for (std::size_t i = 0; i < examples.size(); ++i) {
        if (displacement_mm[i].size() != features.size())
            throw InputError(fmt::format("example {} has {} for {}", base::in_quotes(examples[i]),
                                         base::counted(displacement_mm[i].size(), "displacement"),
                                         base::counted(features.size(), "feature")));
        for (std::size_t k = 0; k < features.size(); ++k)
            if (!near(displacement_mm[i][k]))
                throw InputError(fmt::format("example {}: {} moves by more than {:g} mm; give mm",
                                             base::in_quotes(examples[i]), features[k], farthest_mm));
    }
}

SourceExamples scaled(SourceExamples source, double factor) {
    for (auto& p : source.neutral_mm) p *= factor;
    for (auto& example : source.displacement_mm)
        for (auto& d : example) d *= factor;
    return source;
}

SourceExamples with_features(const SourceExamples& source, std::span<const std::string> features) {
    SourceExamples some;
    some.examples = source.examples;
    some.displacement_mm.resize(source.examples.size());
    for (const auto& name : features) {
        const auto k = source.find_feature(name);
        if (!k) throw InputError(fmt::format("the source examples have no feature {}", base::in_quotes(name)));
        some.features.push_back(name);
        some.neutral_mm.push_back(source.neutral_mm[*k]);
        for (std::size_t i = 0; i < source.examples.size(); ++i)
            some.displacement_mm[i].push_back(source.displacement_mm[i][*k]);
    }
    return some;
}

SourceExamples with_examples(const SourceExamples& source, std::span<const std::string> examples) {
    SourceExamples some;
    some.features = source.features;
    some.neutral_mm = source.neutral_mm;
    for (const auto& name : examples) {
        const auto i = source.find_example(name);
        if (!i) throw InputError(fmt::format("the source examples have no example {}", base::in_quotes(name)));
        some.examples.push_back(name);
        some.displacement_mm.push_back(source.displacement_mm[*i]);
    }
    return some;
}

std::optional<double> outer_eye_distance_mm(const SourceExamples& source) {
    const auto left = source.find_feature("eye_outer_left"), right = source.find_feature("eye_outer_right");
    if (!left || !right) return std::nullopt;
    return (source.neutral_mm[*left] - source.neutral_mm[*right]).norm();
}

const SourceExamples& standard_source_examples() {
    static const auto standard = decode_source_examples(standard_table, "standard_examples.csv");
    return standard;
}

SourceExamples decode_source_examples(std::string_view text, const std::string& name) {
    base::CsvReader rows(text, name);
    if (rows.header().empty() || rows.header()[0] != "example")
        throw InputError(
            fmt::format("{}: the first column is no 'example'; columns are "
                        "example,NAME_x,NAME_y,NAME_z,...",
                        name));
    SourceExamples source;
    source.features = feature_names(rows.header(), name);
    while (rows.next()) {
        std::vector<Point> positions;
        for (std::size_t k = 0; k < source.features.size(); ++k)
            positions.emplace_back(rows.number(3 * k + 1), rows.number(3 * k + 2), rows.number(3 * k + 3));
        const auto& row = rows.field(0);
        if (source.neutral_mm.empty()) {
            if (row != resting || positions.empty())
                rows.fail(
                    fmt::format("the first row is {}; it must be 'neutral', the face at rest, with at least one "
                                "feature",
                                base::in_quotes(row)));
            source.neutral_mm = std::move(positions);
            continue;
        }
        for (std::size_t k = 0; k < positions.size(); ++k) positions[k] -= source.neutral_mm[k];
        source.examples.push_back(row);
        source.displacement_mm.push_back(std::move(positions));
    }
    try {
        source.check();
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", name, e.what()));
    }
    return source;
}

std::string encode_source_examples(const SourceExamples& source) {
    source.check();
    std::string text = "example";
    for (const auto& name : source.features)
        for (const char axis : {'x', 'y', 'z'}) text += ',' + base::csv_field(fmt::format("{}_{}", name, axis));
    const auto add = [&](const std::string& name, const std::vector<Vector>* displacement_mm) {
        text += '\n' + base::csv_field(name);
        for (std::size_t k = 0; k < source.features.size(); ++k) {
            Point p = source.neutral_mm[k];
            if (displacement_mm) p += (*displacement_mm)[k];
            fmt::format_to(std::back_inserter(text), ",{:.6f},{:.6f},{:.6f}", p.x(), p.y(), p.z());
        }
    };
    add(resting, nullptr);
    for (std::size_t i = 0; i < source.examples.size(); ++i) add(source.examples[i], &source.displacement_mm[i]);
    return text + '\n';
}

SourceExamples read_source_examples(const std::filesystem::path& file) {
    return decode_source_examples(base::read_text(file), file.string());
}

void write_source_examples(const std::filesystem::path& file, const SourceExamples& source) {
    base::write_atomically(file, encode_source_examples(source));
}

}  // namespace mimik::modeling
