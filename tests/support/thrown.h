#pragma once

#include <string>

#include "base/errors.h"

namespace mimik::test {

/// What the error says, or "nothing was thrown".
template <class Error = InputError, class Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

}  // namespace mimik::test
