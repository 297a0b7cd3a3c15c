#include "synthesis/builtin_muscles.h"

namespace mimik::synthesis {

/// Amplitudes and directions: order of magnitude after the facial action coding system's descriptions and landmark
/// motions of artist-made face rigs; muscles after their anatomical origins and insertions. (lateral, up, forward), mm.
const std::map<std::string, Motion>& facial_motions() {
    static const std::map<std::string, Motion> motions = [] {
        std::map<std::string, Motion> m;
        // Frontalis, medial and lateral part.
        m["browInnerUp"] = {.muscles = {{{12, 12}, {11, 54}, {0.6, 5.9, -0.3}, 36, 17, 27}},
                            .furrows = {{{{-5, 29}, {10, 28}, {27, 32}}, 0.65, 1.7},
                                        {{{-5, 37}, {10, 36}, {28, 40}}, 0.75, 1.7},
                                        {{{-5, 45}, {10, 44}, {26, 48}}, 0.55, 1.7}}};
        m["browOuterUp"] = {.muscles = {{{46, 14}, {50, 54}, {1.9, 8.0, -2.8}, 34, 16, 23}},
                            .furrows = {{{{28, 30}, {43, 32}, {58, 26}}, 0.65, 1.7},
                                        {{{28, 38}, {43, 40}, {57, 35}}, 0.65, 1.7},
                                        {{{30, 46}, {43, 48}, {55, 44}}, 0.45, 1.7}}};
        // Corrugator and depressor supercilii, procerus.
        m["browDown"] = {
            .muscles = {{{20, 12}, {2, -2}, {-4.0, -3.7, 2.2}, 26, 26, 18},
                        {{6, 12}, {4, -14}, {-0.4, -2.6, 0.5}, 20, 20, 13}},
            .furrows = {{{{6.5, 3}, {7.5, 12}, {9.5, 23}}, 1.2, 1.4}, {{{-8, 1}, {0, 0}, {9, 1}}, 0.6, 1.3}},
            .bulges = {{{14, 14}, 0.9, 8, 8}, {{0, 12}, 0.5, 6, 12}}};
        m["eyeWide"] = {.sphincter = {.upper_lid_lift_mm = 3.2}};
        m["eyeBlink"] = {.sphincter = {.upper_lid_down = 0.86, .lower_lid_up = 0.08}};
        m["eyeSquint"] = {.muscles = {{{31, -17}, {22, -8}, {-1.8, 1.0, 0.2}, 18, 18, 20}},
                          .furrows = {{{{20, -17.5}, {31, -20}, {43, -16}}, 0.5, 1.3}},
                          .bulges = {{{30, -14}, 0.8, 14, 3.6}},
                          .sphincter = {.upper_lid_down = 0.10, .lower_lid_up = 0.27}};
        // Orbicularis oculi, orbital part.
        m["cheekSquint"] = {.muscles = {{{37, -28}, {32, 2}, {-0.8, 5.7, 2.0}, 21, 36, 27},
                                        {{50, 9}, {44, -8}, {-0.4, -1.2, 0}, 15, 15, 14}},
                            .furrows = {{{{47, -3}, {55, 0}, {63, 5}}, 0.8, 1.2},
                                        {{{48, -8}, {56, -8.5}, {65, -8}}, 0.9, 1.2},
                                        {{{47, -13}, {55, -16}, {63, -21}}, 0.8, 1.2},
                                        {{{19, -17}, {31, -21}, {43, -18}}, 0.65, 1.7}},
                            .bulges = {{{36, -27}, 1.3, 18, 8}}};
        // Levator labii superioris alaeque nasi.
        m["noseSneer"] = {.muscles = {{{16, -38}, {10, -2}, {-1.3, 8.8, 0.3}, 32, 30, 15, Lip::upper},
                                      {{10, 10}, {8, -8}, {-0.4, -1.6, 0.4}, 16, 16, 13}},
                          .furrows = {{{{4, -10}, {9, -9}, {14, -5}}, 0.7, 1.2},
                                      {{{5, -15.5}, {10, -14}, {16, -9}}, 0.8, 1.2},
                                      {{{6, -21}, {11, -19.5}, {18, -14}}, 0.7, 1.2},
                                      {{{17, -38}, {20, -47}, {25, -57}}, 1.1, 1.7, Lip::upper}},
                          .bulges = {{{24, -38}, 1.0, 9, 10}}};
        // Levator labii superioris.
        m["mouthUpperUp"] = {.muscles = {{{14, -72}, {21, -26}, {2.0, 8.0, -1.0}, 46, 16, 23, Lip::upper},
                                         {{21, -52}, {24, -20}, {0.6, 2.2, 0}, 26, 22, 13, Lip::upper}},
                             .furrows = {{{{16, -42}, {22, -51}, {28, -62}, {30, -70}}, 1.3, 1.8, Lip::upper}},
                             .bulges = {{{30, -48}, 1.4, 11, 14, Lip::upper}}};
        // Zygomaticus major.
        m["mouthSmile"] = {.muscles = {{{24.7, -77}, {56, -26}, {6.6, 9.3, -7.8}, 50, 36, 33},
                                       {{14, -77}, {50, -30}, {1.6, 2.6, -2.4}, 26, 24, 22}},
                           .furrows = {{{{16, -42}, {24, -50}, {33, -62}, {38, -76}}, 1.1, 2.1}},
                           .bulges = {{{41, -42}, 2.2, 19, 20}}};
        // Buccinator.
        m["mouthDimple"] = {.muscles = {{{25, -77}, {60, -62}, {1.2, 3.6, -6.0}, 32, 22, 22}},
                            .furrows = {{{{35, -64}, {38.5, -76}, {35, -89}}, 0.8, 2.6}},
                            .bulges = {{{33, -76}, -1.1, 8, 9}, {{46, -76}, 0.8, 11, 16}}};
        // Depressor anguli oris.
        m["mouthFrown"] = {.muscles = {{{24.7, -77}, {34, -112}, {1.9, -5.2, -2.3}, 30, 22, 20}},
                           .furrows = {{{{26, -80}, {29.5, -89}, {30, -100}}, 0.7, 2.4}},
                           .bulges = {{{37, -90}, 0.9, 11, 13}}};
        // Depressor labii inferioris.
        m["mouthLowerDown"] = {.muscles = {{{11, -82}, {19, -112}, {1.0, -4.4, -1.4}, 28, 18, 18, Lip::lower}}};
        // Mentalis; the lower lip carries the upper one up.
        m["mouthShrugLower"] = {.central = true,
                                .muscles = {{{0, -100}, {0, -60}, {0, 8.4, 3.2}, 62, 30, 31, Lip::lower},
                                            {{0, -80}, {0, -60}, {0, -0.4, 1.4}, 16, 12, 22, Lip::lower}},
                                .furrows = {{{{-16, -91}, {-8, -94.5}, {0, -95.5}, {8, -94.5}, {16, -91}}, 1.4, 2.0}},
                                .bulges = {{{0, -105}, 1.3, 15, 9}, {{0, -88}, 0.8, 16, 5, Lip::lower}}};
        m["mouthShrugUpper"] = {.central = true,
                                .muscles = {{{0, -75}, {0, -40}, {0, 5.8, 1.6}, 30, 12, 21, Lip::upper}}};
        // Incisivi: corners in, lips forward.
        m["mouthPucker"] = {.central = true,
                            .muscles = {{{24.7, -77}, {2, -74}, {-4.7, 1.8, 8.0}, 28, 26, 24},
                                        {{-24.7, -77}, {-2, -74}, {4.7, 1.8, 8.0}, 28, 26, 24},
                                        {{0, -78}, {0, -60}, {0, 0.6, 8.8}, 22, 20, 26}},
                            .furrows = {{{{3.5, -60}, {3.2, -69}, {2.8, -76}}, 0.35, 0.9, Lip::upper},
                                        {{{-3.5, -60}, {-3.2, -69}, {-2.8, -76}}, 0.35, 0.9, Lip::upper},
                                        {{{10, -61}, {9, -69}, {8, -76}}, 0.45, 1.0, Lip::upper},
                                        {{{-10, -61}, {-9, -69}, {-8, -76}}, 0.45, 1.0, Lip::upper},
                                        {{{6, -79}, {6.5, -86}, {7.5, -93}}, 0.45, 1.0, Lip::lower},
                                        {{{-6, -79}, {-6.5, -86}, {-7.5, -93}}, 0.45, 1.0, Lip::lower}}};
        m["mouthFunnel"] = {.central = true,
                            .muscles = {{{24.7, -77}, {2, -74}, {-3.2, -1.0, 3.4}, 26, 26, 24},
                                        {{-24.7, -77}, {-2, -74}, {3.2, -1.0, 3.4}, 26, 26, 24},
                                        {{0, -74}, {0, -40}, {0, 2.6, 6.6}, 26, 18, 24, Lip::upper},
                                        {{0, -82}, {0, -112}, {0, -7.4, 6.8}, 34, 20, 24, Lip::lower}}};
        // Risorius with platysma.
        m["mouthStretch"] = {
            .muscles = {{{24.7, -77}, {66, -88}, {6.8, -2.6, -6.8}, 50, 32, 26}},
            .furrows = {{{{36, -64}, {39, -76}, {37, -90}}, 0.7, 2.5}, {{{44, -66}, {47, -77}, {45, -90}}, 0.45, 2.6}}};
        m["mouthPress"] = {.muscles = {{{13, -90}, {12, -77}, {-0.2, 2.2, 0.4}, 18, 16, 17, Lip::lower}},
                           .bulges = {{{13, -65.5}, 1.1, 13, 5, Lip::upper}, {{13, -90.5}, 1.4, 13, 5.5, Lip::lower}},
                           .sphincter = {.upper_roll_mm = 1.5, .lower_roll_mm = 1.5, .press = 0.42}};
        m["mouthRollUpper"] = {.central = true,
                               .bulges = {{{0, -64}, 0.8, 22, 5, Lip::upper}},
                               .sphincter = {.upper_roll_mm = 8.5, .press = 0.7}};
        m["mouthRollLower"] = {.central = true,
                               .bulges = {{{0, -92}, 0.9, 22, 6, Lip::lower}},
                               .sphincter = {.lower_roll_mm = 9.5, .press = 0.7}};
        // Air behind the cheek.
        m["cheekPuff"] = {.muscles = {{{44, -70}, {44, -40}, {0.6, 0.8, 4.6}, 34, 36, 32}},
                          .bulges = {{{45, -71}, 6.2, 40, 38}}};
        m["jawOpen"] = {.central = true, .sphincter = {.jaw_rad = 0.35}};
        return m;
    }();
    return motions;
}

}  // namespace mimik::synthesis
