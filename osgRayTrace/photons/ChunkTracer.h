// ChunkTracer.h - follows a chunk of a pass's photons, sixteen to a block. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/photons/PhotonEmitter.h"
#include "osgRayTrace/photons/PhotonOpenings.h"
#include "osgRayTrace/photons/PhotonPaths.h"
#include "osgRayTrace/photons/TracedPhotons.h"
#include "osgRayTrace/sampling/Sampler.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// This is the largest number of photons that are followed together.
constexpr uint32_t kPhotonChunk = 2048;

/// The number of collisions between two surfaces after which a photon ends, and of surfaces.
constexpr uint32_t kMostFlights = 10000;

/// These are the dimensions of a photon's sequence.
enum PhotonDimension : uint32_t
{
    EmissionChoice = 0, ///< light, choice
    EmissionPosition = 1,
    EmissionDirection = 2,
    BounceFirst = 3, ///< then for each bounce: direction; lobe and roulette
};

/// Holds what all chunks of a pass read.
struct ChunkInputs
{
    const TracedScene& traced;
    const SceneTraits& traits; ///< of the scene, as its materials are
    const MaterialTable& materials;
    const std::vector<Light>& lights;
    const PhotonEmitter& emitter;
    const PhotonGuide* photonGuide; ///< null: photons are guided by the scene alone
    const PhotonOpenings* openings; ///< null: there are none
    const PhotonPassOptions& options;
    bool recordsFlights;
    uint32_t seed;   ///< of the pass
    bool culls;      ///< there are faces of which all rays pass one side
    bool shadowless; ///< there are lights without shadows
};

/// Holds the photons of a chunk and what tracing them counted.
struct PhotonChunk
{
    PhotonBlocks photons;
    std::vector<PhotonBeam> beams;
    std::vector<PhotonPoint> points;
    std::vector<PhotonFlight> flights;
    std::vector<uint32_t> bins; ///< of PhotonGuide, for each photon that was emitted
    uint64_t rays = 0;
    uint64_t dropped = 0;
    uint64_t cutWalks = 0;
    uint64_t openWalks = 0;
};

/// Emits and follows the photons of one chunk. The loop, with the estimator above it, is in
/// PhotonTracer.cpp; what photons do at surfaces is in ChunkTracer.cpp.
class ChunkTracer
{
public:
    ChunkTracer(const ChunkInputs& inputs, PhotonChunk& chunk)
        : _inputs(inputs),
          _chunk(chunk),
          _paths(kPhotonChunk, inputs.traits.media, inputs.recordsFlights),
          _sent(0, false, inputs.recordsFlights),
          _arriving(0, false, inputs.recordsFlights)
    {
    }

    /// Traces count photons, the first of which has the number first within the pass.
    void trace(uint32_t first, uint32_t count);

private:
    uint32_t dimension(uint32_t number) const { return dimensionSeed(_inputs.seed, number); }
    static uint32_t bounceNumber(int bounce)
    {
        return BounceFirst + 2 * static_cast<uint32_t>(bounce);
    }

    /// Returns the lanes whose photons are wanted only if a mirror-like lobe scatters them.
    LaneMask mirrorsOnly(int bounce) const
    {
        return bounce == 0 && _inputs.options.use == PhotonUse::Caustics ? ~_glossy : 0;
    }

    void emitBlock(uint32_t first, uint32_t count);
    void follow(PhotonPathBlock block, LaneMask active, int bounce);
    void meetSurfaces(RayHitBlock& rays, LaneMask lanes, SurfaceLanes& surface);
    void meetBehind(LaneMask passed, SurfaceLanes& surface);
    void findSurfaces(PhotonPathBlock& block, LaneMask active, int bounce, SurfaceLanes& surface);
    // stretch: how often the photon has set out since it left a surface.
    LaneMask passFaces(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                       int bounce, uint32_t stretch = 0);
    LaneMask passPanes(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
                       int bounce, uint32_t stretch = 0);
    void absorb(PhotonPathBlock& block, const SurfaceLanes& surface) const;

