// MediumTable.h - the media of a scene in engine units, and which bodies they fill. Layer: media.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/media/MediumStack.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/scene/Scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds the constants of a medium [1/engine unit].
struct MediumRecord
{
    Vec3 sigmaT{0.0f};   ///< extinction: absorption and scattering
    Vec3 sigmaS{0.0f};   ///< scattering
    Vec3 emission{0.0f}; ///< radiance per length
    Phase phase;
    float ior = 1.0f; ///< index of refraction of the body
    int priority = 0;
    bool scatters = false, emits = false;
    bool isDense = false; ///< photons are points rather than beams: see kDenseMeanWay
    bool isClear = true;  ///< true: light passes as if nothing were there
    /// The medium thins out with height: its coefficients are those above times exp(-max(0, x)) at
    /// a point p, x = dot(rise, p) - base. See MediumWay.h.
    bool thins = false;
    Vec3 rise{0.0f}; ///< [1/engine unit]
    float base = 0.0f;

    /// Returns whether photons are beams in the medium, between volumes if there are any.
    bool isThin() const { return scatters && !isDense; }

    /// Returns the share of the coefficients that is left at a point.
    float densityAt(Vec3 point) const
    {
        return thins ? std::exp(-std::max(0.0f, glm::dot(rise, point) - base)) : 1.0f;
    }
};

/// A medium is dense if the mean way between collisions is below this share of the radius of what
/// is traced. Photon beams would be shorter there than the kernel by which they are looked up.
constexpr float kDenseMeanWay = 0.005f * 1.5707963f;

/// A part of a ray.
struct RayPart
{
    float begin = 0.0f, end = 0.0f;
    bool isEmpty() const { return !(end > begin); }
};

/// Holds the media of a scene. Scenes without SceneTraits::media have an empty table.
class MediumTable
{
public:
    MediumTable() = default;

    /// low, high: corners of a box around all that is traced [engine space].
    MediumTable(const Scene& scene, Vec3 low, Vec3 high);

    const MediumRecord& operator[](MediumId medium) const
    {
        OSGRAYTRACE_ASSERT(medium < _records.size());
        return _records[medium];
    }

    /// Returns the medium within the bodies of a material; kOutside if its surfaces enclose none
    /// that light can enter.
    MediumId interiorOf(uint32_t material) const { return _interiors[material]; }

    /// Returns whether some material has such bodies.
    bool hasInteriors() const { return _records.size() > 1; }

    /// Returns whether the material is nothing but the boundary of its medium.
    bool isInterface(uint32_t material) const { return _interfaces[material]; }

    /// Returns whether some material is such a boundary.
    bool hasInterfaces() const { return _hasInterfaces; }

    /// Returns whether bodies have priorities, so that the surface of a body that another one
    /// displaces is not there, and surfaces between two bodies bend light by the ratio of their
    /// indices.
    bool nests() const { return _nests; }

    /// Returns the medium at a point in these bodies: that of the highest priority, and of those
    /// the one entered last. What is around bodies is displaced by any of them.
    MediumId at(MediumStack bodies) const
    {
        MediumId top = kOutside;
        for (int k = 0; k < MediumStack::kSize && bodies[k] != kOutside; ++k)
            if (top == kOutside || _records[bodies[k]].priority >= _records[top].priority)
                top = bodies[k];
        return top;
    }

    /// Returns the part of a ray from begin to end on which the medium has an effect. The medium
    /// around all bodies ends at its sphere, and so does that of a body that is open.
    RayPart clipped(MediumId medium, Vec3 origin, Vec3 direction, float begin, float end) const;

    // The sphere at which the medium around all bodies ends [engine space].
    Vec3 centre() const { return _centre; }
    float radius() const { return _radius; }

private:
    std::vector<MediumRecord> _records; ///< 0: what is around all bodies
    std::vector<MediumId> _interiors;   ///< by material
    std::vector<bool> _interfaces;      ///< by material
    bool _hasInterfaces = false, _nests = false;
    Vec3 _centre{0.0f};
    float _radius = 0.0f;
};

} // namespace osgRayTrace::engine
