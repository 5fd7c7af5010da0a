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

/// Whitted's integrator samples each light at each point up to this number of lights. Of more
/// lights a point takes kTreePicks times RenderOptions::lightSamples samples, which the LightTree
/// chooses.
constexpr std::size_t kMostLoopedLights = 32;
constexpr int kTreePicks = 4;

/// The largest number of lights beside the tree that a pass takes light from.
constexpr std::size_t kMostDeltaLights = 256;

/// The largest number of suns of which each gets RenderOptions::lightSamples samples at a point.
/// More of them share the samples that so many would get, down to one of each.
constexpr std::size_t kMostFullySampled = 64;

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

/// Returns the number of samples that a point takes in a pass of each of so many lights with a
/// size: a square number if the strategy has cells.
int samplesOfEach(const RenderOptions& options, std::size_t lights);

/// Returns whether light samples of the integrator are those of the LightTree. Path tracing uses
/// the tree if there is one.
bool samplesTree(const PassContext& context);

/// Returns the area lights of which each is sampled: all of them without samplesTree, else none.
SampledLights sampledAreaLights(const PassContext& context);

/// Returns the delta lights that a pass samples: all that the tree does not sample, or else about
/// as many as a pass may sample, chosen by power. The choice takes points that are evenly spaced in
/// the sum of all powers and that the golden section moves from pass to pass. So the expected light
/// is that of all lights, and successive passes choose others [systematic sampling: Cochran77, ch.
/// 8]. All points of a pass share the choice.
SampledLights sampledDeltaLights(const PassContext& context);

/// The numbers of lights of a scene, and of those that a pass samples.
struct SampledLightCounts
{
    std::size_t treeLights = 0; ///< lights of the tree; 0 if Whitted's integrator needs none
    int treeSamples = 0;        ///< samples that a point takes of all lights of the tree
    std::size_t deltaLights = 0, sampledDeltaLights = 0; ///< lights beside the tree
};
SampledLightCounts sampledLightCounts(const PassContext& context);

} // namespace osgRayTrace::engine
