// City.cpp - streets at night under street lamps. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"
#include "Transport.h"

#include <osgRayTrace/AreaLight>

#include <cmath>
#include <random>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kBlocks = 10;                      ///< houses along each side
constexpr float kPitch = 30.0f, kStreet = 12.0f; ///< from street to street, and their width [m]
constexpr float kLampHeight = 6.0f, kLampSide = 0.4f;
constexpr float kPower = 4000.0f; ///< of all lamps, over pi

} // namespace

osg::ref_ptr<osg::Group> city(int lamps)
{
    const SceneView view{Vec3d(149, 118, 9), Vec3d(151, 151, 0.5), Vec3d(0, 0, 1), 50.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("city", view, view);
    const float size = kPitch * kBlocks;
    scene->addChild(
        surface("ground",
                {{Vec3(-kPitch, -kPitch, 0), Vec3(size + kPitch, -kPitch, 0),
                  Vec3(size + kPitch, size + kPitch, 0), Vec3(-kPitch, size + kPitch, 0)}},
                lambert(Vec3(0.25f, 0.25f, 0.26f)).get()));
    std::mt19937 engine(5);
    const auto number = [&](float low, float high)
    { return low + (high - low) * (static_cast<float>(engine() >> 8) * 0x1p-24f); };
    std::vector<Quad> houses;
    for (int i = 0; i < kBlocks * kBlocks; ++i)
    {
        const Vec3 low(kPitch * float(i % kBlocks) + 0.5f * kStreet,
                       kPitch * float(i / kBlocks) + 0.5f * kStreet, 0.0f);
        const Vec3 high = low + Vec3(kPitch - kStreet, kPitch - kStreet, number(8.0f, 30.0f));
        for (const Quad& side : boxQuads(low, high))
            houses.push_back(side);
    }
    scene->addChild(surface("houses", houses, lambert(Vec3(0.55f, 0.5f, 0.45f)).get()));
    const float radiance = kPower / (float(lamps) * kLampSide * kLampSide);
    for (int i = 0; i < lamps; ++i)
    {
        // Lamps stand at the edge of a street along x or y.
        const float across = kPitch * std::floor(number(0.0f, float(kBlocks + 1))) +
                             (i % 4 < 2 ? 1.0f : -1.0f) * (0.5f * kStreet - 1.5f);
        const float along = number(0.0f, size);
        const Vec3 place(i % 2 ? across : along, i % 2 ? along : across, kLampHeight);
        scene->addChild(new AreaLight(place, Vec3(0, kLampSide, 0), Vec3(kLampSide, 0, 0),
                                      Vec3(radiance, 0.85f * radiance, 0.6f * radiance)));
    }
    return scene;
}

} // namespace osgRayTrace::data
