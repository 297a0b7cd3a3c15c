#pragma once

#include <vector>

#include "base/fields.h"

namespace mimik::video {

/// The one-euro filter (Casiez, Roussel and Vogel 2012): a low pass whose cutoff grows with speed.
struct OneEuroOptions {
    double cutoff_hz = 2;        ///< of what is still: it lags by about 1 / (2 pi cutoff) s, 80 ms at 2 Hz
    double speed = 0.5;          ///< what is added to the cutoff for each unit of speed (here mm or pixels a second)
    double speed_cutoff_hz = 1;  ///< of the speed itself
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("cutoff_hz", self.cutoff_hz);
        visit("speed", self.speed);
        visit("speed_cutoff_hz", self.speed_cutoff_hz);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<OneEuroOptions>());

class OneEuroFilter {
public:
    OneEuroFilter(double rate_hz, const OneEuroOptions& options = {});
    /// The next value, smoothed. Of the first one, itself.
    double operator()(double value);
    void restart() { started_ = false; }

private:
    double rate_hz_;
    OneEuroOptions options_;
    bool started_ = false;
    double last_ = 0, smooth_ = 0, speed_ = 0;
};

}  // namespace mimik::video