    // What photons do in media is in ChunkFlights.cpp.
    enum class FlightEnd
    {
        Surface,
        GoesOn,
        Dies,
    };
    struct Flights;
    void travel(PhotonPathBlock& block, LaneMask active, int bounce, SurfaceLanes& surface);
    FlightEnd fly(PhotonPathBlock& block, Flights& flights, int i);
    FlightEnd collide(PhotonPathBlock& block, Flights& flights, int i, float distance,
                      float before);
    FlightEnd meet(PhotonPathBlock& block, Flights& flights, int i);
    void countCollision(PhotonPathBlock& block, Flights& flights, int i);
    FlightEnd leaveCollision(PhotonPathBlock& block, Flights& flights, int i, Vec3 point,
                             Vec3 after, Vec3 power);
    bool mustArrive(const Flights& flights) const;
    bool storesPoints(const PhotonPathBlock& block, const Flights& flights, int i) const;
    void storeBeam(const PhotonPathBlock& block, const Flights& flights, int i);
    void storePoint(const PhotonPathBlock& block, const Flights& flights, int i, Vec3 at,
                    Vec3 power);
    void appendPoint(const PhotonPathBlock& block, const Flights& flights, int i, Vec3 at,
                     Vec3 power);
    void storeBetweenVolumes(const PhotonBeam& beam, uint32_t seed);
    GridRay gridsOn(const PhotonPathBlock& block, const Flights& flights, int i, bool stores) const;
    FlightEnd flyGrids(PhotonPathBlock& block, Flights& flights, int i, const GridRay& grids);
    FlightEnd scatterInGrids(PhotonPathBlock& block, Flights& flights, int i, const GridRay& grids,
                             const GridFlight& flight, NumberStream& numbers);
    void traceOn(LaneMask lanes);
    uint32_t flightSeed(int bounce, uint32_t stretch, uint32_t use) const;
    Vec2 flightNumbers(uint32_t photon, int bounce, uint32_t stretch, uint32_t use) const;
    float fallenOff(uint32_t light, Vec3 point, float way) const;
    LaneMask enterBodies(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask alive);
    const Bsdf* bsdfInBodies(const PhotonPathBlock& block, const SurfaceLanes& surface, int i);
    uint32_t edgesAt(const PhotonPathBlock& block, int i, int bounce) const
    {
        if (!_inputs.traits.media) return static_cast<uint32_t>(bounce) + 1;
        return static_cast<uint32_t>(block.met[i] + 1) + block.late[i];
    }

    void leaveLight(PhotonPathBlock& block, SurfaceLanes& surface) const;
    LaneMask classify(const PhotonPathBlock& block, const SurfaceLanes& surface);
    bool isUnread(const PhotonPathBlock& block, const SurfaceLanes& surface, int i) const;
    void store(const PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask lanes,
               int bounce);
    // Photons below diffuse boundaries are in ChunkSubsurface.cpp.
    void walkBelowSurfaces(PhotonPathBlock& block, SurfaceLanes& surface, int bounce);
    struct BodyWalks;
    bool walkBelowSurface(PhotonPathBlock& block, const SurfaceLanes& surface, int i, int bounce,
                          BodyWalks& walks);
    void leaveBodies(PhotonPathBlock& block, const BodyWalks& walks, LaneMask lanes,
                     SurfaceLanes& surface);

    void recordFlights(PhotonPathBlock& block, const SurfaceLanes& surface, LaneMask stored);
    void scatter(PhotonPathBlock& block, const SurfaceLanes& surface, int bounce);
    LaneMask sendThroughOpenings(const PhotonPathBlock& block, const SurfaceLanes& surface,
                                 int bounce);
    LaneMask chooseChildren(const UintLanes& photons, uint32_t seed, Vec3Lanes& wi,
                            FloatLanes& weights);
    void sendFromLights(PhotonPathBlock& block, LaneMask lanes);
    void scatterOne(const PhotonPathBlock& block, const SurfaceLanes& surface, int i,
                    bool mustMirror);
    MaterialPoint pointAt(const SurfaceLanes& surface, int i) const;
    const Bsdf* bsdfAt(const SurfaceLanes& surface, int i);

    const ChunkInputs& _inputs;
    PhotonChunk& _chunk;
    uint32_t _first = 0; ///< number of the chunk's first photon within the pass
    PhotonPathQueue _paths;
    PhotonPathQueue _sent, _arriving; ///< photons sent through openings, and those sent before
    PhotonOpenings::Views _views;
    // These members describe the block at work.
    RayHitBlock _rays;
    FloatLanes _u, _v, _lobe, _roulette; ///< random numbers of the block's bounce
    Vec3Lanes _normal;                   ///< shading, on the side of the ray
    LaneMask _diffuse = 0; ///< lanes on plain Lambert surfaces; _scattered has their albedo
    LaneMask _smooth = 0;  ///< lanes on smooth interfaces
    InterfaceLanes _interfaces;
    LaneMask _general = 0;  ///< lanes on all other surfaces that are not black
    LaneMask _glossy = 0;   ///< lanes of _general on glossy surfaces
    LaneMask _oneSided = 0; ///< lanes on faces that all rays pass from one side
    LaneMask _seen = 0;     ///< lanes of _oneSided on the side of the face that is seen
    LaneMask _collided = 0; ///< lanes that media have scattered on their way to the surface
    LaneMask _aligned = 0;  ///< lanes of _general for whose _bsdfs alignLayers() has been called
    const Bsdf* _bsdfs[kLanes] = {};
    Bsdf _textured[kLanes]; ///< memory for those of _bsdfs that vary over their surface
    Scattered _scattered;
};

} // namespace osgRayTrace::engine
