// PlacePatcher.cpp - moves instances and exchanges meshes. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/PlacePatcher.h"

#include "osgRayTrace/bridge/appearance/textures/TextureUnits.h"
#include "osgRayTrace/bridge/common/FlatMatrix.h"
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// This is the smallest volume that the unit axes of a transform may span. It is more than
/// GraphCollector asks for: a nearly flat transform takes a conversion of the whole graph.
constexpr double kSmallestVolume = 1e-6;

/// A mesh keeps its frame while its centre is at most this many radii away from the frame's origin;
/// meshFrame chooses a new origin at half of that.
constexpr double kFarFromOrigin = 128.0;

/// Returns whether texture coordinates are generated from places in the scene: their matrix then
/// depends on the place of the surface.
bool isPlaceBound(const Material& material)
{
    return material.mapping.coordinates == TextureCoordinates::Position ||
           material.second.mapping.coordinates == TextureCoordinates::Position;
}

/// Returns whether the look depends on which side is OpenGL's front: a mirroring transform swaps
/// the sides.
bool dependsOnWinding(const Material& material)
{
    return material.culling == FaceCulling::Back || material.culling == FaceCulling::Front ||
           material.twoSidedLighting;
}

/// Returns whether a geometry has neither lines nor points: OpenGL then draws nothing of the
/// geometry, and no parts of the geometry are copied for OpenGL.
bool hasTrianglesAlone(const osg::Geometry& geometry)
{
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        if (!set || set->getMode() < GL_TRIANGLES || set->getMode() > GL_POLYGON) return false;
    return true;
}

/// Returns whether a mesh with these bounds can stay in its frame, a translation and a uniform
/// scale.
bool fitsFrame(const VertexBounds& bounds, const osg::Matrixd& meshFromLocal)
{
    if (bounds.count == 0 || areCoarseInFloat(bounds)) return false;
    const osg::Vec3d centre =
        osg::Vec3d(bounds.centre().x, bounds.centre().y, bounds.centre().z) * meshFromLocal;
    const double radius = bounds.radius() * std::fabs(meshFromLocal(0, 0));
    return isOrdinaryLength(largestCoordinate(bounds, meshFromLocal)) &&
           (radius == 0.0 || centre.length() <= kFarFromOrigin * radius);
}

} // namespace

void PlacePatcher::touch(uint32_t index)
{
    Instance& instance = _scene.instances[index];
    instance.changed = _now;
    if (instance.light != kInvalid) _scene.lights[instance.light].changed = _now;
    _changed = true;
}

bool PlacePatcher::move(const MovedUse& use)
{
    const auto found = _index.geometries.find(use.geometry);
    if (found == _index.geometries.end() || found->second.uses.size() != use.uses)
        return refuse(ConversionCause::OtherPaths);
    if (!found->second.patchable) return refuse(ConversionCause::NotAlone);
    const uint32_t index = found->second.uses[use.use].instance;
    const std::optional<osg::Matrixd> worldFromLocal =
        placingMatrix(use.worldFromLocal, kSmallestVolume);
    if (!worldFromLocal) return refuse(ConversionCause::BadTransform);
    if (index == kInvalid) return true;
    if (isPlaceBound(_scene.materials[_scene.instances[index].material]))
        return refuse(ConversionCause::PlaceBound);
    const Vec3d& origin = _scene.origin;
    const osg::Matrixd engineFromLocal =
        *worldFromLocal * osg::Matrixd::translate(-origin.x, -origin.y, -origin.z);
    return found->second.raised ? raise(*use.geometry, index, engineFromLocal, false)
                                : place(*use.geometry, index, engineFromLocal);
}

/// Makes the mesh of raised faces anew at a place: the height depends on the place.
bool PlacePatcher::raise(const osg::Geometry& geometry, uint32_t index,
                         const osg::Matrixd& engineFromLocal, bool copies)
{
    const MeshRequest* last = _geometries.lastRequest(geometry);
    if (!last) return refuse(ConversionCause::NoMesh);
    if (!isOrdinaryLength(largestCoordinate(_geometries.bounds(geometry), engineFromLocal)))
        return refuse(ConversionCause::Lengths);
    _geometries.recordMobility(geometry, copies ? Mobility::Deforming : Mobility::Dynamic);
    MeshRequest request = *last;
    request.transform.reset();
    if (!engineFromLocal.isIdentity()) request.transform = engineFromLocal;
    request.copies |= copies;
    Instance& instance = _scene.instances[index];
    const bool winding = dependsOnWinding(_scene.materials[instance.material]);
    const std::shared_ptr<const Mesh> before = _scene.meshes[instance.mesh];
    if (winding &&
        isMirrored(engineFromLocal) != isMirrored(last->transform.value_or(osg::Matrixd())))
        return refuse(ConversionCause::Winding);
    if (!makeMesh(geometry, request, instance.mesh)) return false;
    if (_scene.meshes[instance.mesh] == before && instance.placed) return true;
    if (!instance.placed)
    {
        if (!placeInstance(instance, osg::Matrixd())) return refuse(ConversionCause::BadTransform);
        _leftStatic = true;
    }
    touch(index);
    return true;
}

