// ShadowCatcher.cpp - the shadows on the ground, as rays from the eye see them. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// The ground shows the share of its light that arrives, E / E0, where E is the irradiance of the
// plane and E0 the irradiance without anything around. The estimate is
//
//   E / E0 = 1 - sum of w (1 - V) L cosTheta / E0
//
// with one sum over the light samples of weight w: 1 - V is 0 where nothing is in the way, so that
// ground in full light has no noise. E0 is known but for lamps: it is the same for all points for
// the sky (TracedScene::groundSky), and a sum over samples for others. E0 is in the denominator,
// and its own variance would shift the mean by its square, so it takes more samples, of other
// points on the lamps.
#include "osgRayTrace/integrators/shared/ShadowCatcher.h"

#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/integrators/shared/TreeLights.h"
#include "osgRayTrace/shading/SoftLight.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kLampSamples = 16; ///< samples of each lamp for the light without shadows
constexpr uint32_t kTreeSamples = 64; ///< samples of a LightTree for the same

/// The points of some lanes on the ground, and the sums over their light.
class GroundBlock
{
public:
    GroundBlock(const PassContext& context, const CatchingRays& rays, TileCounts& counts)
        : _context(context), _table(context.traced->lights()), _counts(counts)
    {
        findPoints(rays);
        for (int i = 0; i < kLanes; ++i)
            _seeds[i] = hash(rays.seeds[i] + 0x9e3779b9u * (rays.number + 1));
    }

    LaneMask lanes() const { return _lanes; }

    /// Sums up the light that is hidden, and all light of lights without area.
    void addHidden()
    {
        for (const uint32_t light : besideTree())
            addDelta(light);
        const auto count = static_cast<uint32_t>(lightSampleCount(_context.options));
        if (_table.shiningEnvironment()) addSky(count);
        eachLamp(count, kTreePicks * count, DimensionGround,
                 [this](auto& samples, LightLanes& light, float share) {
                     addHiddenOf(light, share,
                                 [&] { return visibleLanes(_context, samples, _counts); });
                 });
    }

    /// Adds the light of the sky and of lamps to the sum of all light.
    void addLamps()
    {
        const float sky = _context.traced->groundSky();
        for (const int i : lanesIn(_lanes))
            _all[i] += sky;
        eachLamp(kLampSamples, kTreeSamples, DimensionGround + 1,
                 [this](const auto&, const LightLanes& light, float share)
                 {
                     for (const int i : lanesIn(light.lit))
                         _all[i] += share * irradiance(light, i);
                 });
    }

    /// Returns the lanes whose light is hidden in part.
    LaneMask shadowed() const
    {
        LaneMask shadowed = 0;
        for (const int i : lanesIn(_lanes))
            shadowed |= static_cast<LaneMask>(_hidden[i] > 0.0f) << i;
        return shadowed;
    }

    float share(int i) const { return _all[i] > 0.0f ? 1.0f - _hidden[i] / _all[i] : 1.0f; }

private:
    void findPoints(const CatchingRays& rays)
    {
        const float height = _context.traced->scene().ground;
        const RayBlock& ray = rays.rays.ray;
        for (const int i : lanesIn(rays.active))
        {
            if (!(ray.directionZ[i] < 0.0f) || !(ray.originZ[i] > height)) continue;
            const float t = (height - ray.originZ[i]) / ray.directionZ[i];
            const bool hit = rays.rays.geometry[i] != kInvalid;
            if (!(t > ray.tNear[i] && t < (hit ? ray.tFar[i] : kInfinity))) continue;
            _lanes |= 1u << i;
            setLane(_surface.position, i,
                    Vec3(ray.originX[i] + t * ray.directionX[i],
                         ray.originY[i] + t * ray.directionY[i], height));
        }
        for (int i = 0; i < kLanes; ++i) // kernels read all lanes
        {
            if (!((_lanes >> i) & 1u)) setLane(_surface.position, i, Vec3(0.0f, 0.0f, height));
            setLane(_surface.geometricNormal, i, Vec3(0.0f, 0.0f, 1.0f));
            setLane(_surface.shadingNormal, i, Vec3(0.0f, 0.0f, 1.0f));
            _surface.offset[i] = _surface.minCosine[i] = 0.0f;
            _surface.material[i] = 0;
            _hidden[i] = _all[i] = 0.0f;
        }
        _surface.hits = _surface.front = _lanes;
    }

    bool hasTree() const
    {
        return _table.tree() &&
               _table.areaLights().size() + _table.deltaLights().size() > kMostLoopedLights;
    }

    const std::vector<uint32_t>& besideTree() const
    {
        return hasTree() ? _table.lightsBesideTree() : _table.deltaLights();
    }

    /// Returns what a sample adds to the irradiance of lane i, as a luminance.
    static float irradiance(const LightLanes& light, int i)
    {
        const float radiance =
            luminanceOf(light.radiance[0][i], light.radiance[1][i], light.radiance[2][i]);
        return light.weight[i] * radiance * std::max(0.0f, light.wi.z[i]);
    }

