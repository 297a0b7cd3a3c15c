#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "database/truth.h"
#include "modeling/performance.h"
#include "preprocessing/workspace.h"

namespace mimik::evaluation {

/// What a database with a truth can be made again from, as truth.json has it: which random numbers and faces, who and
/// what, how far those spread, and how they were scanned and marked.
struct TruthOrigin {
    std::uint64_t seed = 0;
    std::string face_model, expressions;
    std::size_t subjects = 0;
    int neutrals = 0;     ///< scans of each subject at rest
    bool repeat = false;  ///< a second scan of each expression
    std::map<std::string, double> variances, scanner;
};

/// Two scans of one subject that should be the same.
struct ScanTwice {
    preprocessing::Face first, second;
    geometry::Transform first_from_second = geometry::Transform::Identity();  ///< the scans' scanner frames
};

/// Reads performances from a workspace, and their truth from its database if that has one. An experiment reads a face
/// when somebody needs it and drops it afterwards: memory does not grow with the database. From any thread.
class PerformanceReader {
public:
    /// @throws InputError if the database had a truth when the workspace was made, and has none now: other zones and
    /// another alignment would change every score without a word.
    explicit PerformanceReader(const preprocessing::Workspace& workspace);

    [[nodiscard]] const preprocessing::Workspace& workspace() const { return workspace_; }
    [[nodiscard]] bool has_truth() const { return truth_.has_value(); }
    [[nodiscard]] std::optional<TruthOrigin> truth_origin() const;
    /// @throws InputError if the subject cannot take part: face, truth or landmark spline to the average are amiss.
    /// @return which landmarks have no partner on the average face, so that no spline between the two has them; empty:
    /// all have one
    std::string check_neutral(const std::string& subject) const;
    /// True displacements are from the neutral as it was, its micro-expression included, not from a face at rest. The
    /// two scans are brought together by the true pose where it is known, else as preprocessing aligned them.
    /// @throws InputError naming the file.
    [[nodiscard]] modeling::Performance read(const database::ScanId& expressive) const;
    /// A scan and the next one of the same subject and expression, or of the same subject at rest; brought together as
    /// those of a performance. Empty if there is none. @throws InputError naming the file.
    [[nodiscard]] std::optional<ScanTwice> second_scan(const database::ScanId& first) const;

private:
    [[nodiscard]] database::TrueScan true_expression(const database::ScanId& expressive,
                                                     const database::TrueScan& neutral) const;

    const preprocessing::Workspace& workspace_;
    std::optional<database::Truth> truth_;
};

/// What gave no answer, told by any thread.
class FailureList {
public:
    void add(std::string what);
    [[nodiscard]] std::vector<std::string> sorted() const;

private:
    mutable std::mutex mutex_;
    std::vector<std::string> failures_;
};

}  // namespace mimik::evaluation
