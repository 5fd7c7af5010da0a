// LightGrid.h - the sample points of area lights in one pass. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

struct LightGridLayout
{
    LightSampling strategy;
    uint32_t samples; ///< samples that a hit takes of each light in the pass
    uint32_t side;    ///< side of the square of cells
    uint32_t passIndex;
};

/// The sample points on lights by the strategy of the options: samples() points for each hit and
/// light.
class LightGrid
{
public:
    /// Sets the layout of so many points: a square number if the strategy has cells.
    LightGrid(const PassContext& context, int samples);

    /// Returns the number of samples that a hit takes of each light in the pass.
    uint32_t samples() const { return _layout.samples; }

    /// Sets the points of number j, below samples(), on area light number light, for pixels with
    /// these seeds.
    void draw(std::size_t light, uint32_t j, const UintLanes& seeds, FloatLanes& u,
              FloatLanes& v) const;

private:
    LightGridLayout _layout;
};

} // namespace osgRayTrace::engine
