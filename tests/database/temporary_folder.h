#pragma once

#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::database {

using test::message_of;
using test::TemporaryFolder;

}  // namespace mimik::database
