#include "io/json_values.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "io/landmark_io.h"

namespace mimik::io {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Transform;
using geometry::Vector;

using nlohmann::json;

namespace {

/// Reads without keeping anything, so that what is too deep or too much is found before it costs memory. The library's
/// callback while building would do, but takes quadratic time over a list of objects.
class Guard final : public nlohmann::json_sax<json> {
public:
    Guard(const std::string& name, const JsonLimits& limits) : name_(name), limits_(limits) {}
    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t&) override { return count(); }
    bool binary(binary_t&) override { return count(); }
    bool key(string_t&) override { return count(); }
    bool start_object(std::size_t) override { return descend(); }
    bool start_array(std::size_t) override { return descend(); }
    bool end_object() override { return --depth_ >= 0; }
    bool end_array() override { return --depth_ >= 0; }
    bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& e) override {
        if (dynamic_cast<const json::out_of_range*>(&e))
            throw InputError(fmt::format("{}: the JSON holds a number too large for a double; correct it", name_));
        throw InputError(fmt::format("{}: byte {}: the JSON is damaged or truncated", name_, byte));
    }

private:
    bool count() {
        if (++values_ > limits_.most_values)
            throw InputError(
                fmt::format("{}: the JSON has more than {} values; is it the right file?", name_, limits_.most_values));
        return true;
    }
    bool descend() {
        if (++depth_ > limits_.deepest)
            throw InputError(
                fmt::format("{}: the JSON nests deeper than {} levels; is it the right file?", name_, limits_.deepest));
        return count();
    }
    const std::string& name_;
    const JsonLimits& limits_;
    int depth_ = 0;
    std::size_t values_ = 0;
};

}  // namespace

json parse_json(std::string_view text, const std::string& name, const JsonLimits& limits) {
    Guard guard(name, limits);
    (void)json::sax_parse(text.begin(), text.end(), &guard);
    return json::parse(text.begin(), text.end());
}

namespace {

/// "[json.exception.type_error.302] type must be string, but is null" without the number.
std::string words_of(const std::exception& fault) {
    std::string what = fault.what();
    if (!what.starts_with("[json.")) return what;
    return what.substr(std::min(what.find("] ") + 2, what.size())).substr(0, 300);
}

}  // namespace

InputError fault_in_field(const std::exception& fault, const std::string& field) {
    return InputError(fmt::format("{}: {}", field, words_of(fault)));
}

std::string shown(const json& value) {
    if (value.is_array()) return "a list";
    if (value.is_object()) return "an object";
    return value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 60);
}

std::size_t whole_number_below(std::size_t limit, const json& value, const std::string& field) {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < limit) return value.get<std::size_t>();
    throw InputError(fmt::format("{} is {}, not a whole number below {}", field, shown(value), limit));
}

json to_json(const Transform& transform) {
    auto rows = json::array();
    for (int r = 0; r < 4; ++r) {
        auto row = json::array();
        for (int c = 0; c < 4; ++c) row.push_back(transform.matrix()(r, c));
        rows.push_back(std::move(row));
    }
    return rows;
}

Transform transform_from_json(const json& rows) {
    const auto expect = [](bool sound) {
        if (!sound) throw InputError("not an invertible 4x4 matrix with 0 0 0 1 below");
    };
    Transform transform;
    expect(rows.is_array() && rows.size() == 4);
    for (std::size_t r = 0; r < 4; ++r) {
        expect(rows[r].is_array() && rows[r].size() == 4);
        for (std::size_t c = 0; c < 4; ++c)
            transform.matrix()(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c].get<double>();
    }
    // Scanners and average faces are in millimetres, so volumes differ by a small factor.
    const double volume = std::abs(transform.linear().determinant());
    expect(transform.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1) && volume > 1e-9 && volume < 1e9);
    return transform;
}

json to_json(const Vector& v) { return {v.x(), v.y(), v.z()}; }

Vector vector_from_json(const json& v) {
    const auto xyz = v.get<std::array<double, 3>>();
    if (v.size() != 3) throw InputError(fmt::format("{}, not 3", base::counted(v.size(), "number")));
    return {xyz[0], xyz[1], xyz[2]};
}

json to_json(const Landmarks& landmarks) {
    auto list = json::array();
    for (const auto& mark : landmarks.all())
        list.push_back(
            {{"name", mark.name}, {"position_mm", to_json(mark.position_mm)}, {"label", mark.original_label}});
    return list;
}

Landmarks landmarks_from_json(const json& object, const char* key) {
    std::vector<Landmark> marks;
    read_list(object, key, [&](const json& mark) {
        if (marks.size() == most_landmarks)
            throw InputError(fmt::format("more than the {} landmarks that are read", most_landmarks));
        marks.push_back({read_field<std::string>(mark, "name"), read_field(mark, "position_mm", vector_from_json),
                         mark.value("label", std::string{})});
    });
    try {
        return Landmarks(std::move(marks));
    } catch (const InputError& e) {
        throw fault_in_field(e, key);
    }
}

std::string json_text(const json& document) {
    return document.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string json_text(const nlohmann::ordered_json& document) {
    return document.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void check_schema(const json& document) {
    if (!document.is_object()) throw InputError(fmt::format("is {}, not a JSON object", shown(document)));
    const auto found = document.find("schema");
    const auto schema = found == document.end() ? json(0) : *found;
    if (!schema.is_number_integer() || schema != 1)
        throw InputError(fmt::format("schema is {}; this version of Mimik reads schema 1", shown(schema)));
}

InputError fault_in_file(const std::exception& fault, const std::string& name, const std::string& mend) {
    const auto what = words_of(fault);
    if (what.starts_with(name + ": ")) return InputError(what);
    return InputError(fmt::format("{}: {}{}{}", name, what, mend.empty() ? "" : "; ", mend));
}

}  // namespace mimik::io
