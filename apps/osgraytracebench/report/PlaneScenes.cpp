// PlaneScenes.cpp - builds the planes under area lights. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/PlaneScenes.h"

#include "data/generator/Surfaces.h"

#include <osgRayTrace/AreaLight>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr double kAlbedo = 0.5;
const Vec3d kRadiance(4.0, 3.0, 2.0);
constexpr double kOccluderHeight = 0.5;

Polygon regularPolygon(int sides, double radius, const Vec3d& centre)
{
    Polygon polygon;
    for (int i = 0; i < sides; ++i)
    {
        const double angle = 2.0 * osg::PI * i / sides;
        polygon.push_back(centre + Vec3d(radius * std::cos(angle), radius * std::sin(angle), 0.0));
    }
    return polygon;
}

/// Returns a large quad whose side through (x, 0) hides all beyond it along (cos angle, sin angle).
Polygon edgeOccluder(double x, double angle)
{
    const Vec3d across(std::cos(angle), std::sin(angle), 0.0), along(-across.y(), across.x(), 0.0);
    const Vec3d start(x, 0.0, kOccluderHeight);
    const double size = 8.0;
    return {start - along * size, start + across * size - along * size,
            start + across * size + along * size, start + along * size};
}

/// Returns the polygon as a fan of triangles.
osg::ref_ptr<osg::Geode> polygonNode(const std::string& name, const Polygon& polygon,
                                     PhysicalMaterial* material)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const Vec3d& corner : polygon)
        vertices->push_back(Vec3(corner));
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices.get());
    const int count = static_cast<int>(polygon.size());
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, count));
    osg::ref_ptr<osg::Geode> node = new osg::Geode;
    node->setName(name);
    node->getOrCreateStateSet()->setAttribute(material);
    node->addDrawable(geometry.get());
    return node;
}

osg::ref_ptr<osg::Node> lightNode(const Polygon& light)
{
    if (light.size() == 4)
    {
        // The light's front, which faces cross(edgeU, edgeV), looks down.
        osg::ref_ptr<AreaLight> node = new AreaLight(Vec3(light[0]), Vec3(light[3] - light[0]),
                                                     Vec3(light[1] - light[0]), Vec3(kRadiance));
        node->setName("light");
        return node;
    }
    const osg::ref_ptr<PhysicalMaterial> material = data::lambert(Vec3(0, 0, 0));
    material->setEmission(Vec3(kRadiance));
    return polygonNode("light", light, material.get());
}

Formula planeFormula(const PlaneLighting& lighting)
{
    return [lighting](const Vec3d& origin, const Vec3d& direction)
    {
        const Vec3d point = origin - direction * (origin.z() / direction.z());
        return planeScale() * irradiance(lighting.light, lighting.occluder, point, Vec3d(0, 0, 1));
    };
}

ReportScene planeScene(const std::string& name, const std::string& title,
                       const PlaneLighting& lighting)
{
    ReportScene scene;
    scene.name = name;
    scene.title = title;
    scene.graph = planeGraph(lighting);
    // The view is from below the occluder: the plane fills the picture.
    scene.view =
        osg::Matrixd::lookAt(Vec3d(-0.2, -0.5, 0.45), Vec3d(0.1, 0.15, 0.0), Vec3d(0, 0, 1));
    scene.projection = osg::Matrixd::perspective(55.0, 1.0, 0.01, 100.0);
    scene.methods = directMethods();
    scene.placements = {atOrigin(), displaced()};
    scene.formula = planeFormula(lighting);
    scene.formulaNodes = lighting.occluder.empty() ? 3 : 6;
    return scene;
}

} // namespace

osg::Vec3d planeScale()
{
    return kRadiance * (kAlbedo / osg::PI);
}

PlaneLighting squareLighting()
{
    return {{Vec3d(-0.5, -0.5, 1), Vec3d(0.5, -0.5, 1), Vec3d(0.5, 0.5, 1), Vec3d(-0.5, 0.5, 1)},
            {}};
}

PlaneLighting axisEdgeLighting()
{
    return {squareLighting().light, edgeOccluder(0.13, 0.0)};
}

PlaneLighting rotatedEdgeLighting()
{
    return {squareLighting().light, edgeOccluder(0.13, osg::DegreesToRadians(17.0))};
}

PlaneLighting roundBlockerLighting()
{
    return {squareLighting().light, regularPolygon(48, 0.22, Vec3d(0.13, 0.07, kOccluderHeight))};
}

osg::ref_ptr<osg::Group> planeGraph(const PlaneLighting& lighting)
{
    const osg::ref_ptr<osg::Group> graph = data::newGraph("plane");
    const data::Quad plane{Vec3(-20, -20, 0), Vec3(20, -20, 0), Vec3(20, 20, 0), Vec3(-20, 20, 0)};
    const osg::ref_ptr<PhysicalMaterial> grey = data::lambert(Vec3(kAlbedo, kAlbedo, kAlbedo));
    graph->addChild(data::surface("plane", {plane}, grey.get()).get());
    graph->addChild(lightNode(lighting.light).get());
    if (!lighting.occluder.empty())
    {
        const osg::ref_ptr<PhysicalMaterial> black = data::lambert(Vec3(0, 0, 0));
        graph->addChild(polygonNode("occluder", lighting.occluder, black.get()).get());
    }
    return graph;
}

ReportScene squareLightScene()
{
    ReportScene scene = planeScene("s1-square", "S1: square light over a plane", squareLighting());
    // The tile of the earth has its plane on the ground's tangent at 48.1 N, 11.6 E.
    osg::Matrixd worldFromTile;
    osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
        osg::DegreesToRadians(48.1), osg::DegreesToRadians(11.6), 519.0, worldFromTile);
    scene.placements.push_back({"earth tile", worldFromTile});
    return scene;
}

ReportScene hexagonLightScene()
{
    const PlaneLighting lighting{regularPolygon(6, 0.6, Vec3d(0, 0, 1)), {}};
    return planeScene("s1-hexagon", "S1 with a hexagon of triangles as the light", lighting);
}

ReportScene axisEdgeScene()
{
    return planeScene("s2-axis-edge", "S2: S1 behind a straight edge", axisEdgeLighting());
}

ReportScene rotatedEdgeScene()
{
    return planeScene("s2-rotated-edge", "S2 with the edge turned by 17 degrees",
                      rotatedEdgeLighting());
}

ReportScene roundBlockerScene()
{
    return planeScene("s2-round-blocker", "S1 behind a disc", roundBlockerLighting());
}

} // namespace osgRayTrace::bench
