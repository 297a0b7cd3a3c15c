#include "base/folder_lock.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::base {
namespace {

using test::message_of;
using testing::HasSubstr;
using Use = FolderLock::Use;

/// What another process meets: 0 it got the lock, 1 it was refused.
int in_another_process(const std::filesystem::path& folder, Use use) {
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            const FolderLock lock(folder, use);
        } catch (const InputError&) {
            ::_exit(1);
        }
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
}

/// Another process that holds the lock until it is killed.
class Holder {
public:
    Holder(const std::filesystem::path& folder, Use use) {
        int ready[2];
        if (::pipe(ready) != 0) std::abort();
        child_ = ::fork();
        if (child_ == 0) {
            const FolderLock lock(folder, use);
            (void)!::write(ready[1], "x", 1);
            for (;;) ::pause();
        }
        char byte = 0;
        (void)!::read(ready[0], &byte, 1);
        ::close(ready[0]);
        ::close(ready[1]);
    }
    ~Holder() {
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

private:
    pid_t child_ = 0;
};

TEST(FolderLock, a_writer_keeps_others_out_and_readers_keep_out_writers_alone) {
    const test::TemporaryFolder folder;
    std::optional<Holder> writer(std::in_place, folder.path(), Use::write);
    EXPECT_THAT(message_of<InputError>([&] { FolderLock lock(folder.path(), Use::write); }),
                HasSubstr("another mimik process is writing this folder; wait until it has ended"));
    EXPECT_THAT(message_of<InputError>([&] { FolderLock lock(folder.path(), Use::read); }),
                HasSubstr("another mimik process is writing this folder"));
    writer.reset();  // killed: nothing is left over
    EXPECT_EQ(in_another_process(folder.path(), Use::write), 0);
    const Holder reader(folder.path(), Use::read);
    EXPECT_NO_THROW(FolderLock(folder.path(), Use::read));
    EXPECT_THAT(message_of<InputError>([&] { FolderLock lock(folder.path(), Use::write); }),
                HasSubstr("another mimik process is reading this folder; wait until it has ended"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLock, readers_of_the_process_stand_beside_its_one_writer) {
    const test::TemporaryFolder folder;
    std::optional<FolderLock> reader(std::in_place, folder.path(), Use::read);
    EXPECT_EQ(in_another_process(folder.path(), Use::read), 0);
    {
        const FolderLock writer(folder.path(), Use::write);
        EXPECT_EQ(in_another_process(folder.path(), Use::read), 1);
        const FolderLock second_reader(folder.path(), Use::read);
        EXPECT_THAT(message_of<InputError>([&] { FolderLock lock(folder.path(), Use::write); }),
                    HasSubstr("another thread of this program is writing"));
    }
    EXPECT_EQ(in_another_process(folder.path(), Use::read), 0);
    EXPECT_EQ(in_another_process(folder.path(), Use::write), 1);
    reader.reset();
    EXPECT_EQ(in_another_process(folder.path(), Use::write), 0);
}

}  // namespace
}  // namespace mimik::base
