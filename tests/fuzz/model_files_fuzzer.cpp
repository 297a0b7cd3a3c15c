#include <algorithm>
#include <cmath>

#include "modeling/expression_model.h"
#include "modeling/region_labels.h"
#include "preprocessing/kept_registrations.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

constexpr int rows = 4, cols = 5;

void region_labels(std::string_view text) {
    const auto labels = modeling::decode_region_labels(text, "input", rows, cols);
    require(labels.rows == rows && labels.cols == cols && labels.label.size() == std::size_t{rows} * cols,
            "there is a label per vertex");
    auto expected = labels.label;
    // A carriage return inside a name becomes a blank: a CSV field here has one line.
    for (auto& name : expected) std::replace(name.begin(), name.end(), '\r', ' ');
    const auto again =
        modeling::decode_region_labels(modeling::encode_region_labels(labels, "0123456789abcdef"), "again", rows, cols);
    require(again.label == expected, "what was written reads back");
    for (const auto& name : labels.names()) require(!name.empty(), "regions have names");
}

}  // namespace

/// An expression model; behind an 'r' region labels.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    if (text.starts_with('r')) return region_labels(text.substr(1));
    const auto model = modeling::decode_expression_model(text, "input");
    require(model.points.size() <= 10000 && model.landmarks.size() <= 10000, "splines stay small");
    for (const auto& point : model.points)
        require(point.position_mm.allFinite() && point.displacement_mm.allFinite(), "points are finite");
    require(std::isfinite(model.mouth_width_mm), "the mouth has a width");
    const auto again = modeling::decode_expression_model(modeling::encode_expression_model(model), "again");
    require(again.points.size() == model.points.size() && again.sources == model.sources &&
                again.left_out == model.left_out && again.expression == model.expression,
            "what was written reads back");
    for (std::size_t k = 0; k < model.points.size(); ++k)
        require(again.points[k].name == model.points[k].name &&
                    again.points[k].position_mm == model.points[k].position_mm &&
                    again.points[k].displacement_mm == model.points[k].displacement_mm,
                "points read back");
    require(again.dense.has_value() == model.dense.has_value(), "a template reads back");
    if (!model.dense) return;
    const auto &made = model.dense->face_template(), &read = again.dense->face_template();
    require(model.dense->motion_mm.size() == made.size() && again.dense->motion_mm == model.dense->motion_mm &&
                preprocessing::template_fingerprint(read) == preprocessing::template_fingerprint(made),
            "template and motion read back");
}

std::vector<std::string> seeds() {
    modeling::ExpressionModel model;
    model.expression = facs::parse_expression("AU12_L").value();
    model.sources = {"bs000_N_N_0", "bs000_LFAU_12L_0"};
    model.landmarks = geometry::Landmarks({{"nose_tip", {0, 0.25, 0}, "Nose tip"}, {"chin", {0, -60, -20}, ""}});
    model.mouth_width_mm = 50;
    model.points = {{"corner_left", facs::ControlKind::muscle, {25, -40, -30}, {2, 4, -1}, 0.5},
                    {"anchor 1", facs::ControlKind::anchor, {50, 40, -40}, {0, 0, 0}, 0}};
    model.left_out = {"point 'x' is off the face"};
    auto affine = model;
    affine.normalisation = modeling::Normalisation::affine;
    affine.points.pop_back();
    auto dense = model;
    preprocessing::FaceTemplate sheet;
    sheet.surface.vertices_mm = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
    sheet.surface.triangles = {{0, 1, 2}, {1, 3, 2}};
    sheet.surface.landmarks = model.landmarks;
    sheet.mirror = {1, 0, 3, 2};
    sheet.upper_lip_line = {0, 1};
    sheet.lower_lip_line = {2, 3};
    sheet.landmarks = {{"nose_tip", {0, 1, 2}, {0.5, 0.25, 0.25}}};
    dense.dense = {std::make_shared<const preprocessing::KeptRegistrations>(std::move(sheet)),
                   {{0, 1, 0}, {0, 2, 0}, {0, 0, 0.5}, {0, 0, 0}}};
    return {modeling::encode_expression_model(dense),           modeling::encode_expression_model(model),
            modeling::encode_expression_model(affine),          "rrow,col,region\n0,0,nose\n0,1,nose\n3,4,cheek_left\n",
            "rregion,col,row\r\n\"my \"\"a\"\", b\",4,1e0\r\n", "rrow,col,region\n9,9,x\n"};
}

}  // namespace mimik::fuzzing
