#pragma once

#include <gtest/gtest.h>

#include "tests/support/analytic_workspace_files.h"
#include "tests/support/temporary_folder.h"

namespace mimik::test {

/// Tests that read one workspace of faces in closed form, made once for all of them.
template <typename Claims>
class WorkspaceTest : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        workspace_ = new preprocessing::Workspace(analytic_workspace(folder_->path()));
    }
    static void TearDownTestSuite() {
        delete workspace_;
        delete folder_;
    }
    static inline TemporaryFolder* folder_ = nullptr;
    static inline preprocessing::Workspace* workspace_ = nullptr;
};

}  // namespace mimik::test
