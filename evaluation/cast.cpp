#include "evaluation/cast.h"

#include <algorithm>
#include <optional>
#include <type_traits>

#include <fmt/format.h>

#include "base/parallel.h"

namespace mimik::evaluation {

using database::ScanId;
using geometry::Vector;

LessonBook::LessonBook(const PerformanceReader& reader, const animation::LearningTask& task,
                       std::span<const animation::MethodPointer> methods, FailureList& failures, std::size_t bytes)
    : reader_(reader), expression_(task.expression.code()), failures_(failures), room_(bytes) {
    for (const auto& method : methods) {
        const auto key = method->lessons_key();
        auto kind = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& known) { return known.key == key; });
        if (kind == kinds_.end()) kind = kinds_.insert(kinds_.end(), {key, method->name(), nullptr, false});
        kind_of_.push_back(static_cast<std::size_t>(kind - kinds_.begin()));
        try {
            learners_.push_back(method->learner(task));
        } catch (const std::exception& e) {
            learners_.push_back(nullptr);
            failures_.add(fmt::format("{} by {}: no model of any source: {}", expression_, method->name(), e.what()));
            continue;
        }
        if (!kind->student) kind->student = learners_.back().get();
        kind->taken = kind->taken || method->needs() != animation::SourceKind::none;
    }
}

std::vector<animation::LessonPointer> LessonBook::study(const modeling::Performance& performance) const {
    std::vector<animation::LessonPointer> lessons(kinds_.size());
    for (std::size_t k = 0; k < kinds_.size(); ++k) try {
            if (kinds_[k].student && kinds_[k].taken) lessons[k] = kinds_[k].student->study(performance);
        } catch (const std::exception& e) {
            failures_.add(fmt::format("{} of {} by {}: no model: {}", expression_, performance.neutral.id.subject,
                                      kinds_[k].first_name, e.what()));
        }
    return lessons;
}

void LessonBook::add(const ScanId& expressive, std::vector<animation::LessonPointer> lessons) {
    std::size_t bytes = 0;
    auto& there = there_.emplace_back();
    for (const auto& lesson : lessons) {
        there.push_back(lesson ? 1 : 0);
        if (lesson) bytes += lesson->bytes();
    }
    if (held_.size() == ids_.size() && bytes <= room_) {
        held_.push_back(std::move(lessons));
        room_ -= bytes;
    }
    ids_.push_back(expressive);
}

animation::LessonPointer LessonBook::lesson(std::size_t method, std::size_t k) const {
    const auto kind = kind_of_[method];
    if (!there_[k][kind]) return nullptr;
    return k < held_.size() ? held_[k][kind] : kinds_[kind].student->study(reader_.read(ids_[k]));
}

namespace {

std::vector<Vector> true_motion(const PerformanceReader& reader, const modeling::Performance& own) {
    return true_motion_on_average(reader.workspace().average(), own.neutral, *own.true_neutral,
                                  own.true_expression->displacement_mm);
}

/// Of one AU of an expression that `performances` show.
ActiveZone zone_of_unit(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                        const facs::Expression& expression, const facs::Expression& unit,
                        std::span<const ScanId> performances, FailureList& failures) {
    std::vector<ScanId> scans;
    for (const auto& performance : performances)
        if (auto id = reader.workspace().scan_of(performance.subject, unit)) scans.push_back(std::move(*id));
    TrueZone zone(reader.workspace().average());
    bool any = false;
    base::in_batches(
        scans.size(),
        [&](std::size_t k) -> std::vector<Vector> {
            const ScanId& id = scans[k];
            try {
                return true_motion(reader, reader.read(id));
            } catch (const std::exception& e) {
                failures.add(
                    fmt::format("{}: takes no part in the zone of {}: {}", id.name(), expression.code(), e.what()));
                return {};
            }
        },
        [&](const std::vector<Vector>& motion_mm) {
            if (motion_mm.empty()) return;
            zone.add(motion_mm);
            any = true;
        });
    return any ? zone.zone(unit) : active_zone_from_catalogue(unit, reader.workspace().average(), catalogue);
}

void add_zones_of_units(ActiveZone& zone, const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                        std::span<const ScanId> performances, FailureList& failures) {
    const auto units = zone.expression.units();
    if (units.size() < 2) return;
    for (const auto& [unit, side, low_intensity] : units)
        unite(zone, zone_of_unit(reader, catalogue, zone.expression, facs::Expression::of_units({{unit, side, false}}),
                                 performances, failures));
}

/// What is taken from one performance before it is dropped.
struct Taken {
    std::optional<ScanId> id;
    std::vector<animation::LessonPointer> lessons;
    std::vector<Vector> true_motion_mm;
};

Taken take(const PerformanceReader& reader, const LessonBook& book, const ScanId& id, FailureList& failures) {
    Taken taken;
    modeling::Performance own;
    try {
        own = reader.read(id);
        if (own.true_expression) taken.true_motion_mm = true_motion(reader, own);
    } catch (const std::exception& e) {
        failures.add(fmt::format("{}: takes part in no case: {}", id.name(), e.what()));
        return taken;
    }
    taken.id = id;
    taken.lessons = book.study(own);
    return taken;
}

}  // namespace

Cast gather_cast(const PerformanceReader& reader, const animation::LearningTask& task,
                 std::span<const ScanId> performances, std::span<const animation::MethodPointer> methods,
                 FailureList& failures) {
    const auto& average = reader.workspace().average();
    Cast cast{task.expression, {}, {}, LessonBook(reader, task, methods, failures)};
    TrueZone zone(average);
    base::in_batches(
        performances.size(), [&](std::size_t k) { return take(reader, cast.lessons, performances[k], failures); },
        [&](Taken& own) {
            if (!own.id) return;
            if (reader.has_truth()) zone.add(own.true_motion_mm);
            cast.lessons.add(*own.id, std::move(own.lessons));
            cast.participants.push_back(std::move(*own.id));
        });
    if (!reader.has_truth()) {
        cast.zone = active_zone_from_catalogue(task.expression, average, task.catalogue);
    } else if (!cast.participants.empty()) {
        cast.zone = zone.zone(task.expression);
        add_zones_of_units(cast.zone, reader, task.catalogue, performances, failures);
    }
    return cast;
}

}  // namespace mimik::evaluation
