#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// One list of fields per Options struct. JSON, fingerprints, differences, names of files and tests all read it, so that
// a new field cannot be forgotten in one of them:
//
//     struct CleaningOptions {
//         double spike_mm = 4.0;
//         bool keep_parts = false;
//         template <class Self, class Visit>
//         static constexpr void each_field(Self& self, Visit&& visit) {
//             visit("spike_mm", self.spike_mm);
//             visit("keep_parts", self.keep_parts);
//         }
//     };
//     static_assert(base::lists_every_field<CleaningOptions>());
//
// Members that are left out on purpose are counted: `static constexpr std::size_t unlisted = 1;`. Every struct of
// options is tested, without a list that could forget one (cmake/OptionsTest.cmake).
//
// A field is a number, a bool, a text, anything with a to_string(), an optional one or a list of these, or a struct
// with a list of its own.

namespace mimik::base {

struct IgnoreField {
    template <class T>
    void operator()(const char*, T&&) const {}
};
template <class T>
concept HasFields = requires(T& options) {
    T::each_field(options, IgnoreField{});
};

/// Calls visit(name, value) for every field. @param options  const or not; so are the values
template <class Options, class Visit>
void each_field(Options& options, Visit&& visit) {
    std::remove_const_t<Options>::each_field(options, visit);
}

namespace detail {
struct AnyField {
    template <class T>
    constexpr operator T() const {  // NOLINT: converts to whatever a member is
        return T();
    }
};
template <class Aggregate, std::size_t... k>
constexpr bool takes(std::index_sequence<k...>) {
    return requires { Aggregate{((void)k, AnyField{})...}; };
}
/// Members of an aggregate: the most initialisers that it takes.
template <class Aggregate, std::size_t count = 32>
constexpr std::size_t member_count() {
    if constexpr (count == 0 || takes<Aggregate>(std::make_index_sequence<count>{}))
        return count;
    else
        return member_count<Aggregate, count - 1>();
}
struct CountFields {
    std::size_t count = 0;
    template <class T>
    constexpr void operator()(const char*, T&&) {
        ++count;
    }
};
}  // namespace detail

/// Whether the list has as many fields as the struct has members, but for those that it counts as `unlisted`.
template <HasFields Options>
constexpr bool lists_every_field() {
    std::size_t unlisted = 0;
    if constexpr (requires { Options::unlisted; }) unlisted = Options::unlisted;
    Options options{};
    detail::CountFields counter;
    Options::each_field(options, counter);
    return counter.count + unlisted == detail::member_count<Options>();
}

/// The shortest text that reads back as the same number: "0.5", "1e-06", "2000".
[[nodiscard]] std::string number_text(double value);
[[nodiscard]] std::string number_text(long long value);
[[nodiscard]] std::string number_text(unsigned long long value);

/// A value as people read it: "0.5", "on", "r2logr", "none".
template <class T>
std::string value_text(const T& value) {
    if constexpr (std::same_as<T, bool>)
        return value ? "on" : "off";
    else if constexpr (requires { to_string(value); })
        return std::string(to_string(value));
    else if constexpr (std::convertible_to<const T&, std::string>)
        return value;
    else if constexpr (std::floating_point<T>)
        return number_text(double{value});
    else if constexpr (std::signed_integral<T>)
        return number_text(static_cast<long long>(value));
    else
        return number_text(static_cast<unsigned long long>(value));
}
template <class T>
std::string value_text(const std::optional<T>& value) {
    return value ? value_text(*value) : std::string("none");
}
/// "a, b"; of an empty list "none".
template <class T>
std::string value_text(const std::vector<T>& values) {
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "" : ", ") + value_text(value);
    return text.empty() ? "none" : text;
}

/// " name value" for every field, those of nested structs as "outer.inner": equal where all fields are equal.
template <HasFields Options>
std::string field_text(const Options& options, const std::string& prefix = {}) {
    std::string text;
    each_field(options, [&](const char* name, const auto& value) {
        if constexpr (HasFields<std::remove_cvref_t<decltype(value)>>)
            text += field_text(value, prefix + name + ".");
        else
            text += " " + prefix + name + " " + value_text(value);
    });
    return text;
}

struct FieldDifference {
    std::string name, first, second;  ///< values as value_text()
    bool is_switch = false;           ///< a bool
};
namespace detail {
struct FieldValue {
    std::string name, text;
    bool is_switch = false;
};
template <HasFields Options>
void list_values(const Options& options, const std::string& prefix, std::vector<FieldValue>& values) {
    each_field(options, [&](const char* name, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (HasFields<Value>)
            list_values(value, prefix + name + ".", values);
        else
            values.push_back({prefix + name, value_text(value), std::same_as<Value, bool>});
    });
}
}  // namespace detail
/// The fields in which two structs differ, those of nested structs as "outer.inner".
template <HasFields Options>
std::vector<FieldDifference> field_differences(const Options& first, const Options& second) {
    std::vector<detail::FieldValue> one, other;
    detail::list_values(first, {}, one);
    detail::list_values(second, {}, other);
    std::vector<FieldDifference> differences;
    for (std::size_t k = 0; k < one.size(); ++k)
        if (one[k].text != other[k].text)
            differences.push_back({one[k].name, one[k].text, other[k].text, one[k].is_switch});
    return differences;
}

}  // namespace mimik::base
