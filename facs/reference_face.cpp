#include "facs/reference_face.h"

#include <string>
#include <vector>

namespace mimik::facs {

const geometry::Landmarks& reference_landmarks() {
    static const geometry::Landmarks marks = [] {
        std::vector<geometry::Landmark> list;
        const auto pair = [&](const std::string& name, double x, double y, double z) {
            list.push_back({name + "_right", {-x, y, z}, ""});
            list.push_back({name + "_left", {x, y, z}, ""});
        };
        pair("brow_outer", 58, 48, -52);
        pair("brow_middle", 38, 58, -32);
        pair("brow_inner", 12, 55, -23);
        pair("eye_outer", 44.5, 30, -45);
        pair("eye_inner", 18.5, 28.5, -39);
        pair("nose_saddle", 8.5, 31.5, -30);
        pair("nose_wing", 17, -8, -16);
        pair("mouth_corner", 25.5, -39, -29);
        list.push_back({"nose_tip", {0, 0, 0}, ""});
        list.push_back({"upper_lip_outer", {0, -29, -12}, ""});
        list.push_back({"upper_lip_inner", {0, -34.5, -14}, ""});
        list.push_back({"lower_lip_inner", {0, -39, -17}, ""});
        list.push_back({"lower_lip_outer", {0, -48, -15}, ""});
        list.push_back({"chin", {0, -69, -20}, ""});
        return geometry::Landmarks(std::move(list));
    }();
    return marks;
}

bool on_reference_face(const geometry::Point& position_mm) {
    const double x = position_mm.x() / 72.0, y = (position_mm.y() - 5.0) / 96.0;
    return x * x + y * y <= 1.0;
}

}  // namespace mimik::facs
