// Terrace.cpp - balls on a terrace in the sun, and the sky. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include "osgPlugins/exr/ExrImage.h"

#include <osgRayTrace/EnvironmentLight>

#include <osg/Image>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kWidth = 128, kHeight = 64;
constexpr int kSunColumn = 40, kSunRow = 46; ///< to the left of the middle, 41 degrees high
constexpr float kHalf = 4.0f;                ///< half the terrace's side [m]
constexpr float kTile = 0.5f;

/// Returns the direction towards the middle of a pixel, in EnvironmentLight's axes.
Vec3d directionOf(int column, int row)
{
    const double azimuth = ((column + 0.5) / kWidth - 0.5) * 2.0 * osg::PI;
    const double elevation = ((row + 0.5) / kHeight - 0.5) * osg::PI;
    const double across = std::cos(elevation);
    return Vec3d(across * std::sin(azimuth), across * std::cos(azimuth), std::sin(elevation));
}

double solidAngle(int row)
{
    const double low = std::sin((double(row) / kHeight - 0.5) * osg::PI);
    const double high = std::sin((double(row + 1) / kHeight - 0.5) * osg::PI);
    return 2.0 * osg::PI / kWidth * (high - low);
}

/// Returns the sky: blue above, pale at the horizon, brighter around the sun; grassland below.
Vec3 skyWithoutSun(const Vec3d& direction)
{
    const double z = direction.z();
    if (z < 0.0)
    {
        const double far = (1.0 + z) * (1.0 + z) * (1.0 + z);
        return Vec3(0.1f, 0.11f, 0.06f) + Vec3(0.12f, 0.13f, 0.12f) * float(far);
    }
    const double haze = std::pow(1.0 - z, 3.0);
    const double glow = std::pow(std::max(0.0, direction * directionOf(kSunColumn, kSunRow)), 24.0);
    return Vec3(0.16f, 0.32f, 0.75f) + Vec3(0.55f, 0.45f, 0.15f) * float(haze) +
           Vec3(1.1f, 0.95f, 0.7f) * float(glow);
}

std::vector<Quad> tiles(int parity)
{
    std::vector<Quad> quads;
    const int count = static_cast<int>(2.0f * kHalf / kTile);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
        {
            if ((i + j) % 2 != parity) continue;
            const float x = -kHalf + kTile * float(i), y = -kHalf + kTile * float(j);
            quads.push_back({Vec3(x, y, 0), Vec3(x + kTile, y, 0), Vec3(x + kTile, y + kTile, 0),
                             Vec3(x, y + kTile, 0)});
        }
    return quads;
}

} // namespace

std::string writeSky(const std::string& path)
{
    engine::ExrImage image;
    image.width = kWidth;
    image.height = kHeight;
    image.channels.resize(3);
    double energy = 0.0;
    for (int c = 0; c < 3; ++c)
    {
        engine::ExrChannel& channel = image.channels[static_cast<std::size_t>(c)];
        channel.name = std::string(1, "RGB"[c]);
        channel.half = true;
        for (int row = 0; row < kHeight; ++row)
            for (int column = 0; column < kWidth; ++column)
            {
                const float value = skyWithoutSun(directionOf(column, row))[c];
                channel.values.push_back(value);
                if (c == 1) energy += value * solidAngle(row);
            }
    }
    // The sun has as much green light as all the rest.
    const Vec3 sun = Vec3(1.08f, 1.0f, 0.82f) * float(energy / solidAngle(kSunRow));
    for (int c = 0; c < 3; ++c)
        image.channels[static_cast<std::size_t>(c)].values[kSunRow * kWidth + kSunColumn] = sun[c];
    return engine::writeExr(path, image);
}

osg::ref_ptr<osg::Group> terrace()
{
    // At home the terrace is level, and seen from the height of the balls on it.
    osg::ref_ptr<osg::MatrixTransform> scene =
        newScene("terrace", {Vec3d(0.6, -4.4, 1.75), Vec3d(0.0, 0.0, 0.55), Vec3d(0, 0, 1), 38.0},
                 {Vec3d(0.0, -5.0, 0.9), Vec3d(0.0, 0.0, 0.9), Vec3d(0, 0, 1), 38.0});
    scene->addChild(surface("pale tiles", tiles(0), lambert(Vec3(0.62f, 0.58f, 0.52f)).get()));
    scene->addChild(surface("dark tiles", tiles(1), lambert(Vec3(0.38f, 0.3f, 0.25f)).get()));
    scene->addChild(surface("plinth", boxQuads(Vec3(-1.9f, 0.3f, 0), Vec3(-1.1f, 1.1f, 0.5f)),
                            lambert(Vec3(0.7f, 0.68f, 0.64f)).get()));
    scene->addChild(
        sphere("chrome", Vec3(-1.5f, 0.7f, 0.951f), 0.45f, metal(Vec3(0.92f, 0.92f, 0.92f)).get()));
    scene->addChild(sphere("glass", Vec3(-0.25f, -0.7f, 0.451f), 0.45f, glass(1.5f).get()));
    scene->addChild(
        sphere("plaster", Vec3(0.45f, 0.9f, 0.601f), 0.6f, lambert(Vec3(0.8f, 0.8f, 0.78f)).get()));
    const osg::ref_ptr<PhysicalMaterial> gold = metal(Vec3(1.0f, 0.71f, 0.29f));
    gold->setRoughness(0.35f);
    scene->addChild(sphere("gold", Vec3(1.35f, -0.35f, 0.401f), 0.4f, gold.get()));

    // The image is stored by name: the file lies beside the scene.
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setFileName("sky.exr");
    image->allocateImage(1, 1, 1, GL_RGB, GL_FLOAT);
    osg::ref_ptr<EnvironmentLight> sky = new EnvironmentLight(image);
    sky->setName("sky");
    scene->addChild(sky.get());
    return scene;
}

} // namespace osgRayTrace::data
