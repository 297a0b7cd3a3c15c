#include <array>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/named_figure.h"

// Tables 3-1 to 3-3 of the thesis and the table of its Fig. 5-7. AUs, their muscles and the emotions are the
// catalogue's; the muscles' courses are in our own words after the sources that the thesis names.

namespace mimik::report::thesis_figures {
namespace {

struct Muscle {
    const char *group, *name, *origin, *insertion, *action;
};

constexpr std::array<Muscle, 22> muscles = {{
    {"scalp", "frontalis", "galea aponeurotica", "skin of eyebrows and root of nose",
     "raises the eyebrows, wrinkles the forehead horizontally"},
    {"scalp", "occipitalis", "occipital and temporal bones", "galea aponeurotica", "pulls the scalp back"},
    {"scalp", "temporoparietalis", "fascia above the ear", "galea aponeurotica",
     "tightens the scalp at the temple, raises the ears"},
    {"scalp", "auricularis", "fascia of the scalp", "near the ear lobe", "moves the ears"},
    {"eyelid", "orbicularis oculi", "frontal and maxillary bones, ligaments of the orbit", "tissue of the eyelids",
     "closes and squeezes the eyes, pulls the brows down"},
    {"eyelid", "corrugator supercilii", "frontal bone above the nasal bone", "skin of the eyebrow",
     "draws the brows together and down, wrinkles the forehead vertically"},
    {"eyelid", "depressor supercilii", "root of the nose", "inner corner of the eyebrow",
     "lowers the inner brow, wrinkles the root of the nose horizontally"},
    {"eyelid", "levator palpebrae superioris", "roof of the orbit", "upper eyelid", "raises the upper eyelid"},
    {"nose", "levator labii superioris alaeque nasi", "upper frontal process of the maxilla",
     "skin beside the nostril and upper lip", "widens the nostril, raises the upper lip"},
    {"nose", "nasalis, compressor naris", "maxilla near the canine tooth", "cartilage of the bridge of the nose",
     "narrows the nostril"},
    {"nose", "nasalis, dilator naris", "maxilla above the lateral incisor", "wing of the nose", "widens the nostril"},
    {"nose", "depressor septi", "incisive fossa of the maxilla", "septum of the nose", "draws the nose down"},
    {"nose", "procerus", "lower nasal bone and lateral cartilage", "skin between the brows",
     "draws the skin between the brows down, wrinkles the root of the nose"},
    {"mouth", "zygomaticus major and minor", "zygomatic bone", "corner of the mouth and upper lip",
     "raises the mouth corners up and out"},
    {"mouth", "risorius", "fascia of the masseter", "corner of the mouth", "draws the mouth corner out"},
    {"mouth", "depressor labii inferioris", "body of the mandible, beside its midline", "lower lip",
     "draws the lower lip down"},
    {"mouth", "levator labii superioris", "zygomatic bone and lower rim of the orbit", "upper lip",
     "raises and furrows the upper lip"},
    {"mouth", "depressor anguli oris (triangularis)", "body of the mandible below the incisors", "corner of the mouth",
     "draws the mouth corners down and out"},
    {"mouth", "levator anguli oris (caninus)", "canine fossa of the maxilla", "corner of the mouth",
     "raises the mouth corner"},
    {"mouth", "orbicularis oris", "fibres of the muscles about the mouth", "skin and muscle of the lips",
     "closes, purses and protrudes the lips"},
    {"mouth", "mentalis", "mandible below the incisors", "skin of the chin",
     "pushes up the lower lip, wrinkles the chin"},
    {"mouth", "buccinator", "molar region of maxilla and mandible", "orbicularis oris",
     "draws the mouth corner back, presses the cheek in"},
}};
constexpr Muscle neck = {"neck", "platysma", "fascia of the chest", "lower margin of the mandible, mouth corner",
                         "draws the lower lip down and back, tenses the neck"};

FigurePlan muscles_of_the_head(const FigureCast&) {
    FigurePlan plan;
    plan.table.header = {"group", "muscle", "origin", "insertion", "action"};
    const auto add = [&](const Muscle& m) {
        plan.table.rows.push_back({m.group, m.name, m.origin, m.insertion, m.action});
    };
    for (const auto& muscle : muscles) add(muscle);
    add(neck);
    plan.caption = "Muscles of the head for facial expressions: where they come from, where they go, what they do.";
    return plan;
}

std::string muscles_of(const facs::ActionUnit& unit) {
    std::vector<std::string> names;
    for (const auto& muscle : unit.muscles) names.push_back(muscle.name);
    return fmt::format("{}", fmt::join(names, "; "));
}

FigurePlan units_table(const std::vector<int>& numbers, std::string caption) {
    const auto& catalogue = facs::builtin_catalogue();
    FigurePlan plan;
    plan.table.header = {"AU", "FACS name", "muscular basis"};
    for (const int number : numbers)
        if (const auto* unit = catalogue.find(number))
            plan.table.rows.push_back({std::to_string(number), unit->name, muscles_of(*unit)});
    plan.caption = std::move(caption);
    return plan;
}

FigurePlan single_units(const FigureCast&) {
    return units_table({1,  2,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18,
                        20, 22, 23, 24, 25, 26, 27, 28, 38, 39, 41, 42, 43, 44, 45, 46},
                       "Single Action Units (AU), as Mimik's catalogue has them.");
}

FigurePlan implemented_units(const FigureCast&) {
    return units_table({1, 2, 4, 12, 14, 15, 17, 20},
                       "The Action Units that the thesis implements, and their muscles.");
}

FigurePlan emotions(const FigureCast&) {
    FigurePlan plan;
    plan.table.header = {"emotion", "prototype"};
    const auto catalogue = facs::builtin_catalogue().with_emotions("thesis");
    for (const auto& emotion : catalogue.emotions()) {
        std::vector<std::string> units;
        for (const int unit : emotion.action_units) units.push_back(fmt::format("AU{}", unit));
        plan.table.rows.push_back({emotion.name, fmt::format("{}", fmt::join(units, " + "))});
    }
    plan.caption = "Example sets of Action Units for emotion predictions.";
    return plan;
}

}  // namespace

std::vector<NamedFigure> tables_figures() {
    return {{"table-3-1", "Muscles of the head for facial expressions", "nothing", FigureNeeds::nothing,
             muscles_of_the_head},
            {"table-3-2", "Single Action Units", "nothing", FigureNeeds::nothing, single_units},
            {"table-3-3", "Sets of Action Units for emotions", "nothing", FigureNeeds::nothing, emotions},
            {"table-5-7", "The implemented Action Units and their muscles (table of Fig. 5-7)", "nothing",
             FigureNeeds::nothing, implemented_units}};
}

}  // namespace mimik::report::thesis_figures
