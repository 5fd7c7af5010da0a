// Measure.h - the mean radiance of a view over independent seeds.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

namespace osgRayTrace::engine::test
{

/// Returns the mean green radiance of the picture, with one value for each of 16 seeds. Requires
/// that no sample was dropped.
inline Estimate measure(const std::shared_ptr<const TracedScene>& traced, const View& view,
                        RenderOptions options, int passes)
{
    Estimate estimate;
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        options.seed = seed;
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.status.ok());
        REQUIRE(picture.progress.passes == passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        estimate.add(double(picture.mean().y));
    }
    return estimate;
}

} // namespace osgRayTrace::engine::test
