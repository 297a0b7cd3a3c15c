#include "preprocessing/workspace.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "preprocessing/kept_registrations.h"
#include "preprocessing/workspace_json.h"
#include "preprocessing/workspace_layout.h"

namespace mimik::preprocessing {

using database::ScanId;
namespace fs = std::filesystem;

WorkspaceList decode_workspace(std::string_view text, const std::string& name) {
    return io::read_json_document(text, name, damaged_file_mend, [](const nlohmann::json& document) {
        WorkspaceList list;
        list.database_root = io::read_field<std::string>(document, "database");
        list.made_with_truth = document.contains("truth") && io::read_field<bool>(document, "truth");
        list.hidden_subjects = io::read_field<std::vector<std::string>>(document, "hidden_subjects");
        io::read_list(document, "scans", [&](const nlohmann::json& entry) {
            list.scans.push_back(database::scan_id_from(entry.get<std::string>()));
        });
        std::sort(list.scans.begin(), list.scans.end());
        return list;
    });
}

std::optional<WorkspaceList> earlier_list(const fs::path& root) {
    for (const auto& file : {list_file(root), list_file_before(root)}) {
        if (!base::is_there(file)) continue;
        try {
            return decode_workspace(base::read_text(file, io::most_json_bytes), file.string());
        } catch (const InputError&) {
            return std::nullopt;  // this run writes another
        }
    }
    return std::nullopt;
}

Workspace::Workspace(fs::path root) : root_(std::move(root)) {
    const auto file = list_file(root_);
    if (base::is_there(root_) && fs::is_directory(root_))
        lock_ = std::make_shared<base::FolderLock>(root_, base::FolderLock::Use::read);
    if (!fs::exists(file))
        throw InputError(
            fmt::format("{}: no finished workspace there; make or finish one with 'mimik preprocess DB -o {}'",
                        root_.string(), root_.string()));
    list_ = decode_workspace(base::read_text(file, io::most_json_bytes), file.string());
    // Who asked to be hidden since then is hidden at once, not from the next preprocessing on.
    for (const auto& folder : {list_.database_root, root_})
        for (auto& subject : database::hidden_subjects_of(folder, subjects(), database::KnownSubjects::some).subjects)
            if (!hidden(subject)) list_.hidden_subjects.push_back(std::move(subject));
    average_ = read_average_face(average_stem(root_));
    registrations_ = std::make_shared<const KeptRegistrations>(average_, registered_folder(root_));
}

std::vector<std::string> Workspace::subjects() const {
    std::set<std::string> names;
    for (const auto& id : list_.scans) names.insert(id.subject);
    return {names.begin(), names.end()};
}

std::vector<std::string> Workspace::shown_subjects() const {
    auto shown = subjects();
    std::erase_if(shown, [&](const std::string& subject) { return hidden(subject); });
    return shown;
}

bool Workspace::hidden(const std::string& subject) const { return database::is_hidden(list_.hidden_subjects, subject); }

void Workspace::refuse_hidden(const std::string& subject) const {
    if (hidden(subject))
        throw InputError(
            fmt::format("subject '{}' stands in unallowed_subjects.txt and must not be shown; choose "
                        "another",
                        subject));
}

bool Workspace::has(const ScanId& id) const { return std::binary_search(list_.scans.begin(), list_.scans.end(), id); }

ScanId Workspace::neutral(const std::string& subject) const {
    for (const auto& id : list_.scans)
        if (id.subject == subject && id.neutral()) return id;
    throw InputError(fmt::format("{}: subject '{}' has no neutral face there; there are: {}", root_.string(), subject,
                                 fmt::join(subjects(), ", ")));
}

std::optional<ScanId> Workspace::scan_of(const std::string& subject, const facs::Expression& expression) const {
    for (const auto& id : list_.scans)
        if (id.subject == subject && !id.neutral() && base::equal_ignoring_case(id.code, expression.code())) return id;
    return std::nullopt;
}

Face Workspace::face(const ScanId& id) const {
    auto face = read_face(stem(id));
    const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("{}.json: {}; run 'mimik preprocess' again", stem(id).string(), what));
    };
    if (face.id != id) refuse(fmt::format("scan is {}", base::in_quotes(face.id.name())));
    // A workspace that came from elsewhere shall not reach other files.
    if (const auto& texture = face.texture_file; !texture.empty() && texture != stem(id).string() + ".png" &&
                                                 !lies_in(texture.lexically_normal(), database_root()))
        refuse(fmt::format("texture_file {} does not lie in the database {}", base::in_quotes(texture.string()),
                           database_root().string()));
    return face;
}

fs::path Workspace::stem(const ScanId& id) const { return face_stem(root_, id); }

namespace {

/// Named by base::write_atomically, today or in earlier versions: ".mimik-<something>.part",
/// "face.ply.<something>.part".
bool half_written(const fs::path& file) {
    const auto name = file.filename().string();
    if (!name.ends_with(".part")) return false;
    if (name.starts_with(".mimik-")) return true;
    return std::any_of(std::begin(written_suffixes), std::end(written_suffixes),
                       [&](const std::string& suffix) { return name.find(suffix + ".") != std::string::npos; });
}

void remove_half_written(const fs::path& folder) {
    std::error_code error, ignored;
    std::vector<fs::path> files;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (it->is_regular_file(ignored) && !it->is_symlink(ignored) && half_written(it->path()))
            files.push_back(it->path());
    for (const auto& file : files) fs::remove(file, ignored);
}

}  // namespace

void remove_leftovers(const fs::path& root) {
    for (const auto& folder : {root, average_stem(root).parent_path(), sheets_folder(root)})
        remove_half_written(folder);
    for (const auto& tree : {faces_folder(root), registered_folder(root), root / "models"}) {
        std::error_code error;
        std::vector<fs::path> folders = {tree};
        for (fs::recursive_directory_iterator it(tree, error), end; !error && it != end; it.increment(error))
            if (it->is_directory(error) && !it->is_symlink(error)) folders.push_back(it->path());
        for (const auto& folder : folders) remove_half_written(folder);
    }
}

void remove_sheets_of_hidden(const Workspace& workspace) {
    std::error_code ignored;
    const auto folder = sheets_folder(workspace.root());
    std::vector<fs::path> sheets;  // also of subjects that this workspace has no scan of any more
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (workspace.hidden(entry.path().stem().string())) sheets.push_back(entry.path().stem());
    for (const auto& sheet : sheets)
        for (const char* suffix : sheet_suffixes) fs::remove_all(folder / (sheet.string() + suffix), ignored);
}

}  // namespace mimik::preprocessing
