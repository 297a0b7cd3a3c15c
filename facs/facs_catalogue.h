#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "facs/expression.h"
#include "facs/placement.h"

namespace mimik::facs {

enum class ControlKind {
    muscle,    ///< on the muscle that the AU names (thesis 5.5.1)
    carried,   ///< lids, lips, cheeks: what the muscle takes along, without lying there
    wrinkle,   ///< where skin folds or bulges (thesis 5.5.2)
    coverage,  ///< fills the AU's zone evenly
    anchor     ///< holds still
};
[[nodiscard]] std::string_view to_string(ControlKind kind);
[[nodiscard]] ControlKind parse_control_kind(const std::string& text);  ///< throws InputError

struct CataloguePoint {
    std::string name;
    ControlKind kind = ControlKind::muscle;
    Placement placement;
};

struct ZoneEllipse {
    Placement centre;
    double lateral_radius = 0.0, up_radius = 0.0;  ///< outer-eye distances
};

struct Muscle {
    std::string name;
    std::string source;     ///< where it comes from, where it goes, what it pulls
    std::string reference;  ///< where its part in the AU and its course were published
};

struct ActionUnit {
    int number = 0;
    std::string name;
    bool lower_face = true;
    bool central = false;  ///< moves both sides at once; cannot be one-sided
    std::vector<Muscle> muscles;
    std::string wrinkles;
    std::string arkit;        ///< ARKit blendshape of one half, without its "Left" or "Right"; empty: none
    std::string arkit_whole;  ///< ARKit blendshape of both halves at once; empty: none
    std::vector<ZoneEllipse> zone;
    std::vector<CataloguePoint> points;
};

/// Lengths in outer-eye distances.
struct Sampling {
    double coverage_spacing = 0.100;
    double anchor_spacing = 0.20;
    double anchor_margin = 0.07;
    double min_separation = 0.035;
};

struct Emotion {
    std::string name;               ///< "HAPPY"
    std::vector<int> action_units;  ///< of the prototype
    std::string set = "emfacs";     ///< to which list of prototypes it belongs: "emfacs", "thesis" (its Table 3-3)
};
inline constexpr const char* usual_emotion_set = "emfacs";

/// One AU on one side or both: what an expression is made of.
struct SidedUnit {
    const ActionUnit* unit = nullptr;
    facs::Side side = facs::Side::both;
};

class FacsCatalogue {
public:
    FacsCatalogue(Sampling sampling, std::vector<ActionUnit> units, std::vector<Emotion> emotions,
                  std::string name = {}, std::string content_hash = {});

    [[nodiscard]] const std::string& name() const { return name_; }  ///< its file, or "built-in catalogue"
    [[nodiscard]] const std::string& content_hash() const { return content_hash_; }  ///< of its text
    [[nodiscard]] const Sampling& sampling() const { return sampling_; }
    [[nodiscard]] const std::vector<ActionUnit>& action_units() const { return units_; }
    [[nodiscard]] const std::vector<Emotion>& emotions() const { return emotions_; }  ///< of the chosen set
    [[nodiscard]] const std::vector<Emotion>& all_emotions() const { return all_emotions_; }
    /// The same with the prototypes of another set. @throws InputError listing the sets there are.
    [[nodiscard]] FacsCatalogue with_emotions(const std::string& set) const;
    [[nodiscard]] const ActionUnit* find(int number) const;
    /// The expression that a text names, in every way in which Mimik reads or writes one: "12", "AU12", "LFAU_12",
    /// "12l", "AU12_L", "12LW" (low intensity), "AU12+AU15", "happy", "joy". An emotion comes with its units.
    /// @throws InputError if it is not in the catalogue, listing what there is.
    [[nodiscard]] Expression expression(const std::string& text) const;
    /// The same; empty if it is not in the catalogue.
    [[nodiscard]] std::optional<Expression> find_expression(const std::string& text) const;
    /// Whether units() names some, and no unit that moves both sides at once is asked for on one.
    [[nodiscard]] bool knows(const Expression& expression) const;
    /// What the catalogue knows of an expression's units; of an emotion, of its prototype's. A database's own word that
    /// the catalogue lacks has none: nobody knows where it moves the face, so it is looked for everywhere.
    /// @throws InputError naming a unit or an emotion that is not in the catalogue.
    [[nodiscard]] std::vector<SidedUnit> units(const Expression& expression) const;

private:
    Sampling sampling_;
    std::vector<ActionUnit> units_;
    std::vector<Emotion> emotions_, all_emotions_;
    std::string name_, content_hash_;
};

/// The ARKit blendshape of an expression: "12L" -> "mouthSmileLeft", "17" -> "mouthShrugLower"; empty without one,
/// for both sides of a paired AU (ARKit has none for both), or for low intensity (a blendshape is the full motion).
[[nodiscard]] std::string arkit_shape(const FacsCatalogue& catalogue, const Expression& expression);
/// The same, and the expression's own name where there is none: "AU12".
[[nodiscard]] std::string arkit_name(const FacsCatalogue& catalogue, const Expression& expression);

/// The catalogue that Mimik ships (facs/facs.toml, embedded).
[[nodiscard]] const FacsCatalogue& builtin_catalogue();
[[nodiscard]] std::string_view builtin_catalogue_text();
/// The same with the points that 'mimik tune' found for the thesis method (facs/facs_thesis.toml, embedded).
[[nodiscard]] const FacsCatalogue& thesis_catalogue();
[[nodiscard]] std::string_view thesis_catalogue_text();

/// What the linter found, one line each: "facs.toml:12: error: ...".
struct LintFinding {
    bool error = false;
    unsigned line = 0;
    std::string what;
};
/// Every fault of a catalogue: unknown keys and landmarks, weights that do not add up to 1, missing fields, AUs without
/// a muscle point or zone, names used twice, points that fall together or off the reference face, lists out of range,
/// landmarks of one side, muscles without a published reference, blendshapes that ARKit does not have.
[[nodiscard]] std::vector<LintFinding> lint_catalogue(const std::string& text);
/// @throws InputError with the first errors, each with file and line.
[[nodiscard]] FacsCatalogue read_catalogue(const std::filesystem::path& file);
[[nodiscard]] FacsCatalogue parse_catalogue(const std::string& text, const std::string& name);

/// "12", "12:0.5", "AU4_L", "HAPPY:0.8"; or a file in place of the expression.
struct TypedMagnitude {
    std::string text;  ///< what stands before the magnitude
    double magnitude = 1.0;
};
[[nodiscard]] TypedMagnitude split_magnitude(const std::string& typed);  ///< throws InputError

}  // namespace mimik::facs
