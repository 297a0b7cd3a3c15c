#pragma once

#include <ostream>
#include <string>
#include <string_view>

namespace mimik::cli {

/// Before anything else: descriptors 0 to 2 that are closed are opened on /dev/null (else the next file would get the
/// number, and messages be written into it); a pipe whose reader ends stops no run; and what std::cout and std::cerr
/// print does nothing to a terminal: control characters and bytes that are no UTF-8 are written out as \x1b, \u009b.
void prepare_standard_streams();

/// Text of others (names of files, subjects, labels) as one line: line breaks and tabs are written out, too.
[[nodiscard]] std::string one_line(std::string_view text);

/// The streams without that guard, for our own control codes and for files that are printed as they are.
[[nodiscard]] std::ostream& raw_output();
[[nodiscard]] std::ostream& raw_error();

/// Whether standard output could not be written because the reader of its pipe has ended.
[[nodiscard]] bool output_reader_has_ended();

/// A terminal that shows colours, and nobody who wants none (NO_COLOR).
[[nodiscard]] bool shows_colours(int descriptor);

/// "mimik: message" on standard error, in one line.
void say_error(std::string_view program, std::string_view message);
/// "note: text" on standard error, in one line.
void say_note(std::string_view text);

}  // namespace mimik::cli
