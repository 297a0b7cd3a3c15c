#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "database/doctor.h"

namespace mimik::database {

/// Heads of these groups are turned or covered on purpose.
[[nodiscard]] inline bool posed_or_covered(const ScanId& id) {
    return id.group == "YR" || id.group == "PR" || id.group == "CR" || id.group == "O" || id.group == "IGN";
}

/// What the doctor's checks of one scan write into.
class Report {
public:
    explicit Report(std::string file) : file_(std::move(file)) {}
    /// `where` is the scan file unless another is named.
    void add(Severity severity, std::string kind, std::string what, std::string mend, std::string where = {}) {
        findings_.push_back(
            {severity, std::move(kind), std::move(what), where.empty() ? file_ : std::move(where), std::move(mend)});
    }
    [[nodiscard]] std::vector<Finding> finish() {  ///< worst first
        std::stable_sort(findings_.begin(), findings_.end(),
                         [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
        return std::move(findings_);
    }

private:
    std::string file_;
    std::vector<Finding> findings_;
};

/// True if the landmarks lie on the scan, whatever the unit of both: three quarters within a twentieth of the eyes'
/// distance. @param off_mm  of each landmark to the surface
[[nodiscard]] bool landmarks_lie_on_scan(const geometry::Landmarks& landmarks, std::span<const double> off_mm);

void check_unit(const LoadedScan& loaded, std::span<const double> off_mm, const DoctorOptions& options, Report& report);
void check_frame(const LoadedScan& loaded, std::span<const double> off_mm, Report& report);

}  // namespace mimik::database
