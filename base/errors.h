#pragma once

#include <stdexcept>

namespace mimik {

/// A file, landmark, option or scan that the user can mend. The message names the file, the thing, the value and the
/// mend, in one line: "scan.bnt: nrows is 0; the file is truncated or not a Bosphorus scan".
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The input is well formed but the numbers allow no answer (for example: all landmarks in one plane).
class NumericalError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace mimik
