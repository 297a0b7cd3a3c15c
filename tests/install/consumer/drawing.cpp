#include <iostream>

#include "figures/colour_map.h"

int main() {
    const auto colour = mimik::figures::map_colour(mimik::figures::parse_colour_map("diverging"), 0);
    std::cout << "blue " << int{colour[2]} << '\n';
}
