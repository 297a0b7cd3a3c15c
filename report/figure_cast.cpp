#include "report/figure_cast.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "animation/model_method.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "io/json_values.h"

namespace mimik::report {

using facs::Expression;

void NamedFigureOptions::check() const {
    if (!std::isfinite(error_scale_mm) || error_scale_mm <= 0)
        throw InputError(fmt::format("error_scale_mm is {}; give more than 0", error_scale_mm));
    const auto known = animation::method_by_name(method);
    if (!dynamic_cast<const animation::ModelMethod*>(known.get()) ||
        known->needs() != animation::SourceKind::one_source)
        throw InputError(fmt::format(
            "method is '{}'; the figures show control points of one source: give default, sparse or thesis", method));
}

const std::vector<std::string>& thesis_codes() {
    static const std::vector<std::string> codes = {"1", "2", "4", "12", "14", "15", "17", "20", "12L"};
    return codes;
}

FigureCast::FigureCast(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                       NamedFigureOptions options)
    : workspace_(workspace), catalogue_(catalogue), options_(std::move(options)) {
    options_.check();
    for (const auto& subject : {options_.source, options_.female, options_.male})
        if (!subject.empty()) {
            workspace_.refuse_hidden(subject);
            (void)workspace_.neutral(subject);
        }
    source_was_given_ = !options_.source.empty();
    choose_people();
}

void FigureCast::choose_people() {
    const auto subjects = workspace_.shown_subjects();
    if (subjects.size() < 2)
        throw InputError(fmt::format("{}: {} may be shown; the figures need a source and a target",
                                     workspace_.root().string(), base::counted(subjects.size(), "subject")));
    for (const auto& subject : subjects) {
        auto file = workspace_.stem(workspace_.neutral(subject));
        file += ".json";
        sex_[subject] = preprocessing::decode_face(base::read_text(file, io::most_json_bytes), file.string()).sex;
    }
    if (!source_was_given_) {
        std::size_t most = 0;
        for (const auto& subject : subjects) {
            if (subject == options_.female || subject == options_.male) continue;
            const auto& codes = thesis_codes();
            const auto has = static_cast<std::size_t>(std::count_if(codes.begin(), codes.end(), [&](const auto& code) {
                return workspace_.scan_of(subject, expression(code)).has_value();
            }));
            if (!options_.source.empty() && has <= most) continue;
            options_.source = subject;
            most = has;
        }
        remarks_.push_back(fmt::format("the source is {}, scanned with {} of the {} expressions of the thesis",
                                       words(options_.source), most, thesis_codes().size()));
    }
    choose_target(options_.female, "f", options_.male);
    choose_target(options_.male, "m", options_.female);
}

/// The first of that sex who is nobody else in the figures; else the first who is nobody else; else who there is.
void FigureCast::choose_target(std::string& target, const std::string& sex, const std::string& other) {
    if (!target.empty()) return;
    const auto subjects = workspace_.shown_subjects();
    const auto first = [&](const auto& good) {
        const auto found = std::find_if(subjects.begin(), subjects.end(), good);
        return found == subjects.end() ? std::string() : *found;
    };
    const auto free = [&](const auto& subject) { return subject != options_.source && subject != other; };
    const std::string word = sex == "f" ? "female" : "male";
    target = first([&](const auto& subject) { return free(subject) && sex_.at(subject) == sex; });
    if (!target.empty()) {
        remarks_.push_back(fmt::format("the {} target is {}", word, target));
        return;
    }
    target = first(free);
    if (target.empty()) target = first([&](const auto& subject) { return subject != options_.source; });
    remarks_.push_back(
        fmt::format("nobody else is said to be {}: {} takes the place of the {} target", word, target, word));
}

Expression FigureCast::expression(const std::string& code) const { return catalogue_.expression(code); }

std::vector<std::string> FigureCast::sources_of(const Expression& expression) const {
    const auto has = [&](const std::string& subject) {
        if (workspace_.scan_of(subject, expression)) return true;
        const auto both = expression.on_both_sides();  // one side is taken of a scan of both
        return both && workspace_.scan_of(subject, *both);
    };
    std::vector<std::string> sources;
    if (has(options_.source)) sources.push_back(options_.source);
    for (const auto& subject : workspace_.shown_subjects())
        if (subject != options_.source && subject != options_.female && subject != options_.male && has(subject))
            sources.push_back(subject);
    return sources;
}

std::string FigureCast::source_of(const Expression& expression) const {
    if (source_was_given_) return options_.source;
    const auto sources = sources_of(expression);
    if (sources.empty()) throw InputError(fmt::format("nobody but the targets was scanned with {}", expression.name()));
    return sources.front();
}

ComparisonRequest FigureCast::request(const std::string& source, const std::string& target,
                                      const Expression& expression) const {
    ComparisonRequest request;
    request.source = source;
    request.target = target;
    request.expression = expression;
    request.method_name = options_.method;
    const auto method = animation::method_by_name(options_.method);
    if (const auto* by_points = dynamic_cast<const animation::ModelMethod*>(method.get())) {
        request.model = by_points->model_options();
        request.animation = by_points->animation_options();
    }
    return request;
}

ShownPair FigureCast::compared(const ComparisonRequest& request) const {
    auto key = fmt::format("{}|{}|{}|{}|{}", request.source, request.target, request.expression.code(),
                           request.method_name, request.magnitude);
    // All that figures change of a method.
    key += fmt::format("|{}|{}", request.model.wrinkle_points, request.model.coverage_points);
    ShownPair pair;
    {
        const std::scoped_lock lock(mutex_);
        if (const auto found = compared_.find(key); found != compared_.end()) pair.people = found->second;
    }
    if (!pair.people) {
        pair.people = std::make_shared<const ComparedPeople>(compare_people(workspace_, catalogue_, request));
        const std::scoped_lock lock(mutex_);
        compared_.emplace(key, pair.people);
    }
    pair.source = &pair.people->people.front();
    pair.target = &pair.people->people.back();
    return pair;
}

preprocessing::Face FigureCast::neutral(const std::string& subject) const {
    return workspace_.face(workspace_.neutral(subject));
}

preprocessing::Face FigureCast::scan(const std::string& subject, const Expression& expression) const {
    const auto id = workspace_.scan_of(subject, expression);
    if (!id) throw InputError(fmt::format("{} was not scanned with {}", subject, expression.name()));
    return workspace_.face(*id);
}

std::string FigureCast::words(const std::string& subject) const {
    const auto found = sex_.find(subject);
    if (found == sex_.end() || found->second.empty()) return subject;
    return fmt::format("{}, {}", subject, found->second == "f" ? "female" : "male");
}

std::string FigureCast::words(const Expression& expression) const {
    const auto units = catalogue_.units(expression);
    auto words = expression.name();
    if (units.size() == 1 && words.starts_with("AU")) words += " " + units.front().unit->name;
    return words;
}

}  // namespace mimik::report
