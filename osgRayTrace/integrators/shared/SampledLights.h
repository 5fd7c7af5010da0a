// SampledLights.h - which lights a pass samples at each surface point, where there are many. Layer:
// integrators.
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

/// Area lights of which each gets RenderOptions::lightSamples samples at a point. More of them
/// share what so many would get: fewer samples each, down to one, and beyond that some of the
/// lights in each pass.
constexpr std::size_t kMostAreaLights = 64;

/// Point, spot and directional lights that a pass takes light from. With a size they share samples
/// as area lights do.
constexpr std::size_t kMostDeltaLights = 256;

/// A light of which samples are taken, and what they are multiplied with: 1 if all lights are
/// sampled.
struct SampledLight
{
    uint32_t light = kInvalid;
    float weight = 1.0f;
};

/// The lights that a pass takes samples of: all of a table's list, for which no memory is needed,
/// or some of them. The list must outlive this.
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

/// Samples that a point takes in a pass of each of so many area lights: whole squares where the
/// strategy has cells.
int samplesOfEach(const RenderOptions& options, std::size_t lights);

/// The lights of a pass. All, or else about as many as a pass may sample, chosen by power: by
/// points that are evenly spaced in the sum of all powers, and moved from pass to pass by the
/// golden section, so that the expected light is that of all, and successive passes choose others
/// [systematic sampling: Cochran77, ch. 8]. The same for all points of a pass.
SampledLights sampledAreaLights(const PassContext& context);
SampledLights sampledDeltaLights(const PassContext& context);

/// How many lights of a scene a pass samples.
struct SampledLightCounts
{
    std::size_t areaLights = 0,
                sampledAreaLights = 0;       ///< 0 unless the integrator samples all that it may
    int samplesOfEach = 0, wantedOfEach = 0; ///< of area lights
    std::size_t deltaLights = 0, sampledDeltaLights = 0;
};
SampledLightCounts sampledLightCounts(const PassContext& context);

} // namespace osgRayTrace::engine
