#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace mimik::test {

/// What is wrong with a GLB by the glTF 2.0 specification, as far as Mimik's files use it: chunks and lengths,
/// alignment, ranges of every index, numbers that are finite, bounds that are those of the data, counts that agree.
/// Shares no code with the writer.
class GlbFaults {
public:
    explicit GlbFaults(std::span<const std::uint8_t> glb) {
        try {
            check(glb);
        } catch (const std::exception& e) {
            fault(e.what());
        }
    }
    [[nodiscard]] const std::vector<std::string>& list() const { return faults_; }

private:
    using Json = nlohmann::json;

    void fault(const std::string& what) {
        if (faults_.size() < 20) faults_.push_back(what);
    }
    void expect(bool good, const std::string& what) {
        if (!good) fault(what);
    }
    void require(bool good, const std::string& what) {
        if (!good) throw std::runtime_error(what);
    }
    static std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    }
    static std::size_t components(const Json& accessor) {
        const auto type = accessor.at("type").get<std::string>();
        return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
    }
    static std::size_t component_bytes(const Json& accessor) {
        switch (accessor.at("componentType").get<int>()) {
            case 5121:
                return 1;
            case 5125:
            case 5126:
                return 4;
            default:
                return 0;
        }
    }

    void check(std::span<const std::uint8_t> glb) {
        require(glb.size() >= 28 && std::memcmp(glb.data(), "glTF", 4) == 0, "no GLB");
        expect(word(glb, 4) == 2, "version is not 2");
        expect(word(glb, 8) == glb.size(), "the length is not that of the file");
        const std::size_t json_bytes = word(glb, 12);
        expect(json_bytes % 4 == 0, "the JSON chunk does not end at a multiple of 4");
        require(std::memcmp(glb.data() + 16, "JSON", 4) == 0 && 28 + json_bytes <= glb.size(), "no JSON chunk");
        const std::size_t binary_bytes = word(glb, 20 + json_bytes);
        expect(binary_bytes % 4 == 0, "the binary chunk does not end at a multiple of 4");
        require(std::memcmp(glb.data() + 24 + json_bytes, "BIN\0", 4) == 0, "no binary chunk");
        require(28 + json_bytes + binary_bytes == glb.size(), "the chunks do not end where the file ends");
        json_ = Json::parse(glb.begin() + 20, glb.begin() + 20 + static_cast<std::ptrdiff_t>(json_bytes));
        binary_ = glb.subspan(28 + json_bytes);
        expect(json_.at("asset").at("version") == "2.0", "asset.version is not 2.0");
        require(json_.at("buffers").size() == 1, "not one buffer");
        buffer_bytes_ = json_["buffers"][0].at("byteLength").get<std::size_t>();
        require(buffer_bytes_ <= binary_bytes && binary_bytes < buffer_bytes_ + 4, "the buffer is not the chunk");
        for (const auto& view : json_.at("bufferViews")) {
            const auto offset = view.at("byteOffset").get<std::size_t>();
            expect(offset % 4 == 0, "a view does not begin at a multiple of 4");
            require(view.at("buffer") == 0 && view.at("byteLength") > 0 &&
                        offset + view["byteLength"].get<std::size_t>() <= buffer_bytes_,
                    "a view leaves the buffer");
        }
        for (std::size_t a = 0; a < json_.at("accessors").size(); ++a) check_accessor(a);
        for (const auto& mesh : json_.at("meshes")) check_mesh(mesh);
        check_links();
        for (const auto& animation : json_.value("animations", Json::array())) check_animation(animation);
    }

    /// One sampler and one channel of weights: times grow, and every frame has a number for each morph target.
    void check_animation(const Json& animation) {
        require(animation.at("samplers").size() == 1 && animation.at("channels").size() == 1, "not one channel");
        const auto& sampler = animation["samplers"][0];
        const auto& channel = animation["channels"][0];
        expect(channel.at("sampler") == 0, "a channel names a sampler that there is not");
        expect(channel.at("target").at("path") == "weights", "a channel moves no weights");
        const auto& node = json_.at("nodes").at(channel["target"].at("node").get<std::size_t>());
        const auto& mesh = json_.at("meshes").at(node.at("mesh").get<std::size_t>());
        const auto input = sampler.at("input").get<std::size_t>(), output = sampler.at("output").get<std::size_t>();
        for (const auto accessor : {input, output}) {
            const auto& a = json_["accessors"].at(accessor);
            expect(a.at("type") == "SCALAR" && a.at("componentType") == 5126, "an animation is not of floats");
            expect(!json_["bufferViews"][a["bufferView"].get<std::size_t>()].contains("target"),
                   "an animation stands in a view of vertices");
        }
        expect(json_["accessors"][input].contains("min") && json_["accessors"][input].contains("max"),
               "times have no bounds");
        const auto times = values(input);
        for (std::size_t k = 0; k < times.size(); ++k)
            expect(times[k] >= 0 && (k == 0 || times[k] > times[k - 1]), "times do not grow from 0 on");
        const auto targets = mesh.at("primitives")[0].value("targets", Json::array()).size();
        expect(targets > 0 && values(output).size() == times.size() * targets,
               "weights are not one per frame and morph target");
    }

    [[nodiscard]] std::vector<double> values(std::size_t accessor) const {
        const auto& a = json_.at("accessors").at(accessor);
        const std::size_t bytes = component_bytes(a), n = components(a) * a.at("count").get<std::size_t>();
        const auto* data =
            binary_.data() +
            json_.at("bufferViews").at(a.at("bufferView").get<std::size_t>()).at("byteOffset").get<std::size_t>();
        std::vector<double> out(n);
        for (std::size_t k = 0; k < n; ++k) {
            float real = 0;
            std::uint32_t whole = 0;
            std::memcpy(&whole, data + k * bytes, bytes);
            std::memcpy(&real, &whole, sizeof real);
            out[k] = a["componentType"] == 5126 ? static_cast<double>(real) : static_cast<double>(whole);
        }
        return out;
    }

    void check_accessor(std::size_t index) {
        const auto& a = json_["accessors"][index];
        const auto name = "accessor " + std::to_string(index);
        const auto& view = json_["bufferViews"].at(a.at("bufferView").get<std::size_t>());
        const std::size_t n = components(a);
        require(n * component_bytes(a) > 0 && a.at("count") > 0, name + " has no type or no element");
        require(n * component_bytes(a) * a["count"].get<std::size_t>() == view.at("byteLength").get<std::size_t>(),
                name + " does not fill its view");
        expect(n * component_bytes(a) % 4 == 0, name + ": elements do not begin at multiples of 4");
        const auto data = values(index);
        expect(std::all_of(data.begin(), data.end(), [](double v) { return std::isfinite(v); }),
               name + " has a number that is not finite");
        if (!a.contains("min") && !a.contains("max")) return;
        require(a.at("min").size() == n && a.at("max").size() == n, name + ": bounds of another type");
        for (std::size_t c = 0; c < n; ++c) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (std::size_t k = c; k < data.size(); k += n) {
                low = std::min(low, data[k]);
                high = std::max(high, data[k]);
            }
            expect(a["min"][c] == low && a["max"][c] == high, name + ": bounds are not those of the data");
        }
    }

    void check_attribute(const Json& attributes, const char* key, const char* type, std::size_t count, bool bounded) {
        const auto& a = json_["accessors"].at(attributes.at(key).get<std::size_t>());
        const auto name = std::string(key);
        expect(a.at("type") == type, name + " is no " + type);
        expect(a.at("count") == count, name + " has another count than the vertices");
        expect(!bounded || (a.contains("min") && a.contains("max")), name + " has no bounds");
        expect(json_["bufferViews"][a["bufferView"].get<std::size_t>()].at("target") == 34962, name + ": wrong target");
    }

    void check_mesh(const Json& mesh) {
        require(mesh.at("primitives").size() == 1, "not one primitive");
        const auto& primitive = mesh["primitives"][0];
        const auto& attributes = primitive.at("attributes");
        const auto n =
            json_["accessors"].at(attributes.at("POSITION").get<std::size_t>()).at("count").get<std::size_t>();
        check_attribute(attributes, "POSITION", "VEC3", n, true);
        check_attribute(attributes, "NORMAL", "VEC3", n, false);
        const auto normals = values(attributes["NORMAL"].get<std::size_t>());
        for (std::size_t k = 0; k + 2 < normals.size(); k += 3)
            expect(
                std::abs(std::hypot(normals[k], normals[k + 1], normals[k + 2]) - 1) < 1e-3,  // as the validator has it
                "a normal has not the length 1");
        if (attributes.contains("TEXCOORD_0")) check_attribute(attributes, "TEXCOORD_0", "VEC2", n, false);
        if (attributes.contains("COLOR_0")) check_attribute(attributes, "COLOR_0", "VEC4", n, false);

        for (const auto& [key, accessor] : attributes.items()) {
            if (!key.starts_with('_')) continue;  // an application's own
            const auto& a = json_["accessors"].at(accessor.get<std::size_t>());
            expect(a.at("componentType") == 5126, key + " is not of 32-bit floats");
            check_attribute(attributes, key.c_str(), a.at("type").get<std::string>().c_str(), n, false);
        }

        const auto indices = primitive.at("indices").get<std::size_t>();
        const auto& a = json_["accessors"].at(indices);
        expect(a.at("type") == "SCALAR" && a.at("componentType") == 5125, "indices are no 32-bit numbers");
        expect(json_["bufferViews"][a["bufferView"].get<std::size_t>()].at("target") == 34963, "indices: wrong target");
        const auto corners = values(indices);
        expect(corners.size() % 3 == 0, "indices are no triangles");
        std::vector<char> used(n, 0);
        for (const double corner : corners) {
            require(corner < static_cast<double>(n), "a triangle names a vertex that there is not");
            used[static_cast<std::size_t>(corner)] = 1;
        }
        expect(std::find(used.begin(), used.end(), 0) == used.end(), "a vertex stands in no triangle");

        const auto targets = primitive.value("targets", Json::array());
        for (const auto& target : targets) {
            check_attribute(target, "POSITION", "VEC3", n, true);
            if (target.contains("NORMAL")) check_attribute(target, "NORMAL", "VEC3", n, false);
        }
        const auto weights = mesh.value("weights", Json::array());
        expect(weights.size() == targets.size(), "weights and morph targets differ in number");
        for (const auto& weight : weights) expect(weight.is_number(), "a weight is no number");
        const auto extras = mesh.value("extras", Json::object());
        expect(targets.empty() || (extras.contains("targetNames") && extras["targetNames"].size() == targets.size()),
               "targetNames and morph targets differ in number");
        expect(!extras.contains("arkitNames") || extras["arkitNames"].size() == targets.size(),
               "arkitNames and morph targets differ in number");
    }

    void check_index(const Json& owner, const char* key, const char* list) {
        if (owner.contains(key))
            expect(owner[key].get<std::size_t>() < json_.value(list, Json::array()).size(),
                   std::string(key) + " names one of " + list + " that there is not");
    }
    void check_links() {
        for (const auto& mesh : json_["meshes"]) check_index(mesh["primitives"][0], "material", "materials");
        for (const auto& node : json_.at("nodes")) check_index(node, "mesh", "meshes");
        for (const auto& scene : json_.at("scenes"))
            for (const auto& node : scene.at("nodes"))
                expect(node.get<std::size_t>() < json_["nodes"].size(), "a scene names a node that there is not");
        for (const auto& material : json_.value("materials", Json::array()))
            if (material.contains("pbrMetallicRoughness") &&
                material["pbrMetallicRoughness"].contains("baseColorTexture"))
                check_index(material["pbrMetallicRoughness"]["baseColorTexture"], "index", "textures");
        for (const auto& texture : json_.value("textures", Json::array())) {
            check_index(texture, "source", "images");
            check_index(texture, "sampler", "samplers");
        }
        for (const auto& image : json_.value("images", Json::array())) {
            const auto& view = json_["bufferViews"].at(image.at("bufferView").get<std::size_t>());
            expect(image.at("mimeType") == "image/png" && view["byteLength"] > 8 &&
                       std::memcmp(binary_.data() + view["byteOffset"].get<std::size_t>(), "\x89PNG\r\n\x1a\n", 8) == 0,
                   "an image is no PNG");
        }
    }

    Json json_;
    std::span<const std::uint8_t> binary_;
    std::size_t buffer_bytes_ = 0;
    std::vector<std::string> faults_;
};

[[nodiscard]] inline std::vector<std::string> glb_faults(std::span<const std::uint8_t> glb) {
    return GlbFaults(glb).list();
}

}  // namespace mimik::test
