// EmissiveMesh.h - the triangles of an emitting mesh, as a distribution by area. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/scene/Mesh.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Where the triangles of a mesh are.
struct MeshPlace
{
    bool placed = false;    ///< false: engineFromLocal is not used
    Affine engineFromLocal; ///< of an Instance

    bool operator==(const MeshPlace& o) const
    {
        return placed == o.placed &&
               (!placed || (engineFromLocal.linear == o.engineFromLocal.linear &&
                            engineFromLocal.translation == o.engineFromLocal.translation));
    }
};

/// The areas of a mesh's triangles in some space. They never change, and tables of lights share
/// them while the mesh stays the same.
struct EmissiveAreas
{
    std::shared_ptr<const Mesh> mesh;
    MeshPlace place;                  ///< where the triangles were measured
    std::vector<uint32_t> primitives; ///< the triangles that have an area; empty: all of them
    std::vector<float> cumulative;    ///< running share of the area; the last is 1
    double area = 0.0;                ///< of all triangles
    float largest = 0.0f;             ///< largest sum of coordinates of a corner and two edges
    float largestEdges = 0.0f;        ///< largest sum of coordinates of two edges
    Vec3 low{0.0f}, high{0.0f};       ///< box around the corners

    std::size_t size() const { return cumulative.size(); }
};

/// Returns the areas of a mesh's triangles at a place. workers: may be null.
std::shared_ptr<const EmissiveAreas> emissiveAreas(const std::shared_ptr<const Mesh>& mesh,
                                                   const MeshPlace& place, const Workers* workers);

/// Returns by how much a transform stretches all lengths; 0 if it does not stretch all directions
/// alike, to about one part in 10,000.
float uniformScale(const Mat3& linear);

/// Sets a box to the one around it at another place.
void placeBox(const Affine& place, Vec3& low, Vec3& high);

/// Holds an emitting mesh at its place. Triangles are computed when they are asked for.
struct EmissiveMesh
{
    struct Triangle
    {
        Vec3 a{0.0f}, ab{0.0f}, ac{0.0f};    ///< engine space
        Vec2 ua{0.0f}, uab{0.0f}, uac{0.0f}; ///< of emissionUvSet
        float area = 0.0f;
        uint32_t primitive = 0; ///< triangle of the mesh
    };

    std::shared_ptr<const EmissiveAreas> areas; ///< of the mesh at its place, or in its own space
    MeshPlace place;
    uint32_t uvSet = 0; ///< emissionUvSet of the material

    std::size_t size() const { return areas->size(); }

    /// Returns whether the areas are those of the mesh in its own space, whose shares are the same
    /// at any place of uniformScale().
    bool hasLocalAreas() const { return place.placed && !areas->place.placed; }

    /// Returns the area of all triangles at their place [length^2].
    double area() const;

    /// Returns a bound of the sum of coordinates of any triangle's corner and two edges.
    float largest() const;

    /// Returns the triangle of an index below size().
    Triangle triangle(std::size_t index) const
    {
        return triangleOf(areas->primitives.empty() ? static_cast<uint32_t>(index)
                                                    : areas->primitives[index]);
    }

    /// Returns a triangle of the mesh.
    Triangle triangleOf(uint32_t primitive) const;
};

} // namespace osgRayTrace::engine
