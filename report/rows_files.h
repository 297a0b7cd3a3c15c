#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "evaluation/case_row.h"

namespace mimik::report {

/// Hands rows over, each once, in a fixed order: evaluation::CaseStore::read, say.
using ReadRows = std::function<void(const std::function<void(const evaluation::CaseRow&)>&)>;

/// The measures of an experiment as one tidy table: header, then one row per number; rows that say how the run went are
/// left out. Bytes depend on the rows alone. @return rows. @throws InputError if it cannot be written.
std::size_t write_rows_csv(const std::filesystem::path& file, const ReadRows& read);

/// Reads a table that write_rows_csv() wrote, row by row. @throws InputError naming file, line and what is wrong.
void read_rows_csv(const std::filesystem::path& file, const std::function<void(const evaluation::CaseRow&)>& visit);

/// The same rows as a SQLite database: table `rows` with the columns of the CSV in its order, indexed by expression and
/// method. Made anew: it is there whole, or as it was. @return rows. @throws InputError if it cannot be written.
std::size_t write_rows_sqlite(const std::filesystem::path& file, const ReadRows& read);

}  // namespace mimik::report
