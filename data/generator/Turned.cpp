// Turned.cpp - bodies of revolution. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"

#include <osg/Geometry>

#include <cmath>

namespace osgRayTrace::data
{

using osg::Vec3d;

void addArc(std::vector<ProfilePoint>& profile, double radius, double z, double size,
            double fromDegrees, double toDegrees, int steps)
{
    for (int i = 0; i <= steps; ++i)
    {
        const double angle =
            osg::DegreesToRadians(fromDegrees + (toDegrees - fromDegrees) * i / steps);
        const double across = std::cos(angle), up = std::sin(angle);
        const double side = size < 0.0 ? -1.0 : 1.0;
        profile.push_back(
            {radius + std::abs(size) * across, z + std::abs(size) * up, side * across, side * up});
    }
}

osg::ref_ptr<osg::Geode> turned(const std::string& name, const std::vector<ProfilePoint>& profile,
                                const Vec3d& base, int columns, PhysicalMaterial* material)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    for (int c = 0; c <= columns; ++c)
    {
        const double phi = 2.0 * osg::PI * (c % columns) / columns;
        for (const ProfilePoint& p : profile)
        {
            positions->push_back(base +
                                 Vec3d(p.radius * std::cos(phi), p.radius * std::sin(phi), p.z));
            normals->push_back(Vec3d(p.outwards * std::cos(phi), p.outwards * std::sin(phi), p.up));
        }
    }
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c)
    {
        for (const std::size_t index : {a, b, c})
            triangles->push_back(static_cast<GLushort>(index));
    };
    const std::size_t rows = profile.size();
    for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c)
    {
        for (std::size_t r = 0; r + 1 < rows; ++r)
        {
            const bool crease = profile[r].radius == profile[r + 1].radius &&
                                profile[r].z == profile[r + 1].z; // only the normal changes
            if (crease) continue;
            const std::size_t a = c * rows + r, b = a + rows;
            if (profile[r].radius > 0.0) add(a, b, a + 1);
            if (profile[r + 1].radius > 0.0) add(a + 1, b, b + 1);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions.get());
    geometry->setNormalArray(normals.get(), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles.get());
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName(name);
    geode->addDrawable(geometry.get());
    geode->getOrCreateStateSet()->setAttribute(material);
    geode->getStateSet()->setAttributeAndModes(
        rasterMaterial(*material, osg::Vec3(0.0f, 0.5f, 0.0f)).get());
    return geode;
}

} // namespace osgRayTrace::data
