#include "io/texture_path.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::io {

std::string checked_texture_path(const std::string& texture, const std::string& file) {
    std::string path;
    bool good = true;
    for (std::size_t begin = 0; begin <= texture.size();) {
        const auto end = std::min(texture.find('/', begin), texture.size());
        const auto part = std::string_view(texture).substr(begin, end - begin);
        begin = end + 1;
        if (part == "." && end < texture.size()) continue;
        good = good && !part.empty() && part != "." && part != ".." && part.size() <= 255 &&
               part.find_first_of("\\:") == std::string_view::npos &&
               std::none_of(part.begin(), part.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
        path += path.empty() ? "" : "/";
        path += part;
    }
    if (!good || path.size() > 4096)
        throw InputError(
            fmt::format("{}: texture name is {}; put the image into the mesh's folder or one below it, and name it "
                        "from there, with '/' and without '..'",
                        file, base::in_quotes(texture)));
    return path;
}

}  // namespace mimik::io
