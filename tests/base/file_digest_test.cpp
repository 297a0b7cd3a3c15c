#include "base/file_digest.h"

#include <string>

#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/support/temporary_folder.h"

namespace mimik::base {
namespace {

TEST(FileDigest, any_bit_that_differs_shows_and_so_do_two_flipped_signs_a_lane_apart) {
    std::string bytes(203, '\0');
    for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<char>(7 * k);
    const auto whole = digest_of(bytes);
    EXPECT_EQ(whole.bytes, 203U);
    for (std::size_t k = 0; k < bytes.size(); ++k)
        for (int bit = 0; bit < 8; ++bit) {
            auto other = bytes;
            other[k] = static_cast<char>(other[k] ^ (1 << bit));
            EXPECT_NE(digest_of(other), whole) << k;
        }
    auto flipped = bytes;
    for (const std::size_t k : {7U, 39U}) flipped[k] = static_cast<char>(flipped[k] ^ 0x80);  // 32 bytes: one lane
    EXPECT_NE(digest_of(flipped), whole);
    EXPECT_NE(digest_of(bytes + std::string(1, '\0')), whole);
    EXPECT_NE(digest_of(bytes.substr(1)), whole);
}

TEST(FileDigest, a_file_has_the_digest_of_its_bytes) {
    const test::TemporaryFolder folder;
    write_atomically(folder / "a.txt", "some bytes");
    EXPECT_EQ(digest_of_file(folder / "a.txt"), digest_of("some bytes"));
    EXPECT_EQ(digest_of("").bytes, 0U);
    EXPECT_EQ(digest_of("").text(), digest_of(std::string()).text());
}

}  // namespace
}  // namespace mimik::base
