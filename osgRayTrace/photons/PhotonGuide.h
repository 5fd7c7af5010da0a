// PhotonGuide.h - the parts of targets to which lights send photons more often. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// The cone (for directional lights: the disc) that holds a target is cut into bins of equal size:
/// sectors of the turn around its axis, and rings.
constexpr uint32_t kGuideSectors = 8, kGuideRings = 8;
constexpr uint32_t kGuideBins = kGuideSectors * kGuideRings;

/// Lights are told apart up to this number; if there are more, groups of lights share their bins.
constexpr uint32_t kMostGuideLights = 16;

/// Returns the bin of a point of the unit square that is mapped onto the cone. u: the turn; v: the
/// share of the solid angle (for discs: of the area) within the ring.
inline uint32_t guideBinOf(float u, float v)
{
    const auto cell = [](float x, uint32_t count)
    {
        const float scaled = x * static_cast<float>(count);
        return scaled > 0.0f ? std::min(static_cast<uint32_t>(scaled), count - 1) : 0u;
    };
    return cell(v, kGuideRings) * kGuideSectors + cell(u, kGuideSectors);
}

/// Returns the bin for coordinates across the axis, in any unit. The sector is an eighth of a turn,
/// so it needs no arctangent.
inline uint32_t guideBinAt(float x, float y, float v)
{
    static_assert(kGuideSectors == 8);
    const uint32_t quarter = y >= 0.0f ? (x >= 0.0f ? 0u : 1u) : (x < 0.0f ? 2u : 3u);
    const uint32_t steep = std::fabs(y) > std::fabs(x);
    return guideBinOf(0.0f, v) + 2u * quarter + (steep ^ (quarter & 1u));
}

/// Holds the weights of the bins of each light and target, learnt from what views saw of photons
/// that were sent there before. The number of photons of a bin should be in proportion to the root
/// mean square of what one of them adds to the pictures: then the variance of a sum over the bins
/// is least [Veach97, ch. 2]. A part of the weight is the same for all bins, so that light which no
/// view has seen yet stays within a known factor. A guide never changes.
class PhotonGuide
{
public:
    /// Names a bin of the target of a light (or group of lights): all lists below are indexed by
    /// it.
    static uint32_t index(uint32_t light, uint32_t target, uint32_t targets, uint32_t bin)
    {
        return (light * targets + target) * kGuideBins + bin;
    }

    /// emitted: number of photons that were guided to each bin. seen: for each bin, the sum of the
    /// squares of what each of its photons added. pmf: probability of each emitter, of which
    /// several may be one light here: see lightOf.
    PhotonGuide(uint32_t targets, const std::vector<uint32_t>& emitted,
                const std::vector<double>& seen, const std::vector<float>& pmf);

    static uint32_t lightOf(std::size_t emitter, std::size_t emitters)
    {
        return static_cast<uint32_t>(
            emitters <= kMostGuideLights ? emitter : emitter * kMostGuideLights / emitters);
    }

    /// Returns for each target of a light the mean weight of its bins, in the unit of weight().
    const float* targetWeights(uint32_t light) const { return &_means[light * _targets]; }
    float weight(uint32_t light, uint32_t target, uint32_t bin) const
    {
        return _weights[index(light, target, _targets, bin)];
    }

    /// Returns the weight of the bin in which off lies, a vector that goes sideways from the axis
    /// [any length], at share v of the target.
    float weightAt(uint32_t light, uint32_t target, Vec3 axis, Vec3 off, float v) const
    {
        Vec3 tangent, bitangent;
        frameOf(axis.x, axis.y, axis.z, tangent, bitangent);
        return weight(light, target,
                      guideBinAt(glm::dot(off, tangent), glm::dot(off, bitangent), v));
    }

    /// Samples a point of the unit square with a density of weight over mean, from u uniform in
    /// [0,1)^2; sets bin to the bin of the point.
    Vec2 sample(uint32_t light, uint32_t target, Vec2 u, uint32_t& bin) const;

    /// Returns the cumulative probabilities of the emitters; the last is 1.
    const std::vector<float>& cumulative() const { return _cumulative; }

private:
    /// Counts photons that were guided for a light, and the use of them: their number, weighted by
    /// how much more of them are wanted in their bins.
    struct LightUse
    {
        double sent = 0.0, useful = 0.0;
    };
    void sumWeights();
    void chooseLights(const std::vector<LightUse>& lights, const std::vector<float>& pmf);

    uint32_t _targets;
    std::vector<float> _weights; ///< by index()
    std::vector<float> _rings;   ///< light, target, ring: sum of its sectors
    std::vector<float> _means;   ///< light, target
    std::vector<float> _cumulative;
};

} // namespace osgRayTrace::engine
