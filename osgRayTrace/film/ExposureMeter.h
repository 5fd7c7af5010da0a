// ExposureMeter.h - the exposure that the mean of a picture asks for. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/Film.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Returns the exposure [EV] that shows the mean luminance of a film as middle grey, 0.18: the mean
/// of logarithms [Reinhard02, eq. 1], over all pixels that show light, between -16 and 16. Black
/// pixels do not count, and those below 1/64 of the arithmetic mean count as that, so that shadows
/// do not decide. Reads most tiles or fewer, evenly spread. Nothing if they show nothing but black.
std::optional<float> meteredEv(const Film& film, bool displayReferred, int most);

/// An exposure that follows what a meter tells in small steps, and not its noise.
class EasedExposure
{
public:
    /// Returns the exposure of the next picture, for a new reading: the first one as it is, later
    /// ones a step nearer if they are off by more than kTolerance.
    float follow(float reading);

    void reset()
    {
        _value.reset();
        _moving = false;
    }

    /// Stays where it is until the next reading.
    void rest() { _moving = false; }

    /// Returns whether the next reading, if it is the same, changes the exposure.
    bool isMoving() const { return _moving; }

    static constexpr float kTolerance = 0.15f; ///< [EV]
    static constexpr float kStep = 0.2f;       ///< share of the difference that a step takes

private:
    std::optional<float> _value;
    bool _moving = false;
};

} // namespace osgRayTrace::engine
