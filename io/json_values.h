#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/fields.h"
#include "base/file.h"
#include "base/text.h"
#include "geometry/landmarks.h"
#include "geometry/types.h"

// How our value types stand in the JSON files that people keep, and how such files are read: whatever they hold, memory
// is bounded and the error names file and field. For .cpp files only: the JSON library is a heavy header.

namespace mimik::io {

inline constexpr std::uintmax_t most_json_bytes = std::uintmax_t{1} << 26;

/// What reading may cost: a value of a few bytes takes up to some 150 in memory.
struct JsonLimits {
    int deepest = 32;  ///< our files nest 6 deep
    std::size_t most_values = 2'000'000;
};

/// @throws InputError naming the byte where the text is damaged, or the limit that it breaks.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& name, const JsonLimits& limits = {});

/// A value for an error message. Lists and objects are not written out: they may be long.
[[nodiscard]] std::string shown(const nlohmann::json& value);

/// "field: complaint": the JSON library's and a value's own complaints know no field.
[[nodiscard]] InputError fault_in_field(const std::exception& fault, const std::string& field);

/// What `convert` makes of object[key]; every complaint names the key.
template <typename Convert>
auto read_field(const nlohmann::json& object, const char* key, const Convert& convert) {
    if (!object.is_object()) throw InputError(shown(object) + " is no object");
    try {
        return convert(object.at(key));
    } catch (const InputError& e) {
        throw fault_in_field(e, key);
    } catch (const nlohmann::json::exception& e) {
        throw fault_in_field(e, key);
    }
}
template <typename T>
T read_field(const nlohmann::json& object, const char* key) {
    return read_field(object, key, [](const nlohmann::json& value) { return value.get<T>(); });
}
/// Hands every entry of the list object[key] to `take`; complaints name key and place.
template <typename Take>
void read_list(const nlohmann::json& object, const char* key, const Take& take) {
    const auto* list = read_field(object, key, [](const nlohmann::json& value) {
        if (!value.is_array()) throw InputError(shown(value) + " is no list");
        return &value;
    });
    for (std::size_t k = 0; k < list->size(); ++k) {
        try {
            take((*list)[k]);
        } catch (const InputError& e) {
            throw fault_in_field(e, std::string(key) + "[" + std::to_string(k) + "]");
        } catch (const nlohmann::json::exception& e) {
            throw fault_in_field(e, std::string(key) + "[" + std::to_string(k) + "]");
        }
    }
}

/// A whole number of 0 or more: nothing is allocated or looked up by one that is not. @throws InputError naming the
/// field.
[[nodiscard]] std::size_t whole_number_below(std::size_t limit, const nlohmann::json& value, const std::string& field);

[[nodiscard]] nlohmann::json to_json(const geometry::Transform& transform);
/// @throws InputError unless it is a finite invertible 4x4 matrix whose last row is 0 0 0 1.
[[nodiscard]] geometry::Transform transform_from_json(const nlohmann::json& rows);
[[nodiscard]] nlohmann::json to_json(const geometry::Vector& v);
[[nodiscard]] geometry::Vector vector_from_json(const nlohmann::json& v);
[[nodiscard]] nlohmann::json to_json(const geometry::Landmarks& landmarks);
[[nodiscard]] geometry::Landmarks landmarks_from_json(const nlohmann::json& object, const char* key);

/// An enum by its to_string(): its values count from 0. @throws InputError listing the words there are.
template <class Enum>
Enum enum_from_json(const nlohmann::json& value) {
    constexpr int most_values = 16;
    const auto word = value.get<std::string>();
    std::string words;
    for (int k = 0; k < most_values; ++k) {
        const std::string known(to_string(static_cast<Enum>(k)));
        if (known == word) return static_cast<Enum>(k);
        if (words.find(known) == std::string::npos) words += (words.empty() ? "" : ", ") + known;
    }
    throw InputError(base::in_quotes(word) + " is none of " + words);
}

namespace detail {
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
}  // namespace detail

/// The fields of an options struct (base/fields.h), by name; enums as words, an optional without a value as null.
template <base::HasFields Options>
nlohmann::json fields_to_json(const Options& options) {
    nlohmann::json json = nlohmann::json::object();
    base::each_field(options, [&](const char* name, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (base::HasFields<Value>)
            json[name] = fields_to_json(value);
        else if constexpr (std::is_enum_v<Value>)
            json[name] = to_string(value);
        else if constexpr (detail::is_optional<Value>)
            json[name] = value ? nlohmann::json(*value) : nlohmann::json(nullptr);
        else
            json[name] = value;
    });
    return json;
}
/// All of them have to be there. @throws InputError naming the field.
template <base::HasFields Options>
void read_fields(const nlohmann::json& json, Options& options) {
    base::each_field(options, [&](const char* name, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (base::HasFields<Value>)
            read_field(json, name, [&](const nlohmann::json& inner) {
                read_fields(inner, value);
                return 0;
            });
        else if constexpr (std::is_enum_v<Value>)
            value = read_field(json, name, enum_from_json<Value>);
        else if constexpr (detail::is_optional<Value>)
            value = read_field(json, name, [](const nlohmann::json& inner) {
                return inner.is_null() ? Value() : Value(inner.get<typename Value::value_type>());
            });
        else
            value = read_field<Value>(json, name);
    });
}

/// As we write it: one value a line; bytes that are no UTF-8 (file names may hold any) become the replacement character
/// instead of an exception at the end of a long run.
[[nodiscard]] std::string json_text(const nlohmann::json& document);
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& document);

/// @throws InputError unless `document` is an object with schema 1.
void check_schema(const nlohmann::json& document);
/// The JSON library's or a value's own complaint, which knows no file, as "name: complaint; mend".
[[nodiscard]] InputError fault_in_file(const std::exception& fault, const std::string& name, const std::string& mend);

/// Reads a document of ours: schema 1, and every fault becomes an InputError that names the file. `name` stands for it.
template <typename Read>
auto read_json_document(std::string_view text, const std::string& name, const std::string& mend, const Read& read) {
    try {
        const auto document = parse_json(text, name);
        check_schema(document);
        return read(document);
    } catch (const InputError& e) {
        throw fault_in_file(e, name, {});
    } catch (const nlohmann::json::exception& e) {
        throw fault_in_file(e, name, mend);
    }
}

}  // namespace mimik::io
