#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <istream>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/temporary.h"
#include "evaluation/case_row.h"

namespace mimik::evaluation {

/// The rows of an experiment on disk: a CSV that every table program reads. Units of work are appended whole, each
/// followed by a comment line with its name, the number of its rows and a checksum over them, so that a file that was
/// cut short or damaged is noticed and the units before the fault still count.
class CaseStore {
public:
    /// In a temporary file without a name, which goes with the store, or with the program.
    CaseStore();
    /// In `file`, begun anew. Until finish() it is a temporary beside it (base/temporary.h). @throws InputError if it
    /// cannot be written.
    explicit CaseStore(std::filesystem::path file);
    /// In a file that stays however the program ends, and is gone on with: the whole units that it holds count as
    /// stored, what follows them is cut off. finish() leaves it where it is.
    /// @throws InputError if it is there and no such file, or cannot be written.
    [[nodiscard]] static CaseStore gone_on_with(std::filesystem::path file);
    /// Of whole files of other stores, read one after another and never written. A unit that several files hold counts
    /// where it comes first. @throws InputError naming the file that is none, is damaged or torn, or holds other rows
    /// of a unit than an earlier one.
    [[nodiscard]] static CaseStore of_files(std::vector<std::filesystem::path> files);
    ~CaseStore();
    CaseStore(CaseStore&&) noexcept;
    CaseStore(const CaseStore&) = delete;
    CaseStore& operator=(const CaseStore&) = delete;

    /// @param unit  one line of text, not stored before. @throws InputError if the disk takes no more, or the store is
    /// one of several files.
    void append(const std::string& unit, std::span<const CaseRow> rows);
    [[nodiscard]] std::size_t units() const { return units_.size(); }
    [[nodiscard]] bool has(const std::string& unit) const { return units_.contains(unit); }

    /// All rows that were appended, in that order. @throws InputError naming the file if they cannot be read back
    /// whole.
    void read(const std::function<void(const CaseRow&)>& visit) const;
    /// The file takes its name.
    void finish();

private:
    struct Kept {};
    struct Joined {};
    CaseStore(std::filesystem::path file, Kept kept);
    explicit CaseStore(Joined joined);
    [[nodiscard]] std::string name() const;  // for messages
    [[nodiscard]] const std::filesystem::path& path() const { return written_ ? written_->path() : file_; }

    std::filesystem::path file_;                    // empty: temporary
    std::unique_ptr<base::TemporaryFile> written_;  // none: file_ itself
    std::ofstream out_;
    std::set<std::string> units_;
    std::vector<std::filesystem::path> joined_;  // files of others, which are read and never written
};

/// One unit of work in a store's file.
struct StoredUnit {
    std::string name;
    std::string checksum;  ///< of its rows
    std::vector<CaseRow> rows;
};
/// The whole units of a store's file, one in memory at a time: up to the first line that does not fit its checksum.
/// @return how much of the file those units take, with its first line, bytes. @throws as read_case_rows.
std::uintmax_t read_case_units(std::istream& in, const std::string& name,
                               const std::function<void(const StoredUnit&)>& visit);
std::uintmax_t read_case_units(const std::filesystem::path& file, const std::function<void(const StoredUnit&)>& visit);

/// The whole units of a store's file, row by row: up to the first line that does not fit its checksum. One unit is in
/// memory at a time.
/// @param whole_bytes  how much of the file those units take, with its first line; may be null
/// @return the names of the units. @throws InputError if it is no such file, a line has more than 64 kB or a unit more
/// than two million rows.
std::set<std::string> read_case_rows(const std::filesystem::path& file,
                                     const std::function<void(const CaseRow&)>& visit,
                                     std::uintmax_t* whole_bytes = nullptr);
/// The same from a stream. @param name  of the file, for messages
std::set<std::string> read_case_rows(std::istream& in, const std::string& name,
                                     const std::function<void(const CaseRow&)>& visit,
                                     std::uintmax_t* whole_bytes = nullptr);

}  // namespace mimik::evaluation
