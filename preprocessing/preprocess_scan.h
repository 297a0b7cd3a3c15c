#pragma once

#include "base/fields.h"
#include "database/scan_database.h"
#include "preprocessing/cleaning.h"
#include "preprocessing/face.h"
#include "preprocessing/face_crop.h"
#include "preprocessing/gridding.h"
#include "preprocessing/landmark_error.h"
#include "preprocessing/pcl_cleaning.h"

namespace mimik::preprocessing {

/// How one scan becomes a face.
struct ScanSteps {
    LandmarkErrorOptions landmark_error;  ///< before all else
    FaceCropOptions crop;
    CleaningMethod cleaning_method = CleaningMethod::own;
    CleaningOptions cleaning;         ///< of the own cleaning
    PclCleaningOptions pcl_cleaning;  ///< of PCL's
    GriddingOptions gridding;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("landmark_error", self.landmark_error);
        visit("crop", self.crop);
        visit("cleaning_method", self.cleaning_method);
        visit("cleaning", self.cleaning);
        visit("pcl_cleaning", self.pcl_cleaning);
        visit("gridding", self.gridding);
    }
    void check() const;  ///< throws InputError, also if PCL is to clean and its module is not there
};
static_assert(base::lists_every_field<ScanSteps>());

/// How the steps went.
struct ScanStepsReport {
    FaceCropReport crop;  ///< all 0 where nothing was cropped
    CleaningReport cleaning;
    GriddingReport gridding;
};

/// One scan to a face in the scanner's frame: cropped, cleaned, gridded, landmarks snapped; transforms still identity.
/// Landmarks outside the crop (ear lobes) have no snapped place. A scan without a landmark that the crop needs is kept
/// whole, with a remark.
[[nodiscard]] Face preprocess_scan(const database::LoadedScan& loaded, const ScanSteps& steps = {},
                                   ScanStepsReport* report = nullptr);

}  // namespace mimik::preprocessing
