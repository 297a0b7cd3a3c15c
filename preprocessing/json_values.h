#pragma once

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/errors.h"
#include "geometry/file.h"
#include "geometry/landmarks.h"

// How our value types stand in the JSON files that people keep. For .cpp files only: the JSON library is a heavy
// header.

namespace mimik::preprocessing {

inline nlohmann::json to_json(const geometry::Transform& transform) {
    auto rows = nlohmann::json::array();
    for (int r = 0; r < 4; ++r) {
        auto row = nlohmann::json::array();
        for (int c = 0; c < 4; ++c) row.push_back(transform.matrix()(r, c));
        rows.push_back(std::move(row));
    }
    return rows;
}

inline geometry::Transform transform_from_json(const nlohmann::json& rows) {
    geometry::Transform transform;
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c)
            transform.matrix()(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
                rows.at(r).at(c).get<double>();
    return transform;
}

inline nlohmann::json to_json(const geometry::Vector& v) { return {v.x(), v.y(), v.z()}; }

inline geometry::Vector vector_from_json(const nlohmann::json& v) {
    return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}

inline nlohmann::json to_json(const geometry::Landmarks& landmarks) {
    auto list = nlohmann::json::array();
    for (const auto& mark : landmarks.all())
        list.push_back(
            {{"name", mark.name}, {"position_mm", to_json(mark.position_mm)}, {"label", mark.original_label}});
    return list;
}

inline geometry::Landmarks landmarks_from_json(const nlohmann::json& list) {
    std::vector<geometry::Landmark> marks;
    for (const auto& mark : list)
        marks.push_back({mark.at("name").get<std::string>(), vector_from_json(mark.at("position_mm")),
                         mark.value("label", std::string{})});
    return geometry::Landmarks(std::move(marks));
}

/// As we write it: one value a line; bytes that are no UTF-8 (file names may hold any) become the replacement character
/// instead of an exception at the end of a long run.
inline std::string json_text(const nlohmann::json& document) {
    return document.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Reads a file of ours: schema 1, and every fault of the JSON becomes an InputError that names the file.
template <typename Value, typename Parse>
Value from_json_file(const std::filesystem::path& file, const Parse& parse) {
    try {
        const auto document = nlohmann::json::parse(geometry::read_text(file));
        const auto schema = document.value("schema", 0);
        if (schema != 1)
            throw InputError(
                fmt::format("{}: schema is {}; this version of Mimik reads schema 1", file.string(), schema));
        return parse(document);
    } catch (const InputError& e) {
        const std::string what = e.what();  // a value type's own complaint names no file
        if (what.find(file.parent_path().string()) == 0) throw;
        throw InputError(fmt::format("{}: {}", file.string(), what));
    } catch (const nlohmann::json::exception& e) {
        throw InputError(fmt::format("{}: {}; the file is damaged or was edited by hand", file.string(), e.what()));
    }
}

}  // namespace mimik::preprocessing
