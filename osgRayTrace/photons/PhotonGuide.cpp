// PhotonGuide.cpp - learns where to send more photons from what views saw of them. Layer:
// photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonGuide.h"

#include <algorithm>
#include <numeric>

namespace osgRayTrace::engine
{

namespace
{

/// Share of the weights that is learnt. A bin whose use was missed still has the rest.
constexpr double kLearnt = 0.7;

/// Bins are few enough to have been sent dozens of photons each. In bins with fewer photons the
/// mean over the target counts as much as this many photons.
constexpr double kPriorPhotons = 4.0;

/// Returns which of the weights holds u, and rescales u to [0,1) within that weight.
uint32_t pickScaled(const float* weights, uint32_t count, float sum, float& u)
{
    float at = u * sum;
    uint32_t k = 0;
    for (; k + 1 < count && at >= weights[k]; ++k)
        at -= weights[k];
    u = std::min(std::max(at / weights[k], 0.0f), 0x1.fffffep-1f);
    return k;
}

/// Returns how many photons each bin of a light should have, in any unit. emitted, seen: of this
/// light's bins, see PhotonGuide::PhotonGuide. 0 in targets of which nothing is known.
std::vector<double> wantedOf(const uint32_t* emitted, const double* seen, uint32_t targets)
{
    std::vector<double> wanted(std::size_t(targets) * kGuideBins);
    for (std::size_t target = 0; target < targets; ++target)
    {
        const std::size_t first = target * kGuideBins, end = first + kGuideBins;
        double photons = 0.0, squares = 0.0;
        for (std::size_t b = first; b < end; ++b)
        {
            photons += emitted[b];
            squares += seen[b];
        }
        if (!(photons > 0.0) || !std::isfinite(squares)) continue;
        for (std::size_t b = first; b < end; ++b)
            wanted[b] = std::sqrt((seen[b] + kPriorPhotons * squares / photons) /
                                  (emitted[b] + kPriorPhotons));
    }
    return wanted;
}

} // namespace

PhotonGuide::PhotonGuide(uint32_t targets, const std::vector<uint32_t>& emitted,
                         const std::vector<double>& seen, const std::vector<float>& pmf)
    : _targets(targets), _weights(emitted.size(), 1.0f), _means(emitted.size() / kGuideBins, 1.0f)
{
    const std::size_t perLight = std::size_t(targets) * kGuideBins;
    std::vector<LightUse> lights(perLight ? emitted.size() / perLight : 0);
    for (std::size_t light = 0; light < lights.size(); ++light)
    {
        const std::size_t first = light * perLight;
        const std::vector<double> wanted = wantedOf(&emitted[first], &seen[first], targets);
        LightUse& use = lights[light];
        for (std::size_t b = 0; b < perLight; ++b)
        {
            use.useful += emitted[first + b] * wanted[b];
            use.sent += emitted[first + b];
        }
        if (!(use.useful > 0.0)) continue;
        const double unit = use.sent / use.useful; // the number of photons on the whole stays
        for (std::size_t b = 0; b < perLight; ++b)
            _weights[first + b] = static_cast<float>(1.0 - kLearnt + kLearnt * unit * wanted[b]);
    }
    sumWeights();
    chooseLights(lights, pmf);
}

void PhotonGuide::sumWeights()
{
    for (std::size_t t = 0; t < _means.size(); ++t)
    {
        float sum = 0.0f;
        for (uint32_t ring = 0; ring < kGuideRings; ++ring)
        {
            const float* sectors = &_weights[t * kGuideBins + ring * kGuideSectors];
            _rings.push_back(std::accumulate(sectors, sectors + kGuideSectors, 0.0f));
            sum += _rings.back();
        }
        _means[t] = sum / kGuideBins;
    }
}

/// Gives lights photons in proportion to the use of theirs.
void PhotonGuide::chooseLights(const std::vector<LightUse>& lights, const std::vector<float>& pmf)
{
    double allUseful = 0.0, allSent = 0.0;
    for (const LightUse& use : lights)
    {
        allUseful += use.useful;
        allSent += use.sent;
    }
    double sum = 0.0;
    std::vector<double> sums;
    for (std::size_t e = 0; e < pmf.size(); ++e)
    {
        const uint32_t light = lightOf(e, pmf.size());
        double factor = 1.0; // also for lights that guide no photons, as those within a target
        if (allUseful > 0.0 && lights[light].sent > 0.0)
            factor = 1.0 - kLearnt +
                     kLearnt * (lights[light].useful / allUseful) * (allSent / lights[light].sent);
        sums.push_back(sum += static_cast<double>(pmf[e]) * factor);
    }
    for (const double s : sums)
        _cumulative.push_back(static_cast<float>(s / sum));
    if (!_cumulative.empty()) _cumulative.back() = 1.0f;
}

Vec2 PhotonGuide::sample(uint32_t light, uint32_t target, Vec2 u, uint32_t& bin) const
{
    const std::size_t t = light * _targets + target;
    const float* weights = &_weights[t * kGuideBins];
    const float* rings = &_rings[t * kGuideRings];
    const uint32_t ring = pickScaled(rings, kGuideRings, _means[t] * kGuideBins, u.y);
    const uint32_t sector =
        pickScaled(weights + ring * kGuideSectors, kGuideSectors, rings[ring], u.x);
    bin = ring * kGuideSectors + sector;
    return Vec2((static_cast<float>(sector) + u.x) / kGuideSectors,
                (static_cast<float>(ring) + u.y) / kGuideRings);
}

} // namespace osgRayTrace::engine
