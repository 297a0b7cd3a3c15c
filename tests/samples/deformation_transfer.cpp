#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/slit_sheet.h"

// [sample]
#include "geometry/deformation_transfer.h"

using namespace mimik;

/// One expression of a source on many targets of the same triangles. What `rim` says stays where it is.
std::vector<std::vector<geometry::Vector>> on_all(std::span<const geometry::Point> source_mm,
                                                  std::span<const geometry::Vector> motion_mm,
                                                  std::span<const std::vector<geometry::Point>> targets_mm,
                                                  const std::vector<geometry::Triangle>& triangles,
                                                  const std::vector<std::uint32_t>& rim) {
    const geometry::DeformationTransferMesh mesh(source_mm.size(), triangles, rim);  // the order, found once
    const auto gradients = geometry::deformation_gradients(source_mm, motion_mm, triangles);
    const std::vector<geometry::Vector> still(rim.size(), geometry::Vector::Zero());
    std::vector<std::vector<geometry::Vector>> motions;
    for (const auto& target : targets_mm) {
        const geometry::DeformationTransfer transfer(mesh, target);  // the factor, for all sources of this target
        motions.push_back(transfer.motion(gradients, still));
    }
    return motions;
}
// [end]

TEST(Samples, a_face_of_twice_the_size_parts_its_lips_twice_as_far) {
    const test::SlitSheet sheet;
    auto twice = sheet.rest_mm;
    for (auto& p : twice) p *= 2;
    const std::vector targets = {sheet.rest_mm, twice};
    auto motion = sheet.parting_mm();
    for (const auto v : sheet.rim) motion[v].setZero();
    const auto motions = on_all(sheet.rest_mm, motion, targets, sheet.triangles, sheet.rim);
    for (std::size_t v = 0; v < sheet.rest_mm.size(); ++v)
        EXPECT_LT((motions[1][v] - 2 * motions[0][v]).norm(), 1e-9);  // rounding
}
