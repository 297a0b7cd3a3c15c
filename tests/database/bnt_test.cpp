#include "database/bnt.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::HasSubstr;

/// 3 x 4 cells at (col, row, 10 col + row), the second one not measured.
Bnt small_scan() {
    Bnt bnt;
    bnt.rows = 3;
    bnt.cols = 4;
    bnt.texture_file = "bs000_N_N_0.png";
    for (int i = 0; i < 12; ++i) {
        const int row = i / 4, col = i % 4;
        bnt.x.push_back(col + 0.1);
        bnt.y.push_back(row + 0.1);
        bnt.z.push_back(10 * col + row);
        bnt.u.push_back(col / 3.0);
        bnt.v.push_back(1 - row / 2.0);
    }
    for (auto* column : {&bnt.x, &bnt.y, &bnt.z, &bnt.u, &bnt.v}) (*column)[1] = bnt.background;
    return bnt;
}

/// The same file put together byte by byte from the format's description.
std::vector<std::uint8_t> small_scan_bytes() {
    std::vector<std::uint8_t> bytes = {3, 0, 4, 0};
    const auto put = [&](const auto& value) {
        const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
        bytes.insert(bytes.end(), raw, raw + sizeof value);
    };
    put(-1e9);
    put(std::uint16_t{15});
    for (const char c : std::string("bs000_N_N_0.png")) put(c);
    put(std::uint32_t{60});
    const Bnt bnt = small_scan();
    for (const auto* column : {&bnt.x, &bnt.y, &bnt.z, &bnt.u, &bnt.v})
        for (const double value : *column) put(value);
    return bytes;
}

template <typename T>
std::vector<std::uint8_t> with(std::vector<std::uint8_t> bytes, std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
}

std::string decode_error(const std::vector<std::uint8_t>& bytes) {
    return message_of<InputError>([&] { (void)decode_bnt(bytes, "bad.bnt"); });
}

TEST(Bnt, a_file_has_the_bytes_of_the_description) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "bs000_N_N_0.bnt";
    write_bnt(file, small_scan());
    EXPECT_EQ(base::read_bytes(file), small_scan_bytes());
}

TEST(Bnt, what_is_read_and_written_again_is_the_same_file_bit_by_bit) {
    const TemporaryFolder folder;
    auto bytes = small_scan_bytes();
    bytes = with(bytes, 14 + 15 + 4, 0x7ff4dead0000beefULL);  // a NaN with a payload, which must survive
    bytes = with(bytes, 14 + 15 + 4 + 8, -0.0);
    const auto file = folder.path() / "a.bnt", copy = folder.path() / "b.bnt";
    base::write_atomically(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    write_bnt(copy, read_bnt(file));
    EXPECT_EQ(base::read_bytes(copy), bytes);
}

TEST(Bnt, a_texture_name_longer_than_one_read_of_the_header_comes_back_whole) {
    const TemporaryFolder folder;
    Bnt bnt = small_scan();
    bnt.texture_file = std::string(5000, 'n') + ".png";
    const auto file = folder.path() / "long.bnt";
    write_bnt(file, bnt);
    const Bnt again = read_bnt(file);
    EXPECT_EQ(again.texture_file, bnt.texture_file);
    EXPECT_EQ(again.v, bnt.v);
}

TEST(Bnt, reading_a_file_and_decoding_its_bytes_agree) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.bnt";
    write_bnt(file, small_scan());
    const Bnt read = read_bnt(file), decoded = decode_bnt(base::read_bytes(file), "a");
    EXPECT_EQ(read.x, decoded.x);
    EXPECT_EQ(read.v, decoded.v);
    EXPECT_EQ(read.texture_file, decoded.texture_file);
}

TEST(Bnt, every_truncation_is_refused_by_name) {
    const auto bytes = small_scan_bytes();
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_THAT(decode_error({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}),
                    HasSubstr("bad.bnt: "))
            << length;
    EXPECT_THAT(decode_error({bytes.begin(), bytes.end() - 1}), HasSubstr("truncated: copy it again"));
}

TEST(Bnt, a_truncated_file_is_refused_by_name) {
    const TemporaryFolder folder;
    const auto bytes = small_scan_bytes();
    const auto file = folder.path() / "cut.bnt";
    base::write_atomically(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size() - 8));
    EXPECT_THAT(message_of<InputError>([&] { (void)read_bnt(file); }),
                HasSubstr("cut.bnt: has 505 bytes, its header promises 513"));
    EXPECT_THAT(message_of<InputError>([&] { (void)read_bnt(folder.path() / "none.bnt"); }),
                HasSubstr("none.bnt: cannot be opened"));
    EXPECT_THAT(message_of<InputError>([&] { (void)read_bnt(folder.path()); }), HasSubstr("not a regular file"));
}

TEST(Bnt, sizes_that_disagree_are_refused_with_the_field_and_the_values) {
    const auto bytes = small_scan_bytes();
    EXPECT_THAT(decode_error(with(bytes, 0, std::uint16_t{0})), HasSubstr("nrows is 0"));
    EXPECT_THAT(decode_error(with(bytes, 2, std::uint16_t{0})), HasSubstr("ncols is 0"));
    EXPECT_THAT(decode_error(with(bytes, 0, std::uint16_t{5})),
                HasSubstr("value count is 60, but nrows 5 x ncols 4 x 5 is 100"));
    EXPECT_THAT(decode_error(with(bytes, 12, std::uint16_t{60000})),
                HasSubstr("texture name is said to be 60000 bytes"));
    // 7000 x 7000 cells, which a sparse file of 4 kB on disk could hold.
    auto large = with(with(bytes, 0, std::uint16_t{7000}), 2, std::uint16_t{7000});
    EXPECT_THAT(decode_error(with(large, 14 + 15, std::uint32_t{5 * 7000 * 7000})),
                HasSubstr("more than the 5000000 cells that Mimik reads"));
    auto longer = bytes;
    longer.push_back(0);
    EXPECT_THAT(decode_error(longer), HasSubstr("behind the last value"));
    EXPECT_THAT(decode_error(with(bytes, 4, std::numeric_limits<double>::quiet_NaN())),
                HasSubstr("zmin is not a number"));
}

