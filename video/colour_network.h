#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "video/colour_transform.h"

namespace mimik::video {

/// A frame whose features are known.
struct LabelledPatch {
    io::Image patch;    ///< of cut_patch()
    FaceCurves curves;  ///< in the patch
};

/// The weights of Eq. 1 that part the features of one labelled patch from its skin best: Fisher's discriminant over M,
/// K, V and G(H), its signs as Sec. 3.1 has them, the sum of their sizes that of the default.
[[nodiscard]] ColourWeights best_weights(const LabelledPatch& labelled);

struct ColourTrainingOptions {
    int variations = 24;     ///< of each labelled patch: other light and other colours of the light
    int rounds = 400;        ///< of back-propagation over all of them
    std::uint64_t seed = 1;  ///< of the variations
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("variations", self.variations);
        visit("rounds", self.rounds);
        visit("seed", self.seed);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<ColourTrainingOptions>());

/// The three-layer network of Sec. 3.1: 11 mean colours, 10 sigmoid units, 4 weights.
class ColourNetwork {
public:
    ~ColourNetwork();
    ColourNetwork(ColourNetwork&&) noexcept;

    /// Back-propagation (OpenCV's ml). @throws InputError if there is no labelled patch.
    [[nodiscard]] static ColourNetwork train(std::span<const LabelledPatch> labelled, const std::string& made_of,
                                             const ColourTrainingOptions& options = {});
    /// @throws InputError if the file is not one of save()'s.
    [[nodiscard]] static ColourNetwork load(const std::filesystem::path& file);
    /// The one that comes with Mimik.
    [[nodiscard]] static ColourNetwork shipped();
    void save(const std::filesystem::path& file) const;

    [[nodiscard]] ColourWeights weights(const ColourInputs& inputs) const;
    [[nodiscard]] const std::string& made_of() const;  ///< what it was trained on

private:
    struct Parts;
    explicit ColourNetwork(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

}  // namespace mimik::video
