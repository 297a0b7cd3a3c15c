#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/folder_lock.h"
#include "database/scan_id.h"
#include "facs/expression.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::preprocessing {

class KeptRegistrations;

/// What workspace.json says.
struct WorkspaceList {
    std::filesystem::path database_root;
    bool made_with_truth = false;
    std::vector<database::ScanId> scans;  ///< sorted
    std::vector<std::string> hidden_subjects;
};
/// `name` stands for the file. @throws InputError naming file, field and value.
[[nodiscard]] WorkspaceList decode_workspace(std::string_view text, const std::string& name);

/// What an earlier run left in a folder: of a finished workspace, or of one that a later run was stopped in. Empty if
/// there is none, or it is damaged.
[[nodiscard]] std::optional<WorkspaceList> earlier_list(const std::filesystem::path& root);

/// A folder of preprocessed faces:
///   workspace.json               database, whether it has a truth, options, list of faces, hidden subjects (schema 1)
///   average/average_face.{ply,json}
///   faces/bs000/bs000_N_N_0.{ply,json}
///   registered/bs000/bs000_N_N_0.{ply,json}   the template on that face, made when somebody needs it
///   unallowed_subjects.txt       the hidden subjects, so that a bare file of the workspace is refused too; if any
/// A subject is hidden if it was hidden when the workspace was made, or stands now in a list of the workspace's or the
/// database's (database::hidden_subjects_of), if that folder is still there.
class Workspace {
public:
    /// Keeps other processes from writing the folder as long as it lives.
    /// @throws InputError if the folder is no finished workspace, or another process is writing it.
    explicit Workspace(std::filesystem::path root);

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] const std::filesystem::path& database_root() const { return list_.database_root; }
    /// Whether the database had a truth (truth/truth.json) when the workspace was made.
    [[nodiscard]] bool made_with_truth() const { return list_.made_with_truth; }
    [[nodiscard]] const AverageFace& average() const { return average_; }
    /// The average face's template on the faces of this workspace.
    [[nodiscard]] const std::shared_ptr<const KeptRegistrations>& registrations() const { return registrations_; }
    [[nodiscard]] const std::vector<database::ScanId>& scans() const { return list_.scans; }
    [[nodiscard]] std::vector<std::string> subjects() const;
    [[nodiscard]] std::vector<std::string> shown_subjects() const;  ///< those who may be shown
    [[nodiscard]] bool hidden(const std::string& subject) const;
    /// @throws InputError if the subject must not be shown.
    void refuse_hidden(const std::string& subject) const;
    [[nodiscard]] bool has(const database::ScanId& id) const;
    /// First neutral of a subject. @throws InputError naming the subjects there are.
    [[nodiscard]] database::ScanId neutral(const std::string& subject) const;
    /// First scan of an expression of a subject; empty if there is none.
    [[nodiscard]] std::optional<database::ScanId> scan_of(const std::string& subject,
                                                          const facs::Expression& expression) const;
    [[nodiscard]] Face face(const database::ScanId& id) const;  ///< read from disk
    /// Path of a face's files without .ply, .json, .done.
    [[nodiscard]] std::filesystem::path stem(const database::ScanId& id) const;

private:
    std::filesystem::path root_;
    std::shared_ptr<const base::FolderLock> lock_;
    WorkspaceList list_;
    AverageFace average_;
    std::shared_ptr<const KeptRegistrations> registrations_;
};

/// Deletes what a run that was killed left half written. For who holds the folder's lock for writing.
void remove_leftovers(const std::filesystem::path& root);

/// Deletes the quality sheets of subjects who must not be shown any more.
void remove_sheets_of_hidden(const Workspace& workspace);

}  // namespace mimik::preprocessing
