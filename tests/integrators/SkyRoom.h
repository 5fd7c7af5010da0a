// SkyRoom.h - a room with an opening to a sunny sky, and means with openings that are given. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/integrators/shared/SkyPortalFinder.h"
#include "tests/integrators/MediaScenes.h"

namespace osgRayTrace::engine::test
{

inline RectangleLight rectangle(Vec3 corner, Vec3 edgeU, Vec3 edgeV)
{
    return rectangleLight(plainOf(corner), plainOf(edgeU), plainOf(edgeV));
}

inline Mat3 turned()
{
    const Vec3 z = glm::normalize(Vec3(0.2f, -0.3f, 1.0f)),
               x = glm::normalize(glm::cross(Vec3(0.5f, 1.0f, 0.0f), z));
    return Mat3(x, glm::cross(z, x), z);
}

/// A box of 4 x 5 x 3 with openings, turned and moved.
struct Room
{
    SceneBuilder builder;
    Mat3 turn{1.0f};
    Material material = lambert(Vec3(0.6f));

    void wall(Vec3 corner, Vec3 u, Vec3 v)
    {
        builder.add(quadMesh(turn * corner, turn * u, turn * v), material);
    }

    /// Adds the wall in the plane x = at, with an opening of 1 x 1 if it has one.
    void sideWall(float at, bool open)
    {
        if (!open) return wall({at, 0, 0}, {0, 5, 0}, {0, 0, 3});
        wall({at, 0, 0}, {0, 2, 0}, {0, 0, 3});
        wall({at, 3, 0}, {0, 2, 0}, {0, 0, 3});
        wall({at, 2, 0}, {0, 1, 0}, {0, 0, 1});
        wall({at, 2, 2}, {0, 1, 0}, {0, 0, 1});
    }

    /// Adds all walls but the one on the right.
    void buildHall(bool left)
    {
        wall({0, 0, 0}, {4, 0, 0}, {0, 5, 0});
        wall({0, 0, 3}, {4, 0, 0}, {0, 5, 0});
        wall({0, 0, 0}, {4, 0, 0}, {0, 0, 3});
        wall({0, 5, 0}, {4, 0, 0}, {0, 0, 3});
        sideWall(0, left);
    }

    void build(bool left, bool right)
    {
        buildHall(left);
        sideWall(4, right);
    }

    /// Adds a sky with a sun of 20 times its light, which shines through the right opening.
    void addSunnySky(float sun = 3000.0f)
    {
        Light sky;
        sky.kind = LightKind::Environment;
        sky.radiance = Vec3(1.0f);
        auto image = newEnvironment(64, 32, Vec3(1.0f));
        const EnvironmentMap map(image);
        const Vec3d towards = glm::normalize(Vec3d(turn * Vec3(1.0f, 0.1f, 0.6f)));
        int x = 0, y = 0;
        double best = -1.0;
        for (int row = 0; row < 32; ++row)
            for (int column = 0; column < 64; ++column)
            {
                const double cosine = glm::dot(map.direction(column + 0.5, row + 0.5), towards);
                if (cosine > best) x = column, y = row;
                best = std::max(best, cosine);
            }
        pixelOf(*image, x, y) = Vec3(sun);
        sky.environment.image = image;
        builder.addLight(sky);
    }

    View view(int width, int height) const
    {
        const auto at = [this](Vec3 p) { return Vec3d(turn * p); };
        return perspectiveView(at({1, 0.4f, 1.6f}), at({2.2f, 4, 1}), at({0, 0, 1}), 60.0, width,
                               height);
    }
};

inline PassContext contextOf(const TracedScene& traced, const View& view, int maxBounces = 8)
{
    PassContext context;
    context.traced = &traced;
    context.lights = &traced.scene().lights;
    context.camera = *cameraRays(view, traced.scene().origin, traced.scene().unit);
    context.width = view.width;
    context.height = view.height;
    const Vec3d eye(glm::inverse(view.viewFromWorld)[3]);
    context.eye = Vec3((eye - traced.scene().origin) / traced.scene().unit);
    context.options = optionsOf(IntegratorKind::Path, maxBounces);
    return context;
}

/// Returns the mean green radiance of a tile whose passes know these portals; null: none.
inline Estimate meanWith(const TracedScene& traced, const View& view, const SkyPortals* portals,
                         int passes)
{
    PassContext context = contextOf(traced, view, 4);
    context.portals = portals;
    const auto integrator = newIntegrator(IntegratorKind::Path);
    Estimate estimate;
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        double sum = 0.0;
        for (int pass = 0; pass < passes; ++pass)
        {
            context.key = context.pathKey = passKey(seed, pass);
            TileRgba rgba;
            TileResult result;
            result.rgba = rgba;
            integrator->renderTile(context, 0, 0, result);
            REQUIRE(result.counts.droppedSamples == 0);
            for (const RgbaLanes& block : rgba)
                for (int i = 0; i < kLanes; ++i)
                    sum += double(block.g[i]) / (double(passes) * kTilePixels);
        }
        estimate.add(sum);
    }
    return estimate;
}

} // namespace osgRayTrace::engine::test
