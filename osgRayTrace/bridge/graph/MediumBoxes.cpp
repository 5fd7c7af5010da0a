// MediumBoxes.cpp - makes boxes and their states. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/MediumBoxes.h"

#include "osgRayTrace/bridge/common/Unshared.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Program>

namespace osgRayTrace::engine
{

namespace
{

/// Sets the faces of a box, with their fronts outside.
void setFaces(const osg::BoundingBox& box, osg::Geometry& geometry)
{
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (unsigned int corner = 0; corner < 8; ++corner)
        vertices->push_back(box.corner(corner)); // x is bit 0, y bit 1, z bit 2
    constexpr unsigned int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (const auto& face : kFaces)
        for (const int k : {0, 1, 2, 0, 2, 3})
            triangles->push_back(face[k]);
    geometry.setVertexArray(vertices);
    geometry.setPrimitiveSetList({triangles});
    geometry.dirtyBound();
}

/// Returns the state of a boundary that is not seen, whatever state the volume inherits.
osg::ref_ptr<osg::StateSet> boundaryOf(const osgRayTrace::Medium& medium)
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setTransmission(1.0f);
    material->setRoughness(0.0f);
    material->setIor(1.0f);
    material->setInterior(
        const_cast<osgRayTrace::Medium*>(&medium)); // which the conversion only reads
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    constexpr unsigned int kOff = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;
    constexpr unsigned int kOn = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;
    state->setAttribute(material, kOn);
    state->setAttribute(new osg::Program, kOn); // without shaders: none of those above
    for (const GLenum mode : {GL_CULL_FACE, GL_BLEND, GL_ALPHA_TEST, GL_FOG})
        state->setMode(mode, kOff);
    return state;
}

} // namespace

const osg::Geometry* MediumBoxes::of(const MediumVolume& volume)
{
    const osg::BoundingBox& box = volume.getBox();
    for (int k = 0; k < 3; ++k)
        if (!(box._min[k] < box._max[k])) return nullptr;
    Entry& entry = _entries[&volume];
    entry.volume = &volume;
    entry.used = _round;
    const bool isNew = !entry.geometry;
    if (isNew)
    {
        entry.geometry = new osg::Geometry;
        entry.geometry->setName("medium box");
    }
    if (isNew || entry.box._min != box._min || entry.box._max != box._max)
        setFaces(box, *entry.geometry);
    if (isNew || entry.medium != volume.getMedium())
        entry.geometry->setStateSet(boundaryOf(*volume.getMedium()));
    entry.box = box;
    entry.medium = volume.getMedium();
    return entry.geometry;
}

void MediumBoxes::end()
{
    eraseUnused(_entries, _round);
}

void MediumBoxes::dropUnshared()
{
    eraseUnshared(_entries, [](const Entry& entry) { return entry.volume.get(); });
}

} // namespace osgRayTrace::engine
