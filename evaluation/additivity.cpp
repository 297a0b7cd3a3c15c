#include "evaluation/additivity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "animation/combine.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "preprocessing/kept_registrations.h"
#include "statistics/bootstrap.h"

namespace mimik::evaluation {

using facs::Expression;
using facs::FacsCatalogue;
using geometry::Vector;
using preprocessing::Workspace;

void AdditivityOptions::check() const {
    if (!std::isfinite(moving_mm) || moving_mm <= 0)
        throw InputError(fmt::format("moving_mm is {}; give more than 0", moving_mm));
    statistics::BootstrapOptions{.seed = seed, .resamples = resamples, .confidence = confidence}.check();
}

namespace {

std::vector<Expression> units_of(const FacsCatalogue& catalogue, const Expression& expression) {
    std::vector<Expression> units;
    for (const auto& one : catalogue.units(expression))
        units.push_back(Expression::of_units({{one.unit->number, one.side, false}}));
    return units;
}

/// The scans of one person that the question needs; empty if one is missing.
struct NeededScans {
    database::ScanId neutral, combined;
    std::vector<database::ScanId> units;
};
std::optional<NeededScans> needed_scans(const Workspace& workspace, const std::string& subject,
                                        const Expression& expression, const std::vector<Expression>& units) {
    const auto combined = workspace.scan_of(subject, expression);
    if (!combined) return std::nullopt;
    NeededScans needed{workspace.neutral(subject), *combined, {}};
    for (const auto& unit : units) {
        const auto scan = workspace.scan_of(subject, unit);
        if (!scan) return std::nullopt;
        needed.units.push_back(*scan);
    }
    return needed;
}

AdditivityCase measure(const Workspace& workspace, const std::string& subject, const NeededScans& needed,
                       const AdditivityOptions& options, double& registration_mm) {
    const auto neutral = workspace.face(needed.neutral);
    const auto& registrations = *workspace.registrations();
    const auto whole = registrations.motion(neutral, workspace.face(needed.combined));
    registration_mm = whole.residual_rms_mm;
    auto known = whole.matched;
    std::vector<std::vector<Vector>> units_mm;
    for (const auto& unit : needed.units) {
        const auto motion = registrations.motion(neutral, workspace.face(unit));
        for (std::size_t v = 0; v < known.size(); ++v) known[v] = known[v] && motion.matched[v] ? 1 : 0;
        units_mm.push_back(motion.motion_mm);
    }
    auto one = add_up(whole.motion_mm, units_mm, known, options);
    one.subject = subject;
    return one;
}

AdditivityShare share_of(const std::vector<AdditivityCase>& cases, const AdditivityOptions& options,
                         const std::function<double(const AdditivityCase&)>& off_mm) {
    std::vector<double> off, motion;
    for (const auto& one : cases) {
        // Sums over vertices, so that every vertex weighs the same.
        off.push_back(off_mm(one) * static_cast<double>(one.vertices));
        motion.push_back(one.motion_mm * static_cast<double>(one.vertices));
    }
    AdditivityShare share;
    share.share = 1 - std::accumulate(off.begin(), off.end(), 0.0) / std::accumulate(motion.begin(), motion.end(), 0.0);
    if (cases.size() < 2) return share;
    std::vector<std::uint32_t> subject(cases.size());
    std::iota(subject.begin(), subject.end(), 0U);
    const auto interval = statistics::bootstrap_interval(
                              statistics::Clusters::one_way(subject), statistics::weighted_ratio(off, motion),
                              {.seed = options.seed, .resamples = options.resamples, .confidence = options.confidence})
                              .interval;
    share.interval = statistics::Interval{1 - interval.high, 1 - interval.low};
    return share;
}

}  // namespace

AdditivityCase add_up(std::span<const Vector> combined_mm, std::span<const std::vector<Vector>> units_mm,
                      std::span<const std::uint8_t> known, const AdditivityOptions& options) {
    for (const auto& unit : units_mm)
        if (unit.size() != combined_mm.size())
            throw InputError(fmt::format("motions of {} and of {} vertices; give those of one template", unit.size(),
                                         combined_mm.size()));
    if (known.size() != combined_mm.size())
        throw InputError(fmt::format("a mask of {} and motions of {} vertices", known.size(), combined_mm.size()));
    AdditivityCase one;
    one.alone_off_mm.assign(units_mm.size(), 0.0);
    std::vector<Vector> sums(combined_mm.size(), Vector::Zero()), pulls(units_mm.size());
    std::vector<std::uint32_t> counted;
    double along = 0, square = 0;
    for (std::uint32_t v = 0; v < combined_mm.size(); ++v) {
        double largest_mm = combined_mm[v].norm();
        for (std::size_t u = 0; u < units_mm.size(); ++u) {
            pulls[u] = units_mm[u][v];
            sums[v] += pulls[u];
            largest_mm = std::max(largest_mm, pulls[u].norm());
        }
        if (!known[v] || largest_mm < options.moving_mm) continue;
        counted.push_back(v);
        along += sums[v].dot(combined_mm[v]);
        square += sums[v].squaredNorm();
        one.motion_mm += combined_mm[v].norm();
        one.sum_off_mm += (sums[v] - combined_mm[v]).norm();
        one.resultant_off_mm += (animation::parallel_resultant(pulls) - combined_mm[v]).norm();
        for (std::size_t u = 0; u < pulls.size(); ++u) one.alone_off_mm[u] += (pulls[u] - combined_mm[v]).norm();
    }
    if (counted.empty() || one.motion_mm == 0)
        throw InputError(fmt::format(
            "no vertex that all scans show moves by {:g} mm; its motion cannot be made of others", options.moving_mm));
    one.gain = square > 0 ? along / square : 0;
    for (const auto v : counted) one.scaled_sum_off_mm += (one.gain * sums[v] - combined_mm[v]).norm();
    one.vertices = counted.size();
    const auto n = static_cast<double>(counted.size());
    for (double* value : {&one.motion_mm, &one.sum_off_mm, &one.scaled_sum_off_mm, &one.resultant_off_mm}) *value /= n;
    for (double& value : one.alone_off_mm) value /= n;
    return one;
}

std::vector<Expression> combined_expressions(const Workspace& workspace, const FacsCatalogue& catalogue) {
    std::map<std::string, Expression> found;
    const auto shown = workspace.shown_subjects();
    for (const auto& scan : workspace.scans()) {
        const auto expression = scan.expression();
        if (expression.neutral() || found.contains(expression.code())) continue;
        if (!catalogue.knows(expression) || std::find(shown.begin(), shown.end(), scan.subject) == shown.end())
            continue;
        const auto units = units_of(catalogue, expression);
        if (units.size() > 1 && needed_scans(workspace, scan.subject, expression, units))
            found.emplace(expression.code(), expression);
    }
    std::vector<Expression> all;
    all.reserve(found.size());
    for (auto& [code, expression] : found) all.push_back(expression);
    return all;
}

Additivity additivity(const PerformanceReader& reader, const FacsCatalogue& catalogue, const Expression& expression,
                      const AdditivityOptions& options, FailureList& failures) {
    options.check();
    Additivity answer;
    answer.expression = expression;
    const auto units = units_of(catalogue, expression);
    if (units.size() < 2)
        throw InputError(fmt::format("{} is one Action Unit; give an expression of several, such as HAPPY or A12A15",
                                     expression.code()));
    for (const auto& unit : units) answer.units.push_back(unit.code());
    const auto& workspace = reader.workspace();
    std::vector<std::pair<std::string, NeededScans>> people;
    for (const auto& subject : workspace.shown_subjects())
        if (auto needed = needed_scans(workspace, subject, expression, units)) people.emplace_back(subject, *needed);
    if (people.empty())
        throw InputError(fmt::format("nobody was scanned with {} and with each of its AUs alone ({})",
                                     expression.code(), fmt::join(answer.units, ", ")));
    std::vector<std::optional<AdditivityCase>> cases(people.size());
    std::vector<double> registration_mm(people.size(), 0.0);
    base::parallel_for_each(people.size(), [&](std::size_t k) {
        try {
            cases[k] = measure(workspace, people[k].first, people[k].second, options, registration_mm[k]);
        } catch (const InputError& e) {
            failures.add(fmt::format("{}, {}: {}", people[k].first, expression.code(), e.what()));
        } catch (const NumericalError& e) {
            failures.add(fmt::format("{}, {}: {}", people[k].first, expression.code(), e.what()));
        }
    });
    for (std::size_t k = 0; k < cases.size(); ++k) {
        if (!cases[k]) continue;
        answer.cases.push_back(*cases[k]);
        answer.registration_mm += registration_mm[k];
        answer.gain += cases[k]->gain;
    }
    if (answer.cases.empty()) throw InputError(fmt::format("{} was measured on nobody", expression.code()));
    const auto n = static_cast<double>(answer.cases.size());
    answer.registration_mm /= n;
    answer.gain /= n;
    answer.sum = share_of(answer.cases, options, [](const auto& one) { return one.sum_off_mm; });
    answer.scaled_sum = share_of(answer.cases, options, [](const auto& one) { return one.scaled_sum_off_mm; });
    answer.resultant = share_of(answer.cases, options, [](const auto& one) { return one.resultant_off_mm; });
    std::size_t best = 0;
    std::vector<double> off(units.size(), 0.0);
    for (const auto& one : answer.cases)
        for (std::size_t u = 0; u < off.size(); ++u) off[u] += one.alone_off_mm[u] * static_cast<double>(one.vertices);
    best = static_cast<std::size_t>(std::min_element(off.begin(), off.end()) - off.begin());
    answer.strongest = answer.units[best];
    answer.alone = share_of(answer.cases, options, [best](const auto& one) { return one.alone_off_mm[best]; });
    return answer;
}

}  // namespace mimik::evaluation
