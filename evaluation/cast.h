#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "animation/method.h"
#include "evaluation/active_zone.h"
#include "evaluation/performance.h"
#include "facs/facs_catalogue.h"

namespace mimik::evaluation {

/// What the methods have learned from every participant. Methods that take the same lessons share them; what a method
/// makes of its lessons is its own. The first ones are held, up to `bytes`; the rest is studied again whenever it is
/// asked for, and then a mean has the lessons of all its sources in memory at once.
class LessonBook {
public:
    /// References are kept, also to what `task` refers to.
    LessonBook(const PerformanceReader& reader, const animation::LearningTask& task,
               std::span<const animation::MethodPointer> methods, FailureList& failures,
               std::size_t bytes = std::size_t{256} << 20);

    /// What is learned from one performance, of every kind of lesson; from any thread. What fails is reported and stays
    /// empty.
    [[nodiscard]] std::vector<animation::LessonPointer> study(const modeling::Performance& performance) const;
    /// The lessons of the next participant, in the order of the participants.
    void add(const database::ScanId& expressive, std::vector<animation::LessonPointer> lessons);

    /// Whether this method can be learned at all; if not, that was reported.
    [[nodiscard]] bool can_learn(std::size_t method) const { return learners_[method] != nullptr; }
    [[nodiscard]] const animation::Learner& learner(std::size_t method) const { return *learners_[method]; }
    /// Of participant k for a method; empty if there is none. From any thread, after the last add().
    [[nodiscard]] animation::LessonPointer lesson(std::size_t method, std::size_t k) const;
    [[nodiscard]] std::size_t held() const { return held_.size(); }  ///< participants

private:
    const PerformanceReader& reader_;
    std::string expression_;
    FailureList& failures_;
    std::size_t room_;
    // One kind of lesson, and the first method that takes it.
    struct Kind {
        std::string key, first_name;
        const animation::Learner* student = nullptr;  // null: no method that takes it can be learned
        bool taken = false;                           // some method needs a source
    };
    std::vector<std::unique_ptr<const animation::Learner>> learners_;  // per method; null: it cannot be learned
    std::vector<Kind> kinds_;
    std::vector<std::size_t> kind_of_;                         // per method
    std::vector<std::vector<animation::LessonPointer>> held_;  // per participant, per kind
    std::vector<std::vector<char>> there_;                     // likewise, also of those that are not held
    std::vector<database::ScanId> ids_;
};

/// All who show one expression, and what is the same for all their cases.
struct Cast {
    facs::Expression expression;
    std::vector<database::ScanId> participants;  ///< the expressive scans: source and target in turn
    ActiveZone zone;
    LessonBook lessons;
    ZoneSource zone_from = ZoneSource::catalogue;  ///< its own zone, not those of an emotion's AUs
    /// What wrinkle points are looked up in.
    facs::FacsCatalogue catalogue = facs::builtin_catalogue();
    std::vector<std::string> remarks = {};  ///< zones that the catalogue draws because the data show too little
};

/// Below this the largest mean motion of an expression on the template makes no zone. Lids that close on built-in faces
/// reach 1.5 mm there (of 9 true ones), and their zone is the wrong one; brows and lips reach 4.5 mm and more.
inline constexpr double least_zone_motion_mm = 2.0;

/// Reads `performances` a few at a time, studies them and finds the zone. From truth or data, an expression of several
/// AUs (an emotion) has the union of its own zone and of its AUs': of each that over the same subjects' scans of that
/// AU alone, or the one that the catalogue draws where nobody shows it. From the data, the catalogue draws where the
/// mean motion stays below least_zone_motion_mm, too. Who cannot be read takes no part, who cannot be studied is no
/// source of that method; both are added to `failures`.
/// @throws InputError if zones from the truth are asked for, and there is none.
[[nodiscard]] Cast gather_cast(const PerformanceReader& reader, const animation::LearningTask& task,
                               std::span<const database::ScanId> performances,
                               std::span<const animation::MethodPointer> methods, FailureList& failures,
                               ZoneSource zones = ZoneSource::automatic);

}  // namespace mimik::evaluation
