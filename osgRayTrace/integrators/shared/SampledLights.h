// SampledLights.h - the choice of the lights that a pass samples. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

struct PassContext;

/// The largest number of area lights of which each gets RenderOptions::lightSamples samples at a
/// point. A larger number of lights shares the samples that so many lights would get: each light
/// gets fewer samples, down to one, and if one is still too many, each pass samples some of the
/// lights.
constexpr std::size_t kMostAreaLights = 64;

/// The largest number of point, spot and directional lights that a pass takes light from. Those
/// with a size share samples as area lights do.
constexpr std::size_t kMostDeltaLights = 256;

/// A light that is sampled, and the factor of its samples: 1 if all lights are sampled.
struct SampledLight
{
    uint32_t light = kInvalid;
    float weight = 1.0f;
};

/// The lights that a pass samples: all lights of a list of the table, without memory of their own,
/// or some of them. The list must outlive the SampledLights.
class SampledLights
{
public:
    explicit SampledLights(const std::vector<uint32_t>& all) : _all(&all) {}
    explicit SampledLights(std::vector<SampledLight> some) : _some(std::move(some)) {}

    std::size_t size() const { return _all ? _all->size() : _some.size(); }
    bool empty() const { return size() == 0; }
    SampledLight operator[](std::size_t k) const
    {
        return _all ? SampledLight{(*_all)[k], 1.0f} : _some[k];
    }

private:
    const std::vector<uint32_t>* _all = nullptr; ///< null: some are sampled
    std::vector<SampledLight> _some;
};

/// Returns the number of samples that a point takes in a pass of each of so many area lights: a
/// square number if the strategy has cells.
int samplesOfEach(const RenderOptions& options, std::size_t lights);

/// Returns the lights that a pass samples: all, or else about as many as a pass may sample, chosen
/// by power. The choice takes points that are evenly spaced in the sum of all powers and that the
/// golden section moves from pass to pass. So the expected light is that of all lights, and
/// successive passes choose others [systematic sampling: Cochran77, ch. 8]. All points of a pass
/// share the choice.
SampledLights sampledAreaLights(const PassContext& context);
SampledLights sampledDeltaLights(const PassContext& context);

/// The numbers of lights of a scene, and of those that a pass samples.
struct SampledLightCounts
{
    std::size_t areaLights = 0,
                sampledAreaLights = 0;       ///< 0 unless the integrator samples all that it may
    int samplesOfEach = 0, wantedOfEach = 0; ///< samples of each area light, taken and wanted
    std::size_t deltaLights = 0, sampledDeltaLights = 0;
};
SampledLightCounts sampledLightCounts(const PassContext& context);

} // namespace osgRayTrace::engine
