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
    std::vector<uint32_t> indices;    ///< by triangle: its place among those; empty: its number
    std::vector<float> cumulative;    ///< running share of the area; the last is 1
    double area = 0.0;                ///< of all triangles
    float largest = 0.0f;             ///< largest sum of coordinates of a corner and two edges
    float largestEdges = 0.0f;        ///< largest sum of coordinates of two edges
    Vec3 low{0.0f}, high{0.0f};       ///< box around the corners

    std::size_t size() const { return cumulative.size(); }

    /// Returns the index of a triangle of the mesh; kInvalid: it has no area.
    uint32_t indexOf(uint32_t primitive) const
    {
        return indices.empty() ? primitive : indices[primitive];
    }
};

/// A mesh of at least so many triangles is large: its triangles are computed each time that they
/// are asked for, and it may have a light tree of its own.
constexpr std::size_t kLeastLargeMesh = 1024;

/// Returns the areas of a mesh's triangles at a place. workers: may be null.
std::shared_ptr<const EmissiveAreas> emissiveAreas(const std::shared_ptr<const Mesh>& mesh,
                                                   const MeshPlace& place, const Workers* workers);

/// Returns by how much a transform stretches all lengths; 0 if it does not stretch all directions
/// alike, to about one part in 10,000.
float uniformScale(const Mat3& linear);

/// Sets a box to the one around it at another place.
void placeBox(const Affine& place, Vec3& low, Vec3& high);

/// Holds an emitting mesh at its place.
struct EmissiveMesh
{
    struct Triangle
    {
        Vec3 a{0.0f}, ab{0.0f}, ac{0.0f};    ///< engine space
        Vec2 ua{0.0f}, uab{0.0f}, uac{0.0f}; ///< of emissionUvSet
        uint32_t primitive = 0;              ///< triangle of the mesh
    };

    std::shared_ptr<const EmissiveAreas> areas; ///< of the mesh at its place, or in its own space
    MeshPlace place;
    uint32_t uvSet = 0;              ///< emissionUvSet of the material
    std::vector<Triangle> triangles; ///< by index; empty if the mesh is large

    /// Computes the triangles, unless the mesh is large.
    void keepTriangles();

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
        return triangles.empty() ? computedTriangle(index) : triangles[index];
    }

private:
    Triangle computedTriangle(std::size_t index) const;
};

/// Returns the area of a triangle with these edges [length^2].
inline double triangleArea(Vec3 ab, Vec3 ac)
{
    return 0.5 * glm::length(glm::cross(Vec3d(ab), Vec3d(ac)));
}

} // namespace osgRayTrace::engine
