// PhotonEmitter.h - photons as they leave the lights, guided to what makes caustics. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/photons/PhotonGuide.h"
#include "osgRayTrace/photons/PhotonTargets.h"

#include <memory>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// A photon on its way from a light.
struct PhotonStart
{
    Vec3 origin{0.0f};    ///< clear of the light's own surface
    Vec3 direction{0.0f}; ///< unit
    Vec3 power{0.0f};     ///< [W] times the number of photons emitted
    uint32_t light = kInvalid;
    uint32_t bin = kInvalid; ///< of PhotonGuide that it was guided to, if it was
};

/// The numbers of [0,1) that an emission takes.
struct EmissionPoint
{
    float light = 0.0f;
    float choice = 0.0f;
    Vec2 position{0.0f};
    Vec2 direction{0.0f};
};

/// The same for sixteen photons.
struct EmissionLanes
{
    FloatLanes light, choice, positionU, positionV, directionU, directionV;
};

struct StartLanes
{
    Vec3Lanes origin, direction, power;
    UintLanes light, bin;
};

/// Chooses lights in proportion to power, and directions by a mixture: a share of them uniformly
/// within the cones (for distant lights: discs) that hold the mirror-like and transmissive
/// instances, the rest as the light shines. The density is that of the mixture, so every share
/// gives the same mean [Veach97, sect. 9.2]. Thread safe.
class PhotonEmitter
{
public:
    /// lights: the scene's, those of eye space placed. guidedShare in [0,1): of photons guided; 0
    /// if nothing in the scene is specular.
    PhotonEmitter(const TracedScene& traced, const std::vector<Light>& lights, float guidedShare);

    /// False if no light has any power.
    bool emits() const { return !_cumulative.empty(); }

    /// Something in the scene reflects like a mirror or transmits.
    bool hasTargets() const { return !_targets.empty(); }

    std::optional<PhotonStart> emit(const EmissionPoint& point,
                                    const PhotonGuide* photonGuide = nullptr) const;

    /// What emit returns for each lane, up to rounding; vector code where a parallelogram is the
    /// only light. Returns the lanes that have a start.
    LaneMask emitLanes(const EmissionLanes& points, StartLanes& starts,
                       const PhotonGuide* photonGuide = nullptr) const;

    /// Of a PhotonGuide for this emitter; 0: there is nothing to aim at.
    std::size_t guideBins() const;
    std::shared_ptr<const PhotonGuide> learn(const std::vector<uint32_t>& emitted,
                                             const std::vector<double>& seen) const;

    /// Fixed-function lights may fade otherwise than with the square of the distance: what arrives
    /// after a free flight from the light is the power times this. distance: to the light's centre,
    /// or its radius where that is more.
    float falloff(uint32_t light, float distance) const;

    /// At most this many.
    static constexpr std::size_t kMaxTargets = 32;

    /// Holds all geometry.
    const Sphere& scene() const { return _scene; }

private:
    struct Cones;
    struct Discs;
    /// What an emission is told beside its numbers. light: as photonGuide numbers it.
    struct LightGuide
    {
        const PhotonGuide* photonGuide;
        uint32_t light;
    };

    std::optional<PhotonStart> emitArea(uint32_t light, const EmissionPoint& point,
                                        LightGuide guide) const;
    std::optional<PhotonStart> emitPoint(uint32_t light, const EmissionPoint& point,
                                         LightGuide guide) const;
    std::optional<PhotonStart> emitDirectional(const Light& light, const EmissionPoint& point,
                                               LightGuide guide) const;
    std::optional<PhotonStart> emitEnvironment(const EmissionPoint& point, LightGuide guide) const;
    std::optional<PhotonStart> emitParallel(Vec3 direction, Vec3 irradiance,
                                            const EmissionPoint& point, LightGuide guide) const;
    float parallelPdf(Vec3 q, Vec3 direction, const Discs& discs, float share,
                      LightGuide guide) const;
    LaneMask emitSingly(const EmissionLanes& points, StartLanes& starts,
                        const PhotonGuide* photonGuide) const;
    Cones conesFrom(Vec3 origin, float spread, LightGuide guide) const;
    uint32_t binOf(LightGuide guide, uint32_t target, uint32_t bin) const;
    Vec3 guidedDirection(const Cones& cones, float share, const EmissionPoint& point,
                         LightGuide guide, uint32_t& bin) const;

    const TracedScene& _traced;
    const std::vector<Light>& _lights;
    float _guidedShare;
    Sphere _scene;
    std::vector<Sphere> _targets;
    std::vector<uint32_t> _emitters; ///< index of a light
    std::vector<float> _cumulative;  ///< an emitter; the last is 1
};

} // namespace osgRayTrace::engine
