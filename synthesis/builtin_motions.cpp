#include "synthesis/builtin_muscles.h"

// Amplitudes and directions: order of magnitude after the facial action coding system's descriptions and landmark
// motions of artist-made face rigs; muscles after their anatomical origins and insertions. (lateral, up, forward), mm.

namespace mimik::synthesis {
namespace {

using Motions = std::map<std::string, Motion>;

/// Brows, lids and what the ring around the eye lifts.
void add_brows_and_eyes(Motions& m) {
    // Frontalis, medial and lateral part.
    m["browInnerUp"] = {.muscles = {{{16, 13}, {15, 60}, {0.6, 6.0, -0.3}, 56, 30, 33}},
                        .furrows = {{{{-5, 29}, {10, 28}, {27, 32}}, 0.45, 1.7},
                                    {{{-5, 37}, {10, 36}, {28, 40}}, 0.55, 1.7},
                                    {{{-5, 45}, {10, 44}, {26, 48}}, 0.4, 1.7}}};
    m["browOuterUp"] = {.muscles = {{{44, 15}, {48, 60}, {1.9, 8.0, -2.7}, 52, 28, 36}},
                        .furrows = {{{{28, 30}, {43, 32}, {58, 26}}, 0.4, 1.7},
                                    {{{28, 38}, {43, 40}, {57, 35}}, 0.45, 1.7},
                                    {{{30, 46}, {43, 48}, {55, 44}}, 0.3, 1.7}}};
    // Corrugator and depressor supercilii, procerus.
    m["browDown"] = {.muscles = {{{24, 13}, {3, -2}, {-4.2, -3.6, 2.0}, 36, 42, 32},
                                 {{6, 12}, {4, -14}, {-0.3, -2.6, 0.4}, 24, 26, 18}},
                     .furrows = {{{{6.5, 3}, {7.5, 12}, {9.5, 23}}, 0.9, 1.3}, {{{-8, 1}, {0, 0}, {9, 1}}, 0.5, 1.3}}};
    m["eyeWide"] = {.sphincter = {.upper_lid_lift_mm = 3.2}};
    m["eyeBlink"] = {.sphincter = {.upper_lid_down = 0.86, .lower_lid_up = 0.08}};
    m["eyeSquint"] = {.muscles = {{{31, -17}, {22, -8}, {-2.2, 1.2, 0.2}, 22, 26, 28}},
                      .furrows = {{{{20, -17.5}, {31, -20}, {43, -16}}, 0.4, 1.3}},
                      .bulges = {{{30, -14}, 0.6, 14, 3.6}},
                      .sphincter = {.upper_lid_down = 0.10, .lower_lid_up = 0.27}};
    // Orbicularis oculi, orbital part.
    m["cheekSquint"] = {.muscles = {{{38, -29}, {33, 2}, {-0.8, 5.7, 1.4}, 24, 50, 38},
                                    {{50, 9}, {44, -8}, {-0.4, -1.2, 0}, 18, 20, 18}},
                        .furrows = {{{{47, -3}, {55, 0}, {63, 5}}, 0.6, 1.2},
                                    {{{48, -8}, {56, -8.5}, {65, -8}}, 0.7, 1.2},
                                    {{{47, -13}, {55, -16}, {63, -21}}, 0.6, 1.2},
                                    {{{19, -17}, {31, -21}, {43, -18}}, 0.5, 1.7}}};
}

/// Nose, and what pulls lips and corners up, aside and down.
void add_nose_and_lips(Motions& m) {
    // Levator labii superioris alaeque nasi.
    m["noseSneer"] = {.muscles = {{{19, -39}, {11, -2}, {-1.4, 8.8, 0.2}, 38, 42, 28, Lip::upper},
                                  {{10, 10}, {8, -8}, {-0.4, -1.6, 0.4}, 18, 22, 18}},
                      .furrows = {{{{4, -10}, {9, -9}, {14, -5}}, 0.5, 1.2},
                                  {{{5, -15.5}, {10, -14}, {16, -9}}, 0.6, 1.2},
                                  {{{6, -21}, {11, -19.5}, {18, -14}}, 0.5, 1.2},
                                  {{{16, -40}, {19, -48}, {24, -59}}, 0.45, 2.0, Lip::upper}}};
    // Levator labii superioris.
    m["mouthUpperUp"] = {.muscles = {{{15, -72}, {22, -26}, {2.0, 7.8, -1.2}, 56, 18, 30, Lip::upper},
                                     {{22, -52}, {25, -18}, {0.5, 1.6, 0}, 32, 24, 18, Lip::upper}},
                         .furrows = {{{{16, -43}, {19.5, -49}, {24.5, -60}, {28.5, -70}}, 0.45, 2.2, Lip::upper}}};
    // Zygomaticus major.
    m["mouthSmile"] = {.muscles = {{{24.7, -77}, {58, -28}, {6.6, 9.3, -7.8}, 66, 44, 44},
                                   {{14, -77}, {50, -30}, {1.0, 2.0, -2.0}, 30, 26, 24}},
                       .furrows = {{{{16, -43}, {19, -49}, {24, -60}, {29, -72}}, 0.5, 2.2}}};
    // Buccinator: the corner against the teeth, the cheek before it folded outward.
    m["mouthDimple"] = {.muscles = {{{25, -77}, {62, -66}, {1.2, 2.6, -5.4}, 56, 34, 48}},
                        .furrows = {{{{33, -67}, {35.5, -76}, {33, -86}}, 0.9, 2.4}},
                        .bulges = {{{58, -70}, 1.2, 28, 34}}};
    // Depressor anguli oris.
    m["mouthFrown"] = {.muscles = {{{24.7, -77}, {33, -114}, {1.9, -5.1, -2.2}, 42, 40, 32}},
                       .furrows = {{{{26, -81}, {29, -90}, {30, -100}}, 0.45, 2.2}}};
    // Depressor labii inferioris.
    m["mouthLowerDown"] = {.muscles = {{{11, -82}, {19, -112}, {1.0, -4.4, -1.4}, 38, 24, 28, Lip::lower}}};
    // Mentalis; the lower lip carries the upper one up.
    m["mouthShrugLower"] = {.central = true,
                            .muscles = {{{0, -102}, {0, -60}, {0, 9.4, 2.2}, 64, 34, 42, Lip::lower},
                                        {{0, -80}, {0, -60}, {0, -0.4, 2.4}, 18, 14, 26, Lip::lower}},
                            .furrows = {{{{-16, -91}, {-8, -94.5}, {0, -95.5}, {8, -94.5}, {16, -91}}, 0.9, 2.0}}};
    m["mouthShrugUpper"] = {.central = true, .muscles = {{{0, -75}, {0, -40}, {0, 5.8, 1.4}, 36, 14, 28, Lip::upper}}};
}

/// What purses, stretches, presses and rolls the lips.
void add_mouth_shapes(Motions& m) {
    // Incisivi: corners in, lips forward.
    m["mouthPucker"] = {.central = true,
                        .muscles = {{{24.7, -77}, {2, -74}, {-5.0, 1.8, 7.0}, 30, 42, 36},
                                    {{-24.7, -77}, {-2, -74}, {5.0, 1.8, 7.0}, 30, 42, 36},
                                    {{0, -78}, {0, -60}, {0, 0.6, 6.4}, 30, 28, 32}},
                        .furrows = {{{{3.5, -60}, {3.2, -69}, {2.8, -76}}, 0.3, 0.9, Lip::upper},
                                    {{{-3.5, -60}, {-3.2, -69}, {-2.8, -76}}, 0.3, 0.9, Lip::upper},
                                    {{{10, -61}, {9, -69}, {8, -76}}, 0.4, 1.0, Lip::upper},
                                    {{{-10, -61}, {-9, -69}, {-8, -76}}, 0.4, 1.0, Lip::upper},
                                    {{{6, -79}, {6.5, -86}, {7.5, -93}}, 0.4, 1.0, Lip::lower},
                                    {{{-6, -79}, {-6.5, -86}, {-7.5, -93}}, 0.4, 1.0, Lip::lower}}};
    m["mouthFunnel"] = {.central = true,
                        .muscles = {{{24.7, -77}, {2, -74}, {-3.4, -1.0, 3.0}, 28, 40, 36},
                                    {{-24.7, -77}, {-2, -74}, {3.4, -1.0, 3.0}, 28, 40, 36},
                                    {{0, -74}, {0, -40}, {0, 2.6, 6.2}, 34, 20, 32, Lip::upper},
                                    {{0, -82}, {0, -112}, {0, -7.4, 6.4}, 44, 24, 34, Lip::lower}}};
    // Risorius with platysma.
    m["mouthStretch"] = {.muscles = {{{24.7, -77}, {70, -88}, {6.9, -2.6, -6.2}, 64, 40, 42}},
                         .furrows = {{{{37, -66}, {40, -77}, {38, -89}}, 0.5, 2.3}}};
    m["mouthPress"] = {.muscles = {{{13, -90}, {12, -77}, {-0.2, 2.2, 0.4}, 22, 26, 26, Lip::lower}},
                       .bulges = {{{13, -65.5}, 0.9, 16, 6, Lip::upper}, {{13, -90.5}, 1.1, 16, 6.5, Lip::lower}},
                       .sphincter = {.upper_roll_mm = 1.5, .lower_roll_mm = 1.5, .press = 0.42}};
    m["mouthRollUpper"] = {.central = true,
                           .bulges = {{{0, -64}, 0.8, 24, 6, Lip::upper}},
                           .sphincter = {.upper_roll_mm = 8.5, .press = 0.7}};
    m["mouthRollLower"] = {.central = true,
                           .bulges = {{{0, -92}, 0.9, 24, 7, Lip::lower}},
                           .sphincter = {.lower_roll_mm = 9.5, .press = 0.7}};
}

/// Cheeks full of air, and the jaw.
void add_cheeks_and_jaw(Motions& m) {
    // Air behind the cheek.
    m["cheekPuff"] = {.muscles = {{{44, -70}, {44, -40}, {0.6, 0.8, 4.4}, 44, 46, 42}},
                      .bulges = {{{46, -70}, 7.0, 50, 48}}};
    m["jawOpen"] = {.central = true, .sphincter = {.jaw_rad = 0.35}};
    // Both lateral pterygoids, or the one of the other side.
    // The lower lip comes to stand before the upper one and over its red; the corners are drawn down with the chin.
    m["jawForward"] = {
        .central = true,
        .muscles = {{{0, -82}, {0, -60}, {0, 3.4, 1.6}, 22, 14, 26, Lip::lower},
                    {{24.7, -77}, {28, -110}, {0, -1.8, 0}, 26, 26, 18},
                    {{-24.7, -77}, {-28, -110}, {0, -1.8, 0}, 26, 26, 18}},
        .furrows = {{{{25, -80}, {30, -92}, {29, -104}}, 0.6, 2.0}, {{{-25, -80}, {-30, -92}, {-29, -104}}, 0.6, 2.0}},
        .sphincter = {.jaw_rad = 0.02, .jaw_forward_mm = 10.5}};
    m["jawLeft"] = {.central = true, .sphincter = {.jaw_left_mm = 8.9}};
    m["jawRight"] = {.central = true, .sphincter = {.jaw_left_mm = -8.9}};
}

}  // namespace

const std::map<std::string, Motion>& facial_motions() {
    static const Motions motions = [] {
        Motions m;
        add_brows_and_eyes(m);
        add_nose_and_lips(m);
        add_mouth_shapes(m);
        add_cheeks_and_jaw(m);
        return m;
    }();
    return motions;
}

}  // namespace mimik::synthesis
