#include "database/truth.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

bool no_path(const database::ScanId& id) { return id.name().find_first_of("/\\") == std::string::npos; }

void truth_of_one_scan(std::string_view text) {
    const auto scan = database::decode_true_scan(text, "input");
    require(no_path(scan.id), "a scan's name leads to no other folder");
    require((scan.scanner_from_head.inverse().matrix() * scan.scanner_from_head.matrix()).allFinite(),
            "a pose can be undone");
    for (const auto& mark : scan.landmarks.all()) require(mark.position_mm.allFinite(), "landmarks are finite");
}

}  // namespace

/// truth.json, and behind an 's' a scan's own .json.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    if (text.starts_with('s')) return truth_of_one_scan(text.substr(1));
    const auto truth = database::decode_truth(text, "input");
    const auto vertices = truth.vertex_regions.size();
    require(vertices <= 2'000'000, "the number of vertices is bounded");
    for (const auto corner : truth.faces.corners) require(corner < vertices, "corners are vertices");
    for (std::size_t f = 0; f < truth.faces.size(); ++f) require(truth.faces[f].size() >= 3, "faces have corners");
    for (const auto& [name, vertex] : truth.landmark_vertices) require(vertex < vertices, "landmarks are vertices");
    for (const auto& region : truth.vertex_regions) require(region.size() <= 64, "a region's name is short");
    for (const auto& id : truth.scans) {
        require(no_path(id), "a scan's name leads to no other folder");
        require(truth.has(id), "a scan that is listed is found");
    }
}

std::vector<std::string> seeds() {
    return {R"({"schema": 1, "seed": 7, "face_model": {"name": "m", "vertices": 5, "faces": [[0, 1, 2], [1, 2, 3, 4]],)"
            R"( "regions": {"lip": [3], "lid": [0, 4]}, "landmark_vertices": {"nose_tip": 2}}, "subjects": [{"name":)"
            R"( "bs000", "sex": "f", "amplitude": 1.1, "asymmetry": 0, "measurements_mm": {"mouth_width": 50.5}}],)"
            R"( "scans": ["bs000_N_N_0", "bs000_LFAU_12L_0"], "variances": {"identity": 0.8}})",
            R"(s{"schema": 1, "scan": "bs000_N_N_0", "scanner_from_head": [[1, 0, 0, 5], [0, 0.5, 0.8, 0],)"
            R"( [0, -0.8, 0.5, -1e1], [0, 0, 0, 1]], "landmarks": {"nose_tip": [0, 1, 2], "chin": [0, -60, 0.5]},)"
            R"( "shape_weights": {"smile": 0.7}, "amplitude": 1, "asymmetry": 0.1})"};
}

}  // namespace mimik::fuzzing
