// SkyPortals.h - rectangles that light of the sky comes through. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/integrators/shared/PortalPanes.h"
#include "osgRayTrace/shading/RectangleLight.h"

#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// Samples directions through rectangles that stand in the openings of a room: windows, doors, or
/// the open side of a box. A point within the room chooses a rectangle by about the solid angle
/// under which the point sees it, and a direction uniformly in that angle, or uniformly by area if
/// the angle is small (RectangleLight.h). As samples are weighted by their densities, the mean of a
/// picture is the same wherever the rectangles stand [Veach97, sect. 9.2]. Portals never change;
/// thread safe.
class SkyPortals
{
public:
    static constexpr std::size_t kMost = 4; ///< rectangles at most

    /// Takes rectangles whose normals point out of the room, in engine space.
    /// lightsSpots: whether beams from the portals go the same ways as rays to them. panes: of the
    /// portals, kMost at most.
    explicit SkyPortals(std::vector<RectangleLight> rectangles, bool lightsSpots = true,
                        std::vector<PaneSide> panes = {});

    /// Returns the rectangles, in engine space; their normals point out of the room.
    const std::vector<RectangleLight>& rectangles() const { return _rectangles; }

    /// Returns the outer sides of panes in the portals, all of different normals.
    const std::vector<PaneSide>& panes() const { return _panes; }

    /// Sets the sum over the rectangles of the weights by which points choose among them; 0: the
    /// point is on the outer side of all, and samples nothing.
    void weigh(const Vec3Lanes& points, FloatLanes& sums) const;

    /// Sets unit directions through the rectangles; (0, 0, 0) in lanes that sample nothing. sums:
    /// as weigh() sets them. choice, u, v: numbers in [0,1).
    void sample(const Vec3Lanes& points, const FloatLanes& sums, const FloatLanes& choice,
                const FloatLanes& u, const FloatLanes& v, Vec3Lanes& wi) const;

    /// Sets the density with which sample() finds directions [1/sr]; 0 for those that cross no
    /// rectangle outwards.
    void pdfW(const Vec3Lanes& points, const FloatLanes& sums, const Vec3Lanes& wi,
              FloatLanes& pdf) const;

    /// What samples at a point find of one direction.
    struct Chance
    {
        bool inside; ///< whether the point samples portals at all
        float pdfW;  ///< as the function for lanes sets it [1/sr]
    };
    Chance chanceOf(Vec3 point, Vec3 direction) const;

    /// Returns whether beams from the portals may light spots: see PathSunSpots.cpp.
    bool lightsSpots() const { return _lightsSpots; }

    /// Returns where a beam of the sky from a direction crosses a portal, evenly over the width of
    /// the beam; nothing if the direction is on the inner side of all.
    std::optional<Vec3> sampleBeam(Vec3 direction, float u, float v) const;

    /// Returns the density of beams from a direction on a surface [1/area]. cosine: of the angle
    /// between the direction and the normal.
    float beamPdfA(Vec3 point, Vec3 direction, float cosine) const;

private:
    std::vector<RectangleLight> _rectangles;
    bool _lightsSpots;
    std::vector<PaneSide> _panes;
};

} // namespace osgRayTrace::engine
