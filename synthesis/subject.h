#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/fields.h"
#include "synthesis/face_model.h"
#include "synthesis/posed_expression.h"

namespace mimik::synthesis {

/// How much people differ, and how much one person differs from one performance to the next. The defaults are the
/// variances of the database on which the project's figures were measured; a score means nothing without them. Every
/// draw is clipped at 2 standard deviations (8 % less variance), and no weight exceeds 1.2: beyond, the factors
/// multiply to motions that no face makes.
struct VarianceOptions {
    double identity = 1.0;           ///< standard deviations of every identity mode; 0: everybody has the mean face
    double amplitude_person = 0.10;  ///< log-normal factor on all of a person's expressions
    double amplitude_performance = 0.15;  ///< log-normal factor per scan
    double shape = 0.05;                  ///< log-normal factor per main shape and scan
    double asymmetry_person = 0.06;       ///< left x (1 + a), right x (1 - a): the person's share of a
    double asymmetry_performance = 0.06;  ///< the scan's share of a
    double co_activation = 1.0;           ///< scales the mean weight of co-activated shapes (6-20 %)
    double co_activation_spread = 1.0;    ///< scales their standard deviation (6-12 %)
    double size_coupling = 0.70;          ///< share of a face's size that its motion follows: mouth width for the lower
                                          ///< face, distance of the outer eye corners for the upper face
    double field_length_mm = 35.0;        ///< correlation length of a smooth random change of the displacement field
    double field_magnitude = 0.15;        ///< standard deviation of the factor on the magnitude
    double field_direction_deg = 7.0;     ///< root mean square turn of the direction
    double micro_expression = 0.015;      ///< standard deviation of the weight of every shape, in neutral scans too

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("identity", self.identity);
        visit("amplitude_person", self.amplitude_person);
        visit("amplitude_performance", self.amplitude_performance);
        visit("shape", self.shape);
        visit("asymmetry_person", self.asymmetry_person);
        visit("asymmetry_performance", self.asymmetry_performance);
        visit("co_activation", self.co_activation);
        visit("co_activation_spread", self.co_activation_spread);
        visit("size_coupling", self.size_coupling);
        visit("field_length_mm", self.field_length_mm);
        visit("field_magnitude", self.field_magnitude);
        visit("field_direction_deg", self.field_direction_deg);
        visit("micro_expression", self.micro_expression);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<VarianceOptions>());

/// A person: the resting face, how they move, and the model's shapes on their face.
struct Subject {
    std::string name;  ///< "bs003"
    Identity identity;
    std::vector<geometry::Point> resting_mm;  ///< head frame; no micro-expression
    double amplitude = 1.0;
    double asymmetry = 0.0;
    double mouth_width_ratio = 1.0;                                     ///< to the model's mean face
    double eye_distance_ratio = 1.0;                                    ///< outer corners, to the model's mean face
    const FaceModel* model = nullptr;                                   ///< drawn from it; must outlive the subject
    std::vector<std::string> shapes;                                    ///< sorted
    std::vector<std::vector<geometry::Vector>> shape_displacements_mm;  ///< at full strength, parallel to `shapes`
};

/// The same name and seed give the same person, whoever else is drawn.
[[nodiscard]] Subject draw_subject(const FaceModel& model, const std::string& name, std::uint64_t seed,
                                   const VarianceOptions& options = {});

/// One expression as one person did it once.
struct PosedFace {
    std::vector<geometry::Point> vertices_mm;       ///< head frame
    std::vector<geometry::Vector> displacement_mm;  ///< from the person's resting face; micro-expression included
    std::map<std::string, double> weights;          ///< shape -> weight after all factors; without micro-expressions
    double amplitude = 1.0;                         ///< person x performance
    double asymmetry = 0.0;                         ///< person + performance
};

/// `expression` with group "N" gives the neutral face with its micro-expression. `scan_name` ("bs003_LFAU_12_0") names
/// the streams of chance. @throws InputError if the model lacks a main shape.
[[nodiscard]] PosedFace perform(const Subject& subject, const PosedExpression& expression, const std::string& scan_name,
                                std::uint64_t seed, const VarianceOptions& options = {});

}  // namespace mimik::synthesis