    /// Adds what is hidden of samples; trace() returns the lanes that see their light, of which
    /// panes may have taken some.
    template <class Trace> void addHiddenOf(LightLanes& light, float share, const Trace& trace)
    {
        const LaneMask lit = light.lit;
        FloatLanes before;
        for (const int i : lanesIn(lit))
            before[i] = irradiance(light, i);
        const LaneMask visible = trace();
        for (const int i : lanesIn(lit))
        {
            const float left = (visible >> i) & 1u ? irradiance(light, i) : 0.0f;
            _hidden[i] += share * (before[i] - left);
        }
    }

    /// Sets the points of sample j of so many in a dimension, for a light of this number.
    void points(std::size_t light, uint32_t j, uint32_t samples, uint32_t dimension, FloatLanes& u,
                FloatLanes& v) const
    {
        const uint32_t index = _context.key.index * samples + j;
        for (int i = 0; i < kLanes; ++i)
        {
            const uint32_t own = hash(_seeds[i] + 0x85ebca6bu * static_cast<uint32_t>(light));
            float x, y;
            sobol2(index, dimensionSeed(own, dimension), x, y);
            u[i] = x;
            v[i] = y;
        }
    }

    /// Adds one sample of a directional, point or spot light to both sums.
    void addDelta(uint32_t index)
    {
        const Light& light = (*_context.lights)[index];
        FloatLanes u, v;
        if (isSoft(light)) points(index, 0, 1, DimensionGround, u, v);
        LightLanes samples;
        for (const int i : lanesIn(_lanes))
        {
            const Vec3 point = laneOf(_surface.position, i);
            const SoftLightSample sample =
                sampleSoft(light, point, isSoft(light) ? Vec2(u[i], v[i]) : Vec2(0.0f));
            if (!(sample.attenuation > 0.0f && sample.wi.z > 0.0f)) continue;
            samples.lit |= 1u << i;
            setRay(samples.shadow, i, {point, 0.0f}, sample.wi, sample.distance);
            setSample(samples, i, sample.wi, light.diffuse * (kPi * sample.attenuation),
                      sample.weight);
            _all[i] += irradiance(samples, i);
        }
        addHiddenOf(samples, 1.0f, [&] { return visibleLanes(_context, light, samples, _counts); });
    }

    void addSky(uint32_t count)
    {
        const float share = 1.0f / static_cast<float>(count);
        for (uint32_t j = 0; j < count; ++j)
        {
            FloatLanes u, v;
            points(0, j, count, DimensionGround + 2, u, v);
            LightLanes samples;
            environmentLanes(_context, {_surface, _lanes, 0, u, v}, kAllLanes, samples);
            addHiddenOf(samples, share, [&] { return visibleLanes(_context, samples, _counts); });
        }
    }

    /// Calls add(samples, share) for samples of all lamps, or for picks of the tree.
    template <class Add>
    void eachLamp(uint32_t samples, uint32_t picks, uint32_t dimension, const Add& add)
    {
        FloatLanes u, v;
        if (hasTree())
        {
            const TreePoints at = treePoints(_surface, _surface.shadingNormal, 0);
            for (uint32_t j = 0; j < picks; ++j)
            {
                FloatLanes choice, unused;
                points(0, j, picks, dimension, u, v);
                points(1, j, picks, dimension, choice, unused);
                TreeSamples chosen;
                treeLightLanes(_context, at, choice, static_cast<float>(picks),
                               {_surface, _lanes, 0, u, v}, chosen);
                add(chosen, chosen.lights, 1.0f);
            }
            return;
        }
        for (const uint32_t light : _table.areaLights())
            for (uint32_t j = 0; j < samples; ++j)
            {
                points(light, j, samples, dimension, u, v);
                LightLanes lanes;
                areaLightLanes(_context, light, 1.0f, {_surface, _lanes, 0, u, v}, lanes);
                add(lanes, lanes, 1.0f / static_cast<float>(samples));
            }
    }

    const PassContext& _context;
    const LightTable& _table;
    TileCounts& _counts;
    LaneMask _lanes = 0;
    SurfaceLanes _surface;
    UintLanes _seeds;
    FloatLanes _hidden, _all; ///< irradiance that is hidden, and without anything around
};

} // namespace

void catchShadows(const PassContext& context, const CatchingRays& rays, TileCounts& counts,
                  CaughtShadows& caught)
{
    caught.lanes = 0;
    if (!context.options.shadows) return;
    GroundBlock ground(context, rays, counts);
    if (!ground.lanes()) return;
    ground.addHidden();
    caught.lanes = ground.shadowed();
    if (!caught.lanes) return;
    ground.addLamps();
    for (const int i : lanesIn(caught.lanes))
        caught.share[i] = ground.share(i);
}

} // namespace osgRayTrace::engine
