#include <algorithm>

#include "database/manifest.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto manifest = database::parse_manifest(text_of(bytes), "/folder/manifest.csv");
    for (const auto& scan : manifest.scans) {
        for (const auto& file : {scan.scan_file, scan.landmarks_file}) {
            const auto text = file.lexically_normal().string();
            require(file.empty() || text.starts_with("/folder/"), "no path leads out of the folder");
        }
        require(database::parse_scan_name(scan.id.name()) == scan.id, "a scan's name can be read back");
    }
}

std::vector<std::string> seeds() {
    return {"subject,expression,scan,landmarks,sex,unit\nanna,N,a/x.ply,a/x.pp,f,mm\nanna,AU12_L,b.obj,,,cm\n",
            "subject,expression,scan\n\"b \"\"q\"\"\",AU22+AU25,../x.stl\n",
            "scan,subject,expression\nx.pcd,J_D,bite lip\ny.pcd,J_D,e lips\x1d\n",
            "scan,subject,expression\nx.pcd,J,E_\u00e9\ny.pcd,J,\u5fae\u7b11\nz.pcd,J,A01A012LW\n"};
}

}  // namespace mimik::fuzzing
