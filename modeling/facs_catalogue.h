#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "database/scan_id.h"

namespace mimik::modeling {

enum class ControlKind {
    muscle,    ///< where muscle fibres lie (thesis 5.5.1)
    wrinkle,   ///< where skin folds or bulges (thesis 5.5.2)
    coverage,  ///< fills the AU's zone evenly
    anchor     ///< holds still
};
[[nodiscard]] std::string_view to_string(ControlKind kind);
[[nodiscard]] ControlKind parse_control_kind(const std::string& text);  ///< throws InputError

/// A place relative to landmarks, written for the subject's left side: sum of weight * landmark, plus an offset in
/// outer-eye distances. A landmark name without a side ("mouth_corner") means that of the side asked for.
struct Placement {
    std::vector<std::pair<std::string, double>> at;
    double lateral = 0.0;  ///< away from the midline
    double up = 0.0;
};

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
};

/// One AU on one side or both: what an expression is made of.
struct SidedUnit {
    const ActionUnit* unit = nullptr;
    database::Side side = database::Side::both;
};

class FacsCatalogue {
public:
    FacsCatalogue(Sampling sampling, std::vector<ActionUnit> units, std::vector<Emotion> emotions,
                  std::string name = {}, std::string content_hash = {});

    [[nodiscard]] const std::string& name() const { return name_; }  ///< its file, or "built-in catalogue"
    [[nodiscard]] const std::string& content_hash() const { return content_hash_; }  ///< of its text
    [[nodiscard]] const Sampling& sampling() const { return sampling_; }
    [[nodiscard]] const std::vector<ActionUnit>& units() const { return units_; }
    [[nodiscard]] const std::vector<Emotion>& emotions() const { return emotions_; }
    [[nodiscard]] const ActionUnit* find(int number) const;
    /// The one way in which scans spell an expression, of every way that Mimik reads or writes: "12", "AU12", "LFAU_12"
    /// -> "12"; "12l", "AU12_L" -> "12L"; "12LW" (low intensity); "AU12+AU15" -> "A12A15"; "happy", "joy" -> "HAPPY".
    /// @throws InputError if it is not in the catalogue, listing what there is.
    [[nodiscard]] std::string code(const std::string& expression) const;
    /// The AUs and sides of an expression, spelt as for code(). @throws InputError as code().
    [[nodiscard]] std::vector<SidedUnit> resolve(const std::string& expression) const;

private:
    Sampling sampling_;
    std::vector<ActionUnit> units_;
    std::vector<Emotion> emotions_;
    std::string name_, content_hash_;
};

/// The ARKit blendshape of an expression: "12L" -> "mouthSmileLeft", "17" -> "mouthShrugLower"; empty without one,
/// for both sides of a paired AU (ARKit has none for both), or for low intensity (a blendshape is the full motion).
[[nodiscard]] std::string arkit_shape(const FacsCatalogue& catalogue, const std::string& expression);
/// The same, and Mimik's own name where there is none: "AU12".
[[nodiscard]] std::string arkit_name(const FacsCatalogue& catalogue, const std::string& expression);
/// Mimik's own name of an expression: "12" -> "AU12", "4L" -> "AU4_L", "12LW" -> "AU12_LW", "happy" -> "HAPPY",
/// "A12A15" -> "AU12+AU15". Other expressions have other names, and code() reads every name back.
[[nodiscard]] std::string expression_name(const FacsCatalogue& catalogue, const std::string& expression);

/// The catalogue that Mimik ships (modeling/facs.toml, embedded).
[[nodiscard]] const FacsCatalogue& builtin_catalogue();
[[nodiscard]] std::string_view builtin_catalogue_text();

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
struct Selection {
    std::string code;  ///< as typed; FacsCatalogue::code knows what it means
    double magnitude = 1.0;
};
[[nodiscard]] Selection parse_selection(const std::string& text);  ///< throws InputError

}  // namespace mimik::modeling
