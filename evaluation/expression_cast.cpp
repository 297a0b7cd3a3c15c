#include "evaluation/expression_cast.h"

#include <algorithm>
#include <type_traits>

#include <fmt/format.h>

#include "base/parallel.h"

namespace mimik::evaluation {

using database::ScanId;
using geometry::Vector;
using modeling::ExpressionGauge;

std::vector<std::size_t> models_shared_by(std::span<const Method> methods) {
    std::vector<std::size_t> first(methods.size());
    for (std::size_t m = 0; m < first.size(); ++m)
        for (first[m] = 0; !(methods[first[m]].model == methods[m].model);) ++first[m];
    return first;
}

TrueFields::TrueFields(const PerformanceReader& reader, std::size_t bytes) : reader_(reader), room_(bytes) {}

void TrueFields::add(const ScanId& expressive, Field field) {
    const std::size_t bytes = field.size() * sizeof(Vector);
    if (held_.size() == ids_.size() && bytes <= room_) {
        field.shrink_to_fit();  // it was read without knowing its length
        held_.push_back(std::make_shared<const Field>(std::move(field)));
        room_ -= bytes;
    }
    ids_.push_back(expressive);
}

std::shared_ptr<const TrueFields::Field> TrueFields::of(std::size_t k) const {
    if (k < held_.size()) return held_[k];
    return std::make_shared<const Field>(reader_.true_field_mm(ids_[k]));
}

namespace {

/// In batches, and within a batch one face per thread: only what `keep` keeps stays, in the order of the scans.
template <typename Take, typename Keep>
void in_batches(std::span<const ScanId> scans, const Take& take, const Keep& keep) {
    constexpr std::size_t batch = 16;
    for (std::size_t begin = 0; begin < scans.size(); begin += batch) {
        std::vector<std::invoke_result_t<Take, const ScanId&>> taken(std::min(batch, scans.size() - begin));
        base::parallel_for(taken.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) taken[k] = take(scans[begin + k]);
        });
        for (auto& one : taken) keep(one);
    }
}

std::vector<Vector> true_motion(const PerformanceReader& reader, const Performance& own) {
    return true_motion_on_average(reader.workspace().average(), own.neutral, *own.true_neutral,
                                  own.true_expression->displacement_mm);
}

/// Of one AU of an expression that `performances` show.
ActiveZone zone_of_unit(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                        const std::string& expression, const std::string& unit, std::span<const ScanId> performances,
                        FailureList& failures) {
    std::vector<ScanId> scans;
    for (const auto& performance : performances)
        if (auto id = reader.workspace().expression(performance.subject, unit)) scans.push_back(std::move(*id));
    TrueZone zone(reader.workspace().average());
    bool any = false;
    in_batches(
        scans,
        [&](const ScanId& id) -> std::vector<Vector> {
            try {
                return true_motion(reader, reader.read(id));
            } catch (const std::exception& e) {
                failures.add(fmt::format("{}: takes no part in the zone of {}: {}", id.name(), expression, e.what()));
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
    const auto units = catalogue.resolve(zone.expression);
    if (units.size() < 2) return;
    for (const auto& [unit, side] : units) {
        const char* of_side = side == facs::Side::both ? "" : side == facs::Side::left ? "L" : "R";
        unite(zone, zone_of_unit(reader, catalogue, zone.expression, fmt::format("{}{}", unit->number, of_side),
                                 performances, failures));
    }
}

/// What is taken from one performance before it is dropped.
struct Taken {
    std::optional<Participant> participant;
    std::vector<Vector> true_motion_mm, true_field_mm;
};

class Gathering {
public:
    Gathering(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const std::string& expression,
              std::span<const Method> methods, FailureList& failures)
        : reader_(reader), expression_(expression), methods_(methods), failures_(failures) {
        const auto shared = models_shared_by(methods);
        gauges_.resize(methods.size());
        for (std::size_t m = 0; m < methods.size(); ++m) try {
                if (shared[m] == m)
                    gauges_[m].emplace(catalogue, expression, reader.workspace().average(), methods[m].model);
            } catch (const std::exception& e) {
                failures_.add(
                    fmt::format("{} by {}: no model of any source: {}", expression_, methods[m].name, e.what()));
            }
    }

    [[nodiscard]] Taken take(const ScanId& id) const {
        Taken taken;
        Performance own;
        try {
            own = reader_.read(id);
            if (own.true_expression) taken.true_motion_mm = true_motion(reader_, own);
        } catch (const std::exception& e) {
            failures_.add(fmt::format("{}: takes part in no case: {}", id.name(), e.what()));
            return taken;
        }
        if (own.true_expression) taken.true_field_mm = std::move(own.true_expression->displacement_mm);
        auto& participant = taken.participant.emplace();
        participant.id = id;
        participant.models.resize(methods_.size());
        for (std::size_t m = 0; m < methods_.size(); ++m) try {
                if (gauges_[m]) participant.models[m] = gauges_[m]->measure(own.neutral, own.expressive);
            } catch (const std::exception& e) {
                failures_.add(
                    fmt::format("{} of {} by {}: no model: {}", expression_, id.subject, methods_[m].name, e.what()));
            }
        return taken;
    }

private:
    const PerformanceReader& reader_;
    const std::string& expression_;
    std::span<const Method> methods_;
    std::vector<std::optional<ExpressionGauge>> gauges_;
    FailureList& failures_;
};

}  // namespace

ExpressionCast gather_cast(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                           const std::string& expression, std::span<const ScanId> performances,
                           std::span<const Method> methods, bool keep_true_fields, FailureList& failures) {
    const auto& average = reader.workspace().average();
    const Gathering gathering(reader, catalogue, expression, methods, failures);
    ExpressionCast cast{expression, {}, {}, TrueFields(reader)};
    TrueZone zone(average);
    in_batches(
        performances, [&](const ScanId& id) { return gathering.take(id); },
        [&](Taken& own) {
            if (!own.participant) return;
            if (reader.has_truth()) zone.add(own.true_motion_mm);
            if (keep_true_fields) cast.true_fields.add(own.participant->id, std::move(own.true_field_mm));
            cast.participants.push_back(std::move(*own.participant));
        });
    if (!reader.has_truth()) {
        cast.zone = active_zone_from_catalogue(expression, average, catalogue);
    } else if (!cast.participants.empty()) {
        cast.zone = zone.zone(expression);
        add_zones_of_units(cast.zone, reader, catalogue, performances, failures);
    }
    return cast;
}

}  // namespace mimik::evaluation
