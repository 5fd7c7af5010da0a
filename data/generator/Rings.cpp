// Rings.cpp - metal rings on a table before a mirror. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

/// Returns a ring with upright walls inside and outside and a round rim, which stands on the table.
osg::ref_ptr<osg::Geode> ring(const std::string& name, const Vec3d& base, double inner,
                              double thickness, double height,
                              const osg::ref_ptr<PhysicalMaterial>& material)
{
    constexpr int kColumns = 144, kRimSteps = 8;
    const double half = 0.5 * thickness, outer = inner + thickness;
    std::vector<ProfilePoint> profile{{outer, 0.0, 1.0, 0.0}};
    addArc(profile, inner + half, height - half, half, 0.0, 180.0, kRimSteps);
    profile.push_back({inner, 0.0, -1.0, 0.0});
    return turned(name, profile, base, kColumns, material.get());
}

} // namespace

osg::ref_ptr<osg::Group> rings(double roughness)
{
    const auto brushed = [roughness](const Vec3& color)
    {
        const osg::ref_ptr<PhysicalMaterial> material = metal(color);
        material->setRoughness(static_cast<float>(roughness));
        return material;
    };
    const Quad table{Vec3(-40, -40, 0), Vec3(40, -40, 0), Vec3(40, 9, 0), Vec3(-40, 9, 0)};
    const Quad wall{Vec3(-40, 9, 0), Vec3(40, 9, 0), Vec3(40, 9, 40), Vec3(-40, 9, 40)};
    const Quad looking{Vec3(-9, 8.4f, 0.6f), Vec3(9, 8.4f, 0.6f), Vec3(9, 8.4f, 11),
                       Vec3(-9, 8.4f, 11)};

    const SceneView view{Vec3d(-5, -17, 13.5), Vec3d(0.2, 2.6, 1.7), Vec3d(0, 0, 1), 36.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("rings", view, view);
    scene->addChild(surface("table", {table}, lambert(Vec3(0.62f, 0.5f, 0.4f)).get()));
    scene->addChild(surface("wall", {wall}, lambert(Vec3(0.5f, 0.55f, 0.6f)).get()));
    scene->addChild(surface("looking-glass", {looking}, metal(Vec3(0.93f, 0.95f, 0.94f)).get()));
    scene->addChild(surface("its frame",
                            boxQuads(Vec3(-9.6f, 8.42f, 0.01f), Vec3(9.6f, 8.98f, 11.6f)),
                            lambert(Vec3(0.16f, 0.1f, 0.07f)).get()));
    scene->addChild(
        ring("gold ring", Vec3d(-3.3, 1.2, 0), 2.6, 0.3, 1.5, brushed(Vec3(1.0f, 0.77f, 0.34f)))
            .get());
    scene->addChild(
        ring("silver ring", Vec3d(3.2, 2.6, 0), 2.1, 0.25, 1.7, brushed(Vec3(0.97f, 0.96f, 0.92f)))
            .get());
    scene->addChild(
        ring("copper ring", Vec3d(1.6, -2.6, 0), 1.5, 0.22, 1.0, brushed(Vec3(0.95f, 0.64f, 0.54f)))
            .get());

    // The lamp is low on the left, small so that the caustics are sharp; its front looks at the
    // rings.
    osg::ref_ptr<AreaLight> lamp =
        new AreaLight(Vec3(-26.0f, -13.0f, 17.0f), Vec3(0.55f, 0.3f, 0.95f),
                      Vec3(0.52f, -1.0f, 0.0f), Vec3(2100, 1900, 1600));
    lamp->setName("lamp");
    scene->addChild(lamp.get());
    osg::ref_ptr<AreaLight> ceiling =
        new AreaLight(Vec3(-20, -30, 45), Vec3(0, 30, 0), Vec3(40, 0, 0), Vec3(0.6f, 0.66f, 0.8f));
    ceiling->setName("ceiling");
    scene->addChild(ceiling.get());
    return scene;
}

} // namespace osgRayTrace::data
