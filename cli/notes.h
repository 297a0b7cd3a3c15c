#pragma once

#include <string>
#include <vector>

namespace mimik::cli {

/// Lines "thing: text" of which several say the same of other things are one: "bs003_N_N_0 and 11 more: text". Where
/// only numbers differ, those of the first stand, and that is said. The order is that of the first of each.
[[nodiscard]] std::vector<std::string> grouped(const std::vector<std::string>& lines);

/// Each group once on standard error, behind "note: ".
void say_notes(const std::vector<std::string>& notes);

/// Each of them on standard error, those that are equal once: what failed is named, however many did.
void say_failures(const std::vector<std::string>& failures);

}  // namespace mimik::cli
