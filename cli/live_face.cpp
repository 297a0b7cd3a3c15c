#include "cli/live_face.h"

#include <filesystem>

#include "cli/performer_examples.h"
#include "database/hidden_subjects.h"

namespace mimik::cli {

LiveFace::LiveFace(const LiveArguments& arguments, double rate_hz, int neutral_from)
    : arguments_(arguments), neutral_from_(neutral_from) {
    options_.gain = arguments.gain;
    options_.clamp = arguments.clamp;
    check_by_option({{"gain", "--gain"}}, [&] { options_.check(); });
    const auto neutral_file = std::filesystem::path(arguments.examples) / "neutral.ply";
    if (std::filesystem::exists(neutral_file)) database::refuse_hidden_file(neutral_file);
    character_ = animation::read_facial_examples(arguments.examples);
    std::vector<std::vector<geometry::Vector>> displacements;
    for (const auto& example : character_.examples) displacements.push_back(example.displacement_mm);
    blender_.emplace(character_.neutral.vertices_mm, displacements);
    vertices_mm_ = character_.neutral.vertices_mm;
    weights_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(character_.examples.size()));
    for (const auto& feature : capture::face_features()) motion_.names.emplace_back(feature.name);
    motion_.rate_hz = rate_hz;
    table_ = arguments.source_examples.empty() ? modeling::standard_source_examples()
                                               : modeling::read_source_examples(arguments.source_examples);
    (void)examples_of_character(table_, character_, arguments.examples, remarks_);  // before the work
    remarks_.clear();
}

void LiveFace::take(const video::FeatureRows::Row& row) {
    if (mapper_)
        weights_ = columns_.transpose() * mapper_->next(row.features).weights;
    else if (row.features.state == capture::TrackState::tracked)
        waiting_.emplace_back(row.frame, row.features);
}

void LiveFace::begin() {
    if (mapper_ || waiting_.empty()) return;
    for (const auto& [frame, features] : waiting_)
        if (frame >= neutral_from_) motion_.frames.push_back(features);
    if (motion_.frames.empty()) motion_.frames.push_back(waiting_.front().second);
    auto rest = animation::performer_rest(motion_, 0, motion_.frames.size() - 1);
    mapping_.emplace(examples_of_character(animation::fitted_examples(table_, motion_, rest), character_,
                                           arguments_.examples, remarks_),
                     options_);
    const auto& names = mapping_->source().examples;
    const auto count = static_cast<Eigen::Index>(names.size());
    columns_ = columns_of(character_, names, Eigen::MatrixXd::Identity(count, count), remarks_);
    mapper_.emplace(motion_, std::move(rest), *mapping_);
    motion_.frames.clear();
    waiting_.clear();
}

void LiveFace::blend() { blender_->blend(weights(), vertices_mm_); }

io::Image LiveFace::picture(int size_px) {
    if (!painter_) {
        io::Image texture;
        if (!character_.texture_file.empty()) texture = io::read_image(character_.texture_file);
        report::ShadedFaceOptions options;
        options.width = options.height = size_px;
        painter_.emplace(character_.neutral, std::move(texture), options);
    }
    return painter_->picture(vertices_mm_);
}

std::vector<std::string> LiveFace::examples() const {
    std::vector<std::string> names;
    for (const auto& example : character_.examples) names.push_back(example.name);
    return names;
}

}  // namespace mimik::cli
