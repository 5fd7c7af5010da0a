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

/// Holds a photon on its way from a light.
struct PhotonStart
{
    Vec3 origin{0.0f};    ///< clear of the light's own surface
    Vec3 direction{0.0f}; ///< unit
    Vec3 power{0.0f};     ///< [W] times the number of photons emitted
    uint32_t light = kInvalid;
    uint32_t bin = kInvalid; ///< the bin of PhotonGuide that the photon was guided to, if any
};

/// Holds the random numbers in [0,1) that an emission takes.
struct EmissionPoint
{
    float light = 0.0f;
    float choice = 0.0f;
    Vec2 position{0.0f};
    Vec2 direction{0.0f};
};

/// Holds the random numbers of sixteen emissions: see EmissionPoint.
struct EmissionLanes
{
    FloatLanes light, choice, positionU, positionV, directionU, directionV;
};

struct StartLanes
{
    Vec3Lanes origin, direction, power;
    UintLanes light, bin;
};

/// Chooses lights in proportion to power, and directions by a mixture. A share of the directions is
/// uniform within the cones (for distant lights: discs) that hold what makes caustics, or follows a
/// PhotonGuide there; the rest are as the light shines. The density is that of the mixture, so
/// every share gives the same mean [Veach97, sect. 9.2]. Thread safe.
class PhotonEmitter
{
public:
    /// lights: the scene's, with those of eye space placed. guidedShare: share of the photons that
    /// are guided, in [0,1); 0 is used if nothing in the scene makes caustics. use: of the photons.
    PhotonEmitter(const TracedScene& traced, const std::vector<Light>& lights, float guidedShare,
                  PhotonUse use = PhotonUse::Caustics);

    /// Returns false if no light has any power.
    bool emits() const { return !_cumulative.empty(); }

    /// Returns whether something in the scene makes caustics.
    bool hasTargets() const { return !_targets.empty(); }

    std::optional<PhotonStart> emit(const EmissionPoint& point,
                                    const PhotonGuide* photonGuide = nullptr) const;

    /// Emits a photon in each lane as emit does, up to rounding: by vector code if a parallelogram
    /// is the only light. Returns the lanes that have a start.
    LaneMask emitLanes(const EmissionLanes& points, StartLanes& starts,
                       const PhotonGuide* photonGuide = nullptr) const;

    /// Returns the number of bins of a PhotonGuide for this emitter; 0: there is nothing to guide
    /// photons to.
    std::size_t guideBins() const;

    /// Makes a guide: see PhotonGuide's constructor.
    std::shared_ptr<const PhotonGuide> learn(const std::vector<uint32_t>& emitted,
                                             const std::vector<double>& seen) const;

    /// Returns the factor on the power of photons that have come straight from a light. Only
    /// fixed-function lights have one, which may fade otherwise than with the square of the
    /// distance. distance: to the light's centre, or the light's radius if that is more.
    float falloff(uint32_t light, float distance) const;

    /// This is the largest number of targets.
    static constexpr std::size_t kMaxTargets = 32;

    /// Returns a sphere that holds all geometry, and the medium around it.
    const Sphere& scene() const { return _scene; }

    /// Returns the bodies that the photons of a light begin in.
    MediumStack bodiesOf(uint32_t light) const
    {
        return _bodies.empty() ? MediumStack() : _bodies[light];
    }

private:
    struct Cones;
    struct Discs;
    /// Holds the guide of an emission, or null, and the light as the guide numbers it.
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
    std::vector<uint32_t> _emitters;  ///< indices of the lights that have power
    std::vector<float> _cumulative;   ///< by emitter: cumulative probability; the last is 1
    std::vector<MediumStack> _bodies; ///< by light; empty: all lights are outside of all bodies
};

} // namespace osgRayTrace::engine
