#include "evaluation/cast.h"

#include <algorithm>
#include <optional>
#include <type_traits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/data_zone.h"
#include "preprocessing/kept_registrations.h"

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

/// Zones of one experiment, and what they are made from.
class ZoneFinder {
public:
    ZoneFinder(const PerformanceReader& reader, ZoneSource source, FailureList& failures)
        : reader_(reader), failures_(failures), source_(source) {
        if (source_ == ZoneSource::automatic) source_ = reader.has_truth() ? ZoneSource::truth : ZoneSource::data;
        if (source_ == ZoneSource::truth && !reader.has_truth())
            throw InputError(fmt::format("zones from the truth are asked for, and {} has none; take those of the data",
                                         reader.workspace().database_root().string()));
        if (source_ != ZoneSource::data) return;
        try {
            on_average_.emplace(average(), registrations().face_template());
        } catch (const InputError& e) {  // an average face without a mouth has no template
            source_ = ZoneSource::catalogue;
            remarks_.push_back(fmt::format("zones from the catalogue, there are none from the data: {}", e.what()));
        }
    }

    [[nodiscard]] ZoneSource source() const { return source_; }
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

    /// How one subject's skin moves, per vertex of the average face; empty where the catalogue draws.
    [[nodiscard]] std::vector<Vector> motion(const modeling::Performance& own) const {
        if (source_ == ZoneSource::truth)
            return true_motion_on_average(average(), own.neutral, *own.true_neutral,
                                          own.true_expression->displacement_mm);
        if (source_ == ZoneSource::data)
            return on_average_->of(registrations().motion(own.neutral, own.expressive).motion_mm);
        return {};
    }

    /// As motion(); of somebody of whom there is none that is reported, and empty.
    [[nodiscard]] std::vector<Vector> motion_if_known(const modeling::Performance& own,
                                                      const facs::Expression& of_zone) const {
        try {
            return motion(own);
        } catch (const std::exception& e) {
            failures_.add(fmt::format("{}: takes no part in the zone of {}: {}", own.expressive.id.name(),
                                      of_zone.code(), e.what()));
            return {};
        }
    }

    /// From the motions of those who show it.
    ActiveZone zone(const facs::Expression& expression, const MotionZone& motions, ZoneSource* from = nullptr) {
        const bool too_little = source_ == ZoneSource::data && motions.largest_mm() < least_zone_motion_mm;
        if (too_little && motions.subjects() > 0)
            remarks_.push_back(
                fmt::format("{}: zone from the catalogue, the scans show a mean motion of {:.1f} mm at most",
                            expression.code(), motions.largest_mm()));
        const bool drawn = too_little || motions.subjects() == 0 || source_ == ZoneSource::catalogue;
        if (from) *from = drawn ? ZoneSource::catalogue : source_;
        return drawn ? shipped_active_zone(expression, average()) : motions.zone(expression);
    }

    /// An expression of several AUs has theirs, too: a share of the largest motion would leave out the small ones.
    void add_zones_of_units(ActiveZone& zone, std::span<const ScanId> performances) {
        const auto units = zone.expression.units();
        if (units.size() < 2 || source_ == ZoneSource::catalogue) return;
        for (const auto& [unit, side, low_intensity] : units)
            unite(zone, zone_of_unit(zone.expression, facs::Expression::of_units({{unit, side, false}}), performances));
    }

private:
    [[nodiscard]] const preprocessing::AverageFace& average() const { return reader_.workspace().average(); }
    [[nodiscard]] const preprocessing::KeptRegistrations& registrations() const {
        return *reader_.workspace().registrations();
    }

    /// Of one AU of an expression that `performances` show.
    ActiveZone zone_of_unit(const facs::Expression& expression, const facs::Expression& unit,
                            std::span<const ScanId> performances) {
        std::vector<ScanId> scans;
        for (const auto& performance : performances)
            if (auto id = reader_.workspace().scan_of(performance.subject, unit)) scans.push_back(std::move(*id));
        MotionZone motions(average());
        base::in_batches(
            scans.size(),
            [&](std::size_t k) -> std::vector<Vector> {
                try {
                    return motion_if_known(reader_.read(scans[k]), expression);
                } catch (const std::exception& e) {
                    failures_.add(fmt::format("{}: takes no part in the zone of {}: {}", scans[k].name(),
                                              expression.code(), e.what()));
                    return {};
                }
            },
            [&](const std::vector<Vector>& motion_mm) {
                if (!motion_mm.empty()) motions.add(motion_mm);
            });
        return zone(unit, motions);
    }

    const PerformanceReader& reader_;
    FailureList& failures_;
    ZoneSource source_;
    std::optional<MotionOnAverage> on_average_;  // of zones from the data
    std::vector<std::string> remarks_;
};

/// What is taken from one performance before it is dropped.
struct Taken {
    std::optional<ScanId> id;
    std::vector<animation::LessonPointer> lessons;
    std::vector<Vector> motion_mm;
};

Taken take(const PerformanceReader& reader, const LessonBook& book, const ZoneFinder& zones, const ScanId& id,
           const facs::Expression& expression, FailureList& failures) {
    Taken taken;
    modeling::Performance own;
    try {
        own = reader.read(id);
        // A truth that does not fit its scan is the end of it, a template that does not lie on the scan is not.
        if (zones.source() == ZoneSource::truth) taken.motion_mm = zones.motion(own);
    } catch (const std::exception& e) {
        failures.add(fmt::format("{}: takes part in no case: {}", id.name(), e.what()));
        return taken;
    }
    if (zones.source() == ZoneSource::data) taken.motion_mm = zones.motion_if_known(own, expression);
    taken.id = id;
    taken.lessons = book.study(own);
    return taken;
}

}  // namespace

Cast gather_cast(const PerformanceReader& reader, const animation::LearningTask& task,
                 std::span<const ScanId> performances, std::span<const animation::MethodPointer> methods,
                 FailureList& failures, ZoneSource zones) {
    Cast cast{task.expression, {}, {}, LessonBook(reader, task, methods, failures)};
    ZoneFinder finder(reader, zones, failures);
    MotionZone motions(reader.workspace().average());
    base::in_batches(
        performances.size(),
        [&](std::size_t k) { return take(reader, cast.lessons, finder, performances[k], task.expression, failures); },
        [&](Taken& own) {
            if (!own.id) return;
            if (!own.motion_mm.empty()) motions.add(own.motion_mm);
            cast.lessons.add(*own.id, std::move(own.lessons));
            cast.participants.push_back(std::move(*own.id));
        });
    if (cast.participants.empty()) return cast;
    cast.zone = finder.zone(task.expression, motions, &cast.zone_from);
    finder.add_zones_of_units(cast.zone, performances);
    cast.catalogue = task.catalogue;
    cast.remarks = finder.remarks();
    return cast;
}

}  // namespace mimik::evaluation
