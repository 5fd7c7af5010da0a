// LightGrid.h - the sample points of area lights in one pass. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

struct LightGridLayout
{
    LightSampling strategy;
    uint32_t samples; ///< that a hit takes of each light in the pass
    uint32_t side;    ///< of the square of cells
    uint32_t passIndex;
};

/// Points by the strategy of the options, samples of them for each hit and light.
class LightGrid
{
public:
    /// lights: that share the samples of a point, see samplesOfEach.
    LightGrid(const PassContext& context, std::size_t lights);

    /// Samples that a hit takes of each light in the pass.
    uint32_t samples() const { return _layout.samples; }

    /// Points number j, below samples(), on the light-th area light, for pixels with these seeds.
    void draw(std::size_t light, uint32_t j, const UintLanes& seeds, FloatLanes& u,
              FloatLanes& v) const;

private:
    LightGridLayout _layout;
};

} // namespace osgRayTrace::engine
