#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/active_zone.h"
#include "evaluation/method.h"
#include "evaluation/performance.h"
#include "facs/facs_catalogue.h"
#include "modeling/expression_model.h"

namespace mimik::evaluation {

/// For each method the first one that models alike (default and mean do): they share their models.
[[nodiscard]] std::vector<std::size_t> models_shared_by(std::span<const Method> methods);

/// One who shows an expression: source and target in turn. A few kB of points per method.
struct Participant {
    database::ScanId id;
    std::vector<std::optional<modeling::ExpressionModel>> models;  ///< per method; those of models_shared_by() only
};

/// The true fields of the participants. The first ones are held, up to `bytes`; the rest is read again whenever it is
/// asked for.
class TrueFields {
public:
    using Field = std::vector<geometry::Vector>;
    explicit TrueFields(const PerformanceReader& reader, std::size_t bytes = std::size_t{128} << 20);

    void add(const database::ScanId& expressive, Field field);  ///< in the order of the participants
    /// Of participant k. From any thread, after the last add(). @throws InputError naming the file.
    [[nodiscard]] std::shared_ptr<const Field> of(std::size_t k) const;
    [[nodiscard]] std::size_t held() const { return held_.size(); }

private:
    const PerformanceReader& reader_;
    std::size_t room_;
    std::vector<std::shared_ptr<const Field>> held_;
    std::vector<database::ScanId> ids_;
};

/// All who show one expression, and what is the same for all their cases.
struct ExpressionCast {
    std::string expression;
    std::vector<Participant> participants;
    ActiveZone zone;
    TrueFields true_fields;  ///< parallel to `participants`; empty without a truth, or where they are not wanted
};

/// Reads `performances` a few at a time, measures their models and the zone. With a truth, an expression of several AUs
/// (an emotion) has the union of its own zone and of its AUs': of each the true one over the same subjects' scans of
/// that AU alone, or the one that the catalogue draws where nobody shows it. Who cannot be read takes no part, who
/// cannot be measured is no source of that method; both are added to `failures`.
[[nodiscard]] ExpressionCast gather_cast(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                         const std::string& expression, std::span<const database::ScanId> performances,
                                         std::span<const Method> methods, bool keep_true_fields, FailureList& failures);

}  // namespace mimik::evaluation
