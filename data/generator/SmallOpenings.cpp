// SmallOpenings.cpp - rooms that get their light by a door ajar, or by a window. Part of the scene
// generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"
#include "Transport.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>

#include <osg/Image>

#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr float kWidth = 4.0f, kDepth = 4.0f, kHeight = 2.8f; ///< of a room [m]
constexpr float kThick = 0.1f;                                ///< of walls [m]

void addBox(osg::Group& scene, const std::string& name, const Vec3& low, const Vec3& high,
            PhysicalMaterial* material)
{
    scene.addChild(surface(name, boxQuads(low, high), material));
}

/// Adds floor, ceiling and the outer walls of a space from (x0, 0, 0) to (x1, kDepth, kHeight),
/// without the wall at x1.
void addShell(osg::Group& scene, float x0, float x1, PhysicalMaterial* floor,
              PhysicalMaterial* walls)
{
    const float t = kThick;
    addBox(scene, "floor", Vec3(x0, 0, -t), Vec3(x1, kDepth, 0), floor);
    addBox(scene, "ceiling", Vec3(x0, 0, kHeight), Vec3(x1, kDepth, kHeight + t), walls);
    addBox(scene, "front wall", Vec3(x0 - t, -t, -t), Vec3(x1, 0, kHeight + t), walls);
    addBox(scene, "back wall", Vec3(x0 - t, kDepth, -t), Vec3(x1, kDepth + t, kHeight + t), walls);
    addBox(scene, "left wall", Vec3(x0 - t, 0, -t), Vec3(x0, kDepth, kHeight + t), walls);
}

/// Adds a wall from (x, 0) to (x + kThick, kDepth) with an opening.
void addWallWithOpening(osg::Group& scene, float x, const Vec3& low, const Vec3& high,
                        PhysicalMaterial* walls)
{
    const float end = x + kThick;
    addBox(scene, "wall before", Vec3(x, -kThick, -kThick), Vec3(end, low.y(), kHeight + kThick),
           walls);
    addBox(scene, "wall beyond", Vec3(x, high.y(), -kThick),
           Vec3(end, kDepth + kThick, kHeight + kThick), walls);
    addBox(scene, "wall above", Vec3(x, low.y(), high.z()), Vec3(end, high.y(), kHeight + kThick),
           walls);
    addBox(scene, "wall below", Vec3(x, low.y(), -kThick), Vec3(end, high.y(), low.z()), walls);
}

/// Returns an even sky above grey ground, and a sun of one pixel with as much light as the sky.
osg::ref_ptr<osg::Image> skyWithSun()
{
    constexpr int kColumns = 128, kRows = 64, kSunColumn = 108, kSunRow = 46;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(kColumns, kRows, 1, GL_RGB, GL_FLOAT);
    auto* pixels = reinterpret_cast<Vec3*>(image->data());
    for (int i = 0; i < kColumns * kRows; ++i)
        pixels[i] = i / kColumns < kRows / 2 ? Vec3(0.2f, 0.2f, 0.18f) : Vec3(0.7f, 0.85f, 1.0f);
    const double low = std::sin((double(kSunRow) / kRows - 0.5) * osg::PI),
                 high = std::sin((double(kSunRow + 1) / kRows - 0.5) * osg::PI);
    const auto radiance = static_cast<float>(kColumns / (high - low));
    pixels[kSunRow * kColumns + kSunColumn] = Vec3(radiance, 0.9f * radiance, 0.75f * radiance);
    return image;
}

} // namespace

osg::ref_ptr<osg::Group> ajar(double slit, bool glossy)
{
    const SceneView view{Vec3d(7.6, 0.6, 1.6), Vec3d(4.6, 2.6, 0.9), Vec3d(0, 0, 1), 55.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("ajar", view, view);
    const osg::ref_ptr<PhysicalMaterial> white = lambert(Vec3(0.75f, 0.75f, 0.72f)),
                                         floor = lambert(Vec3(0.5f, 0.4f, 0.3f));
    if (glossy)
    {
        floor->setIor(1.5f);
        floor->setRoughness(0.15f);
    }
    const float end = 2.0f * kWidth;
    addShell(*scene, 0.0f, end, floor.get(), white.get());
    addBox(*scene, "right wall", Vec3(end, -kThick, -kThick),
           Vec3(end + kThick, kDepth + kThick, kHeight + kThick), white.get());
    const auto open = static_cast<float>(slit);
    addWallWithOpening(*scene, kWidth - 0.5f * kThick, Vec3(0, 2.0f, 0), Vec3(0, 2.0f + open, 2.0f),
                       white.get());
    addBox(*scene, "table", Vec3(5.2f, 2.4f, 0), Vec3(6.0f, 3.4f, 0.7f),
           lambert(Vec3(0.2f, 0.35f, 0.5f)).get());
    // The lamp stands by the far wall and shines to the ceiling.
    scene->addChild(new AreaLight(Vec3(0.4f, 0.5f, 1.5f), Vec3(0.3f, 0, 0), Vec3(0, 0.3f, 0),
                                  Vec3(400, 380, 340)));
    return scene;
}

osg::ref_ptr<osg::Group> window(WindowKind kind, double side)
{
    const SceneView view{Vec3d(0.3, 0.3, 1.6), Vec3d(3.0, 3.2, 0.9), Vec3d(0, 0, 1), 60.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("window", view, view);
    const osg::ref_ptr<PhysicalMaterial> white = lambert(Vec3(0.75f, 0.75f, 0.72f));
    addShell(*scene, 0.0f, kWidth, lambert(Vec3(0.5f, 0.4f, 0.3f)).get(), white.get());
    const auto half = static_cast<float>(0.5 * side);
    const Vec3 low(0, 2.0f - half, 1.4f - half), high(0, 2.0f + half, 1.4f + half);
    addWallWithOpening(*scene, kWidth, low, high, white.get());
    const osg::ref_ptr<PhysicalMaterial> clear = glass(1.5f);
    const float x = kWidth + 0.5f * kThick;
    if (kind == WindowKind::Pane)
    {
        clear->setThinWalled(true);
        scene->addChild(surface("pane",
                                {{Vec3(x, low.y(), low.z()), Vec3(x, high.y(), low.z()),
                                  Vec3(x, high.y(), high.z()), Vec3(x, low.y(), high.z())}},
                                clear.get()));
    }
    if (kind == WindowKind::Box)
        addBox(*scene, "pane", Vec3(x - 0.005f, low.y() - 0.01f, low.z() - 0.01f),
               Vec3(x + 0.005f, high.y() + 0.01f, high.z() + 0.01f), clear.get());
    addBox(*scene, "table", Vec3(2.2f, 1.2f, 0), Vec3(3.2f, 2.0f, 0.7f),
           lambert(Vec3(0.2f, 0.35f, 0.5f)).get());
    scene->addChild(new EnvironmentLight(skyWithSun().get()));
    return scene;
}

} // namespace osgRayTrace::data
