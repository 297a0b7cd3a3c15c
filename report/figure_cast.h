#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/fields.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/workspace.h"
#include "report/compared_people.h"
#include "report/hole_drawing.h"

namespace mimik::report {

struct NamedFigureOptions {
    std::string source;  ///< whose expressions are taken; empty: who was scanned with most of the thesis's AUs
    std::string female;  ///< the female target; empty: the first woman who is not the source
    std::string male;    ///< the male target, likewise
    std::string method = "default";  ///< that makes a model of control points, of one source
    HoleDrawing holes = HoleDrawing::fill;
    double error_scale_mm = 5.0;  ///< upper end of the colours of error maps: the same in all, so they can be compared
    std::string rows_file;        ///< rows.csv of an experiment, for the plots of its numbers; empty: none

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("source", self.source);
        visit("female", self.female);
        visit("male", self.male);
        visit("method", self.method);
        visit("holes", self.holes);
        visit("error_scale_mm", self.error_scale_mm);
        visit("rows_file", self.rows_file);
    }
    void check() const;  ///< throws InputError naming the field and the value
};
static_assert(base::lists_every_field<NamedFigureOptions>());

/// One figure's people, of which the thesis shows the source and one target.
struct ShownPair {
    std::shared_ptr<const ComparedPeople> people;
    const ShownPerson* source = nullptr;  ///< the same as target where they are one
    const ShownPerson* target = nullptr;
};

/// Who stands in the figures of a workspace: a source, a woman and a man as targets. What one figure has had animated,
/// the next one takes. From any thread.
class FigureCast {
public:
    /// Keeps references. @throws InputError for bad options, a subject that is not there or must not be shown, or if
    /// the workspace has fewer than two subjects that may be shown.
    FigureCast(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
               NamedFigureOptions options);

    [[nodiscard]] const preprocessing::Workspace& workspace() const { return workspace_; }
    [[nodiscard]] const facs::FacsCatalogue& catalogue() const { return catalogue_; }
    [[nodiscard]] const NamedFigureOptions& options() const { return options_; }
    [[nodiscard]] const std::string& source() const { return options_.source; }
    [[nodiscard]] const std::string& female() const { return options_.female; }
    [[nodiscard]] const std::string& male() const { return options_.male; }
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }  ///< who was chosen, and why

    /// "12L". @throws InputError if the catalogue lacks it.
    [[nodiscard]] facs::Expression expression(const std::string& code) const;
    /// The source, or, where it was not asked for by name and was not scanned with the expression, the first who was
    /// and is no target. @throws InputError if there is nobody.
    [[nodiscard]] std::string source_of(const facs::Expression& expression) const;
    /// Everybody who can be a source of an expression, the one of source_of() first, no target.
    [[nodiscard]] std::vector<std::string> sources_of(const facs::Expression& expression) const;

    /// The request of the usual method.
    [[nodiscard]] ComparisonRequest request(const std::string& source, const std::string& target,
                                            const facs::Expression& expression) const;
    /// Carried out, or taken from an earlier figure. @throws as compare_people.
    [[nodiscard]] ShownPair compared(const ComparisonRequest& request) const;
    [[nodiscard]] preprocessing::Face neutral(const std::string& subject) const;
    /// The scan of a subject with an expression. @throws InputError if there is none.
    [[nodiscard]] preprocessing::Face scan(const std::string& subject, const facs::Expression& expression) const;

    /// "bs001", with its sex where it is known: "bs001, female".
    [[nodiscard]] std::string words(const std::string& subject) const;
    /// "AU4 Brow Lowerer"
    [[nodiscard]] std::string words(const facs::Expression& expression) const;
    /// "synthetic scan" of faces that nobody has, as far as it is known; else "scan": whether a database holds people
    /// or a modeller's heads, its files do not say, so no figure calls them real.
    [[nodiscard]] std::string scan_words() const { return workspace_.made_with_truth() ? "synthetic scan" : "scan"; }
    /// The same, where a caption begins.
    [[nodiscard]] std::string scan_title() const { return workspace_.made_with_truth() ? "Synthetic scan" : "Scan"; }

private:
    void choose_people();
    void choose_target(std::string& target, const std::string& sex, const std::string& other);

    const preprocessing::Workspace& workspace_;
    const facs::FacsCatalogue& catalogue_;
    NamedFigureOptions options_;
    bool source_was_given_ = false;
    std::map<std::string, std::string> sex_;  ///< by subject
    std::vector<std::string> remarks_;
    mutable std::mutex mutex_;
    mutable std::map<std::string, std::shared_ptr<const ComparedPeople>> compared_;
};

/// The AUs of the thesis (5.5.1), and its AU 12 on the left side alone.
[[nodiscard]] const std::vector<std::string>& thesis_codes();

}  // namespace mimik::report
