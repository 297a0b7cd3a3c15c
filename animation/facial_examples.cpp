#include "animation/facial_examples.h"

#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "facs/arkit_shapes.h"
#include "facs/toml_depth.h"

namespace mimik::animation {
namespace {

constexpr std::size_t deepest = 32;
constexpr std::uintmax_t most_bytes = 1 << 20;

bool is_plain_name(std::string_view name) {
    return !name.empty() && name.size() <= 80 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

class ListReader {
public:
    ListReader(const toml::table& document, const std::string& name) : document_(document), name_(name) {}

    ExampleList read() {
        only_keys(document_, {"schema", "neutral", "texture", "features", "example", "feature_vertices"});
        if (document_["schema"].value_or(0) != 1) fail(document_, "schema is not 1; write schema = 1");
        ExampleList list;
        list.neutral = file_name(document_, "neutral", true);
        list.texture = file_name(document_, "texture", false);
        list.features = file_name(document_, "features", false);
        const auto* tables = document_["example"].as_array();
        if (!tables || tables->empty()) fail(document_, "there is no [[example]]; give at least one");
        if (tables->size() > most_examples)
            fail(*tables,
                 fmt::format("{} examples, and {} is the most; leave some out", tables->size(), most_examples));
        std::set<std::string> names;
        for (const auto& node : *tables) {
            const auto* table = node.as_table();
            if (!table) fail(node, "an example is no table; write [[example]] and its keys below");
            list.entries.push_back(read_entry(*table));
            if (!names.insert(list.entries.back().name).second)
                fail(node, fmt::format("two examples are called {}; rename one", list.entries.back().name));
        }
        read_vertices(list);
        return list;
    }

private:
    void read_vertices(ExampleList& list) const {
        const auto* node = document_.get("feature_vertices");
        if (!node) return;
        const auto* table = node->as_table();
        constexpr std::size_t most = 1000;
        if (!table || table->size() > most) fail(*node, "'feature_vertices' is no table of names and vertices");
        for (const auto& [key, value] : *table) {
            const auto vertex = value.value<std::int64_t>();
            if (!value.is_integer() || !vertex || *vertex < 0 || *vertex > std::numeric_limits<std::uint32_t>::max())
                fail(value, fmt::format("{} is no vertex; give a whole number from 0 on", base::in_quotes(key.str())));
            list.feature_vertices.emplace_back(std::string(key.str()), static_cast<std::uint32_t>(*vertex));
        }
    }

    [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
        throw InputError(fmt::format("{}: line {}: {}", name_, node.source().begin.line, what));
    }
    void only_keys(const toml::table& table, std::initializer_list<std::string_view> known) const {
        for (const auto& [key, node] : table)
            if (std::find(known.begin(), known.end(), key.str()) == known.end())
                fail(node,
                     fmt::format("unknown key {}; known here: {}", base::in_quotes(key.str()), fmt::join(known, ", ")));
    }
    std::string text(const toml::table& table, const char* key, bool required) const {
        const auto* node = table.get(key);
        if (!node) {
            if (required) fail(table, fmt::format("'{}' is missing; add it", key));
            return {};
        }
        const auto value = node->value<std::string>();
        if (!value) fail(*node, fmt::format("'{}' is not a text; put it in quotes", key));
        return *value;
    }
    /// A folder of examples can be moved, and reads nothing outside.
    std::string file_name(const toml::table& table, const char* key, bool required) const {
        auto name = text(table, key, required);
        if (name.empty() && !required) return name;
        if (name.empty() || name == "." || name == ".." || name.find_first_of("/\\") != std::string::npos)
            fail(*table.get(key),
                 fmt::format("'{}' is {}; give the name of a file in this folder", key, base::in_quotes(name)));
        return name;
    }
    ExampleList::Entry read_entry(const toml::table& table) const {
        only_keys(table, {"name", "file", "arkit"});
        ExampleList::Entry entry{text(table, "name", true), file_name(table, "file", true), {}};
        if (!is_plain_name(entry.name) || entry.name == "neutral")
            fail(*table.get("name"), fmt::format("an example is called {}; give letters, digits, _ and -, and not "
                                                 "'neutral'",
                                                 base::in_quotes(entry.name)));
        const auto* node = table.get("arkit");
        if (!node) return entry;
        const auto* shapes = node->as_array();
        if (!shapes) fail(*node, "'arkit' is no list; write it as [\"mouthSmileLeft\"]");
        for (const auto& shape : *shapes) {
            auto value = shape.value<std::string>();
            if (!value || !facs::is_arkit_shape(*value))
                fail(shape, fmt::format("ARKit has no blendshape {}; give names such as mouthSmileLeft",
                                        base::in_quotes(value.value_or("that is a text"))));
            entry.arkit.push_back(std::move(*value));
        }
        return entry;
    }

    const toml::table& document_;
    const std::string& name_;
};

/// The neutral mesh's topology is everybody's.
void check_same_topology(const geometry::Mesh& neutral, const geometry::Mesh& mesh, const std::string& neutral_file,
                         const std::string& file) {
    if (mesh.vertices_mm.size() != neutral.vertices_mm.size())
        throw InputError(fmt::format("{}: {} where {} has {}; examples share their vertices", file,
                                     base::counted(mesh.vertices_mm.size(), "vertex", "vertices"), neutral_file,
                                     neutral.vertices_mm.size()));
    if (mesh.faces.corners != neutral.faces.corners || mesh.faces.first != neutral.faces.first)
        throw InputError(
            fmt::format("{}: its faces are not those of {}; examples share their faces", file, neutral_file));
}

}  // namespace

void FacialExamples::check() const {
    if (neutral.vertices_mm.empty() || neutral.faces.size() == 0)
        throw InputError("the neutral face of the examples has no surface; give a mesh with faces");
    if (examples.empty() || examples.size() > most_examples)
        throw InputError(fmt::format("{}; give 1 to {}", base::counted(examples.size(), "example"), most_examples));
    for (const auto& [feature, vertex] : feature_vertices)
        if (vertex >= neutral.vertices_mm.size())
            throw InputError(
                fmt::format("feature {} lies on vertex {} of {}", feature, vertex, neutral.vertices_mm.size()));
    std::set<std::string> names;
    for (const auto& example : examples) {
        if (!is_plain_name(example.name) || example.name == "neutral")
            throw InputError(fmt::format("an example is called {}; give letters, digits, _ and -, and not 'neutral'",
                                         base::in_quotes(example.name)));
        if (!names.insert(example.name).second)
            throw InputError(fmt::format("two examples are called {}; rename one", example.name));
        if (example.displacement_mm.size() != neutral.vertices_mm.size())
            throw InputError(fmt::format("example {} moves {} of {} vertices", example.name,
                                         example.displacement_mm.size(), neutral.vertices_mm.size()));
    }
}

ExampleList decode_example_list(std::string_view text, const std::string& name) {
    if (const auto line = facs::line_too_deep(text, deepest); line > 0)
        throw InputError(
            fmt::format("{}: line {}: brackets nest deeper than {}; this is no list of examples", name, line, deepest));
    try {
        const auto document = toml::parse(text, name);
        return ListReader(document, name).read();
    } catch (const toml::parse_error& e) {
        throw InputError(
            fmt::format("{}: line {}: {}; mend the TOML", name, e.source().begin.line, std::string(e.description())));
    }
}

FacialExamples read_facial_examples(const std::filesystem::path& folder) {
    const auto list_file = folder / example_list_name;
    const auto list = decode_example_list(base::read_text(list_file, most_bytes), list_file.string());
    FacialExamples set;
    const auto neutral_file = folder / list.neutral;
    set.neutral =
        io::read_mesh_file(neutral_file, io::LengthUnit::millimetre, io::MeshParts::all, io::BadTexture::report).mesh;
    if (!list.texture.empty()) set.texture_file = folder / list.texture;
    if (!list.features.empty()) set.features_file = folder / list.features;
    set.feature_vertices = list.feature_vertices;
    for (const auto& entry : list.entries) {
        const auto file = folder / entry.file;
        const auto mesh = io::read_mesh_file(file, io::LengthUnit::millimetre, io::MeshParts::without_attributes,
                                             io::BadTexture::report)
                              .mesh;
        check_same_topology(set.neutral, mesh, neutral_file.string(), file.string());
        FacialExample example{entry.name, entry.arkit, {}};
        example.displacement_mm.reserve(mesh.vertices_mm.size());
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
            example.displacement_mm.emplace_back(mesh.vertices_mm[v] - set.neutral.vertices_mm[v]);
        set.examples.push_back(std::move(example));
    }
    try {
        set.check();
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", list_file.string(), e.what()));
    }
    return set;
}

void write_facial_examples(const std::filesystem::path& folder, const FacialExamples& examples,
                           const io::MadeBy& made_by) {
    examples.check();
    io::MeshWriteOptions options;
    options.made_by = made_by;
    if (!examples.texture_file.empty()) options.texture_file = examples.texture_file.filename().string();
    std::string list = "schema = 1\nneutral = \"neutral.ply\"\n";
    if (!examples.texture_file.empty()) list += fmt::format("texture = \"{}\"\n", options.texture_file);
    if (!examples.features_file.empty())
        list += fmt::format("features = \"{}\"\n", examples.features_file.filename().string());
    io::write_mesh(folder / "neutral.ply", examples.neutral, options);
    auto mesh = examples.neutral;
    mesh.attributes.clear();
    for (const auto& example : examples.examples) {
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
            mesh.vertices_mm[v] = examples.neutral.vertices_mm[v] + example.displacement_mm[v];
        io::write_mesh(folder / (example.name + ".ply"), mesh, options);
        list += fmt::format("\n[[example]]\nname = \"{0}\"\nfile = \"{0}.ply\"\n", example.name);
        if (!example.arkit.empty()) list += fmt::format("arkit = [\"{}\"]\n", fmt::join(example.arkit, "\", \""));
    }
    if (!examples.feature_vertices.empty()) list += "\n[feature_vertices]\n";
    for (const auto& [feature, vertex] : examples.feature_vertices) list += fmt::format("{} = {}\n", feature, vertex);
    base::write_atomically(folder / example_list_name, list);
}

}  // namespace mimik::animation
