#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "animation/prepared_target.h"
#include "facs/facs_catalogue.h"
#include "geometry/face_surface.h"
#include "modeling/performance.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face_template.h"

namespace mimik::animation {

/// An expression that was learned, put on a face: a motion of its neutral surface at magnitude 1. From any thread.
class Transfer {
public:
    virtual ~Transfer() = default;
    /// @throws InputError, NumericalError if there is no answer for this face.
    [[nodiscard]] virtual geometry::DisplacementField on(const PreparedTarget& target) const = 0;
    /// Per vertex of the target, on which lip it lies, so that who draws the face can leave out the surface between
    /// lips that part (torn_faces); empty: not known. @throws as on().
    [[nodiscard]] virtual std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget&) const { return {}; }
};

/// What a method keeps of one performance: small, since an experiment holds those of all its subjects.
class Lesson {
public:
    virtual ~Lesson() = default;
    [[nodiscard]] virtual std::size_t bytes() const = 0;  ///< about how much memory it takes
};

using LessonPointer = std::shared_ptr<const Lesson>;

/// A method at work on one expression. From any thread.
class Learner {
public:
    virtual ~Learner() = default;
    /// @throws InputError, NumericalError if nothing can be learned from this performance.
    [[nodiscard]] virtual LessonPointer study(const modeling::Performance& performance) const = 0;
    /// @param lessons  of study(), kept as long as needed; one where the method needs one source, none where it needs
    /// none.
    [[nodiscard]] virtual std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const = 0;
};

/// Whose performances a method learns from, beside the target's neutral face.
enum class SourceKind {
    none,           ///< nobody's
    one_source,     ///< one other subject's
    all_but_target  ///< every subject's but the target's
};
[[nodiscard]] const char* to_string(SourceKind kind);  ///< "none", "one source", "mean"

/// Why somebody takes a method: what lists of methods are ordered by.
enum class MethodGroup {
    usual,      ///< those to animate faces with
    thesis,     ///< the thesis, and single steps from it to the usual ones
    published,  ///< other authors' methods
    simple,     ///< what every method has to beat
    bound       ///< looks at the truth of a synthetic database
};

/// What everybody who learns an expression shares. References.
struct LearningTask {
    const facs::Expression& expression;
    const preprocessing::AverageFace& average;
    const facs::FacsCatalogue& catalogue;
    /// The average face's template on faces, for those who follow every vertex; none: each makes them anew.
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations = nullptr;
};

/// How an expression of some is put on the face of another. A new one is one file: docs/algorithms/methods.md.
class Method {
public:
    virtual ~Method() = default;
    [[nodiscard]] virtual std::string name() const = 0;                 ///< as it is typed: letters, digits, '-'
    [[nodiscard]] virtual std::string title() const { return name(); }  ///< as tables print it
    /// What it does, in one sentence, for those who choose one.
    [[nodiscard]] virtual std::string summary() const { return title(); }
    [[nodiscard]] virtual MethodGroup group() const { return MethodGroup::usual; }
    [[nodiscard]] virtual SourceKind needs() const = 0;
    /// Whether it looks at the truth of a synthetic database: a bound for the others, no method for real scans.
    [[nodiscard]] virtual bool needs_truth() const { return false; }
    /// Methods with equal keys take the same lessons, which are then studied once for all of them, by the learner of
    /// one; each makes its own transfer of them.
    [[nodiscard]] virtual std::string lessons_key() const { return name(); }
    /// @throws InputError if the expression cannot be learned at all.
    [[nodiscard]] virtual std::unique_ptr<const Learner> learner(const LearningTask& task) const = 0;
};

/// All at once, for who has a few performances: study each, then learn.
[[nodiscard]] std::unique_ptr<const Transfer> learn(const Method& method, const LearningTask& task,
                                                    std::span<const modeling::Performance> performances);

/// What a transfer says of a face, made safe for everything behind it: a vertex without an answer stays where it is.
/// @throws as Transfer::on; InputError if there are not as many displacements and answers as vertices; NumericalError
/// if an answer is not finite.
[[nodiscard]] geometry::DisplacementField field_on(const Transfer& transfer, const PreparedTarget& target);

/// Anybody's mesh, moved by what a method learned: its own vertices, faces, texture and attributes.
/// @param landmarks  on the mesh, our names, in its frame: +x the subject's left, +y up, +z out of the face, mm.
/// @param magnitude  0 (neutral) or more, as for models
/// @throws as field_on; InputError if the mesh has no face, a landmark is missing or the magnitude is below 0.
[[nodiscard]] geometry::Mesh animate_mesh(const geometry::Mesh& mesh, const geometry::Landmarks& landmarks,
                                          const preprocessing::AverageFace& average, const Transfer& transfer,
                                          double magnitude = 1.0);

using MethodPointer = std::shared_ptr<const Method>;
[[nodiscard]] inline std::string to_string(const MethodPointer& method) { return method->name(); }

/// The methods of animation/methods/, by name.
[[nodiscard]] std::vector<MethodPointer> known_methods();
/// @throws InputError listing the names there are.
[[nodiscard]] MethodPointer method_by_name(const std::string& name);

}  // namespace mimik::animation
