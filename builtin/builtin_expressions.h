#pragma once

#include <cstdint>
#include <memory>

#include "base/fields.h"
#include "facs/facs_catalogue.h"
#include "modeling/expression_model.h"
#include "preprocessing/average_face.h"

namespace mimik::builtin {

struct BuiltinExpressionOptions {
    int people = 6;          ///< who show the expressions; a mean of one would be one person's manner
    std::uint64_t seed = 1;  ///< they are drawn from
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("people", self.people);
        visit("seed", self.seed);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<BuiltinExpressionOptions>());

/// The average face and the expressions that come with Mimik, for whoever has a mesh and no database of scans: people
/// of the procedural face model (synthesis/face_model.h) show them. Their skin is followed by its own vertices, so
/// neither scanner nor registration blurs the motion. Made in memory within some seconds; same options, same
/// numbers, whatever the number of threads.
class BuiltinExpressions {
public:
    explicit BuiltinExpressions(const BuiltinExpressionOptions& options = {});
    ~BuiltinExpressions();

    [[nodiscard]] const preprocessing::AverageFace& average() const;
    /// The mean of all people: an Action Unit alone, without what untrained people move beside it.
    /// @param options  with place_on_average: a mean has no face of its own
    /// @throws InputError naming the codes there are if the people cannot show the expression.
    [[nodiscard]] modeling::ExpressionModel model(const facs::FacsCatalogue& catalogue,
                                                  const facs::Expression& expression,
                                                  const modeling::ModelOptions& options = {}) const;
    /// Whether they can.
    [[nodiscard]] bool shows(const facs::Expression& expression) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mimik::builtin
