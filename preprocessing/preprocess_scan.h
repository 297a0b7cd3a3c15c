#pragma once

#include "base/fields.h"
#include "database/scan_database.h"
#include "preprocessing/cleaning.h"
#include "preprocessing/face.h"
#include "preprocessing/gridding.h"

namespace mimik::preprocessing {

/// How one scan becomes a face.
struct ScanSteps {
    CleaningOptions cleaning;
    GriddingOptions gridding;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("cleaning", self.cleaning);
        visit("gridding", self.gridding);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<ScanSteps>());

/// One scan to a face in the scanner's frame: cleaned, gridded, landmarks snapped; transforms still identity.
[[nodiscard]] Face preprocess_scan(const database::LoadedScan& loaded, const ScanSteps& steps = {},
                                   CleaningReport* cleaning = nullptr, GriddingReport* gridding = nullptr);

}  // namespace mimik::preprocessing