TEST(Bnt, absurd_sizes_are_refused_before_memory_is_asked_for) {
    auto bytes = with(with(small_scan_bytes(), 0, std::uint16_t{65535}), 2, std::uint16_t{13107});
    bytes = with(bytes, 14 + 15, std::uint32_t{4294836225});  // 5 x 65535 x 13107
    EXPECT_THAT(decode_error(bytes), HasSubstr("nrows 65535 x ncols 13107 is more than"));
}

TEST(BntScan, cells_with_the_marker_or_no_number_in_any_coordinate_are_not_measured) {
    Bnt bnt = small_scan();
    bnt.y[2] = bnt.background;
    bnt.x[3] = std::numeric_limits<double>::infinity();
    const auto scan = to_range_scan(bnt, "made.bnt");
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(scan.valid(i), i == 0 || i > 3) << i;
    EXPECT_EQ(scan.points_mm[4], geometry::Point(0.1, 1.1, 1));
}

TEST(BntScan, texture_v_counts_from_the_bottom) {
    const auto scan = to_range_scan(small_scan(), "made.bnt");
    EXPECT_EQ(scan.texture_coordinates[0], geometry::TextureCoordinate(0, 0));   // lowest row of the grid
    EXPECT_EQ(scan.texture_coordinates[11], geometry::TextureCoordinate(1, 1));  // highest row
}

TEST(BntScan, converting_there_and_back_keeps_positions_and_the_unmeasured_cells) {
    const Bnt bnt = small_scan();
    const Bnt again = to_bnt(to_range_scan(bnt, "made.bnt"));
    EXPECT_EQ(again.x, bnt.x);
    EXPECT_EQ(again.z, bnt.z);
    EXPECT_EQ(again.u, bnt.u);
    EXPECT_EQ(again.v, bnt.v);  // 1 - (1 - v) is exact for these v
    EXPECT_EQ(again.texture_file, bnt.texture_file);
}

TEST(BntScan, a_texture_name_with_a_folder_in_it_is_not_followed) {
    Bnt bnt = small_scan();
    for (const char* name : {"../../etc/secret.png", "/abs.png", "a\\b.png", "..", "a/b.png", "C:x.png"}) {
        bnt.texture_file = name;
        auto scan = to_range_scan(bnt, "made.bnt");
        EXPECT_EQ(scan.texture_file, "");
        EXPECT_THAT(scan.texture_error, testing::AllOf(HasSubstr("made.bnt: texture name is"), HasSubstr(name)));
        scan.texture_file = name;
        EXPECT_THAT(message_of<InputError>([&] { (void)to_bnt(scan); }), HasSubstr(name));
    }
    bnt.texture_file = "a\nb.png";
    EXPECT_THAT(to_range_scan(bnt, "made.bnt").texture_error, HasSubstr("'a?b.png'"));
    bnt.texture_file.clear();
    EXPECT_EQ(to_range_scan(bnt, "made.bnt").texture_error, "");
}

TEST(BntScan, a_coordinate_further_than_a_kilometre_is_refused_with_its_cell_and_value) {
    for (const double z : {1e300, -1.01e6}) {
        Bnt bnt = small_scan();
        bnt.z[6] = z;  // 4 columns
        EXPECT_THAT(message_of<InputError>([&] { (void)to_range_scan(bnt, "made.bnt"); }),
                    HasSubstr(fmt::format("made.bnt: z of row 1, column 2 is {:g} mm", std::abs(z))));
    }
    Bnt far = small_scan();
    far.x[6] = 1e6;
    EXPECT_TRUE(to_range_scan(far, "made.bnt").valid(6));
    EXPECT_THAT(message_of<InputError>([&] { (void)to_range_scan(far, "made.bnt", io::LengthUnit::centimetre); }),
                HasSubstr("x of row 1, column 2 is 1e+07 mm"));
}

TEST(BntScan, a_unit_scales_every_point) {
    const auto scan = to_range_scan(small_scan(), "made.bnt", io::LengthUnit::centimetre);
    const auto same = to_range_scan(small_scan(), "made.bnt");
    for (const std::size_t i : {0, 2, 11}) EXPECT_EQ(scan.points_mm[i], 10 * same.points_mm[i]) << i;
}

TEST(BntScan, a_point_that_equals_the_marker_is_refused_rather_than_lost) {
    auto scan = to_range_scan(small_scan(), "made.bnt");
    scan.points_mm[5].z() = -1e9;
    EXPECT_THAT(message_of<InputError>([&] { (void)to_bnt(scan); }), HasSubstr("point 5"));
}

TEST(BntScan, a_cloud_without_rows_is_refused_with_the_mend) {
    geometry::RangeScan cloud;
    cloud.points_mm = {{0, 0, 0}};
    EXPECT_THAT(message_of<InputError>([&] { (void)to_bnt(cloud); }), HasSubstr("write it as .ply"));
}

}  // namespace
}  // namespace mimik::database