bool PlacePatcher::place(const osg::Geometry& geometry, uint32_t index,
                         const osg::Matrixd& engineFromLocal)
{
    const VertexBounds& bounds = _geometries.bounds(geometry);
    if (!isOrdinaryLength(largestCoordinate(bounds, engineFromLocal)))
        return refuse(ConversionCause::Lengths);
    Instance& instance = _scene.instances[index];
    const bool winding = dependsOnWinding(_scene.materials[instance.material]);
    if (winding && !instance.placed)
        return refuse(ConversionCause::Winding); // it is unknown whether the instance was mirrored
    osg::Matrixd localFromMesh;
    if (instance.placed)
    {
        const MeshRequest* request = _geometries.lastRequest(geometry);
        if (!request) return refuse(ConversionCause::NoMesh);
        if (request->transform) localFromMesh = osg::Matrixd::inverse(*request->transform);
    }
    else
    {
        const MeshFrame frame = meshFrame(bounds);
        if (!fitsFrame(bounds, frame.meshFromLocal)) return refuse(ConversionCause::Lengths);
        _geometries.recordMobility(geometry, Mobility::Dynamic);
        const MeshRequest* last = _geometries.lastRequest(geometry);
        if (!last) return refuse(ConversionCause::NoMesh);
        MeshRequest request = *last;
        request.transform.reset();
        if (!frame.meshFromLocal.isIdentity()) request.transform = frame.meshFromLocal;
        request.copies = _geometries.mobility(geometry) == Mobility::Deforming;
        if (!makeMesh(geometry, request, instance.mesh)) return false;
        localFromMesh = frame.localFromMesh;
        _leftStatic = true;
    }
    const Affine before = instance.engineFromLocal;
    const bool wasPlaced = instance.placed, wasMirrored = instance.mirrored;
    if (!placeInstance(instance, localFromMesh * engineFromLocal))
        return refuse(ConversionCause::BadTransform);
    if (winding && instance.mirrored != wasMirrored) return refuse(ConversionCause::Winding);
    if (!wasPlaced || before.linear != instance.engineFromLocal.linear ||
        before.translation != instance.engineFromLocal.translation)
        touch(index);
    return true;
}

/// Makes a mesh from the arrays as they are. Returns false if the count of bad data differs from
/// the last one, because the report would change. It tells nothing of proxies.
bool PlacePatcher::makeMesh(const osg::Geometry& geometry, const MeshRequest& request,
                            uint32_t meshIndex)
{
    std::shared_ptr<const Mesh>& mesh = _scene.meshes[meshIndex];
    const ConversionCounts before = _geometries.lastCounts(geometry);
    ConversionReport report;
    const auto result =
        _geometries.mesh(geometry, GeometryCache::kOwnVariant, request, mesh->name, report);
    const std::vector<TracedUse>& uses = _index.geometries.at(&geometry).uses;
    const bool isProxy = std::all_of(uses.begin(), uses.end(),
                                     [](const TracedUse& use) { return use.effects == kInvalid; });
    if (!result || (!isProxy && report.counts() != before))
        return refuse(ConversionCause::Reported);
    mesh = result;
    return true;
}

bool PlacePatcher::deform(const osg::Geometry& geometry)
{
    const auto found = _index.geometries.find(&geometry);
    if (found == _index.geometries.end()) return refuse(ConversionCause::OtherPaths);
    if (!found->second.patchable) return refuse(ConversionCause::NotAlone);
    const std::vector<TracedUse>& uses = found->second.uses;
    const MeshRequest* last = _geometries.lastRequest(geometry);
    if (!last) return refuse(ConversionCause::NoMesh);
    if (!hasTrianglesAlone(geometry)) return refuse(ConversionCause::LinesOrPoints);
    if (found->second.raised && uses.size() == 1 && uses[0].instance != kInvalid)
        return raise(geometry, uses[0].instance, last->transform.value_or(osg::Matrixd()), true);
    for (const TracedUse& use : uses)
    {
        const uint32_t index = use.instance;
        if (index == kInvalid) return refuse(ConversionCause::NotAnInstance);
        const Instance& instance = _scene.instances[index];
        if (!instance.placed)
        {
            if (uses.size() > 1) return refuse(ConversionCause::NotAnInstance);
            const osg::Matrixd engineFromLocal = last->transform.value_or(osg::Matrixd());
            return place(geometry, index, engineFromLocal);
        }
        if (instance.mesh != _scene.instances[uses.front().instance].mesh)
            return refuse(ConversionCause::NotAnInstance);
    }

    const VertexBounds& bounds = _geometries.bounds(geometry);
    MeshRequest request = *last;
    request.copies = true;
    if (!fitsFrame(bounds, request.transform.value_or(osg::Matrixd())))
        return refuse(ConversionCause::Lengths);
    const uint32_t meshIndex = _scene.instances[uses.front().instance].mesh;
    const std::shared_ptr<const Mesh> before = _scene.meshes[meshIndex];
    if (!makeMesh(geometry, request, meshIndex)) return false;
    if (_scene.meshes[meshIndex] == before) return true; // move() has made the mesh
    for (const TracedUse& use : uses)
    {
        const Instance& instance = _scene.instances[use.instance];
        const Affine& m = instance.engineFromLocal;
        const double reach = glm::length(m.translation) +
                             largestCoordinate(bounds, request.transform.value_or(osg::Matrixd())) *
                                 double(glm::length(m.linear[0]) + glm::length(m.linear[1]) +
                                        glm::length(m.linear[2]));
        if (!isOrdinaryLength(reach)) return refuse(ConversionCause::Lengths);
        touch(use.instance);
    }
    return true;
}

} // namespace osgRayTrace::engine
